"""DIR that turns between pulses laid ahead: hold and set-up kept, every pulse at its tick."""

from __future__ import annotations

import pytest
from step_acts import FAST_BUS, LONG, MOTORS, ODD, READY, SHORT, WIDTH, WRAP, Acts
from step_trials import assert_turns

TURN_TICKS = 12 * 84
NAMES = [SHORT, LONG]


def zigzag(acts: Acts, motor: int, tick: int, pace: int, pieces: list[int], gap: int) -> list[int]:
    """Pieces of a train, every other one backward, `gap` ticks apart; their ticks."""
    ticks: list[int] = []
    acts.begin(motor, tick - 1000)
    for number, steps in enumerate(pieces):
        acts.turn(motor, number % 2 != 0)
        ticks += acts.push_steady(motor, tick, pace, steps)
        tick = ticks[-1] + gap
    return ticks


@pytest.mark.parametrize(
    ("name", "options"), [(SHORT, []), (SHORT, ODD), (SHORT, FAST_BUS), (LONG, []), (LONG, ODD)]
)
@pytest.mark.parametrize("pieces", [[1] * 20, [2] * 20, [7, 30, 1, 1, 40, 3, 100], [200, 200]])
def test_pulses_come_at_their_ticks_and_dir_turns_between_them(make_acts, name, pieces, options):
    acts: Acts = make_acts(name)
    pace = 8 * WIDTH[name]
    ticks = [
        zigzag(acts, motor, READY + 20_000 + 37 * motor, pace, pieces, TURN_TICKS + 40_000)
        for motor in MOTORS
    ]
    for motor in MOTORS:
        acts.run(motor)
    acts.rest()

    shown = acts.show(*options)

    assert shown.rises == ticks
    assert shown.late == 0
    made = sum(steps if number % 2 == 0 else -steps for number, steps in enumerate(pieces))
    assert shown.positions == [made] * len(MOTORS)
    for motor in MOTORS:
        levels = [level for _, level in shown.directions[motor]]
        assert levels == [number % 2 for number in range(1, len(pieces))]
        assert_turns(shown, motor)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("start", [0, WRAP - READY - 40_000])
def test_two_turns_are_as_near_as_they_may_be(make_acts, name, start):
    acts: Acts = make_acts(name)
    acts.start = start
    expected: list[list[int]] = []
    for motor in MOTORS:
        tick = READY + 20_000 + 501 * motor
        ticks = []
        acts.begin(motor, tick - 1000)
        for number in range(25):
            acts.turn(motor, number % 2 != 0)
            ticks += acts.push_steady(motor, tick, 1000, 1)
            tick += TURN_TICKS if number % 2 == 0 else 42_000
        expected.append(ticks)
    for motor in MOTORS:
        acts.run(motor)
    acts.rest()

    shown = acts.show()

    assert shown.rises == expected
    assert shown.late == 0
    assert shown.positions == [1] * len(MOTORS)
    for motor in MOTORS:
        assert len(shown.directions[motor]) == 24
        assert_turns(shown, motor)


@pytest.mark.parametrize("name", NAMES)
def test_a_pulse_too_soon_after_a_turn_waits_for_dir_and_is_counted(make_acts, name):
    acts: Acts = make_acts(name)
    ticks = zigzag(acts, 1, READY + 20_000, 3000, [3, 3], TURN_TICKS // 2)
    acts.run(1)
    acts.rest()

    shown = acts.show()

    assert shown.late == 1
    assert shown.rises[1][:3] == ticks[:3]
    assert shown.rises[1][4:] == ticks[4:]
    assert 0 < shown.rises[1][3] - ticks[3] < TURN_TICKS
    assert_turns(shown, 1)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize("stays", [1, 2, 5, 6, 7, 9, 10])
def test_what_is_recalled_over_a_turn_gives_way_to_what_comes_instead(
    make_acts, name, stays, backward
):
    acts: Acts = make_acts(name)
    before, pace = 5, 3000
    tick = READY + 60_000
    ticks = zigzag(acts, 2, tick, pace, [before, before], pace)
    acts.wait(READY + 20_000)
    acts.run(2)
    acts.wait(tick - 35_000 + stays * pace)
    acts.freeze(2, 2 * before - stays)
    new = acts.recall(2, ticks[stays - 1] + pace, pace, 4, backward)
    acts.rest()

    shown = acts.show()

    assert shown.notes[0].running == 1
    assert shown.rises[2] == ticks[:stays] + new
    assert shown.late == 0
    made = min(stays, before) - max(stays - before, 0)
    assert shown.positions[2] == made + (-4 if backward else 4)
    assert_turns(shown, 2)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_frozen_ends_where_nothing_comes_instead(make_acts, name):
    acts: Acts = make_acts(name)
    ticks = acts.move_steady(0, READY + 60_000, 3000, 100)
    acts.wait(READY + 70_000)
    acts.freeze(0, 80)
    acts.recall(0)
    acts.rest()
    acts.note()

    shown = acts.show()

    assert shown.rises[0] == ticks[:20]
    assert shown.notes[1].pulses == 20
    assert shown.late == 0


def test_a_freeze_that_comes_too_late_changes_nothing(make_acts):
    acts: Acts = make_acts()
    ticks = acts.move_steady(0, READY + 60_000, 3000, 100)
    acts.wait(ticks[30] - 100)
    acts.freeze(0, 70)
    acts.rest()

    shown = acts.show()

    assert shown.notes[0].running == 0
    assert shown.rises[0] == ticks
    assert shown.late == 0
