"""What commands that act send to a unit, and what they print of it."""

from __future__ import annotations

from typing import Any

from fake_unit import MOVING, RUNNING, FakeUnit

NODE = 3
GOES = RUNNING | MOVING
PROGRAMS = {1: b"S100V1000F5000R", 2: b"", 3: b"C100", 4: b""}


def acts(unit: FakeUnit) -> list[tuple[int, bytes]]:
    """Motor and text of the Set Command messages."""
    return [(int(done[1:2]), done[2:]) for done in unit.done if done[0] == 2]


def lines(result: Any) -> list[str]:
    """What was printed of the unit, nothing being wrong."""
    assert result.err == ""
    return [line.removeprefix(f"unit {NODE}: ") for line in result.out.splitlines()]
