"""What the registers of an axis of the positioning unit tell, written from the contract alone.

The unit notes in passes what has happened, so that a register may be as it was up to 1 ms before,
or as it will be; the pulses of the last microseconds may be counted or not.
"""

from __future__ import annotations

from dataclasses import replace

from pos_axis import Axis
from pos_bits import Bits
from pos_session import Sample
from pos_words import MS, US, Mismatch, signed32

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


def expected(axis: Axis, tick: int) -> dict[str, set[int]]:
    """Of each register the values that it may have at a tick."""
    told: dict[str, set[int]] = {}
    if axis.bits.jede and axis.motion.stand()[0] <= tick:
        return told
    for bits in states(axis, tick):
        for name, value in bits.registers.items():
            told.setdefault(name, set()).add(value)
        told.setdefault("FLAGS", set()).add(flags(axis, bits))
    offsets = (-COUNTED, -US, 0, US)
    steps = [axis.seat_at(tick + off).step for off in offsets]
    counted = range(min(steps), max(steps) + 1)
    told["POSITION_STEPS"] = {signed32(step) for step in counted}
    if tick > axis.initiated and len({bits.referenced for bits in states(axis, tick)}) == 1:
        position = axis.origin.position_of
        told["POSITION"] = {signed32(position(axis.settings, step)) for step in counted}
    if axis.captured:
        told["CAPTURED_STEPS"] = {signed32(step) for step in axis.captured}
    elif not axis.bits.captures:
        told["CAPTURED_STEPS"] = {0}
    return told


def check_sample(axis: Axis, sample: Sample) -> None:
    """Compare registers with what they may be."""
    told = expected(axis, sample.tick)
    for name, value in sample.values.items():
        if name in told and value not in told[name]:
            wanted = " or ".join(map(str, sorted(told[name])))
            raise Mismatch(sample.tick, f"{name} is {value}, not {wanted}")


def read(axis: Axis, tick: int, number: int) -> Sample:
    """One of the things that a unit may tell."""
    return Sample(tick, number, {name: min(v) for name, v in expected(axis, tick).items()})
