"""Feeds, holds and limits of the positioning unit at any moment, pulse by pulse.

Each run is laid beside the exact curve of the contract: where a change may take effect, where the
axis stands and goes on, every pulse, none too many, and where it is at last. `RKM04_LONG` tries ten
thousand random measures of sixteen hours and more, and all places and many pairs of the sweeps in
place of samples, and prints what was seen.
"""

from __future__ import annotations

import math
import os
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise, product

import pytest
from chance import SEED, epoch
from pos_feeds import CONTROL, LIMIT, Case, Event, Found, compare, run, stands_after
from pos_words import FEED_UNITS, MS, US, Mismatch, Settings

LONG = bool(os.environ.get("RKM04_LONG"))
MEASURES = 10_500 if LONG else 150
HOURS = 16
SINGLES = 10**6 if LONG else 120
PAIRS = 10_000 if LONG else 80
"""So many runs of each measure, of some thousands with one event and some millions with two."""

BEGIN = 2 * MS
LATE_MS_MAX = 110_000
"""The contract has windows for changes; the engine keeps them but for faults, which are planned
first, and for a change on a ramp at the very tick of a pulse, which is followed by a whole
interval. So late is no more than an interval of the slowest pulses here."""

SLOWEST = 0.01
"""steps/s"""

RATIOS = ((1, 10), (1, 10), (3200, 40_000), (7, 3), (50, 1), (1, 1000))
ACTS = (0, 2, 5, 10, 30)


def held(cases: Iterator[Case], what: str) -> Found:
    """Hold cases against the contract."""
    found = Found()
    for case, made in run(cases):
        try:
            found.take(compare(case, made))
            if case.back:
                assert made.steps_after == stands_after(case, made)
        except (Mismatch, AssertionError) as wrong:
            raise AssertionError(f"{wrong}\n{case.line}") from wrong
    print(f"{what}: {found}")
    assert max(found.longest, found.latest) <= LATE_MS_MAX * MS
    return found


# --- random measures ---


class Drawn:
    """Draws a measure and what comes to it."""

    def __init__(self, seed: object) -> None:
        """Draw everything from a seed."""
        self.rng = random.Random(f"feeds {seed}")
        steps, micrometres = self.rng.choice(RATIOS)
        self.settings = Settings(steps=steps, micrometres=micrometres)
        self.rate = self.size(3, 200_000)
        self.seconds = self.size(0.05, 10)
        self.tick = BEGIN
        self.events = [Event(BEGIN, CONTROL, self.feed(self.rate))]

    def size(self, low: float, high: float) -> float:
        """Draw a number of any order of size."""
        return math.exp(self.rng.uniform(math.log(low), math.log(high)))

    def feed(self, rate: float) -> int:
        """The feed with so many steps/s."""
        units = rate * 60 * FEED_UNITS / 1000 / float(self.settings.ratio)
        return max(1, min(2**32 - 1, round(units)))

    def wait(self) -> None:
        """Let some time go by, often hardly any."""
        gap_ms = self.rng.choice((self.size(0.001, 3), self.size(1, 1000 * self.seconds)))
        self.tick += round(gap_ms * MS)

    def act(self) -> None:
        """Hold, or give a feed."""
        self.wait()
        feed = self.feed(self.rng.choice((self.rate, self.size(self.rate / 30, self.rate * 3))))
        kind = self.rng.random()
        mp = int(kind >= 0.35)
        self.events.append(Event(self.tick, CONTROL, 0 if 0.35 <= kind < 0.4 else feed, mp))

    def case(self) -> Case:
        """The whole of it."""
        rng, ratio = self.rng, float(self.settings.ratio)
        if rng.random() < 0.3:
            start_feed = self.feed(self.size(1, 2 * self.rate))
            self.settings = replace(self.settings, start_feed=start_feed)
        length = min(2**31 - 1, max(1, round(self.rate * self.seconds / ratio)))
        slope = round(self.size(self.rate / 5, self.rate * 200) / 1000 / ratio)
        for _ in range(rng.choice(ACTS)):
            self.act()
        self.wait()
        self.events.append(Event(self.tick, CONTROL, self.feed(self.rate)))
        return Case(
            rng.choice((1, -1)) * length, max(1, min(65_535, slope)), tuple(self.events),
            self.settings, epoch=rng.getrandbits(40),
        )  # fmt: skip


def test_random_feeds_and_holds_move_no_pulse_from_its_time() -> None:
    found = held((Drawn((SEED, i)).case() for i in range(MEASURES)), "random feeds and holds")

    assert found.changes > MEASURES
    assert not LONG or found.seconds > HOURS * 3600


# --- sweeps ---


@dataclass(frozen=True)
class Course:
    """A short measure of which every pulse is tried."""

    length: int
    slope: int
    feed: int
    start_feed: int = 0

    def case(self, *events: Event, **more: int) -> Case:
        """With some events after the one that starts it; the last one is its feed again."""
        settings = Settings(start_feed=self.start_feed, error_accel=min(65_535, 4 * self.slope))
        return Case(
            self.length, self.slope, (Event(BEGIN, CONTROL, self.feed), *events), settings,
            epoch=epoch(self, len(events)), **more,
        )  # fmt: skip


def feed_of(rate: float) -> int:
    """As delivered, a step is 10 um."""
    return round(rate * 600 / 1000 * FEED_UNITS)


COURSES = {
    "ramps and a cruise": Course(600, 100, feed_of(800)),
    "backward, with a start feed": Course(-500, 200, feed_of(900), feed_of(300)),
    "ramps that meet": Course(400, 50, feed_of(3000)),
    "slow": Course(80, 1, feed_of(9)),
    "below a step a second": Course(40, 1, feed_of(0.7)),
    "fast": Course(2000, 20_000, feed_of(100_000)),
    "slower than the start feed": Course(120, 10, feed_of(20), feed_of(40)),
}


def moments(course: Course) -> list[int]:
    """The ticks of the pulses, those beside them, some before, and some between two."""
    ((_, made),) = run([course.case()])
    ticks = abs(made.ticks)
    found = {BEGIN, BEGIN + 1, BEGIN + 300 * US}
    for first, last in pairwise(ticks):
        found |= {int(first + part * (last - first)) for part in (0.25, 0.5, 0.75)}
    for tick in map(int, ticks):
        found |= {tick + off for off in (-1000 * US, -360 * US, -340 * US, -1, 0, 1)}
    return sorted(tick for tick in found if tick >= BEGIN)


Acts = Callable[[Course, int], tuple[Event, ...]]


def holding(rest: int) -> Acts:
    """A hold, and on after a time."""
    return lambda c, at: (Event(at, CONTROL, c.feed, 0), Event(at + rest, CONTROL, c.feed))


def feeding(part: float, time: int = 0) -> Acts:
    """Another feed, for a time, or to the end."""

    def acts(course: Course, at: int) -> tuple[Event, ...]:
        other = Event(at, CONTROL, min(2**32 - 1, max(feed_of(SLOWEST), round(course.feed * part))))
        return (other, Event(at + time, CONTROL, course.feed)) if time else (other,)

    return acts


KINDS: dict[str, Acts] = {
    "hold for long": holding(800 * MS),
    "hold": holding(20 * MS),
    "hold for a moment": holding(100 * US),
    "half": feeding(0.5),
    "more": feeding(1.7),
    "a little": feeding(0.97),
    "crawl": feeding(0, 30 * MS),
    "crawl for a moment": feeding(0.01, 500 * US),
}


def some(cases: list[Case], count: int, *of: object) -> Iterator[Case]:
    """All, or some of them."""
    rng = random.Random(f"{SEED} {of}")
    return iter(cases if len(cases) <= count else rng.sample(cases, count))


@pytest.mark.parametrize("name", COURSES)
def test_a_hold_or_another_feed_at_any_pulse(name: str) -> None:
    course = COURSES[name]
    cases = [
        course.case(*acts(course, at)) for at, acts in product(moments(course), KINDS.values())
    ]

    held(some(cases, SINGLES, name), f"single, {name}")


@pytest.mark.parametrize("name", COURSES)
def test_holds_and_feeds_at_any_two_pulses(name: str) -> None:
    course, rng = COURSES[name], random.Random(f"{SEED} pairs {name}")
    at, kinds = moments(course), list(KINDS.values())

    def pair() -> Case:
        first, last = rng.choice(kinds)(course, rng.choice(at)), rng.choice(kinds)
        events = [*first, *last(course, rng.choice(at))]
        events.sort(key=lambda event: event.tick)
        end = Event(
            max(events[-1].tick, BEGIN) + rng.choice((1, MS, 50 * MS)), CONTROL, course.feed
        )
        return course.case(*events, end)

    held((pair() for _ in range(PAIRS)), f"pairs, {name}")


@pytest.mark.parametrize("name", COURSES)
def test_a_limit_at_any_pulse(name: str) -> None:
    course = COURSES[name]
    back = -course.length // 3
    cases = [course.case(Event(at, LIMIT, 1), back=back) for at in moments(course)]
    cases += [
        course.case(Event(at, CONTROL, course.feed, 0), Event(at + gap, LIMIT, 1), back=back)
        for at, gap in product(moments(course), (1, 500 * US, 3 * MS))
    ]

    held(some(cases, SINGLES, name), f"limit, {name}")


def test_pulses_do_not_burst_out_where_a_change_would_be_far_ahead():
    """From 300 to 1/256 steps/s at once at the end of a ramp, and faster again just before that."""
    settings = Settings(start_feed=11_796_480)
    go = 35_389_440
    feeds = ((2 * MS, go), (2_896_507, 1), (5_416_507, go))
    events = tuple(Event(tick, CONTROL, feed) for tick, feed in feeds)

    held(iter([Case(-500, 200, events, settings)]), "a change before a cruise of minutes")


def test_a_hold_that_acts_as_it_is_taken_back_is_left_by_a_start():
    """On a ramp to a crawl no hold can act; in the crawl, where it is over, it is taken back."""
    settings = Settings(steps=1, micrometres=10, start_feed=279_934)
    go, crawl = 357_953, 12_974
    first = ((168_000, go, 1), (329_185, go, 0), (5_375_362, go, 1))
    last = ((8_863_544, crawl, 1), (8_863_852, crawl, 0), (9_015_955, go, 1))
    events = tuple(Event(tick, CONTROL, feed, mp) for tick, feed, mp in (*first, *last))

    found = held(iter([Case(193, 13, events, settings)]), "a hold that acts late")

    assert found.stands == 2
