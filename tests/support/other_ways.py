"""Other ways to find what the exact reference finds, for its tests; no code is shared with it.

They are the interval formula t' - t = 2/(v + v') in decimals, and a walk through time in small
steps, which knows only "brake when you must, else make for the top speed". Besides, the samples
and random moves that the tests compare on.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from decimal import Decimal, localcontext

import pytest
from exact import Fraction
from reference import TICK_HZ, Curve, Leg, Position, Section


def decimal_tick(legs: tuple[Leg, ...], k: int) -> Decimal:
    """Tick of position k by way over mean speed, leg by leg, with 60 digits."""

    def exact(x: Fraction) -> Decimal:
        return Decimal(x.numerator) / Decimal(x.denominator)

    seconds = Decimal(0)
    for leg in legs:
        end = min(leg.x1, Fraction(k))
        if end > leg.x0:
            v0, v1 = exact(leg.w0).sqrt(), exact(leg.speed_squared(end)).sqrt()
            seconds += 2 * exact(end - leg.x0) / (v0 + v1)
    return seconds * TICK_HZ


def assert_decimal_agrees(curve: Curve, pulses: list[int]) -> None:
    """Compare the reference with 60-digit decimals."""
    with localcontext() as context:
        context.prec = 60
        for k in pulses:
            tick = curve.tick(k)
            decimal = Decimal(tick.numerator) / Decimal(tick.denominator)
            difference = decimal - decimal_tick(curve.legs, k)
            assert abs(difference) < Decimal(2) ** -60, k


def corners_of(curve: Curve) -> Sequence[tuple[Position, float]]:
    """Return the corners of a curve, comparable with whole and broken positions."""
    return curve.corners()


def sample(last: int) -> list[int]:
    """Pulses at both ends, in the middle and spread between."""
    near = [*range(1, 20), *range(last // 2 - 9, last // 2 + 9)]
    far = [*range(last - 19, last + 1), *range(1, last, max(1, last // 50))]
    return sorted({k for k in near + far if 1 <= k <= last})


def random_sections(rng: random.Random, most: int = 6) -> list[Section]:
    """Make sections in which every kind of border is common."""
    return [
        Section(
            rng.choice([1, 2, 7, rng.randint(1, 60), rng.randint(1, 2000)]),
            rng.choice([1, 20, 100, rng.randint(1, 300), rng.randint(1, 4000)]),
            rng.choice([1, 60_000, rng.randint(1, 500), rng.randint(1, 20_000)]),
        )
        for _ in range(rng.randint(1, most))
    ]


def must_brake_from(
    sections: list[Section], start_speed: int, parts: int
) -> Callable[[float], float]:
    """Greatest w at each position from which the rest can be braked, on a grid.

    The grid has `parts` points to a step; between its points w is linear.
    """
    cells = [s for s in sections for _ in range(s.steps * parts)]
    limit = [float(min(start_speed, sections[-1].speed) ** 2)]
    for section in reversed(cells):
        reach = limit[-1] + 2 * section.accel / parts
        limit.append(min(reach, section.speed**2))
    limit.reverse()

    def at(x: float) -> float:
        cell = min(int(x * parts), len(limit) - 2)
        share = x * parts - cell
        return limit[cell] + share * (limit[cell + 1] - limit[cell])

    return at


def faster_or_slower(
    v: float, x: float, section: Section, dt: float, limit: Callable[[float], float]
) -> float:
    """Speed after dt: towards the top speed, but not above what can be braked.

    Braking along `limit` may be a hundredth harder, to stay on it.
    """
    change, top = section.accel * dt, section.speed
    wanted = min(v + change, top) if v <= top else max(v - change, top)
    brakeable = math.sqrt(limit(x + (v + wanted) / 2 * dt))
    hardest = v - (1.0 if v > top else 1.01) * change
    return max(min(wanted, brakeable), hardest, 1e-3)


def walk(
    sections: list[Section],
    start_speed: int,
    dt: float,
    state: tuple[float, float] | None = None,
) -> list[float]:
    """Seconds of the pulses, by a walk through time in steps of dt.

    `state` is position and speed to set out from; without it the move begins at 0
    with its start speed.
    """
    limit = must_brake_from(sections, start_speed, parts=4)
    cells = [s for s in sections for _ in range(s.steps)]
    x, v = state or (0.0, float(min(start_speed, sections[0].speed)))
    times: list[float] = []
    t, k = 0.0, int(x)
    while k < len(cells):
        faster = faster_or_slower(v, x, cells[k], dt, limit)
        way = (v + faster) / 2 * dt
        if x + way >= k + 1:
            times.append(t + dt * (k + 1 - x) / way)
            k += 1
        x, v, t = x + way, faster, t + dt
    return times


def assert_walk_agrees(curve: Curve, walked: list[float], first: int = 1) -> None:
    """Pulses from `first` on must agree with a walk to a few parts in 10 000."""
    origin = curve.tick(first - 1)
    assert curve.last == first - 1 + len(walked)
    for k, seconds in enumerate(walked, start=first):
        ideal = float(curve.tick(k) - origin) / TICK_HZ
        assert seconds == pytest.approx(ideal, rel=2e-3, abs=1e-4), k
