"""What the registers of an axis of the positioning unit tell, written from the contract alone.

The unit notes in passes what has happened, so that a register may be as it was up to 1 ms before,
or as it will be; the pulses of the last microseconds may be counted or not.
"""

from __future__ import annotations

import math
from dataclasses import replace

from exact import Fraction
from pos_axis import Axis
from pos_bits import Bits
from pos_session import Sample
from pos_words import FEED_UNITS, MS, US, Mismatch, signed32
from reference import TICK_HZ

Container = set[int] | range
SPEED_SLACK = 2 / 256
"""Steps/s: speeds are rounded twice."""

COUNTED = 50 * US
"""So old may a position be."""


def flags(axis: Axis, bits: Bits) -> int:
    """FLAGS."""
    inputs = ("limit_minus", "limit_plus", "reference", "capture")
    named = (bits.referenced, *map(axis.active, inputs), bits.armed, bits.homing)
    return sum(1 << bit for bit, holds in enumerate(named) if holds)


def states(axis: Axis, tick: int) -> list[Bits]:
    """What may be told at a tick."""
    found = []
    for low, high, bits in reversed(axis.history):
        if low <= tick:
            found.append(bits)
        if high <= tick:
            break
    if tick <= axis.initiated:
        found += [replace(bits, pol=False, inic=True, cont=False) for bits in found if bits.prog]
    leaves = any(f.starts and tick <= f.high + MS for f in axis.motion.families)
    if leaves and axis.bits.jede:
        found += [replace(bits, jede=False) for bits in found]
    return found


def expected(axis: Axis, tick: int) -> dict[str, Container]:
    """Of each register the values that it may have at a tick."""
    told: dict[str, Container] = {}
    if axis.bits.jede and axis.motion.stand()[0] <= tick:
        return told
    if axis.before and tick <= axis.initiated:
        return told
    known = states(axis, tick)
    for name in known[0].registers:
        told[name] = {bits.registers[name] for bits in known}
    told["FLAGS"] = {flags(axis, bits) for bits in known}
    offsets = (-COUNTED, -US, 0, US)
    steps = [axis.seat_at(tick + off).step for off in offsets]
    counted = range(min(steps), max(steps) + 1)
    told["POSITION_STEPS"] = {signed32(step) for step in counted}
    if tick > axis.initiated and len({bits.referenced for bits in states(axis, tick)}) == 1:
        position = axis.origin.position_of
        told["POSITION"] = {signed32(position(axis.settings, step)) for step in counted}
    told |= _motion(axis, tick, counted)
    if axis.captured:
        told["CAPTURED_STEPS"] = {signed32(step) for step in axis.captured}
    elif not axis.bits.captures:
        told["CAPTURED_STEPS"] = {0}
    return told


def _motion(axis: Axis, tick: int, counted: range) -> dict[str, Container]:
    """SPEED and WAY_LEFT, when it is sure whether the axis moves and to where."""
    if tick <= axis.initiated + MS or any(high + MS > tick for _, high, _ in axis.history):
        return {}
    told: dict[str, Container] = {"WAY_LEFT": _way_left(axis, counted)}
    if not axis.bits.jede:
        told["SPEED"] = {0}
    elif axis.motion.stand()[0] > tick + MS:
        speeds = _speeds(axis, tick)
        if speeds:
            told["SPEED"] = speeds
    return told


def _way_left(axis: Axis, counted: range) -> Container:
    """The way to the target, which is a step or lies beside one; either may be meant."""
    goal, ratio = axis.goal, axis.settings.ratio
    if goal is None or axis.programmed:
        return {0}
    ends = [Fraction(axis.target)]
    if not axis.cut:
        ends.append(goal.base + goal.way * ratio)
    ways = [(end - step) / ratio for end in ends for step in counted]
    return range(math.floor(min(ways)) - 1, math.ceil(max(ways)) + 2)


def _speeds(axis: Axis, tick: int) -> Container | None:
    """The speed at the last pulse; none is known before the first one."""
    motion = axis.motion
    numbers = {motion.train.count_until(tick + off) - motion.offset for off in (-COUNTED, -US, US)}
    low, high = min(numbers), max(numbers)
    curves = motion.curves()
    if any(curve.next > low or curve.blur or curve.start > 0 for curve in curves):
        return None
    found = [v for curve in curves for v in curve.speeds(low, high) * TICK_HZ]
    unit = 60 * FEED_UNITS / 1000 / float(axis.settings.ratio)
    slack = SPEED_SLACK * unit
    return range(math.floor(min(found) * unit - slack), math.ceil(max(found) * unit + slack) + 1)


def check_sample(axis: Axis, sample: Sample) -> None:
    """Compare registers with what they may be."""
    told = expected(axis, sample.tick)
    for name, value in sample.values.items():
        if name in told and value not in told[name]:
            values = told[name]
            wanted = (
                f"{values.start} to {values.stop - 1}"
                if isinstance(values, range)
                else " or ".join(map(str, sorted(values)))
            )
            raise Mismatch(sample.tick, f"{name} is {value}, not {wanted}")


def read(axis: Axis, tick: int, number: int) -> Sample:
    """One of the things that a unit may tell."""
    return Sample(
        tick,
        number,
        {
            name: v[0] if isinstance(v, range) else min(v)
            for name, v in expected(axis, tick).items()
        },
    )
