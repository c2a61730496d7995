"""The pages of all units that need no service; each unit's `service --static` writes all."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rkm04_tools.gve134.service import alone as gve134
from rkm04_tools.positioning import state as positioning
from rkm04_tools.service import static
from rkm04_tools.service.checking import examples
from rkm04_tools.service.static import StaticPage
from rkm04_tools.status import CAUSES, ERRORS, LINE_COUNTS
from rkm04_tools.tree import ROOT

SCRIPTS = ROOT / "tools/examples/positioning"
INPUTS = "-inputs"
"""What the name of a file of inputs has after that of its script."""


def _of_rkm04() -> dict[str, Any]:
    names = {"causes": CAUSES, "errors": ERRORS, "line": list(LINE_COUNTS)}
    return {"names": names, "examples": examples()}


def _of_positioning() -> dict[str, Any]:
    scripts = [path for path in sorted(SCRIPTS.glob("*.csv")) if not path.stem.endswith(INPUTS)]
    names = {"errors": positioning.ERRORS, "exceptions": positioning.EXCEPTIONS}
    return {"names": names, "examples": [_script(path) for path in scripts]}


def _script(path: Path) -> dict[str, str]:
    """An example with the inputs that belong to it."""
    inputs = path.with_name(f"{path.stem}{INPUTS}.csv")
    text = inputs.read_text(encoding="utf-8") if inputs.exists() else ""
    return {"name": path.name, "text": path.read_text(encoding="utf-8"), "inputs": text}


PAGES = (
    StaticPage(
        "index.html", "page", "engine.js", "told_rkm04.json",
        {"program": "rkm04-host.wasm", "unit": "rkm04-unit.wasm"}, _of_rkm04,
    ),
    StaticPage(
        "gve134.html", "gve134", "gve134_unit.js", "told_gve134.json",
        {"program": "gve134-host.wasm", "unit": "gve134-unit.wasm"}, gve134.brought,
    ),
    StaticPage(
        "positioning.html", "positioning", "positioning_unit.js", "told_positioning.json",
        {"program": "positioning-host.wasm", "unit": "positioning-unit.wasm"}, _of_positioning,
    ),
)  # fmt: skip
"""The first one is what a web server shows for the folder."""

PROGRAMS = tuple(name for page in PAGES for name in page.programs.values())


def write(folder: Path, shown: str = PAGES[0].name) -> int:
    """Write all pages into a folder, which is made if need be; tell which one is to be opened."""
    return static.write(folder, PAGES, shown)
