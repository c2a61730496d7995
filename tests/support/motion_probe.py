"""Runs moves on the firmware's motion and step stages and lays them beside the exact reference.

`build/host/bin/motion-probe` (`motion_probe.c`) makes the pulses; `RKM04_BUILD` names another build
folder.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from reference import ENDLESS, FRACTION_BITS, Curve, Section, plan

ROOT = Path(__file__).resolve().parents[2]
STOP = 0
"""As the new speed of a change: stop down the ramp."""

EPOCH_BITS = 62
"""Moves may start at any time of so many bits."""


class Missing(Exception):
    """The probe has not been built."""


@dataclass(frozen=True)
class Move:
    """A move and its changes: (pulse at which it takes effect, new speed or `STOP`)."""

    start_speed: int
    sections: tuple[Section, ...]
    changes: tuple[tuple[int, int], ...] = ()

    @cached_property
    def curve(self) -> Curve:
        """The ideal curve; changes at its last pulse and after it change nothing."""
        curve = plan(self.sections, self.start_speed)
        for pulse, speed in self.changes:
            curve = changed(curve, pulse, speed)
        return curve

    def __str__(self) -> str:
        sections = (f"V{s.speed} A{s.accel} n{steps_of(s) or '-'}" for s in self.sections)
        changes = (f", at {k} {f'V{speed}' if speed else 'stop'}" for k, speed in self.changes)
        return f"S{self.start_speed} {' + '.join(sections)}{''.join(changes)}"


def single(start_speed: int, speed: int, accel: int, steps: int) -> Move:
    """Return a move of one section."""
    return Move(start_speed, (Section(steps, speed, accel),))


def changed(curve: Curve, pulse: int, speed: int) -> Curve:
    """Return the curve after one change."""
    if curve.last is not None and pulse > curve.last:
        return curve
    return curve.speed_changed_at(pulse, speed) if speed else curve.stopped_at(pulse)


def steps_of(section: Section) -> int:
    """Steps as the probe takes them: 0 for a run without end."""
    return 0 if section.steps == ENDLESS else section.steps


@dataclass(frozen=True)
class Case:
    """What the probe is asked: a move, its start in the unit's time, and pulses (none: all)."""

    move: Move
    epoch: int = 0
    wanted: Sequence[int] = ()

    @property
    def line(self) -> str:
        """The case as the probe reads it."""
        move = self.move
        numbers = [self.epoch, move.start_speed, len(move.sections)]
        for section in move.sections:
            numbers += [steps_of(section), section.speed, section.accel]
        numbers.append(len(move.changes))
        for change in move.changes:
            numbers += change
        numbers += [len(self.wanted), *self.wanted]
        return " ".join(map(str, numbers))


@dataclass(frozen=True)
class Run:
    """What the probe answers: ticks from the start of the move, and the rest of its line."""

    ticks: list[int]
    pulses: int
    late: int
    corners: list[tuple[int, int]]

    @classmethod
    def parse(cls, line: str) -> Run:
        """Read an answer."""
        ticks, pulses, late, corners = line.split("|")
        points = (corner.split(":") for corner in corners.split())
        return cls(
            [int(tick) for tick in ticks.split()],
            int(pulses),
            int(late),
            [(int(step), int(speed)) for step, speed in points],
        )


@dataclass(frozen=True)
class Deviation:
    """How far the pulses of a run are from their ideal ticks: the worst of them."""

    ticks: float
    pulse: int


def run(cases: Iterable[Case]) -> Iterator[Run]:
    """Run cases on the probe, all in one process."""
    probe = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin" / "motion-probe"
    text = "".join(f"{case.line}\n" for case in cases)
    try:
        done = subprocess.run([probe], input=text, capture_output=True, text=True, check=True)
    except FileNotFoundError as error:
        raise Missing(f"{probe} is not there: build the preset 'host' first") from error
    return map(Run.parse, done.stdout.splitlines())


def run_one(case: Case) -> Run:
    """Run one case."""
    (made,) = run([case])
    return made


def complaints(case: Case, made: Run) -> list[str]:
    """Return what is wrong with a run besides its ticks."""
    last = case.move.curve.last
    found = []
    if made.pulses != last:
        found.append(f"{case.move}: {made.pulses} pulses instead of {last}")
    if made.late:
        found.append(f"{case.move}: {made.late} pulses were late")
    expected = len(case.wanted) or made.pulses
    if not found and len(made.ticks) != expected:
        found.append(f"{case.move}: {len(made.ticks)} pulses told instead of {expected}")
    return found


def deviation(case: Case, made: Run) -> Deviation:
    """Return the worst deviation of a run."""
    curve = case.move.curve
    pulses = case.wanted or range(1, made.pulses + 1)
    triples = zip(pulses, made.ticks, map(curve.tick_scaled, pulses), strict=True)
    return worst_of(triples)


def worst_of(pulses: Iterable[tuple[int, int, int]]) -> Deviation:
    """Return the worst of pulses, each with its tick and its ideal tick * 2^FRACTION_BITS."""
    errors = ((abs((tick << FRACTION_BITS) - ideal), k) for k, tick, ideal in pulses)
    worst, pulse = max(errors, default=(0, 0))
    return Deviation(worst / (1 << FRACTION_BITS), pulse)
