"""Corners by a deviation: the speed of each border, and nothing else of the path."""

from __future__ import annotations

import math
from typing import Any

import pytest
from gcode_played import content, good, mill
from hypothesis import given
from hypothesis import strategies as st
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import Mill

DEVIATION_MM = 0.01
ACCEL, PER_MM = 500.0, 320.0
TOP, LEAST = 200_000, 10


def even(deviation: float | None = DEVIATION_MM) -> Mill:
    """The mill of the examples, with axes that are alike."""
    told: dict[str, Any] = content()
    told["motors"][2]["steps_per_mm"] = 320
    told["gve134"]["axes"]["z"]["accel_steps_per_s2"] = 160_000
    if deviation:
        told["gve134"]["corner_deviation_mm"] = deviation
    return mill(told)


def borders(program: str, machine: Mill | None = None) -> list[int]:
    """B of each vector."""
    found, border = [], 0
    for line in good(program, machine or even()).lines:
        if line[0] == "B":
            border = int(line[1:])
        if line[0] == "C":
            found.append(border)
    return found


def expected(turn_degrees: float, accel: float = ACCEL) -> float:
    """By the arc that touches both sides: v² = a·r, and its centre is r/cos(t/2) away."""
    half = math.radians(turn_degrees) / 2
    radius = DEVIATION_MM / (1 / math.cos(half) - 1)
    return PER_MM * math.sqrt(accel * radius)


@pytest.mark.parametrize("degrees", [0.5, 5, 20, 45, 90, 135, 170])
def test_a_corner_is_passed_by_the_arc_that_fits_beside_it(degrees: float) -> None:
    """The turn is around the direction 45° + 90°, in which two axes share the acceleration."""
    one, two = (math.radians(45 + sign * degrees / 2) for sign in (-1, 1))
    x, y = 100 * math.cos(one), 100 * math.sin(one)
    u, v = x + 100 * math.cos(two), y + 100 * math.sin(two)

    first, *_ = borders(f"G1 X{x:.6f} Y{y:.6f} F600\nX{u:.6f} Y{v:.6f}")

    assert first == pytest.approx(min(TOP, expected(degrees, ACCEL * math.sqrt(2))), rel=0.01)


def test_a_flat_corner_off_one_axis_has_its_acceleration() -> None:
    slope = math.tan(math.radians(10))
    first, *_ = borders(f"G1 X100 Y{-100 * slope:.6f} F600\nX200 Y0")

    assert first == pytest.approx(expected(20), rel=0.01)


@pytest.mark.parametrize(
    ("program", "border"),
    [
        ("G1 X10 F600\nX20", TOP),
        ("G1 X10 F600\nX0", LEAST),
        ("G1 A10 F600\nX1", TOP),
        ("G1 X10 F600\nA1", TOP),
    ],
)
def test_what_is_no_corner_of_x_y_z_has_no_speed_of_one(program: str, border: int) -> None:
    assert borders(program)[0] == border


def test_where_pulses_differ_the_slower_side_counts() -> None:
    told = content()
    told["gve134"]["corner_deviation_mm"] = DEVIATION_MM
    z_accel = 120_000 / 400

    first, *_ = borders("G1 X10 F600\nZ-10", mill(told))

    accel = min(ACCEL, z_accel) * math.sqrt(2)
    assert first == pytest.approx(PER_MM * math.sqrt(accel * DEVIATION_MM * 2.4142), rel=0.01)


def test_the_speed_stands_before_the_vector_that_ends_at_the_corner() -> None:
    lines = good("G1 X10 F600\nY10\nM5\nG1 X20", even()).lines

    assert lines[2:6] == ["L0,0,0,0", "T1", "VK", "B200000"]
    assert lines[6] == "$1"
    assert lines[9:] == [
        "V3200", "A160", "B1322", "C3200,0,0,0 ; line 1", "C0,3200,0,0 ; line 2", "L0,0,0,0",
        "!7V0", "C3200,0,0,0 ; line 4", "L0,0,0,0",
    ]  # fmt: skip


MOVES = st.lists(
    st.tuples(
        st.sampled_from(["G0", "G1", "G2", "M8", "M9"]), *[st.integers(-40, 40) for _ in range(3)]
    ),
    min_size=1,
    max_size=30,
)


@given(MOVES)
def test_nothing_but_borders_is_added(moves: list[tuple[str, int, int, int]]) -> None:
    lines = ["F600"]
    for word, x, y, z in moves:
        more = f" X{x / 10} Y{y / 10} Z{z / 10}"
        lines.append(
            {"G2": "G2 I1 Z" + str(z / 10)}.get(word, word + more if word[0] == "G" else word)
        )
    program = "\n".join(lines)

    plain, cornered = good(program, even(None)).lines, good(program, even()).lines

    assert [line for line in cornered if line[0] not in "B$"] == [
        line for line in plain if line[0] != "B"
    ]
    assert host.check("\n".join(cornered)).errors == []
