"""What holds measures with feeds against the contract finds what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from exact import Fraction
from pos_curve import BITS, Order, started
from pos_feeds import CONTROL, LIMIT, Case, Event, Made, Place, compare
from pos_words import FEED_UNITS, MS, US, Mismatch, Settings

ASKED = MS
BEGUN = ASKED + 600 * US
CASE = Case(10_000, 500, (Event(ASKED, CONTROL, 1000 * FEED_UNITS),))
CURVE = started(0, 0, Order(Settings().speed(1000 * FEED_UNITS), 0, Settings().accel(500), 1000))
START = Place(ASKED, Fraction(0), BEGUN)
"""The contract's example: 1000 pulses."""


def right() -> Made:
    """What a unit does that keeps the contract."""
    ticks = np.rint(CURVE.ticks(1, 1000, 0)).astype(np.int64) + BEGUN
    return Made(0x0803, 0, 1000, 1000, 0, 0, (START,), ticks)


def shifted(at: int, ticks: int) -> Made:
    """One pulse is beside its time."""
    made = right()
    other = made.ticks.copy()
    other[at] += ticks
    return replace(made, ticks=other)


def planned(*places: Place) -> Made:
    """Plans of other places."""
    return replace(right(), places=places)


def at_pulse(number: int, seen: int) -> Place:
    """A plan from a pulse on."""
    return Place(seen, Fraction(number), BEGUN + (CURVE.time_of(number) >> BITS))


def then(*events: Event) -> Case:
    """The example, and something that comes to it."""
    return replace(CASE, events=(*CASE.events, *events))


WRONG: dict[str, Callable[[], Made]] = {
    "pulse 1 is": lambda: shifted(0, 2),
    "pulse 501 is": lambda: shifted(500, -2),
    "pulse 1000 is": lambda: shifted(999, 2),
    "999 pulses": lambda: replace(right(), ticks=right().ticks[:-1], steps=999),
    "1 late": lambda: replace(right(), late=1),
    "status": lambda: replace(right(), status=0x0003),
    "error 7": lambda: replace(right(), error=7),
    "wrong direction": lambda: replace(right(), ticks=-right().ticks),
    "a start from": lambda: planned(replace(START, tick=ASKED + 2 * MS)),
    "does not start": planned,
    "where it is not": lambda: planned(START, Place(ASKED, Fraction(400), BEGUN + 30 * MS)),
}


def test_a_measure_as_in_the_contract_is_right() -> None:
    found = compare(CASE, right())

    assert (found.pulses, found.changes, found.later) == (1000, 0, 0)
    assert found.worst <= 0.501


@pytest.mark.parametrize("what", WRONG)
def test_what_is_not_as_in_the_contract_is_found(what: str) -> None:
    with pytest.raises(Mismatch, match=what):
        compare(CASE, WRONG[what]())


def test_a_change_that_comes_late_or_not_at_all_is_found() -> None:
    at = BEGUN + 30 * MS
    case = then(Event(at, CONTROL, 500 * FEED_UNITS))

    with pytest.raises(Mismatch, match="us late"):
        compare(case, planned(START, at_pulse(500, at)))
    with pytest.raises(Mismatch, match="a change is lost"):
        compare(case, right())


def test_a_limit_that_does_not_act_is_found() -> None:
    with pytest.raises(Mismatch):
        compare(then(Event(BEGUN + 100 * MS, LIMIT, 1)), right())
