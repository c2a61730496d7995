"""DIR and STEP of the step driver: hold and set-up, motors that are disconnected, no crystal."""

from __future__ import annotations

import pytest
from step_acts import LONG, MOTORS, READY, SHORT, WIDTH, Acts, What

HOLD_TICKS = SETUP_TICKS = 420
"""Of DIR, 5 us."""
NAMES = [SHORT, LONG]


def connect(acts: Acts, motor: int, connected: bool) -> None:
    acts.add(What.CONNECT, motor, steps=int(connected))


def direct(acts: Acts, motor: int, backward: bool) -> None:
    acts.add(What.DIRECT, motor, steps=int(backward))


@pytest.mark.parametrize("name", NAMES)
def test_dir_stands_still_after_the_last_pulse_and_before_the_next(make_acts, name):
    acts: Acts = make_acts(name)
    tick = READY + 10_000
    acts.move(0, tick)
    for number in range(1, 8):
        acts.rest(0)
        acts.begin(0, 0, backward=number % 2 != 0)
        acts.note(0)
        acts.push(0, tick + 1 + number)  # late, so as soon as can be
        acts.run(0)
    acts.rest()

    shown = acts.show()

    rises, turns = shown.rises[0], [at for at, _ in shown.directions[0]]
    assert len(rises) == 8
    assert [level for _, level in shown.directions[0]] == [1, 0, 1, 0, 1, 0, 1]
    for before, turn, after, note in zip(rises, turns, rises[1:], shown.notes, strict=False):
        assert turn - before >= HOLD_TICKS
        assert after - turn >= SETUP_TICKS
        assert note.tick - turn >= SETUP_TICKS
        assert after - before < 6000


@pytest.mark.parametrize("name", NAMES)
def test_dir_does_not_turn_before_its_hold_time_is_over(make_acts, name):
    acts: Acts = make_acts(name)
    ticks = [READY + 20_000 * (i + 1) for i in range(10)]
    for number, tick in enumerate(ticks):
        acts.move(3, tick, backward=number % 2 != 0)
        acts.wait(tick + 4 * number)
        direct(acts, 3, number % 2 == 0)
        acts.rest(3)

    shown = acts.show()

    holds = [at - tick for tick, (at, _) in zip(ticks, shown.directions[3], strict=True)]
    assert shown.rises[3] == ticks
    assert min(holds) >= HOLD_TICKS
    assert max(holds) < HOLD_TICKS + 500


def test_dir_turns_forth_and_back_and_pulses_count_so(make_acts):
    acts: Acts = make_acts()
    for number, backward in enumerate((False, True, True, False)):
        tick = READY + 20_000 * number
        acts.wait(tick)
        acts.move(2, tick + 3000, tick + 6000, tick + 9000, backward=backward)
        acts.rest()
    acts.wait(READY + 80_000)
    acts.move(2, READY + 85_000)
    acts.rest()

    shown = acts.show()

    assert shown.positions == [0, 0, 1, 0]
    assert [level for _, level in shown.directions[2]] == [1, 0]


@pytest.mark.parametrize("name", NAMES)
def test_a_disconnected_motor_keeps_its_time_and_its_pins_low(make_acts, name):
    acts: Acts = make_acts(name)
    acts.wait(READY)
    connect(acts, 1, False)
    direct(acts, 1, True)
    ticks = [READY + 20_000 + 3000 * i for i in range(5)]
    acts.move(1, *ticks, backward=True)
    acts.move_steady(2, ticks[0], 3000, len(ticks))
    for tick in (ticks[0] - 1000, ticks[2] + 100, ticks[4] + 100):
        acts.wait(tick)
        acts.note(1)
    acts.rest()
    acts.note(1)

    shown = acts.show()

    assert shown.rises == [[], [], ticks, []]
    assert shown.falls[1] == []
    assert shown.directions[1] == []
    assert [note.pulses for note in shown.notes] == [0, 3, 5, 5]
    assert [note.running for note in shown.notes[:2]] == [1, 1]
    assert not shown.notes[3].running
    assert shown.late == 0


@pytest.mark.parametrize("name", NAMES)
def test_pulses_reach_the_pin_again_when_it_is_connected_again(make_acts, name):
    acts: Acts = make_acts(name)
    acts.wait(READY)
    connect(acts, 1, False)
    acts.move(1, READY + 10_000, READY + 13_000)
    acts.rest()
    connect(acts, 1, True)
    ticks = acts.move_steady(1, READY + 30_000, 3000, 3)
    acts.rest()

    shown = acts.show()

    assert shown.rises == [[], ticks, [], []]
    assert shown.widths == {WIDTH[name]}
    assert shown.late == 0


def test_dir_falls_after_its_hold_when_a_motor_is_disconnected_and_rises_set_up_ahead(make_acts):
    acts: Acts = make_acts()
    tick = READY + 10_000
    acts.move(1, tick, backward=True)
    acts.rest(1)
    connect(acts, 1, False)
    acts.note(1)
    connect(acts, 1, True)
    acts.note(1)
    acts.move(1, tick + 1, backward=True)  # late, so as soon as can be
    acts.rest()

    shown = acts.show()

    (_, risen), (fall, fallen), (again, up) = shown.directions[1]
    assert [risen, fallen, up] == [1, 0, 1]
    assert fall - tick >= HOLD_TICKS
    assert shown.notes[1].tick - again >= SETUP_TICKS
    assert shown.rises[1][1] - again >= SETUP_TICKS
    assert shown.positions[1] == -2


def test_what_is_as_it_should_be_already_is_left_alone(make_acts):
    acts: Acts = make_acts()
    acts.wait(READY)
    acts.note()
    acts.note()
    connect(acts, 1, True)
    direct(acts, 1, False)
    acts.note()

    shown = acts.show()

    first, second, third = (note.tick for note in shown.notes)
    assert third - second < second - first + SETUP_TICKS
    assert shown.directions == [[], [], [], []]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("connected", [False, True])
def test_a_motor_may_be_switched_at_any_moment_of_the_edges_of_others(make_acts, name, connected):
    """The pulses of channels that share its registers are all made."""
    acts: Acts = make_acts(name)
    ticks: list[list[int]] = [[], [], [], []]
    tick = READY
    for offset in [*range(-900, -840, 9), *range(-36, 10, 3), *range(10, WIDTH[name] + 60, 23)]:
        tick += 40_000
        connect(acts, 1, not connected)
        for motor in (0, 2, 3):
            ticks[motor] += acts.move_steady(motor, tick, 4000, 5)
        acts.wait(tick + 8000 + offset)
        connect(acts, 1, connected)
        acts.rest()

    shown = acts.show()

    assert shown.rises == ticks
    assert shown.widths == {WIDTH[name]}
    assert shown.late == 0


@pytest.mark.parametrize("name", NAMES)
def test_a_motor_begins_and_is_halted_at_any_moment_of_the_edges_of_others(make_acts, name):
    acts: Acts = make_acts(name)
    ticks: list[list[int]] = [[], [], [], []]
    tick = READY
    for offset in range(0, 900, 31):
        tick += 40_000
        for motor in (0, 2, 3):
            ticks[motor] += acts.move_steady(motor, tick, 900, 20)
        acts.wait(tick + 1500 + offset)
        acts.begin(1, tick)
        acts.push_steady(1, tick + 3600, 900, 20)
        acts.run(1)
        acts.wait(tick + 9000 + offset)
        acts.add(What.HALT, 1)
        acts.rest()

    shown = acts.show()

    assert [shown.rises[motor] for motor in (0, 2, 3)] == [ticks[motor] for motor in (0, 2, 3)]
    assert shown.widths == {WIDTH[name]}
    assert shown.least_gap >= WIDTH[name]


@pytest.mark.parametrize("name", NAMES)
def test_without_the_crystal_nothing_is_ever_connected(make_acts, name):
    acts: Acts = make_acts(name)
    acts.wait(READY)
    for motor in MOTORS:
        connect(acts, motor, True)
        acts.move(motor, *[READY + 20_000 + 3000 * i for i in range(5)], backward=True)
    acts.rest()
    acts.note(3)

    shown = acts.show("--no-crystal")

    assert shown.rises == shown.falls == [[], [], [], []]
    assert shown.directions == [[], [], [], []]
    assert shown.notes[0].pulses == 5
