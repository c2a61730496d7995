"""What is measured of a controller's pulses beside another's: known lines give known figures.

The comparison itself, tests/support/peer_grblhal.py, needs a program that the project has not.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from peer_grblhal import train_of, train_of_steps
from peer_jobs import JOBS
from peer_pulses import (
    AXES,
    Circle,
    Deviation,
    Steps,
    Train,
    corner_speeds,
    deviation,
    off_the_circles,
)

Moment = Callable[[float], float]
"""When a part of the way, 0 to 1, has been done: seconds since the begin of the move."""


def cruise(way: float) -> float:
    return 0.5 * way


def ramp(way: float) -> float:
    return math.sqrt(way + 0.01)


def played(ends: Sequence[Steps], moment: Moment, offset: float = 0.0) -> Train:
    """Ideal pulses of moves, each of which begins where the one before it has ended."""
    train, begun = Train(), 0.0
    for begin, end in itertools.pairwise(ends):
        for axis in range(AXES):
            way = end[axis] - begin[axis]
            for k in range(1, abs(way) + 1):
                at = begun + moment((k - offset) / abs(way))
                train.add(axis, at, 1 if way > 0 else -1)
        begun += moment(1)
    return train


LINES = st.lists(
    st.tuples(*(st.integers(-60, 60),) * AXES), min_size=1, max_size=4
).map(lambda ends: [(0, 0, 0), *ends])  # fmt: skip


@given(LINES, st.sampled_from([0.0, 0.5]))
def test_pulses_on_the_ideal_line_do_not_deviate(ends: list[Steps], offset: float) -> None:
    worst = deviation(played(ends, cruise, offset), ends, offset)

    assert worst.pulses < 1e-9
    assert worst.us < 1e-3


def test_a_ramp_is_no_deviation() -> None:
    ends = [(0, 0, 0), (1000, 317, -41)]

    assert deviation(played(ends, ramp), ends, 0).pulses < 0.001


@given(
    st.integers(1, 40),
    st.floats(-0.4, 0.4).filter(lambda part: abs(part) > 0.001),
    st.sampled_from([1, 2]),
)
def test_one_pulse_beside_the_line_is_found(number: int, part: float, axis: int) -> None:
    ends = [(0, 0, 0), (100, 50, 50)]
    train = played(ends, cruise)
    train.times[axis][number] += part * cruise(1) / 50

    worst = deviation(train, ends, 0)

    assert worst.pulses == pytest.approx(abs(part))
    assert worst.us == pytest.approx(abs(part) * cruise(1) / 50 * 1e6)


def test_pulses_on_the_grid_of_the_longest_axis_deviate_by_half_a_pulse_at_most() -> None:
    length, short = 100, 97
    train = Train()
    taken = 0
    for k in range(1, length + 1):
        train.add(0, k * 1e-3, 1)
        due = (2 * k * short + length) // (2 * length)
        if due > taken:
            train.add(1, k * 1e-3, 1)
            taken = due

    worst = deviation(train, [(0, 0, 0), (length, short, 0)], 0.5)

    assert worst.pulses == pytest.approx(0.5, abs=0.02)
    assert worst.us == pytest.approx(500, abs=20)


@pytest.mark.parametrize("ends", [[(0, 0, 0), (10, 5, 1)], [(0, 0, 0), (10, 4, 0)],
                                  [(0, 0, 0), (9, 5, 0), (10, 6, 0)]])  # fmt: skip
def test_a_train_that_goes_elsewhere_is_not_measured(ends: list[Steps]) -> None:
    train = played([(0, 0, 0), (10, 5, 0)], cruise)

    with pytest.raises(ValueError, match=r"move|pulses"):
        deviation(train, ends, 0)


def test_a_move_of_no_steps_is_no_move() -> None:
    there = played([(0, 0, 0), (10, 5, 0)], cruise)

    assert deviation(there, [(0, 0, 0), (0, 0, 0), (10, 5, 0)], 0).pulses < 1e-9


def test_the_speed_at_a_corner_is_that_of_the_tool() -> None:
    ends = [(0, 0, 0), (30, 40, 0), (30, 40, 50), (30, 40, 0)]

    assert corner_speeds(played(ends, cruise), ends) == pytest.approx([100, 100])


def test_the_slower_side_of_a_corner_counts() -> None:
    train = Train()
    moments = [1.0, 2.0, 3.0, 4.0, 4.5, 5.0, 5.5]
    for axis, moment in zip([0, 0, 0, 0, 1, 1, 1], moments, strict=True):
        train.add(axis, moment, 1)

    assert corner_speeds(train, [(0, 0, 0), (4, 0, 0), (4, 3, 0)]) == [1.0]


def test_the_distance_from_an_arc_is_that_of_the_place_after_all_pulses_of_a_moment() -> None:
    train = Train()
    train.add(0, 1.0, 1)
    train.add(1, 1.0, 1)
    train.add(0, 2.0, 1)

    assert off_the_circles(train, [Circle(0, 0, 2)]) == pytest.approx(2 - math.sqrt(2))
    assert off_the_circles(train, [Circle(0, 0, 2), Circle(1, 0, 1)]) == pytest.approx(
        math.sqrt(5) - 2
    )


def test_the_worst_of_two_is_that_of_each_figure() -> None:
    assert Deviation(0.1, 5).worst(Deviation(0.2, 3)) == Deviation(0.2, 5)


def test_the_log_of_the_simulator_is_read() -> None:
    train = train_of(["16000000 3 2", "32000000 4 0", "32000008 1 1"])

    assert train.times == [[1.0, 2.0000005], [1.0], [2.0]]
    assert train.positions == [[1, 0], [-1], [1]]


def test_the_steps_of_the_unit_are_read() -> None:
    train = train_of_steps(["# hz=10", "tick,motor,position", "5,1,1", "10,2,-1", "15,1,0"])

    assert train.times == [[0.5, 1.5], [1.0], []]
    assert train.positions == [[1, 0], [-1], []]


def test_jobs_end_where_their_gcode_says() -> None:
    for job in JOBS:
        assert job.gcode().endswith("M30\n")
        assert job.points or job.circles
