"""Runs paths on the firmware's path and step stages and lays them beside the exact reference.

`build/host/bin/path-probe` (`path_probe.c`) makes the pulses; `RKM04_BUILD` names another build
folder.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import path_reference as reference
from path_reference import AXES, FRACTION_BITS, Vector

ROOT = Path(__file__).resolve().parents[2]
STOP, SPEED, ADD, JOIN = range(4)
"""Kinds of changes, as the probe numbers them."""

TURN_US = 12
RING = 128
NEVER = 2**62


@dataclass(frozen=True)
class Change:
    """What happens at a tick after the start.

    STOP: a stop, and the path goes on `value` ticks after it has come to rest. SPEED: all vectors
    from there on have this speed. ADD: so many more vectors are added. JOIN: likewise, but without
    planning anew what has been laid.
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

    @property
    def line(self) -> str:
        """The case as the probe reads it."""
        numbers = [self.epoch, self.turn_us, self.ring, len(self.vectors)]
        for v in self.vectors:
            numbers += [*v.steps, v.speed, v.accel, v.extent2 or v.length**2, v.border]
        numbers += [self.known or len(self.vectors), len(self.changes)]
        for change in self.changes:
            numbers += [change.kind, change.tick, change.patience, change.value, change.accel]
        numbers.append(self.stride)
        return " ".join(map(str, numbers))


@dataclass(frozen=True)
class Made:
    """A change that took effect, and the place at which it did."""

    change: Change
    section: int
    place: Fraction
    square: int
    tick: int
    start: int = 0
    """Of a stop: when the path went on; 0: it did not."""

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


def ideal(case: Case, made: Run) -> reference.Path:
    """Return the path as the contract wants it, with the changes where the probe made them."""
    vectors = list(case.vectors)
    path = reference.Path(vectors, case.known or len(vectors), case.turn_us)
    path.start(0)
    for at in made.changes:
        wanted, section, place = at.change, at.section, at.place
        if place == 0 and section > 0 and path.legs[0].vector < section:
            section, place = section - 1, Fraction(vectors[section - 1].length)
        if wanted.kind in (ADD, JOIN):
            path.known = min(len(vectors), path.known + wanted.value)
        if wanted.kind == SPEED:
            for i in range(at.section, path.known):
                vectors[i] = replace(vectors[i], speed=wanted.value)
        if wanted.kind != JOIN:
            path.check(section, place, wanted.tick)
        for i in range(at.section, path.known if wanted.accel else 0):
            vectors[i] = replace(vectors[i], accel=wanted.accel)
        if wanted.kind == JOIN and (at.section, at.place) == path.begun:
            path.start_again()
            continue
        path.change(section, place, stops=wanted.kind == STOP)
        if wanted.kind == STOP and path.rest[0] != path.known:
            if not 0 <= at.start - wanted.value - path.rest_tick() <= 2:
                raise AssertionError(f"{at}: the path rests at {path.rest_tick()}")
            path.start(at.start)
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
        total += count
        wanted = path.pulses(axis, None if case.stride == 1 else ordinals)
        for k, tick, (sign, time) in zip(ordinals, ticks, wanted, strict=True):
            if tick * sign < 0:
                raise AssertionError(f"axis {axis}, pulse {k}: the wrong way")
            off = abs((abs(tick) << FRACTION_BITS) - time) / 2**FRACTION_BITS
            if off > worst.ticks:
                worst = Deviation(off, axis, k, 0)
    return Deviation(worst.ticks, worst.axis, worst.pulse, total)


def told(case: Case, train: list[str]) -> tuple[Sequence[int], list[int]]:
    """Return ordinals and ticks of the pulses that the probe tells."""
    if case.stride == 1:
        return range(1, len(train) + 1), [int(word) for word in train]
    pairs: dict[int, int] = {}
    for word in train:
        ordinal, tick = word.split(":")
        pairs[int(ordinal)] = int(tick)
    return list(pairs), list(pairs.values())
