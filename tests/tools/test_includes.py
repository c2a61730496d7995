"""Includes and imports under tools/ lead one way: no module in C includes itself by way of others,
where a source and its header count as one, and in Python the tools know nothing of the checks."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from checks.house import ROOT

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
CHECKS = re.compile(r"^ *(?:from|import) checks\b", re.MULTILINE)
FOLDERS = (
    "common",
    "unit_host",
    "unit_serve",
    "simulator",
    "gve134_host",
    "positioning_host",
    "vboard",
)


def modules(folder: Path) -> dict[str, set[str]]:
    """The modules of a folder, each a source with its header, and which others they include."""
    sources = list(folder.glob("*.[ch]"))
    own = {source.stem for source in sources}
    found: dict[str, set[str]] = {stem: set() for stem in own}
    for source in sources:
        names = {Path(name).stem for name in INCLUDE.findall(source.read_text())}
        found[source.stem] |= names & own - {source.stem}
    return found


def circle(includes: dict[str, set[str]]) -> set[str]:
    """What is left when all that includes nothing of what is left has been taken away."""
    left = dict(includes)
    while ends := {name for name, others in left.items() if not others & left.keys()}:
        left = {name: others for name, others in left.items() if name not in ends}
    return set(left)


@pytest.mark.parametrize("folder", FOLDERS)
def test_includes_go_in_no_circle(folder: str) -> None:
    assert circle(modules(ROOT / "tools" / folder)) == set()


def test_no_model_knows_the_board() -> None:
    top = {"board", "board_map", "board_reset", "hook", "main", "run", "summary"}
    includes = modules(ROOT / "tools" / "vboard")

    assert {name for name, others in includes.items() if "board" in others} <= top


def test_a_circle_through_a_source_is_seen(tmp_path: Path) -> None:
    texts = {"board.h": "timer", "timer.h": "clock", "timer.c": "board", "clock.h": "none"}
    for name, other in texts.items():
        (tmp_path / name).write_text(f'#include "{other}.h"\n')

    assert circle(modules(tmp_path)) == {"board", "timer"}


def test_the_tools_import_nothing_from_the_checks() -> None:
    sources = (ROOT / "tools/rkm04_tools").rglob("*.py")

    assert [source for source in sources if CHECKS.search(source.read_text())] == []
