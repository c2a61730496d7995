"""Measures of one axis with feeds, holds and a limit, held against the exact curve of the contract.

`build/host/bin/pos-feeds-probe` (`pos_feeds_probe.c`) makes the pulses. It also tells where the
firmware's path left a stand or was planned anew: of all places that the contract allows the one
that was taken. Nothing else of the firmware's plan is used: that the contract allows the place is
checked here, and each curve is that of `pos_curve`, which was written from the contract alone.
"""

from __future__ import annotations

import math
import os
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO

import numpy as np
from exact import Fraction
from pos_change import CHANGE, SLOW_CHANGE, ceil_tick
from pos_curve import BITS, Curve, Order, started
from pos_words import JEDE, MS, POL, SPEED_UNITS, US, Error, Mismatch, Settings
from reference import TICK_HZ

ROOT = Path(__file__).resolve().parents[2]
CONTROL, LIMIT = range(2)
"""Kinds of events, as the probe numbers them."""

TOLERANCE = 1.0
LEADS = (235 * US, 245 * US)
"""Planning takes about so long; pulses that are due before come as they were. So a change on a ramp
may come later than the contract says, which is counted."""

PASS = MS
"""A stand is seen so late, and what follows it begins so much after what the contract says."""

BATCH = 200


@dataclass(frozen=True)
class Event:
    """POS_CONTROL, or the level of the limit input of the direction, at a tick."""

    tick: int
    kind: int
    value: int
    mp: int = 1


@dataclass(frozen=True)
class Case:
    """A measure of a fresh unit, and what comes to it."""

    length: int
    slope: int
    events: tuple[Event, ...]
    settings: Settings = field(default_factory=Settings)
    back: int = 0
    """The way of the measure after it; 0: none."""
    epoch: int = 0
    end: int = 24 * 3600 * TICK_HZ

    @property
    def line(self) -> str:
        """As the probe reads it."""
        own = self.settings
        head = (self.epoch, own.steps, own.micrometres, own.start_feed, own.error_accel)
        rows = [(e.tick, e.kind, e.value, e.mp) for e in self.events]
        numbers = (*head, self.length, self.slope, len(rows), *(n for row in rows for n in row))
        return " ".join(map(str, (*numbers, self.back, self.end)))


@dataclass(frozen=True)
class Place:
    """Where the path left a stand or was planned anew: seen by a pass, and when it is there."""

    seen: int
    x: Fraction
    tick: int


@dataclass(frozen=True)
class Made:
    """What the firmware did."""

    status: int
    error: int
    steps: int
    steps_after: int
    late: int
    end: int
    places: tuple[Place, ...]
    ticks: np.ndarray[tuple[int], np.dtype[np.int64]]
    """Negative: backward."""


@dataclass
class Found:
    """What a comparison has seen."""

    pulses: int = 0
    worst: float = 0.0
    seconds: float = 0.0
    changes: int = 0
    stands: int = 0
    waits: int = 0
    """Changes that waited for a pulse at which one before them was still to take effect, while the
    contract wants them between two pulses."""
    longest: int = 0
    """By how many ticks at most."""
    later: int = 0
    """Changes that came after the contract's window, but at the first pulse after LEADS."""
    latest: int = 0
    """By how many ticks at most."""

    def take(self, other: Found) -> None:
        """Add another one."""
        self.pulses += other.pulses
        self.worst = max(self.worst, other.worst)
        self.seconds += other.seconds
        self.changes += other.changes
        self.stands += other.stands
        self.waits += other.waits
        self.longest = max(self.longest, other.longest)
        self.later += other.later
        self.latest = max(self.latest, other.latest)

    def __str__(self) -> str:
        """For people."""
        return (
            f"{self.pulses} pulses in {self.seconds / 3600:.2f} h of motion, the worst "
            f"{self.worst:.3f} ticks off; {self.changes} changes, {self.stands} stands; "
            f"{self.waits} waited for one before them, {self.longest / MS:.1f} ms at most; "
            f"{self.later} came {self.latest / MS:.1f} ms at most after the contract's window"
        )


# --- running ---


def program() -> Path:
    """Return where the build has put the probe."""
    build = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
    return build / "bin" / "pos-feeds-probe"


def run(cases: Iterable[Case]) -> Iterator[tuple[Case, Made]]:
    """Play cases, some at a time."""
    batch: list[Case] = []
    for case in cases:
        batch.append(case)
        if len(batch) == BATCH:
            yield from _run_batch(batch)
            batch = []
    yield from _run_batch(batch)


def _run_batch(batch: Sequence[Case]) -> Iterator[tuple[Case, Made]]:
    text = "".join(f"{case.line}\n" for case in batch).encode()
    done = subprocess.Popen([program()], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert done.stdin
    assert done.stdout
    with done, done.stdin, done.stdout:
        for case, line in zip(batch, text.splitlines(keepends=True), strict=True):
            done.stdin.write(line)
            done.stdin.flush()
            yield case, _read(done.stdout)


def _read(stream: IO[bytes]) -> Made:
    line = stream.readline()
    assert line, "the probe has ended; its complaint is on standard error"
    told = list(map(int, line.split()))
    count = told[6]
    rows = [told[7 + 5 * i : 12 + 5 * i] for i in range(count)]
    places = [Place(seen, step + Fraction(g, grains), tick) for seen, step, g, grains, tick in rows]
    ticks = np.frombuffer(stream.read(8 * told[-1]), dtype=np.int64)
    status, error, steps, steps_after, late, end = told[:6]
    return Made(status, error, steps, steps_after, late, end, tuple(places), ticks)


# --- comparing ---


class Follower:
    """Lays the curve of a case from the contract, and from which of the allowed places it took."""

    def __init__(self, case: Case, made: Made) -> None:
        """Begin at the stand."""
        own = case.settings
        self.case, self.made, self.found = case, made, Found()
        end = abs(own.way_steps(case.length))
        self.order = Order(0, own.start_speed, own.accel(case.slope), end)
        self.curve: Curve | None = None
        self.last: Place | None = None
        """Where the path was planned from,"""
        self.before: Curve | None = None
        """what it was before, and whether it left a stand there."""
        self.starts = False
        self.feed, self.mp = 0, 1
        self.asked = 0
        """When what is wanted was asked for."""
        self.faulty = self.blocked = False

    def follow(self) -> Found:
        """Compare all of it."""
        places = list(self.made.places)
        events = self.case.events
        for event, until in zip(events, [*(e.tick for e in events[1:]), 2**62], strict=True):
            before = (self.asked, self.order)
            changed = self._take(event)
            while places and places[0].seen < until:
                place = places.pop(0)
                if places and self._stands_first(place, places[0]):
                    self._hold(place, *before)
                else:
                    self._move(event.tick, place)
                changed = False
            if changed:
                self._see_nothing(event.tick, until)
        if places:
            raise Mismatch(places[0].tick, "a plan before anything was asked for")
        self._compare()
        return self.found

    def _take(self, event: Event) -> bool:
        """What is wanted from an event on; whether that is something else."""
        own, before, was_faulty = self.case.settings, self.order, self.faulty
        if event.kind == LIMIT:
            self.blocked = bool(event.value)
        else:
            self.feed, self.mp = event.value, event.mp
        self.faulty = self.faulty or (self.blocked and self._acts(event.tick))
        if self.faulty and not was_faulty:
            accel = own.accel(own.error_accel) or before.accel
            self.order = replace(before, accel=accel)
        wanted = self.mp and not self.faulty
        self.order = replace(self.order, speed=own.speed(self.feed) if wanted else 0)
        if self.order != before:
            self.asked = event.tick
        return self.order != before

    def _acts(self, tick: int) -> bool:
        """Whether an active limit acts; in the last moment of a motion either may be."""
        left = self.curve.rest_time - (tick << BITS) if self.curve else -1
        if self.curve and self.last and self.last.x == self.curve.rest:
            left = 0  # it comes to rest where it was stopped: no pulse comes any more
        if abs(left) < 3 << BITS:
            return self.made.error == Error.LIMIT
        return left > 0 or bool(self.feed and self.mp)

    def _move(self, tick: int, place: Place) -> None:
        """The path leaves a stand, or is planned anew, because of what came at a tick."""
        if self.last and (self.last.x, self.last.tick) == (place.x, place.tick):
            self._again(tick, place)
        elif self.curve and place.x == self.curve.rest and not self.order.speed:
            return
        elif self.curve is None or self._stands(self.curve, place):
            self._start(tick, place)
        else:
            self._change(tick, place, self.curve)

    @staticmethod
    def _stands_first(place: Place, then: Place) -> bool:
        """Whether it is planned for a stand, and in the same pass for a start from there."""
        return then.seen == place.seen and then.x == place.x and then.tick > place.tick

    def _hold(self, place: Place, asked: int, order: Order) -> None:
        """A hold that is taken back only acts yet, as it stands before a pulse comes."""
        wanted, self.order = self.order, order
        if order.speed:
            raise Mismatch(place.tick, "it stands, but was not held")
        self._move(asked, place)
        self.order = wanted

    @staticmethod
    def _stands(curve: Curve, place: Place) -> bool:
        return place.x == curve.rest and place.tick << BITS >= curve.rest_time

    def _again(self, tick: int, place: Place) -> None:
        """Something else is wanted from where the path was planned from already."""
        if not self.starts and place.tick > self._window(tick, 0) + 1:
            self.found.waits += 1
            self.found.longest = max(self.found.longest, place.tick - tick)
        self._lay(place)

    def _start(self, tick: int, place: Place) -> None:
        curve = self.curve
        rest = curve.rest if curve else Fraction(0)
        low = max(tick, ceil_tick(curve.rest_time) if curve else 0)
        late = CHANGE + (2 * PASS if low > tick else 0)
        if not self.order.speed or place.x != rest or not low <= place.tick <= low + late:
            raise Mismatch(place.tick, f"a start from {place.x} when it stands at {rest} at {low}")
        self.found.stands += curve is not None
        self.last, self.before, self.starts = place, curve, True
        self._lay(place)

    def _change(self, tick: int, place: Place, curve: Curve) -> None:
        leg = curve.leg_at(place.x)
        if leg is None or abs(leg.time_at(place.x) - (place.tick << BITS)) > 2 << BITS:
            raise Mismatch(place.tick, f"a change at {place.x}, where it is not")
        if place.x.denominator != 1 and leg.sign:
            raise Mismatch(place.tick, f"a change on a ramp between two pulses, at {place.x}")
        self._see_window(tick, place.tick)
        self.last, self.before, self.starts = place, curve, False
        self.found.changes += 1
        self._lay(place)

    def _lay(self, place: Place) -> None:
        """The curve from a place on."""
        if not self.starts:
            assert self.before
            self.curve = self.before.changed(place.x, self.order)
            return
        curve = started(place.x, place.tick << BITS, self.order)
        if not curve.legs:
            self.curve = self.before
            return
        legs = self.before.legs if self.before else ()
        self.curve = replace(curve, legs=(*legs, *curve.legs))

    def _window(self, tick: int, lead: int) -> int:
        """By when a change that is asked for at a tick has to take effect."""
        curve = self._present
        leg = next((each for each in curve.legs if each.end_time > (tick + lead) << BITS), None)
        if leg is None:
            return tick + CHANGE
        begun = max((tick + lead) << BITS, leg.time)
        pulse = math.floor(leg.place_at(begun)) + 1
        while pulse > curve.next and self._due(curve, pulse - 1) >= tick + lead:
            pulse -= 1
        due = self._due(curve, pulse) if pulse <= curve.count else tick + CHANGE
        if self.faulty:
            return due if curve.leg_at(pulse) else tick + CHANGE
        within = SLOW_CHANGE if leg.square2 < 2 * SPEED_UNITS**2 else CHANGE
        cruises = leg.sign == 0 and leg.time <= (tick + lead) << BITS
        if cruises and leg.end_time >= (tick + lead + within) << BITS:
            return tick + within
        return max(tick + CHANGE, due)

    def _latest(self, tick: int) -> int:
        return max(self._window(tick, lead) for lead in LEADS)

    @staticmethod
    def _due(curve: Curve, pulse: int) -> int:
        if curve.leg_at(pulse) is None:
            return 0
        return ceil_tick(curve.time_of(pulse))

    @property
    def _present(self) -> Curve:
        assert self.curve
        return self.curve

    def _see_window(self, tick: int, due: int) -> None:
        late = due - self._window(tick, 0) - 1
        if late > 0:
            self.found.later += 1
            self.found.latest = max(self.found.latest, late)
            if due > self._latest(tick) + 1:
                raise Mismatch(due, f"a change asked for at {tick} comes {late / US:.0f} us late")

    def _see_nothing(self, tick: int, until: int) -> None:
        """Something else was wanted, and nothing was planned for it before the next event."""
        curve, order = self.curve, self.order
        if curve is None or curve.rest_time <= tick << BITS:
            reached = curve is not None and curve.reaches
            if order.speed and order.end and not reached and until > tick + CHANGE + 2 * PASS:
                raise Mismatch(tick, "it does not start")
            return
        if until <= self._latest(tick):
            return
        stands = ceil_tick(curve.rest_time)
        if not curve.reaches:
            if order.speed and until > stands + CHANGE + 2 * PASS:
                raise Mismatch(stands, "it does not go on")
            return
        later = [n for n in range(curve.count + 1) if self._due(curve, n) >= tick + LEADS[-1]]
        if not later:
            return
        apart = curve.changed(later[0], order).rest_time - curve.rest_time
        if abs(apart) > 2 << BITS:  # else what is wanted is what there was, laid anew
            raise Mismatch(tick, "a change is lost")

    def _compare(self) -> None:
        curve, made = self.curve, self.made
        sign = 1 if self.case.length > 0 else -1
        ticks = made.ticks * sign
        if len(ticks) and ticks.min() < 0:
            raise Mismatch(made.end, "a pulse in the wrong direction")
        count = curve.count if curve else 0
        if made.late or len(ticks) != count or made.steps != sign * count:
            what = f"{len(ticks)} pulses, {made.steps} steps, {made.late} late; {count} are due"
            raise Mismatch(made.end, what)
        if self.faulty != (made.error == Error.LIMIT) or made.status & JEDE:
            raise Mismatch(made.end, f"it ends with error {made.error}")
        if not self.faulty and (curve.reaches if curve else not self.order.end) != bool(
            made.status & POL
        ):
            raise Mismatch(made.end, f"it ends with status {made.status:04X}")
        if curve:
            self._compare_ticks(curve, ticks)

    def _compare_ticks(
        self, curve: Curve, ticks: np.ndarray[tuple[int], np.dtype[np.int64]]
    ) -> None:
        found = self.found
        for leg in curve.legs:
            found.seconds += (leg.end_time - leg.time) / 2**BITS / TICK_HZ
            low, high = leg.pulses.start, min(leg.pulses.stop - 1, curve.count)
            if low > high:
                continue
            base = leg.time >> BITS
            due = leg.ticks(np.arange(low, high + 1), base)
            off = np.abs(ticks[low - 1 : high] - base - due)
            at = int(off.argmax())
            if off[at] > TOLERANCE:
                raise Mismatch(int(ticks[low - 1 + at]), f"pulse {low + at} is {off[at]:.2f} off")
            found.worst = max(found.worst, float(off[at]))
        found.pulses += len(ticks)


def compare(case: Case, made: Made) -> Found:
    """Hold what the firmware did against the contract."""
    return Follower(case, made).follow()


def stands_after(case: Case, made: Made) -> int:
    """Where the axis stands after the measure that follows: B and M of the contract."""
    own = case.settings
    if made.status & POL:
        return own.way_steps(case.length + case.back)
    return made.steps + own.way_steps(case.back)
