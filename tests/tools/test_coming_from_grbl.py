"""What firmware/gve134/docs/coming-from-grbl.md tells users of grbl is so."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from gcode_played import content, good, mill, play
from rkm04_tools.gve134.gcode.axes import mill_of
from rkm04_tools.machine.machine import Machine

PAGE = (Path(__file__).resolve().parents[2] / "firmware/gve134/docs/coming-from-grbl.md").read_text(
    encoding="utf-8"
)
WORD = re.compile(r"\b[GM]\d+(?:\.\d)?\b")
LINES = {
    "G1": "G1 X1 F100", "G2": "G2 I5 F100", "G3": "G3 I5 F100", "G4": "G4 P1", "G20": "G20 G0 X1",
    "G92": "G92 X3", "G93": "G93 G1 X1 F10", "M3": "M3 S1000", "M6": "T1 M6",
    "M4": "M4 S1000", "G10": "G10 L20 P1 X0", "G43.1": "G43.1 Z1", "G53": "G53 G0 X0",
    "G38.3": "G38.3 Z-1 F60", "G38.4": "G38.4 Z-1 F60", "G38.5": "G38.5 Z-1 F60",
}  # fmt: skip
"""Words that stand alone do without what they need; these lines have it."""


def row(name: str) -> list[str]:
    """The words of a row of the table of G-code."""
    found = re.search(rf"^\| {name} \| (.*) \|$", PAGE, re.MULTILINE)
    assert found is not None
    return WORD.findall(found[1])


def both_ways() -> Any:
    """A mill whose spindle turns both ways."""
    told = content()
    told["gve134"]["spindle"]["reverse_bit"] = 4
    return mill(told)


@pytest.mark.parametrize("word", row("the same") + row("taken, as it is so anyway"))
def test_what_is_the_same_is_taken(word: str) -> None:
    good(LINES.get(word, word), both_ways())


@pytest.mark.parametrize("word", row("an error here"))
def test_what_is_an_error_is_refused(word: str) -> None:
    assert play(LINES.get(word, word)).errors


@pytest.mark.parametrize(
    "line", ["G81 X1 Z-1 R1 F100", "#1=3", "G0 X[1+2]", "M98 P1", "/G0 X1", "$H", "$J=G91 X1 F100"]
)
def test_what_else_is_an_error_is_refused(line: str) -> None:
    assert play(line).errors


def test_what_acts_makes_the_axes_stand() -> None:
    for acting in ("M3 S1000", "M5", "M7", "M8", "M9"):
        lines = good(f"M3 S500\nG1 X1 F100\n{acting}\nG1 X2").lines

        assert lines.count("L0,0,0,0") >= 2, acting


def test_positions_beyond_the_limits_are_errors_after_a_reference_run() -> None:
    assert play("G28\nG0 X-1").errors
    good("G0 X-1")


def test_after_a_touch_only_ways_are_allowed_until_a_position_is_set() -> None:
    assert play("G38.2 Z-5 F60\nG0 Z1").errors
    good("G38.2 Z-5 F60\nG91\nG0 Z1")
    good("G38.2 Z-5 F60\nG92 Z0\nG0 Z1")


def test_a_feed_above_the_axes_is_an_error_and_one_axis_too_slow_a_warning() -> None:
    assert play("G1 X1 F100000").errors
    assert good("G1 X10 A90 F500").warnings


def example() -> dict[str, Any]:
    block = re.search(r"^```json\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert block is not None
    told: dict[str, Any] = json.loads(block[1])
    return told


def test_the_machine_file_of_the_page_is_one() -> None:
    machine = mill_of(Machine("mill.rkm", example()))

    good("G28 X0\nG0 X10 Y10\nM3 S12000\nG1 X20 Z-1 F600\nG38.2 Z-5 F60\nM30", machine)


def test_settings_are_converted_as_the_page_says() -> None:
    axis = example()["gve134"]["axes"]["x"]
    homing = axis["homing"]

    assert axis["speed_steps_per_s"] == 320 * 3000 / 60
    assert axis["accel_steps_per_s2"] == 320 * 500
    assert axis["jump_steps_per_s"] == math.floor(320 * math.sqrt(8 * 500 * 0.01))
    assert example()["gve134"]["corner_deviation_mm"] == 0.01
    assert homing["way_steps"] == -320 * 310
    assert homing["speed_steps_per_s"] == 320 * 1500 / 60
    assert homing["back_speed_steps_per_s"] == 320 * 60 / 60
    assert homing["back_steps"] == 320 * 5
