"""The step driver makes each edge at its tick, on one to four motors, around the counter's wrap."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from itertools import accumulate, permutations

import pytest
from chance import SEED
from step_acts import (
    FAST_BUS,
    LONG,
    MOTORS,
    ODD,
    QUANTA,
    READY,
    SHORT,
    WIDTH,
    WRAP,
    Acts,
    Shown,
    What,
)

LEAD, MANY_LEAD = 20_000, 80_000
"""Ticks that main has to ready what four motors do; with some thirty segments each."""
FASTEST = 210
"""Ticks between pulses that four motors can have at a time, 400 000 steps/s."""
KINDS = [(SHORT, []), (SHORT, ODD), (SHORT, FAST_BUS), (LONG, [])]
AROUND_WRAP = [-300, -211, -210, -43, -42, -41, -1, 0, 1, 2, 42, 300]
MakeActs = Callable[..., Acts]


def assert_as_laid(
    shown: Shown, ticks: list[list[int]], width: int, options: Sequence[str] = ()
) -> None:
    """Every edge at its tick, so TIM5 counts as TIM2 does. Where a look at a counter takes half a
    tick more than a whole number, as on no part, it may be one off, always."""
    if options == FAST_BUS:
        first, laid = min(filter(None, shown.rises))[0], min(filter(None, ticks))[0]
        assert abs(first - laid) <= 1
        ticks = [[tick + first - laid for tick in each] for each in ticks]
    assert shown.rises == ticks
    assert shown.falls == [[tick + width for tick in each] for each in ticks]
    assert shown.late == 0


@pytest.mark.parametrize(("name", "options"), KINDS)
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_every_edge_of_steady_trains_comes_at_its_tick(make_acts, name, options, count):
    chance = random.Random(f"{SEED} {name} {options} {count}")
    acts: Acts = make_acts(name, chance.getrandbits(32))
    ticks: list[list[int]] = [[], [], [], []]
    at = READY
    for _ in range(6):
        chosen = chance.sample(MOTORS, count)
        for motor in chosen:
            first = at + LEAD + chance.choice([0, 0, 0, 1, 7, 500])
            slope = round(QUANTA / chance.uniform(max(2 * WIDTH[name] + 10, FASTEST), 9000))
            acts.begin(motor, first - 1000)
            ticks[motor] += acts.push_train(motor, first, slope, chance.randrange(1, 90))
        for motor in chance.sample(chosen, count):
            acts.run(motor)
        acts.rest()
        at = max(ticks[motor][-1] for motor in chosen)

    assert_as_laid(acts.show(*options), ticks, WIDTH[name], options)


@pytest.mark.parametrize(("name", "options"), KINDS)
@pytest.mark.parametrize("count", [1, 2, 3, 4])
@pytest.mark.parametrize(("pulses", "widest"), [(30, 200), (120, 9000)])
def test_every_edge_comes_at_its_tick_where_each_pulse_is_a_segment(
    make_acts, name, options, count, pulses, widest
):
    chance = random.Random(f"{SEED} {name} {options} {count} {pulses}")
    acts: Acts = make_acts(name, chance.getrandbits(32))
    ticks: list[list[int]] = [[], [], [], []]
    at = READY
    for _ in range(2):
        least = max(2 * WIDTH[name] + 10, 300 * (count - 1)) if pulses <= 30 else 3000
        moves = {
            motor: [
                at + MANY_LEAD + since
                for since in accumulate(
                    (chance.randrange(least, least + widest) for _ in range(pulses - 1)), initial=0
                )
            ]
            for motor in chance.sample(MOTORS, count)
        }
        acts.move_each(moves)
        acts.rest()
        for motor, mine in moves.items():
            ticks[motor] += mine
        at = max(mine[-1] for mine in moves.values())

    assert_as_laid(acts.show(*options), ticks, WIDTH[name], options)


@pytest.mark.parametrize("name", [SHORT, LONG])
def test_edges_at_the_same_tick_all_come_in_whatever_order_they_were_laid(make_acts, name):
    acts: Acts = make_acts(name)
    ticks: list[list[int]] = [[], [], [], []]
    at = READY
    for number, order in enumerate(permutations(MOTORS)):
        at += LEAD
        both = [at, at + 3 * WIDTH[name], at + 9 * WIDTH[name]]
        for place, motor in enumerate(order):
            acts.begin(motor, at - 1000)
            if (number + place) % 3 != 0:
                acts.push_steady(motor, at, 3 * WIDTH[name], 2)
            else:
                acts.push(motor, both[0])
                acts.push(motor, both[1])
            acts.push(motor, both[2])
            ticks[motor] += both
        for motor in order:
            acts.run(motor)
        acts.rest()

    assert_as_laid(acts.show(), ticks, WIDTH[name])


def test_a_segment_may_end_where_others_go_on_and_one_motor_comes_to_rest(make_acts):
    acts: Acts = make_acts()
    ticks = [READY + LEAD + 2000 * i for i in range(7)]
    acts.move(0, *ticks)
    acts.move_steady(1, ticks[0], 2000, 7)
    acts.move(2, *ticks[:4])
    acts.move_steady(3, ticks[0], 2000, 4)
    acts.rest()

    assert_as_laid(acts.show(), [ticks, ticks, ticks[:4], ticks[:4]], WIDTH[SHORT])


# The counter's wrap


@pytest.mark.parametrize("name", [SHORT, LONG])
@pytest.mark.parametrize("steady", [False, True])
@pytest.mark.parametrize("part", range(3))
def test_edges_around_the_wrap_come_at_their_ticks(make_acts, name, steady, part):
    wrap = READY + 2 * LEAD
    acts: Acts = make_acts(name, WRAP - wrap)
    firsts = [wrap + edge - 6000 for edge in AROUND_WRAP[4 * part :][:4]]
    ticks = [[first + 3000 * i for i in range(5)] for first in firsts]
    for motor in MOTORS:
        if steady:
            acts.move_steady(motor, firsts[motor], 3000, 5)
        else:
            acts.move(motor, *ticks[motor])
    acts.rest()

    assert_as_laid(acts.show(), ticks, WIDTH[name])


@pytest.mark.parametrize("edge", [-43, -1, 0, 1, 42])
def test_first_edges_of_all_motors_around_the_wrap_come_at_their_ticks(make_acts, edge):
    wrap = READY + LEAD
    acts: Acts = make_acts(SHORT, WRAP - wrap)
    for motor in MOTORS:
        acts.move(motor, wrap + edge, wrap + edge + 1500)
    acts.rest()

    assert_as_laid(acts.show(), [[wrap + edge, wrap + edge + 1500]] * 4, WIDTH[SHORT])


# Begin and end


@pytest.mark.parametrize("name", [SHORT, LONG])
def test_a_channel_rests_after_its_last_pulse_with_its_pin_low_and_its_stream_off(make_acts, name):
    acts: Acts = make_acts(name)
    at = READY + LEAD
    for motor in MOTORS:
        acts.move(motor, at)
        acts.wait(at - 500)
        acts.note(motor)
        acts.wait(at + 2 * WIDTH[name] + 1000)
        acts.note(motor)
        at += LEAD
    acts.wait(at)

    shown = acts.show()

    assert [note.running for note in shown.notes] == [1, 0] * 4
    assert [note.asks.bit_count() for note in shown.notes] == [1, 0] * 4
    assert [note.streams.bit_count() for note in shown.notes] == [1, 0] * 4
    assert [note.pulses for note in shown.notes] == [0, 1] * 4
    assert_as_laid(shown, [[READY + LEAD * i] for i in range(1, 5)], WIDTH[name])


@pytest.mark.parametrize("steady", [False, True])
def test_main_is_told_of_the_end_of_a_move_and_not_of_the_pulses_before(make_acts, steady):
    acts: Acts = make_acts()
    first = READY + LEAD
    acts.add(What.QUIET)
    if steady:
        ticks = acts.move_steady(0, first, 2000, 300)
    else:
        ticks = [first]
        acts.move(0, first)
    acts.wait(ticks[len(ticks) // 3] - 500)
    acts.note()
    acts.wait(ticks[-1] - 100)
    acts.note()
    acts.wait(ticks[-1] + 1000)
    acts.note()

    notes = acts.show().notes

    assert [note.running for note in notes] == [1, 1, 0]
    assert [note.told for note in notes[1:]] == [0, 1]


def test_main_is_told_of_the_begin_of_a_marked_segment(make_acts):
    acts: Acts = make_acts()
    ticks = [READY + 3 * LEAD * i for i in range(1, 5)]
    acts.add(What.QUIET)
    acts.begin(0, READY)
    for tick in ticks:
        acts.push(0, tick, marked=tick == ticks[2])
    acts.run(0)
    for tick in ticks:
        acts.wait(tick - 300)
        acts.note()
    acts.rest()

    notes = acts.show().notes

    (told,) = (note for note in notes if note.marked)
    assert told == notes[2]  # by when the pulse before it has been made, and not before
    assert told.told


def test_a_rested_channel_goes_on_with_what_was_queued_late(make_acts):
    acts: Acts = make_acts()
    first, second = READY + LEAD, READY + 2 * LEAD
    acts.move(1, first)
    acts.wait(first + 3000)
    acts.push(1, second)
    acts.run(1)
    acts.rest()
    acts.note(1)

    shown = acts.show()

    assert shown.notes[0].pulses == 2
    assert_as_laid(shown, [[], [first, second], [], []], WIDTH[SHORT])


@pytest.mark.parametrize("name", [SHORT, LONG])
def test_a_queue_that_runs_dry_is_filled_at_any_time_around_its_last_pulse(make_acts, name):
    acts: Acts = make_acts(name)
    ticks: list[int] = []
    for after in range(-1000, 3 * WIDTH[name] + 100, 17):
        first = (ticks[-1] if ticks else READY) + 6000
        acts.move(1, first)
        acts.wait(first + after)
        acts.push(1, first + 6000)
        acts.run(1)
        acts.rest()
        ticks += [first, first + 6000]

    assert_as_laid(acts.show(), [[], ticks, [], []], WIDTH[name])
