"""Where and when a change may take effect: what the contract leaves open becomes families."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from exact import Fraction
from pos_curve import BITS, GAIN, Curve, Leg, Order, moving, started
from pos_family import Family, Observed, alone, apart, resolution
from pos_loose import Loose, loose, rested
from pos_words import MS, SPEED_UNITS, Unsure

CHANGE = MS
"""A change takes effect within this, or at the next pulse."""

SLOW_CHANGE = 20 * MS
"""Likewise below 1 step/s."""

SETTLED = 1 / 256
"""Steps; curves that are nearer than this are as one."""

Places = tuple[int, int, int]
"""Places in a step, the first and the last of them; 1 place in a step: pulses."""


Option = tuple[int, Curve, Places]
"""After how many pulses, on which curve, where."""


Kind = tuple[int, Fraction | int]
"""On a ramp up or down, or how fast."""

Known = tuple[Curve, float, Kind]
"""A curve, and where and how it is when the change comes."""


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
    families: Sequence[Family], seen: int, window: tuple[int, int], order: Order, ahead: Observed
) -> list[Family]:
    """The families in which something else is wanted from a tick on, or so much later.

    `seen` pulses have come before, those `ahead` until the window is over.
    """
    found: list[Family] = []
    blind: list[Option] = []
    tick, late = window
    waiting, moving_on = _parted(families, window)
    found += [_restarted(family, order) for family in waiting]
    known: dict[int, list[Known]] = {}
    for family in moving_on:
        if family.base and _undone(family, tick):
            _put(known.setdefault(seen, []), family.base, tick)
        for made, part, last in _shown(family, seen, ahead, tick):
            if _settled(part, tick):
                for curve in part.closed(tick):
                    _put(known.setdefault(made, []), curve, tick)
            else:
                found += _of_wide(part, made, window, order, last=last)
                blind += ((made, *each) for each in _between_of(part, made, window))
    for made, curves in known.items():
        for curve, *_ in curves:
            found += _of_curve(curve, made, tick, order, late)
    for group in _alike(blind):
        found.append(_blindly(group, window, order))
    return found


def _put(known: list[Known], curve: Curve, tick: int) -> None:
    """Keep a curve, or make one that is as good as the same wider by it."""
    near = resolution(curve, tick)
    place, kind = float(curve.place_at(tick << BITS)), _kind(curve, tick)
    for index, (other, there, other_kind) in enumerate(known):
        if abs(there - place) <= near and (other.legs == curve.legs or other_kind == kind):
            gap = apart(other, curve, tick << BITS)
            if gap <= near:
                wider = replace(other, blur=max(other.blur, curve.blur + gap))
                known[index] = wider, there, other_kind
                return
    known.append((curve, place, kind))


def _kind(curve: Curve, tick: int) -> Kind:
    """Whether a curve is on a ramp at a tick, else how fast it is."""
    leg = _leg_during(curve, tick)
    return (leg.sign, 0 if leg.sign else leg.square2) if leg else (0, 0)


def _shown(
    family: Family, seen: int, ahead: Observed, tick: int
) -> Iterator[tuple[int, Family, bool]]:
    """What is known of a family at a change, if that comes behind none, one, two of the pulses.

    The last one is known well enough, or all pulses have come, or all of the curve.
    """
    parts = [family]
    for index in range(len(ahead) + 1):
        settled = [part for part in parts if _settled(part, tick)]
        yield from ((seen + index, part, True) for part in settled)
        parts = [part for part in parts if not _settled(part, tick)]
        over = index == len(ahead)
        made = seen + index
        yield from ((made, p, over or any(c.count <= made for c in p.both)) for p in parts)
        if over or not parts:
            return
        number, next_pulse = seen + index + 1, ahead[index : index + 1]
        at = int(next_pulse[0])
        parts = [replace(f, kept={}) for part in parts for f in part.seen(number, next_pulse)]
        parts = [part for part in parts if part.narrow(number, next_pulse, at) is None]


def _settled(family: Family, tick: int) -> bool:
    """Whether all curves of a family are as one, but for a little."""
    if not family.wide:
        return True
    if isinstance(family, Loose):
        return False
    first, last = family.both
    if _kind(first, tick) != _kind(last, tick):
        return False
    return apart(first, last, tick << BITS) <= SETTLED


def _parted(
    families: Sequence[Family], window: tuple[int, int]
) -> tuple[list[Family], list[Family]]:
    """Those that have not left the stand when the unit notices a change, and those that have."""
    waiting, moving_on = [], []
    tick, late = window
    for family in families:
        if not any(curve.waits(tick) for curve in family.both):
            moving_on.append(family)
        elif not family.starts:
            if not all(curve.waits(tick) for curve in family.both):
                raise Unsure("a change just when the axis starts")
            waiting.append(family)
        else:
            waiting.append(replace(family, low=max(tick, family.low), kept={}))
            if family.low <= tick + late:
                moving_on.append(replace(family, high=min(family.high, tick + late), kept={}))
    return waiting, moving_on


def _restarted(family: Family, order: Order) -> Family:
    """The starts that come, with something else wanted."""
    if isinstance(family, Loose):
        shape, ticks = family.shape, (family.low, family.high)
        places = family.first, family.last
        return loose(lambda n: shape(n).restarted(order), places, ticks, family.skip)
    make = family.make
    return replace(family, make=lambda i: make(i).restarted(order), kept={})


def _between_of(
    family: Family, made: int, window: tuple[int, int]
) -> Iterator[tuple[Curve, Places]]:
    """Places before the next pulse; for a curve that is nearer to that there may be others."""
    curves = family.spread
    found = [
        (curve, (per_step, max(low, made * per_step), min(high, (made + 1) * per_step - 1)))
        for curve in curves
        for per_step, low, high in _between(curve, *window)
    ]
    found = [(curve, places) for curve, places in found if places[1] <= places[2]]
    if found and len({id(curve) for curve, _ in found}) < len(curves):
        curve, (per_step, low, _) = min(found, key=lambda each: each[1][1])
        found = [(curve, (per_step, low, (made + 1) * per_step - 1))]
    yield from found


def _of_wide(
    family: Family, made: int, window: tuple[int, int], order: Order, *, last: bool
) -> Iterator[Family]:
    """A change at the next pulse, of curves that are too many to follow each; or none in time."""
    tick, late = window
    both = family.both
    options = [list(_places(curve, made, tick, late)) for curve in family.spread]
    if any(low <= made + 1 <= high for places in options for low, high in _pulses(places)):
        yield _composed(family, order, made + 1)
    if not last or (family.starts and any(curve.waits(tick) for curve in both)):
        return
    soon = any(ceil_tick(curve.rest_time) <= tick + late for curve in both)
    if not soon and all(options) and made < min(curve.count for curve in both):
        return
    if not order.speed or all(curve.reaches for curve in both):
        yield family
    elif not any(curve.reaches for curve in both):
        stands = [max(tick, ceil_tick(curve.rest_time)) for curve in both]
        ticks = (min(stands), max(stands) + 2 * late)
        yield rested(family, lambda old: started(old.rest, 0, order, old.blur), ticks)
    else:
        raise Unsure("a change when the axis may have reached its measure or not")


def _pulses(places: Sequence[Places]) -> Iterator[tuple[int, int]]:
    """From which pulse to which one some places lie; places between two are of the next one."""
    for per_step, low, high in places:
        yield -(-low // per_step), -(-high // per_step)


def _composed(family: Family, order: Order, number: int) -> Family:
    place = Fraction(number)
    if isinstance(family, Loose):
        shape, ticks = family.shape, (family.low, family.high)
        places = family.first, family.last
        return loose(lambda n: shape(n).changed(place, order), places, ticks, family.skip)
    make = family.make
    changed_there = replace(family, make=lambda i: make(i).changed(place, order), kept={})
    return replace(changed_there, base=None)


def _alike(options: Sequence[Option]) -> list[list[Option]]:
    """The options between the same pulses at the same speed together."""
    groups: dict[tuple[int, int, Fraction], list[Option]] = {}
    for made, curve, places in options:
        key = made, places[0], _at(curve, places).square2
        groups.setdefault(key, []).append((made, curve, places))
    return list(groups.values())


def _blindly(options: Sequence[Option], window: tuple[int, int], order: Order) -> Family:
    """A change at constant speed, when where the axis is then is known only about."""
    made, first, (per_step, *_) = options[0]
    square2 = _at(first, options[0][2]).square2
    ends = (min(places[1] for *_, places in options), max(places[2] for *_, places in options))
    tick, late = window
    late = max(late, SLOW_CHANGE) if square2 < 2 * SPEED_UNITS**2 else late
    blur = max(curve.blur for _, curve, _ in options)
    begins = [ceil_tick(_at(curve, places).time) for _, curve, places in options]
    since = [tick if begin <= tick + late else begin for begin in begins]
    return loose(
        lambda n: moving(Fraction(n, per_step), square2, 0, order, blur),
        ends,
        (min(since), max(since) + late),
        made,
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
    before = any(low < curve.rest * per_step for per_step, low, _ in options)
    if before and rests > tick + late and seen < curve.count:
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
    """Where a change may take effect, if the unit notices it at any time up to `late`.

    That is the next pulse from then on; at constant speed it is where the axis is then.
    """
    cruises = [
        (per_step, max(low, seen * per_step), high)
        for per_step, low, high in _between(curve, tick, late)
        if high >= seen * per_step
    ]
    yield from cruises
    first = seen + 1
    if first > curve.count or curve.rest_time <= tick << BITS:
        return
    end = tick + late << BITS
    last = max(seen, math.floor(curve.place_at(end)))
    made = curve.leg_at(last) if last > seen else None
    since = max(tick << BITS, made.time_at(last) if made else 0)
    ramps = any(leg.sign and leg.time < end and leg.end_time > since for leg in curve.legs)
    if last < curve.count and ramps:
        last += 1
    for per_step, low, high in cruises:
        before, after = -(-low // per_step) - 1, high // per_step + 1
        if first <= before:
            yield 1, first, min(last, before)
        first = max(first, after)
    if first <= last:
        yield 1, first, last


def _leg_during(curve: Curve, tick: int) -> Leg | None:
    """The leg at a tick; the first one, if none has begun."""
    begun = [leg for leg in curve.legs if leg.time <= tick << BITS]
    return begun[-1] if begun else next(iter(curve.legs), None)


def _between(curve: Curve, tick: int, late: int) -> Iterator[Places]:
    """Places where a change may take effect at constant speed.

    A change that waits for a pulse on a ramp does so no longer where the ramp ends before it.
    """
    for leg in curve.legs:
        if leg.sign:
            continue
        low = since = max(tick << BITS, leg.time)
        if leg.time <= tick + late << BITS:
            since = tick << BITS
        elif math.floor(leg.x0) > curve.place_at(tick << BITS):
            continue
        slow = leg.square2 < 2 * SPEED_UNITS**2
        high = min(since + ((max(SLOW_CHANGE, late) if slow else late) << BITS), leg.end_time)
        if low > high:
            continue
        per_step = GAIN * leg.accel
        first = math.ceil(leg.place_at(low) * per_step)
        last = math.floor(leg.place_at(high) * per_step)
        first = max(first, math.floor(leg.x0 * per_step) + 1)
        if first <= last:
            yield per_step, first, last


def _parting(curve: Curve, other: Curve) -> int:
    """When two curves part."""
    for a, b in zip(curve.legs, other.legs, strict=False):
        if a != b:
            return min(a.end_time, b.end_time) if a.time == b.time else max(a.time, b.time)
    return min(curve.rest_time, other.rest_time)
