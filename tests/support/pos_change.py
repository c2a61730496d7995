"""Where and when a change may take effect: what the contract leaves open becomes families."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from pos_curve import BITS, GAIN, Curve, Leg, Order, moving, started
from pos_family import FEW, Family, alone
from pos_loose import Loose, loose, rested
from pos_words import MS, SPEED_UNITS, Unsure

CHANGE = MS
"""A change takes effect within this, or at the next pulse."""

LEAD = MS * 34 // 100
"""Planning takes so long: pulses that are due before come as they were."""

SLOW_CHANGE = 20 * MS
"""Likewise below 1 step/s."""

NEVER = 2**62

Places = tuple[int, int, int]
"""Places in a step, the first and the last of them; 1 place in a step: pulses."""


def ceil_tick(time: int) -> int:
    """The first tick at or after a time."""
    return -(-time >> BITS)


# --- leaving a stand ---


def begun(families: Sequence[Family], order: Order, low: int, high: int) -> list[Family]:
    """Starts at a tick within a window, or so long after each stand, from where each rests."""
    if not families:
        return [_start(Fraction(0), order, low, high)]
    late = high - low
    if any(isinstance(f, Loose) or (f.wide and not f.starts) for f in families):
        return [_from_rests(families, order, low, late)]
    starts: dict[Fraction, Family] = {}
    for curve in (curve for family in families for curve in family.closed(low)):
        first = max(low, ceil_tick(curve.rest_time))
        if curve.rest not in starts or first < starts[curve.rest].low:
            starts[curve.rest] = _start(curve.rest, order, first, first + late, curve.blur)
    return list(starts.values())


def _start(
    x: Fraction, order: Order, low: int, high: int, blur: float = 0.0, before: Curve | None = None
) -> Family:
    return Family(
        lambda tick: _after(before, started(x, tick << BITS, order, blur)), low, high, starts=True
    )


def _after(before: Curve | None, curve: Curve) -> Curve:
    """A curve with what came before its stand."""
    if before is None:
        return curve
    start = len(before.legs) if curve.legs else -1
    return replace(curve, legs=(*before.legs, *curve.legs), start=start)


def _from_rests(families: Sequence[Family], order: Order, low: int, late: int) -> Family:
    """The starts from all rests together, as where the axis rests is known only about."""
    curves = [curve for family in families for curve in family.both]
    per_step = GAIN * order.accel
    rests = [curve.rest * per_step for curve in curves]
    blur = max(curve.blur for curve in curves)
    first = max(low, min(ceil_tick(curve.rest_time) for curve in curves))
    last = max(low, *(ceil_tick(curve.rest_time) for curve in curves)) + late
    return loose(
        lambda n: started(Fraction(n, per_step), 0, order, blur),
        (math.floor(min(rests)), math.ceil(max(rests))),
        (first, last),
    )


# --- changes ---


def changed(
    families: Sequence[Family], seen: int, tick: int, order: Order, late: int
) -> list[Family]:
    """The families in which something else is wanted from a tick on, after so many pulses."""
    found: list[Family] = []
    blind: list[tuple[Curve, Places]] = []
    waiting, moving_on = _parted(families, tick)
    found += [_restarted(family, order) for family in waiting]
    for family in moving_on:
        sources = [family.base] if family.base and _undone(family, tick) else []
        if family.wide and _few(family, seen, tick, late):
            found += _of_wide(family, seen, tick, order, late)
            blind += _between_of(family, seen, tick, late)
        elif family.starts and family.wide:
            raise Unsure("a change before a start has shown itself")
        else:
            sources += family.closed(tick)
        for curve in sources:
            found += _of_curve(curve, seen, tick, order, late)
    if blind:
        if late > CHANGE and any(c.ticks(seen + 1, seen + 1, tick)[0] < late for c, _ in blind):
            raise Unsure("a late change before a start has shown itself")
        found.append(_blindly(blind, seen, (tick, late), order))
    return found


def _parted(families: Sequence[Family], tick: int) -> tuple[list[Family], list[Family]]:
    """Those that have not left the stand at a tick, and the others."""
    waiting, moving_on = [], []
    for family in families:
        if not family.both[0].waits(tick) and not family.both[-1].waits(tick):
            moving_on.append(family)
        elif all(curve.waits(tick) for curve in family.both):
            waiting.append(family)
        elif isinstance(family, Loose) or not family.starts:
            raise Unsure("a change just when the axis starts")
        else:
            waiting.append(replace(family, low=tick, kept={}))
            moving_on.append(replace(family, high=tick - 1, kept={}))
    return waiting, moving_on


def _restarted(family: Family, order: Order) -> Family:
    """The starts that come, with something else wanted."""
    if isinstance(family, Loose):
        shape, ticks = family.shape, (family.low, family.high)
        return loose(lambda n: shape(n).restarted(order), (family.first, family.last), ticks)
    make = family.make
    return replace(family, make=lambda i: make(i).restarted(order), kept={})


def _between_of(family: Family, seen: int, tick: int, late: int) -> Iterator[tuple[Curve, Places]]:
    """Places between pulses; for a curve that is nearer to its next pulse there may be others."""
    curves = family.spread
    found = [
        (curve, places)
        for curve in curves
        for places in _places(curve, seen, tick, late)
        if places[0] > 1
    ]
    if found and len({id(curve) for curve, _ in found}) < len(curves):
        curve, (per_step, low, _) = min(found, key=lambda each: each[1][1])
        found = [(curve, (per_step, low, (seen + 1) * per_step - 1))]
    yield from found


def _few(family: Family, seen: int, tick: int, late: int) -> bool:
    """Whether a change comes at one of a few pulses, if at a pulse."""
    numbers = _numbers(family, seen, tick, late)
    return not numbers or max(numbers) - min(numbers) <= FEW


def _numbers(family: Family, seen: int, tick: int, late: int) -> list[int]:
    places = [p for curve in family.both for p in _places(curve, seen, tick, late)]
    return [number for per_step, *ends in places if per_step == 1 for number in ends]


def _of_wide(family: Family, seen: int, tick: int, order: Order, late: int) -> Iterator[Family]:
    """A change of curves that are too many to follow each, but for those between pulses."""
    numbers = _numbers(family, seen, tick, late)
    for number in range(min(numbers), max(numbers) + 1) if numbers else ():
        yield _composed(family, order, number)
    both = family.both
    soon = any(ceil_tick(curve.rest_time) <= tick + late for curve in both)
    leads_on = any(list(_places(curve, seen, tick, late)) for curve in both)
    if not soon and leads_on and seen < min(curve.count for curve in both):
        return
    if not order.speed or all(curve.reaches for curve in both):
        yield family
    elif not any(curve.reaches for curve in both):
        stands = [max(tick, ceil_tick(curve.rest_time)) for curve in both]
        ticks = (min(stands), max(stands) + 2 * late)
        yield rested(family, lambda old: started(old.rest, 0, order, old.blur), ticks)
    else:
        raise Unsure("a change when the axis may have reached its measure or not")


def _composed(family: Family, order: Order, number: int) -> Family:
    place = Fraction(number)
    if isinstance(family, Loose):
        shape, ticks = family.shape, (family.low, family.high)
        return loose(lambda n: shape(n).changed(place, order), (family.first, family.last), ticks)
    make = family.make
    return Family(
        lambda i: make(i).changed(place, order), family.low, family.high, starts=family.starts
    )


def _blindly(
    options: Sequence[tuple[Curve, Places]], seen: int, window: tuple[int, int], order: Order
) -> Family:
    """A change at constant speed, when where the axis is then is known only about."""
    per_steps = {places[0] for _, places in options}
    squares = {_at(curve, places).square2 for curve, places in options}
    if len(squares) > 1 or len(per_steps) > 1:
        raise Unsure("a change at a speed that is not known")
    square2, per_step = squares.pop(), per_steps.pop()
    low = max(min(places[1] for _, places in options), seen * per_step)
    high = min(max(places[2] for _, places in options), (seen + 1) * per_step - 1)
    tick, late = window
    late = max(late, SLOW_CHANGE) if square2 < 2 * SPEED_UNITS**2 else late
    blur = max(curve.blur for curve, _ in options)
    return loose(
        lambda n: moving(Fraction(n, per_step), square2, 0, order, blur),
        (low, max(low, high)),
        (tick, tick + late),
    )


def _at(curve: Curve, places: Places) -> Leg:
    leg = curve.leg_at(Fraction(places[1], places[0]))
    assert leg is not None
    return leg


def _undone(family: Family, tick: int) -> bool:
    """Whether what made a family may not have come to pass before a tick."""
    base = family.base
    assert base is not None
    return any(
        curve.legs != base.legs and _parting(curve, base) >= tick << BITS for curve in family.both
    )


def _of_curve(curve: Curve, seen: int, tick: int, order: Order, late: int) -> Iterator[Family]:
    options = list(_places(curve, seen, tick, late))
    for per_step, low, high in options:
        yield _family(curve, order, per_step, low, high)
    rests = ceil_tick(curve.rest_time)
    if options and rests > tick + late and seen < curve.count:
        return
    if curve.reaches or not order.speed:
        yield alone(curve)
    else:
        first = max(tick, rests)
        yield _start(curve.rest, order, first, first + 2 * late, curve.blur, before=curve)


def _family(curve: Curve, order: Order, per_step: int, low: int, high: int) -> Family:
    family = Family(lambda i: curve.changed(Fraction(i, per_step), order), low, high, base=curve)
    first, last = family.both[0], family.both[-1]
    return alone(curve) if first.legs == last.legs == curve.legs else family


def _places(curve: Curve, seen: int, tick: int, late: int) -> Iterator[Places]:
    """Where a change may take effect: at pulses up to the first that planning leaves time for.

    And at constant speed between pulses, if it is not later than `late`.
    """
    first = seen + 1
    due = last = soon = NEVER
    since = tick
    if curve.rest_time > tick << BITS and first <= curve.count and curve.leg_at(first):
        due, last = ceil_tick(curve.time_of(first)), first
        while last < curve.count and curve.time_of(last) < tick + LEAD << BITS:
            since = ceil_tick(curve.time_of(last))
            last += 1
        soon = ceil_tick(curve.time_of(last))
        while last < curve.count and curve.time_of(last + 1) <= tick + late << BITS:
            last += 1
    between: list[Places] = []
    if due == NEVER or soon > tick + LEAD + late // 2:
        between = list(_between(curve, since, tick + max(late, CHANGE) - since, soon))
    cruises = between and _leg_during(curve, tick).sign == 0
    if due < NEVER and (not cruises or due <= tick + 2 * late):
        yield 1, first, last
    yield from between


def _leg_during(curve: Curve, tick: int) -> Leg:
    """The leg at a tick; the first one, if none has begun."""
    begun = [leg for leg in curve.legs if leg.time <= tick << BITS]
    return begun[-1] if begun else curve.legs[0]


def _between(curve: Curve, tick: int, late: int, due: int) -> Iterator[tuple[int, int, int]]:
    """Places between pulses where a change may take effect at constant speed."""
    for leg in curve.legs:
        slow = leg.square2 < 2 * SPEED_UNITS**2
        window = max(SLOW_CHANGE, late) if slow else late
        low = max(tick << BITS, leg.time)
        high = min(min(due, tick + window) << BITS, leg.end_time)
        if leg.sign or low >= high:
            continue
        per_step = GAIN * leg.accel
        first = math.ceil(leg.place_at(low) * per_step)
        last = math.floor(leg.place_at(high) * per_step)
        if first <= last:
            yield per_step, max(first, math.floor(leg.x0 * per_step) + 1), last


def _parting(curve: Curve, other: Curve) -> int:
    """When two curves part."""
    for a, b in zip(curve.legs, other.legs, strict=False):
        if a != b:
            return min(a.end_time, b.end_time) if a.time == b.time else max(a.time, b.time)
    return min(curve.rest_time, other.rest_time)
