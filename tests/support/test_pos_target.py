"""Targets, remainders and backlash of the model of the positioning unit."""

from __future__ import annotations

from pos_target import Origin, Seat, absolute, relative
from pos_words import REMAINDER_MAX, Settings

UNEVEN = Settings(steps=3200, micrometres=40_000)
"""0.08 steps in a micrometre."""


def travelled(ways: list[int], settings: Settings) -> int:
    origin = Origin()
    step = 0
    for way in ways:
        goal = relative(origin, settings, way)
        step, origin.base, origin.way = goal.step, goal.base, goal.way
        origin.given_up(settings, step)
    return step


def test_ten_thousand_small_moves_end_where_a_long_one_does() -> None:
    for settings in (UNEVEN, Settings(), Settings(steps=7, micrometres=3)):
        assert travelled([1] * 10_000, settings) == travelled([10_000], settings)
        assert travelled([-1] * 10_000, settings) == travelled([-10_000], settings)
    assert travelled([1] * 10_000, UNEVEN) == 800


def test_halves_go_up_on_both_sides_of_zero() -> None:
    assert [travelled([way], Settings()) for way in (4, 5, 15, -5, -6, -15, -16)] == [
        *(0, 1, 2, 0, -1, -1, -2),
    ]


def test_a_measure_given_up_on_its_step_keeps_the_remainder() -> None:
    origin = Origin(base=5, way=14)
    origin.given_up(Settings(), 6)
    assert (origin.base, origin.way) == (5, 14)
    origin.given_up(Settings(), 7)
    assert (origin.base, origin.way) == (7, 0)


def test_positions_count_from_the_reference() -> None:
    origin = Origin()
    origin.refer(100, -2500)
    assert origin.position_of(Settings(), 100) == -2500
    assert origin.position_of(Settings(), 99) == -2510
    assert absolute(origin, Settings(), 0).step == 350
    assert absolute(origin, Settings(), -2495).step == 101
    assert origin.position_of(Settings(steps=2, micrometres=1), 101) == -2499


def test_ways_are_kept_up_to_the_limit() -> None:
    origin = Origin(way=REMAINDER_MAX - 1)
    assert relative(origin, Settings(), 1).possible
    assert not relative(origin, Settings(), 2).possible


def test_backlash_is_taken_first_and_positions_stand_meanwhile() -> None:
    seat = Seat(step=0, slack=3, backlash=3)
    assert seat.pulses_to(10) == 10
    assert seat.pulses_to(-10) == -13
    assert seat.pulses_to(0) == 0
    assert seat.moved(-2) == Seat(0, 1, 3)
    assert seat.moved(-13) == Seat(-10, 0, 3)
    back = seat.moved(-13)
    assert back.pulses_to(0) == 13
    assert back.moved(13) == Seat(0, 3, 3)
    assert back.moved(2) == Seat(-10, 2, 3)
