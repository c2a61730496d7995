"""Runs paths on the firmware's path and step stages and lays them beside the exact reference.

`build/host/bin/path-probe` (`path_probe.c`) makes the pulses; `RKM04_BUILD` names another build
folder.
"""

from __future__ import annotations

import os
import subprocess
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import path_reference as reference
from exact import Fraction
from path_reference import AXES, ROOT_BITS, Leg, Limits, Vector

ROOT = Path(__file__).resolve().parents[2]
STOP, SPEED, ADD, JOIN, SECTION, BRAKE, GO, LATER = range(8)
"""Kinds of changes, as the probe numbers them."""

TURN_US = 12
RING = 128
NEVER = 2**62
AHEAD = 30 * 84_000


@dataclass(frozen=True)
class Change:
    """What happens at a tick after the start.

    STOP: a stop, and the path goes on `value` ticks after it has come to rest. SPEED: all vectors
    from there on have this speed. SECTION: the one there has it. LATER: those after it. ADD: so
    many more vectors are added. JOIN: likewise, but without planning anew what has been laid.
    BRAKE: a stop; what is changed before it has come to rest does not stop any more. GO: it goes on
    `value` ticks after the rest, whatever `tick` is.
    """

    kind: int
    tick: int
    value: int
    patience: int = NEVER
    accel: int = 0
    """Of a stop: with which it brakes, and all from there on; 0: that of the vectors."""


@dataclass(frozen=True)
class Case:
    """What the probe is asked."""

    vectors: tuple[Vector, ...]
    known: int = 0
    """Vectors that are there at the start; 0: all."""
    changes: tuple[Change, ...] = ()
    epoch: int = 0
    turn_us: int = TURN_US
    ring: int = RING
    stride: int = 1
    start_speed: int = 0
    ahead: int = AHEAD
    """So far, in ticks, pulses after a change have been handed over when it is planned."""

    @property
    def line(self) -> str:
        """The case as the probe reads it."""
        numbers = [self.epoch, self.turn_us, self.start_speed, self.ring, len(self.vectors)]
        for v in self.vectors:
            numbers += [*v.steps, v.speed, v.accel, v.extent2 or v.length**2, v.border]
        numbers += [self.known or len(self.vectors), len(self.changes)]
        for change in self.changes:
            numbers += [change.kind, change.tick, change.patience, change.value, change.accel]
        numbers += [self.stride, self.ahead]
        return " ".join(map(str, numbers))


@dataclass(frozen=True)
class Made:
    """A change that took effect, and the place at which it did."""

    change: Change
    section: int
    place: Fraction
    square: int
    tick: int
    start: int = -1
    """Of a stop: when the path went on; -1: it did not."""

    @classmethod
    def parse(cls, text: str, changes: Sequence[Change]) -> Made:
        """Read what the probe tells."""
        ordinal, section, place, *rest = text.split(":")
        whole, part = place.split("+")
        return cls(
            changes[int(ordinal)], int(section), int(whole) + Fraction(part), *map(int, rest)
        )


@dataclass(frozen=True)
class Run:
    """What the probe answers; ticks as words, `count:tick` where only some are told."""

    changes: list[Made]
    trains: list[list[str]]
    segments: list[int]

    @classmethod
    def parse(cls, line: str, case: Case) -> Run:
        """Read an answer."""
        changes, *trains, segments = line.split("|")
        return cls(
            [Made.parse(text, case.changes) for text in changes.split()],
            [train.split() for train in trains],
            [int(count) for count in segments.split()],
        )


def run(cases: Iterable[Case]) -> Iterator[Run]:
    """Run cases on the probe, all in one process."""
    probe = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin" / "path-probe"
    asked = list(cases)
    text = "".join(f"{case.line}\n" for case in asked)
    done = subprocess.run([probe], input=text, capture_output=True, text=True, check=True)
    return map(Run.parse, done.stdout.splitlines(), asked)


def go_on(path: reference.Path, at: Made, known: int) -> None:
    """Leave the stand if anything is left of the path, as the probe must have done."""
    path.known = known
    if (path.rest[0] == known) != (at.start < 0):
        raise AssertionError(f"{at}: the path rests at {path.rest} of {known} vectors")
    if at.start >= 0:
        if at.start - at.change.value not in path.rest_ticks():
            raise AssertionError(f"{at}: the path rests at {path.rest_ticks()}")
        path.start(at.start)


def limit(vectors: list[Vector], at: Made, known: int) -> None:
    """Give the vectors from a change on the speed or acceleration that it wants."""
    there, later = at.section, range(at.section + 1, known)
    wanted = {SPEED: (there, *later), SECTION: (there,), LATER: tuple(later)}
    for i in wanted.get(at.change.kind, ()):
        vectors[i] = replace(vectors[i], speed=at.change.value)
    for i in range(at.section, known if at.change.accel else 0):
        vectors[i] = replace(vectors[i], accel=at.change.accel)


def join(path: reference.Path, at: Made) -> None:
    """Plan what has not been laid anew."""
    if (at.section, at.place) == path.begun:
        path.start_again()
    elif at.section > path.planned_from:
        path.join(at.section)
    else:
        path.change(*before(path, at), stops=False)


def change(path: reference.Path, at: Made) -> None:
    """Plan the path anew from a place, or from where it left its stand."""
    stops = at.change.kind in (STOP, BRAKE)
    if (at.section, at.place) == path.begun:
        path.start_again(stops=stops)
    else:
        path.change(*before(path, at), stops=stops)


def before(path: reference.Path, at: Made) -> tuple[int, Fraction]:
    """Return the place of a change; a border is the end of the vector before."""
    begins = (at.section, at.place) == path.begun
    if at.place == 0 and at.section > 0 and path.legs[0].vector < at.section and not begins:
        return at.section - 1, Fraction(path.vectors[at.section - 1].length)
    return at.section, at.place


def ideal(case: Case, made: Run) -> reference.Path:
    """Return the path as the contract wants it, with the changes where the probe made them."""
    vectors = list(case.vectors)
    known = case.known or len(vectors)
    path = reference.Path(vectors, known, Limits(case.turn_us, case.start_speed))
    path.start(0)
    stopping = False
    for at in made.changes:
        wanted = at.change
        if wanted.kind in (ADD, JOIN):
            known = min(len(vectors), known + wanted.value)
        if wanted.kind == JOIN and (stopping or case.start_speed):
            continue
        if not case.start_speed:
            path.known = known
        if wanted.kind == GO:
            go_on(path, at, known)
        elif wanted.kind == JOIN:
            join(path, at)
        else:
            path.check(*before(path, at), wanted.tick)
            limit(vectors, at, known)
            change(path, at)
            if wanted.kind == STOP:
                go_on(path, at, known)
        stopping = wanted.kind == BRAKE
    return path


@dataclass(frozen=True)
class Deviation:
    """How far pulses are from their ideal ticks, the worst of them, and their number."""

    ticks: float
    axis: int
    pulse: int
    pulses: int


def deviation(case: Case, made: Run) -> Deviation:
    """Return the worst deviation; raises where a pulse is missing, too many, or backward."""
    path = ideal(case, made)
    worst = Deviation(0, 0, 0, 0)
    total = 0
    for axis in range(AXES):
        ordinals, ticks = told(case, made.trains[axis])
        count = path.count(axis)
        if (ordinals[-1] if ordinals else 0) != count:
            raise AssertionError(f"axis {axis}: {ordinals[-1:]} pulses instead of {count}")
        total += len(ordinals)
        before = 0
        for leg, length, steps, pulses in path.stretches(axis):
            shift = before + 1 - pulses[0]
            low, high = bisect_right(ordinals, before), bisect_right(ordinals, before + len(pulses))
            before += len(pulses)
            if low == high:
                continue
            if any((tick > 0) != (steps > 0) for tick in ticks[low:high]):
                raise AssertionError(f"axis {axis}, pulses {low} to {high}: the wrong way")
            made_at = [abs(tick) for tick in ticks[low:high]]
            numbers = [n - shift for n in ordinals[low:high]]
            off, which = worst_of(leg, length, abs(steps), numbers, made_at)
            if off > worst.ticks:
                worst = Deviation(off, axis, ordinals[low + which], 0)
    return replace(worst, pulses=total)


def worst_of(
    leg: Leg, length: int, steps: int, pulses: list[int], ticks: list[int]
) -> tuple[float, int]:
    """Return how far the worst of these pulses of a leg is from its ideal tick, and which it is.

    It is found roughly, if the leg is short enough for that, and told exactly.
    """

    def exactly(which: int) -> float:
        ideal_time = leg.pulse_time(length, steps, pulses[which])
        return float(abs((ticks[which] << ROOT_BITS) - ideal_time) / 2**ROOT_BITS)

    if not leg.is_short:
        return max((exactly(which), which) for which in range(len(pulses)))
    begin = leg.time >> ROOT_BITS
    part = (leg.time - (begin << ROOT_BITS)) / 2**ROOT_BITS
    rough = leg.rough_times(length, steps, pulses)
    offs = [abs(tick - begin - part - time) for tick, time in zip(ticks, rough, strict=True)]
    which = offs.index(max(offs))
    return exactly(which), which


def told(case: Case, train: list[str]) -> tuple[Sequence[int], list[int]]:
    """Return ordinals and ticks of the pulses that the probe tells."""
    if case.stride == 1:
        return range(1, len(train) + 1), [int(word) for word in train]
    pairs: dict[int, int] = {}
    for word in train:
        ordinal, tick = word.split(":")
        pairs[int(ordinal)] = int(tick)
    return list(pairs), list(pairs.values())
