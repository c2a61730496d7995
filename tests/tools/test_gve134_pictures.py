"""The pictures of the examples are those that the tools draw, as their README tells."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from rkm04_tools.cli import run_tool
from rkm04_tools.gve134.cli import make_parser

EXAMPLES = Path(__file__).resolve().parents[2] / "tools" / "examples" / "gve"
OPTIONS = {
    "packet": ["--xy"], "circle": ["--xy"], "pocket": ["--xy"], "engraving": ["--xy"],
    "stop": ["--plot"], "probe": ["--plot"], "home": ["--plot"], "rotary": ["--plot"],
}  # fmt: skip
NUMBER = re.compile(r"-?\d+\.\d+")
NAME = re.compile(r'id="[^"]*"|url\(#[^)]*\)|href="#[^"]*"')
"""Made of what is drawn, to the last digit."""

NEAR = 0.01
"""Points."""


def tool(*words: str | Path) -> None:
    assert run_tool(make_parser(), list(map(str, words))) == 0


def draw(name: str, folder: Path) -> str:
    picture, program, vectors = folder / "a.svg", EXAMPLES / f"{name}.nc", EXAMPLES / f"{name}.gve"
    inputs = EXAMPLES / f"{name}.csv"
    machine: list[str | Path] = ["--machine", EXAMPLES / "mill.rkm"]
    if OPTIONS[name] == ["--xy"] and program.is_file():
        tool("gcode", program, *machine, "--xy", picture)
        return picture.read_text(encoding="utf-8")
    if program.is_file():
        vectors = folder / f"{name}.gve"
        tool("gcode", program, *machine, "-o", vectors)
    more: list[str | Path] = ["--inputs", inputs] if inputs.is_file() else []
    tool("sim", vectors, *more, *OPTIONS[name], picture)
    return picture.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(OPTIONS))
def test_the_picture_of_an_example_is_what_is_drawn_of_it(name: str, tmp_path: Path) -> None:
    drawn, kept = (
        NAME.sub("", text)
        for text in (draw(name, tmp_path), (EXAMPLES / f"{name}.svg").read_text(encoding="utf-8"))
    )

    assert NUMBER.sub("", drawn) == NUMBER.sub("", kept)
    pairs = itertools.zip_longest(NUMBER.findall(drawn), NUMBER.findall(kept))
    assert all(abs(float(ours) - float(theirs)) <= NEAR for ours, theirs in pairs)
