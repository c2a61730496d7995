"""`service --static`: the page as one file that needs no service, with a unit in it."""

from __future__ import annotations

import base64
import contextlib
import gzip
import json
import re
from pathlib import Path

from rkm04_tools import host
from rkm04_tools.failure import DONE, Failure
from rkm04_tools.service.checking import examples
from rkm04_tools.status import CAUSES, ERRORS, LINE_COUNTS

PROGRAM, UNIT = "bin/rkm04-host.wasm", "bin/rkm04-unit.wasm"
NAME = "index.html"


def write(folder: Path) -> int:
    """Write the page into a folder, which is made if need be."""
    build = host.program_path().parents[2]
    page, wasm = build / "service", build / "wasm"
    for needed in (page / "engine.js", wasm / PROGRAM, wasm / UNIT):
        if not needed.is_file():
            raise Failure(f"{needed}: not built; start the command as tools/rkm04, which builds it")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        place, part = folder / NAME, folder / f"{NAME}.part"
        part.write_text(_whole(page, wasm), encoding="utf-8")
        part.replace(place)
    except OSError as error:
        with contextlib.suppress(OSError):
            (folder / f"{NAME}.part").unlink()
        why = (error.strerror or str(error)).lower()
        raise Failure(f"{folder}: cannot be written ({why}); name a folder of yours") from None
    print(f"{place}: open it in a browser, or let any web server serve the folder")
    return DONE


def _whole(page: Path, wasm: Path) -> str:
    """The page with all that it refers to; what it brings along it finds under `alone`."""
    brought = {
        "program": _packed(wasm / PROGRAM),
        "unit": _packed(wasm / UNIT),
        "names": {"causes": CAUSES, "errors": ERRORS, "line": list(LINE_COUNTS)},
        "worker": (page / "engine.js").read_text(encoding="utf-8"),
        "examples": examples(),
    }
    icon = base64.b64encode((page / "icon.svg").read_bytes()).decode("ascii")
    script = (page / "page.js").read_text(encoding="utf-8")
    parts = {
        '<link rel="stylesheet" href="/static/page.css">': _element(
            "style", (page / "page.css").read_text(encoding="utf-8")
        ),
        '<script type="module" src="/static/page.js"></script>': _element(
            'script type="application/json" id="alone"', json.dumps(brought)
        )
        + _element('script type="module"', script),
        "/static/icon.svg": f"data:image/svg+xml;base64,{icon}",
    }
    text = (page / "index.html").read_text(encoding="utf-8")
    for place, part in parts.items():
        if place not in text:
            raise Failure(f"{page}: the page is of another version; run tools/setup service")
        text = text.replace(place, part)
    return text


def _packed(path: Path) -> str:
    """A program, compressed before base64, after which little could be gained."""
    return base64.b64encode(gzip.compress(path.read_bytes(), mtime=0)).decode("ascii")


def _element(tag: str, content: str) -> str:
    """An element whose content cannot end it."""
    name = tag.split()[0]
    safe = re.sub(f"</(?={name})", r"<\\/", content, flags=re.IGNORECASE)
    return f"<{tag}>{safe}</{name}>"
