"""Random moves, and changes at every pulse of one, against the exact reference.

`RKM04_SWEEP=all` tries every pair of pulses instead of a sample.
"""

from __future__ import annotations

import os
import random
from itertools import accumulate, combinations, groupby, product

import pytest
from chance import epoch
from exact import Fraction
from hypothesis import example, given, settings
from hypothesis import strategies as st
from motion_probe import EPOCH_BITS, STOP, Case, Move, complaints, deviation, run, run_one
from reference import ENDLESS, Section, plan

GOAL_TICKS = 1
SECTIONS_MAX = 10
PAIRS = 1500

COMPOUND = Move(
    90,
    (
        Section(40, 900, 4000),
        Section(1, 16_000, 1),
        Section(35, 250, 12_000),
        Section(44, 1200, 9000),
    ),
)
"""Ramps that meet, a section of one step, a slow section, and a top speed that is not reached."""


def up_to(most: int) -> st.SearchStrategy[int]:
    """Draw from 1 to `most`: both ends often, and small numbers as often as large ones."""
    sizes = [st.integers(1, min(10**digits, most)) for digits in range(1, len(str(most)) + 1)]
    return st.one_of(st.just(1), st.just(most), *sizes)


def sections(steps: int) -> st.SearchStrategy[Section]:
    """Draw a section of at most so many steps."""
    return st.builds(Section, up_to(steps), up_to(16_000), up_to(60_000))


@st.composite
def moves(draw: st.DrawFn) -> Move:
    """Draw a single or a compound move with up to four changes, the last one perhaps a stop."""
    single = draw(st.booleans())
    parts = st.lists(
        sections(3000 if single else 300), min_size=1, max_size=1 if single else SECTIONS_MAX
    )
    chosen = tuple(draw(parts))
    last = sum(section.steps for section in chosen)
    pulses = sorted(draw(st.sets(st.integers(1, last), max_size=4)))
    speeds = st.one_of(st.just(STOP), up_to(16_000))
    return Move(draw(up_to(2000)), chosen, tuple((pulse, draw(speeds)) for pulse in pulses))


EPOCHS = st.integers(0, (1 << EPOCH_BITS) - 1).map(epoch)


def assert_exact(cases: list[Case]) -> None:
    """Run cases; every pulse of each must be there, within a tick of its time."""
    for case, made in zip(cases, run(cases), strict=True):
        assert not complaints(case, made), case.line
        worst = deviation(case, made)
        assert worst.ticks <= GOAL_TICKS, f"{case.move}, pulse {worst.pulse}: {case.line}"


@settings(max_examples=400, deadline=None)
@given(moves(), EPOCHS)
@example(Move(1, (Section(3000, 16_000, 60_000),)), 0)
@example(Move(1, (Section(3000, 16_000, 1),), ((1500, 1), (1501, 16_000))), 0)
@example(Move(2000, (Section(1, 1, 1), Section(1, 16_000, 60_000), Section(300, 1, 1))), 0)
def test_every_pulse_of_any_move_is_within_a_tick(move: Move, epoch: int) -> None:
    assert_exact([Case(move, epoch)])


@settings(max_examples=100, deadline=None)
@given(moves(), EPOCHS)
def test_pulses_do_not_depend_on_when_a_move_starts(move: Move, epoch: int) -> None:
    early, late = run([Case(move), Case(move, epoch)])
    assert early == late


@settings(max_examples=100, deadline=None)
@given(up_to(2000), up_to(16_000), up_to(60_000), st.integers(1, 3000), EPOCHS)
def test_every_pulse_of_a_run_without_end_is_within_a_tick(
    start_speed: int, speed: int, accel: int, pulse: int, epoch: int
) -> None:
    move = Move(start_speed, (Section(ENDLESS, speed, accel),), ((pulse, STOP),))
    last = move.curve.last
    assert last is not None
    assert_exact([Case(move, epoch, range(max(1, last - 3000), last + 1))])


@settings(max_examples=200, deadline=None)
@given(up_to(2000), st.lists(sections(300), min_size=1, max_size=SECTIONS_MAX))
def test_break_points_are_the_corners_of_the_ideal_curve(
    start_speed: int, chosen: list[Section]
) -> None:
    curve = plan(chosen, start_speed)
    borders = list(accumulate(section.steps for section in chosen))
    corners = [(x, round(v)) for x, v in curve.corners()]
    corners += [(Fraction(x), round(float(curve.speed_squared(x)) ** 0.5)) for x in borders]
    corners = sorted(set(corners), key=lambda corner: corner[0])
    rounded = [(int(x + Fraction(1, 2)), v) for x, v in corners]
    expected = [(1, rounded[0][1]), *rounded[1:-1], (borders[-1], 0)]
    made = run_one(Case(Move(start_speed, tuple(chosen)), 0, [1]))
    assert [point for point, _ in groupby(made.corners)] == [
        point for point, _ in groupby(expected)
    ]


def changed(*changes: tuple[int, int]) -> Case:
    """Return the compound move with changes, started at a moment that depends on them."""
    return Case(Move(COMPOUND.start_speed, COMPOUND.sections, changes), epoch(changes))


def every_pulse() -> range:
    last = COMPOUND.curve.last
    assert last is not None
    return range(1, last + 1)


def test_a_stop_at_every_pulse_is_exact() -> None:
    assert_exact([changed((pulse, STOP)) for pulse in every_pulse()])


@pytest.mark.parametrize("speed", [1, 60, 90, 91, 250, 700, 900, 16_000])
def test_a_change_of_speed_at_every_pulse_is_exact(speed: int) -> None:
    assert_exact([changed((pulse, speed)) for pulse in every_pulse()])


def test_two_changes_at_every_pair_of_pulses_are_exact() -> None:
    speeds = (60, 250, 2000)
    pairs = list(product(combinations(every_pulse(), 2), speeds, (STOP, *speeds)))
    if os.environ.get("RKM04_SWEEP") != "all":
        pairs = random.Random(2009).sample(pairs, PAIRS)
    assert_exact([changed((k, first), (m, second)) for (k, m), first, second in pairs])


def test_two_changes_at_one_pulse_are_exact() -> None:
    speeds = (60, 250, 2000)
    changes = product(every_pulse(), speeds, (STOP, *speeds))
    assert_exact([changed((k, first), (k, second)) for k, first, second in changes])
