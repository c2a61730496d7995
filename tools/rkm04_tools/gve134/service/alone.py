"""What the page that needs no service brings along: examples as vector files."""

from __future__ import annotations

from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.gcode.axes import read_mill
from rkm04_tools.gve134.gcode.turning import turn_file
from rkm04_tools.gve134.job import job_of
from rkm04_tools.gve134.service.app import EXAMPLES, MACHINE, examples
from rkm04_tools.gve134.source import is_gcode
from rkm04_tools.source import Source


def brought() -> dict[str, Any]:
    """The examples that can be sent; those of G-code as `gcode` turns them."""
    found = [_example(name) for name in examples()]
    return {"examples": [each for each in found if _can_be_sent(each)]}


def _can_be_sent(example: dict[str, str]) -> bool:
    try:
        job_of(Source(example["name"], example["text"]))
    except Failure:
        return False
    return True


def _example(name: str) -> dict[str, str]:
    place = EXAMPLES / name
    if not is_gcode(name):
        return {"name": name, "text": place.read_text(encoding="utf-8")}
    pieces: list[str] = []
    lines = place.read_bytes().splitlines()
    if not turn_file(lines, name, read_mill(str(MACHINE)), pieces.append).is_good:
        raise Failure(f"{name}: the example has errors; is the clone whole?")
    return {"name": place.with_suffix(".gve").name, "text": "".join(pieces)}
