"""Pulses that are late, taken back or held off: none is lost, none is too short or too near."""

from __future__ import annotations

import random

import pytest
from chance import SEED
from step_acts import LONG, MOTORS, ODD, READY, SHORT, WIDTH, WRAP, Acts, Shown, What, gaps

SOON = 2000
"""Ticks in which a late pulse is made good when nothing else is to do."""
TICKS_PER_MS = 84_000
IN_TIME = 5040
"""Ticks that the driver asks for: hal_step_lead_ticks."""
HIGH_SETTLE = WIDTH[SHORT] + 48
"""From a last rising edge until the driver looks after it."""
FASTEST = 210
"""Ticks between pulses of the fastest move of one motor, 400 000 steps/s (MOTION_SPEED_MAX).

Of faster ones some are late, and counted, where a change comes too late and they go on."""
BOARDS = [(SHORT, []), (SHORT, ODD), (LONG, [])]


def assert_whole(shown: Shown, ticks: list[list[int]], width: int) -> None:
    """No pulse is lost or early, those that are late are counted, and the pins keep their times."""
    assert [len(each) for each in shown.rises] == [len(each) for each in ticks]
    lates = [
        r - t
        for mine, due in zip(shown.rises, ticks, strict=True)
        for r, t in zip(mine, due, strict=True)
    ]
    assert min(lates) >= 0
    assert shown.late == sum(late > 0 for late in lates)
    assert shown.widths == {width}
    assert shown.least_gap >= width


@pytest.mark.parametrize(("name", "options"), BOARDS)
@pytest.mark.parametrize("wrap", [False, True])
def test_a_first_tick_that_is_past_is_made_good_at_once_and_counted(make_acts, name, options, wrap):
    acts: Acts = make_acts(name, WRAP - READY - 40_000 if wrap else 0)
    ticks: list[int] = []
    looks: list[int] = []
    for after in (0, 1, 42, 500, 3000, 100_000):
        at = READY + 10_000 * (1 + len(ticks))
        acts.wait(at)
        acts.move(3, at - after)
        acts.rest(3)
        ticks.append(at - after)
        looks.append(at)

    shown = acts.show(*options)

    assert_whole(shown, [[], [], [], ticks], WIDTH[name])
    assert shown.late == len(ticks)
    assert all(0 < rise - at < SOON for rise, at in zip(shown.rises[3], looks, strict=True))


@pytest.mark.parametrize(("name", "options"), BOARDS)
def test_a_late_train_catches_up_and_goes_on_at_its_ticks(make_acts, name, options):
    acts: Acts = make_acts(name)
    acts.wait(READY)
    ticks = acts.move_steady(0, READY - 12_000, 1000, 100)
    acts.rest()

    shown = acts.show(*options)

    assert_whole(shown, [ticks, [], [], []], WIDTH[name])
    assert 12 < shown.late < 60
    assert shown.rises[0][shown.late :] == ticks[shown.late :]
    catching_up = set(gaps(shown.rises[0])[: shown.late // 2])
    assert catching_up <= {2 * WIDTH[name], WIDTH[name] + max(WIDTH[name], 96)}


@pytest.mark.parametrize(("name", "options"), BOARDS)
def test_a_pulse_that_comes_soon_is_in_time_or_made_good_but_never_lost(make_acts, name, options):
    acts: Acts = make_acts(name)
    ticks: list[int] = []
    for number, ahead in enumerate(range(0, 1500, 13)):
        at = READY + 6000 * number
        acts.wait(at)
        acts.move(2, at + ahead, at + 4000)
        acts.rest(2)
        ticks += [at + ahead, at + 4000]

    shown = acts.show(*options)

    assert_whole(shown, [[], [], ticks, []], WIDTH[name])
    on_time = [rise == tick for rise, tick in zip(shown.rises[2], ticks, strict=True)][::2]
    first = on_time.index(True)
    assert first > 0
    assert all(on_time[first + 2 :]), "at the border itself the phase of the bus decides"


@pytest.mark.parametrize("name", [SHORT, LONG])
def test_a_late_pulse_may_come_together_with_those_of_other_motors(make_acts, name):
    acts: Acts = make_acts(name)
    ticks: list[list[int]] = [[], [], [], []]
    for number in range(40):
        at = READY + 40_000 * (number + 1)
        for motor in MOTORS[1:]:
            ticks[motor] += acts.move_steady(motor, at, 500, 8)
        acts.wait(at - 100 + 29 * number)
        acts.move(0, at - 5000, at + 6000)
        ticks[0] += [at - 5000, at + 6000]
        acts.rest()

    shown = acts.show()

    assert_whole(shown, ticks, WIDTH[name])
    assert shown.rises[1:] == ticks[1:]
    assert shown.late == 40


@pytest.mark.parametrize("name", [SHORT, LONG])
def test_a_queue_that_ran_dry_and_is_filled_too_late_is_made_good(make_acts, name):
    acts: Acts = make_acts(name)
    ticks = [READY + 10_000, READY + 13_000, READY + 13_500, READY + 40_000]
    acts.move(1, ticks[0])
    acts.wait(READY + 20_000)
    for tick in ticks[1:]:
        acts.push(1, tick)
    acts.run(1)
    acts.rest()

    shown = acts.show()

    assert_whole(shown, [[], ticks, [], []], WIDTH[name])
    assert shown.late == 2
    assert READY + 20_000 < shown.rises[1][1] < READY + 20_000 + SOON


# What is laid is replaced


@pytest.mark.parametrize(("name", "options"), BOARDS)
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_what_is_taken_back_at_any_time_gives_way_to_what_is_laid_instead(
    make_acts, name, options, count
):
    chance = random.Random(f"{SEED} {name} {options} {count}")
    acts: Acts = make_acts(name, chance.getrandbits(32))
    least = max(2 * WIDTH[name] + 30, FASTEST) + 300 * (count - 1)
    moves: list[tuple[int, list[int]]] = []
    changes: list[tuple[int, int, int, int]] = []  # move, note, pace, pulses
    at = READY
    for _ in range(12):
        at += 40_000
        chosen = chance.sample(MOTORS, count)
        for motor in chosen:
            first, pace = at + chance.randrange(5000), chance.randrange(least, 4000)
            moves.append((motor, acts.move_steady(motor, first, pace, 400)))
        for motor in chance.sample(chosen, count) * 3:
            at += chance.randrange(20_000)
            acts.wait(at)
            pace, steps = chance.randrange(least, 4000), chance.randrange(20, 60)
            number = acts.replace(motor, chance.randrange(IN_TIME, 12_000), pace, steps)
            move = max(i for i, (mine, _) in enumerate(moves) if mine == motor)
            changes.append((move, number, pace, steps))
        acts.rest()
        at += 400 * 4000

    shown = acts.show(*options)

    for move, number, pace, steps in changes:
        note, due = shown.notes[number], moves[move][1]
        if note.running:
            last = due[note.pulses - 1]
            assert (acts.start + last) % WRAP == note.tick
            due[note.pulses :] = [last + pace * (i + 1) for i in range(steps)]
    ticks = [[tick for mine, due in moves if mine == motor for tick in due] for motor in MOTORS]
    assert shown.rises == ticks
    assert shown.widths == {WIDTH[name]}
    assert shown.late == 0
    assert len(changes) / 2 < sum(shown.notes[number].running for _, number, _, _ in changes)


# The step interrupt is held off


@pytest.mark.parametrize("held_ms", [0.02, 0.1, 0.3, 1.0, 4.9])
@pytest.mark.parametrize("pace", [5250, 420])
def test_pulses_of_a_step_interrupt_that_is_held_off_are_late_and_whole(make_acts, held_ms, pace):
    acts: Acts = make_acts()
    pulses = (12 if held_ms < 1 else 24) * TICKS_PER_MS // pace
    ticks = []
    for motor in MOTORS:
        ticks.append([READY + 20_000 + pace * i + 37 * motor for i in range(pulses)])
        acts.begin(motor, READY)
        acts.push_steady(motor, ticks[motor][0], pace, pulses)
    for motor in MOTORS:
        acts.run(motor)
    acts.rest()
    for motor in MOTORS:
        acts.note(motor)

    apart = held_ms + 0.06
    times = [10 + apart * i for i in range(max(1, min(15, int(5 / apart))))]
    faults = [word for at in times for word in ("--fault", f"{at:.3f}:lose=44,{held_ms}")]
    shown = acts.show(*faults)

    (vector,) = (v for v in shown.summary["vectors"] if v["number"] == 44)
    assert held_ms < 0.3 or vector["latency_max"] > 0.5 * held_ms * 168_000
    assert_whole(shown, ticks, WIDTH[SHORT])
    assert [note.pulses for note in shown.notes] == [pulses] * 4
    assert held_ms > 0.02 or shown.late == 0
    assert held_ms < 1 or shown.late > 0
    assert all(mine[-1] == due[-1] for mine, due in zip(shown.rises, ticks, strict=True))
    assert shown.summary["resets"] == {"power": 1, "software": 0, "watchdog": 0}


def test_a_step_interrupt_that_does_not_come_for_5_ms_is_noticed(make_acts):
    acts: Acts = make_acts()
    tick = READY + 5000
    due = tick + HIGH_SETTLE + 5 * TICKS_PER_MS
    acts.wait(READY)
    acts.move(0, tick)
    acts.add(What.HOLD)
    for moment in (tick + 1000, due - 200, due + 200):
        acts.wait(moment)
        acts.note(0)
    acts.add(What.RELEASE)
    acts.rest()
    acts.note(0)

    shown = acts.show()

    assert [note.stuck for note in shown.notes] == [0, 0, 1, 0]
    assert shown.rises[0] == [tick]
