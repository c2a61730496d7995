"""`service --static`: pages as files that need no service, each with a unit in it."""

from __future__ import annotations

import base64
import contextlib
import gzip
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rkm04_tools import host
from rkm04_tools.failure import DONE, Failure

PAGES_MARK = "<!-- pages -->"
"""Where a page has the links to those of other units."""

INDENT = re.compile("^ +", re.MULTILINE)


@dataclass(frozen=True)
class StaticPage:
    """A page that is written as one file.

    `script` names its script and style, `worker` the script of its worker, `words` the file of
    what that says in other languages. `programs` are those
    for WebAssembly, each under the name by which the page finds it, and so is what `more` returns.
    """

    name: str
    script: str
    worker: str
    words: str
    programs: Mapping[str, str]
    more: Callable[[], dict[str, Any]]

    @property
    def word(self) -> str:
        """The key of its name in the words of all pages."""
        return f"unit.{Path(self.name).stem}"


def write(folder: Path, pages: Sequence[StaticPage], shown: str) -> int:
    """Write pages, which lead to each other, into a folder, which is made if need be.

    `shown` is the name of that which is to be opened.
    """
    build = host.program_path().parents[2]
    source, wasm = build / "service", build / "wasm" / "bin"
    for needed in _needed(pages, source, wasm):
        if not needed.is_file():
            raise Failure(f"{needed}: not built; start the command as tools/rkm04, which builds it")
    texts = {page.name: _whole(page, pages, source, wasm) for page in pages}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            _put(folder / name, text)
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise Failure(f"{folder}: cannot be written ({why}); name a folder of yours") from None
    print(f"{folder / shown}: open it in a browser, or let any web server serve the folder")
    return DONE


def _needed(pages: Sequence[StaticPage], source: Path, wasm: Path) -> list[Path]:
    programs = [wasm / name for page in pages for name in page.programs.values()]
    brought = [source / name for page in pages for name in (page.worker, page.words)]
    return [*brought, *programs]


def _put(place: Path, text: str) -> None:
    """Write a file, whole or not at all."""
    part = place.with_name(f"{place.name}.part")
    try:
        part.write_text(text, encoding="utf-8")
        part.replace(place)
    except OSError:
        with contextlib.suppress(OSError):
            part.unlink()
        raise


def _whole(page: StaticPage, pages: Sequence[StaticPage], source: Path, wasm: Path) -> str:
    """The page with all that it refers to; what it brings along it finds under `alone`."""
    brought = {
        **{key: _packed(wasm / name) for key, name in page.programs.items()},
        "worker": (source / page.worker).read_text(encoding="utf-8"),
        "words": json.loads((source / page.words).read_text(encoding="utf-8"))["alone"],
        **page.more(),
    }
    icon = base64.b64encode((source / "icon.svg").read_bytes()).decode("ascii")
    style, script = (
        (source / f"{page.script}.{kind}").read_text(encoding="utf-8") for kind in ("css", "js")
    )
    parts = {
        f'<link rel="stylesheet" href="/static/{page.script}.css">': _element("style", style),
        f'<script type="module" src="/static/{page.script}.js"></script>': _element(
            'script type="application/json" id="alone"', json.dumps(brought, ensure_ascii=False)
        )
        + _element('script type="module"', script),
        "/static/icon.svg": f"data:image/svg+xml;base64,{icon}",
        PAGES_MARK: _links(page, pages),
    }
    text = INDENT.sub("", (source / page.name).read_text(encoding="utf-8"))
    for place, part in parts.items():
        if place not in text:
            raise Failure(f"{source}: the page is of another version; run tools/setup service")
        text = text.replace(place, part)
    return text


def _links(page: StaticPage, pages: Sequence[StaticPage]) -> str:
    """Those to all pages, where there are several."""
    if len(pages) == 1:
        return ""
    links = ""
    for each in pages:
        here = ' aria-current="page"' if each is page else ""
        links += f'<a href="{each.name}" data-t="{each.word}"{here}></a>'
    return f'<nav id="pages" data-t-label="page.units">{links}</nav>'


def _packed(path: Path) -> str:
    """A program, compressed before base64, after which little could be gained."""
    return base64.b64encode(gzip.compress(path.read_bytes(), mtime=0)).decode("ascii")


def _element(tag: str, content: str) -> str:
    """An element whose content cannot end it."""
    name = tag.split()[0]
    safe = re.sub(f"</(?={name})", r"<\\/", content, flags=re.IGNORECASE)
    return f"<{tag}>{safe}</{name}>"
