"""Chains with a start/stop speed: against the exact reference, and beside the moves of one motor.

A move of `engine/motion`, single or compound, is a chain of one axis. Both have the same curve and
the same pulses; where the curve comes within `NEAR_TICKS` of the middle between two ticks each may
round its own way. `RKM04_LONG` tries more.
"""

from __future__ import annotations

import os
import random

import motion_probe
import pytest
from chance import SEED
from motion_probe import Move
from path_chains import SPEED_MAX, any_chain, any_size
from path_probe import SECTION, STOP, Case, Change, deviation, run
from path_reference import ACCEL_UNITS, SPEED_UNITS, Vector
from reference import FRACTION_BITS, Section

GOAL_TICKS = 0.65
LONG = bool(os.environ.get("RKM04_LONG"))
MOVES = 5000 if LONG else 250
CHAINS = 1000 if LONG else 50
SINGLE_TICKS = 0.51
NEAR_TICKS = 0.01
"""1/128 tick is what a segment of a path may be off where the axis has all of its steps, 1/500 what
one of a move may be."""

FAR = 2**40


def any_move(rng: random.Random) -> Move:
    """Draw a single or compound move."""
    count = rng.choice((1, 1, rng.randint(2, 10)))
    sections = tuple(
        Section(any_size(rng, 3000 // count), any_size(rng, 16_000), any_size(rng, 60_000))
        for _ in range(count)
    )
    return Move(any_size(rng, 2000), sections)


def chain_of(move: Move, changes: tuple[Change, ...] = ()) -> Case:
    """Return a move as a chain."""
    vectors = tuple(
        Vector((s.steps, 0, 0, 0), s.speed * SPEED_UNITS, s.accel * ACCEL_UNITS)
        for s in move.sections
    )
    return Case(vectors, changes=changes, start_speed=move.start_speed * SPEED_UNITS)


def with_change(rng: random.Random, move: Move, ticks: list[int]) -> tuple[Move, Case]:
    """Add a stop or another speed at a pulse, to the move and to the chain."""
    pulse = rng.randint(1, len(ticks))
    speed = rng.choice((motion_probe.STOP, any_size(rng, 16_000)))
    before = ticks[pulse - 2] if pulse > 1 else 0
    moment = (before + ticks[pulse - 1]) // 2
    change = Change(SECTION, moment, speed * SPEED_UNITS) if speed else Change(STOP, moment, FAR)
    return Move(move.start_speed, move.sections, ((pulse, speed),)), chain_of(move, (change,))


def differences(moves: list[Move], chains: list[Case]) -> tuple[int, int]:
    """Compare moves with chains; returns the number of pulses, and of those not on one tick."""
    pulses, others = 0, 0
    asked = [motion_probe.Case(move) for move in moves]
    for move, one, chain, other in zip(
        moves, motion_probe.run(asked), chains, run(chains), strict=True
    ):
        ticks = [int(tick) for tick in other.trains[0]]
        if len(ticks) > len(one.ticks):
            assert ticks[len(one.ticks)] > FAR, chain.line
        for pulse, (a, b) in enumerate(zip(one.ticks, ticks, strict=False), start=1):
            if a != b:
                others += 1
                assert_is_rounded(move, pulse, (a, b))
        assert len(ticks) >= len(one.ticks), chain.line
        pulses += len(one.ticks)
        found = deviation(chain, other)
        assert found.ticks <= SINGLE_TICKS, f"pulse {found.pulse}: {chain.line}"
    return pulses, others


def assert_is_rounded(move: Move, pulse: int, ticks: tuple[int, int]) -> None:
    """Two ticks of one pulse are neighbours, and its time is about between them."""
    time = move.curve.tick_scaled(pulse) / 2**FRACTION_BITS
    assert abs(ticks[0] - ticks[1]) == 1, f"{move}, pulse {pulse}: {ticks}, due at {time}"
    middle = sum(ticks) / 2
    assert abs(time - middle) < NEAR_TICKS, f"{move}, pulse {pulse}: {ticks}, due at {time}"


def test_a_move_of_one_motor_is_a_chain_of_one_axis() -> None:
    rng = random.Random(f"{SEED} moves")
    moves = [any_move(rng) for _ in range(MOVES)]
    pulses, others = differences(moves, [chain_of(move) for move in moves])
    print(f"{pulses} pulses, {others} rounded the other way")
    assert others < pulses / 500


def test_a_change_or_stop_of_a_move_is_one_of_a_chain() -> None:
    rng = random.Random(f"{SEED} changes")
    moves = [any_move(rng) for _ in range(MOVES)]
    made = motion_probe.run([motion_probe.Case(move) for move in moves])
    pairs = [with_change(rng, move, one.ticks) for move, one in zip(moves, made, strict=True)]
    pulses, others = differences([move for move, _ in pairs], [chain for _, chain in pairs])
    print(f"{pulses} pulses, {others} rounded the other way")
    # Nearly always some ten; but a cruise may come just between two ticks all the way.
    assert others < pulses / 100


@pytest.mark.parametrize("batch", range(5))
def test_every_pulse_of_a_chain_with_a_start_speed_is_on_its_tick(batch: int) -> None:
    rng = random.Random(f"{SEED} {batch}")
    top = SPEED_MAX * SPEED_UNITS
    chains = [any_chain(rng, start_speed=any_size(rng, top)) for _ in range(CHAINS // 5)]
    for case, made in zip(chains, run(chains), strict=True):
        found = deviation(case, made)
        assert found.ticks <= GOAL_TICKS, f"axis {found.axis}, pulse {found.pulse}: {case.line}"
