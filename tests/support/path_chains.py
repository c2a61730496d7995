"""Random chains of vectors with changes, and the corner cases of paths.

Every order of size of steps, speeds and accelerations is as likely as any other, and neighbours
differ as much as they can.
"""

from __future__ import annotations

import math
import random

from path_probe import ADD, JOIN, NEVER, SPEED, STOP, Case, Change
from path_reference import ACCEL_UNITS, AXES, SPEED_UNITS, Vector
from reference import TICK_HZ

SPEED_MAX = 1_000_000
ACCEL_MAX = 8_000_000
STEPS_MAX = 2**31 - 1
VECTORS_MAX = 128
VECTOR_US_MIN = 500


def vector(steps: tuple[int, int, int, int], speed: float, accel: float, **rest: int) -> Vector:
    """Return a vector, its limits in steps/s and steps/s²."""
    return Vector(steps, max(1, round(speed * SPEED_UNITS)), round(accel * ACCEL_UNITS), **rest)


def any_size(rng: random.Random, most: int, least: int = 1) -> int:
    """Draw a number of any order of size."""
    return max(least, min(most, round(math.exp(math.log(most) * rng.random()))))


def any_steps(rng: random.Random, most: int) -> tuple[int, int, int, int]:
    """Draw the steps of the axes: some rest, some have the same, one more or one less."""
    longest = any_size(rng, most)
    steps = [
        rng.choice((1, -1))
        * rng.choice((0, longest, max(1, longest - 1), *(any_size(rng, longest) for _ in range(3))))
        for _ in range(AXES)
    ]
    if not any(steps):
        steps[rng.randrange(AXES)] = longest
    return (steps[0], steps[1], steps[2], steps[3])


def any_vector(rng: random.Random, most_steps: int) -> Vector:
    """Draw a vector; it passes no faster than the contract lets it."""
    steps = any_steps(rng, most_steps)
    length = max(map(abs, steps))
    top = SPEED_MAX * SPEED_UNITS
    speed = rng.choice(
        (
            rng.randint(10 * SPEED_UNITS, top),
            any_size(rng, top, 10 * SPEED_UNITS),
            any_size(rng, top),
        )
    )
    accel = rng.choice((any_size(rng, ACCEL_MAX // 1000) * 1000, any_size(rng, ACCEL_MAX, 1000)))
    border = rng.choice(
        (2**32 - 1, any_size(rng, SPEED_MAX, 10) * SPEED_UNITS, rng.choice((0, 1, 5, 100)))
    )
    extent2 = sum(d * d for d in steps[:3]) if rng.random() < 0.4 else 0
    fastest = SPEED_UNITS * length * 10**6 // VECTOR_US_MIN
    return Vector(steps, min(speed, fastest), accel * ACCEL_UNITS, border, extent2)


def any_change(rng: random.Random, tick: int) -> Change:
    """Draw what happens at a tick."""
    kind = rng.choice((STOP, SPEED, ADD, JOIN))
    patience = rng.choice((NEVER, 84_000, 0))
    if kind == STOP:
        accel = rng.choice((0, 0, any_size(rng, ACCEL_MAX * ACCEL_UNITS)))
        return Change(kind, tick, rng.choice((0, 1, any_size(rng, 10**7))), patience, accel)
    if kind == SPEED:
        return Change(kind, tick, any_size(rng, SPEED_MAX * SPEED_UNITS), patience)
    return Change(kind, tick, rng.randint(1, 5), patience)


def duration(vectors: tuple[Vector, ...]) -> int:
    """Return about how many ticks vectors take."""
    seconds = sum(
        v.length * SPEED_UNITS / v.speed + (v.speed / SPEED_UNITS) / (v.accel / ACCEL_UNITS)
        for v in vectors
    )
    return math.ceil(seconds * TICK_HZ)


def any_chain(
    rng: random.Random, steps: int = 1500, changes: int = 6, start_speed: int = 0
) -> Case:
    """Draw a chain with about so many steps on its longest axes, and up to so many changes."""
    count = any_size(rng, VECTORS_MAX)
    vectors = tuple(any_vector(rng, max(1, 2 * steps // count)) for _ in range(count))
    ticks = duration(vectors)
    moments = sorted(int(ticks * rng.random() ** 2) for _ in range(rng.randint(0, changes)))
    return Case(
        vectors,
        rng.choice((0, 0, rng.randint(1, count))),
        tuple(any_change(rng, tick) for tick in moments),
        rng.getrandbits(61),
        rng.choice((12, 12, 1, 100, 500)),
        start_speed=start_speed,
    )


def corners() -> list[Case]:
    """The cases in which a planner of paths is most likely to go wrong."""
    far, near, slow = (9999, 10_000, 7, 5003), (999, 1000, 501, 333), 1 / ACCEL_UNITS
    return [
        *(Case((vector(far, 10, a),)) for a in (1000, ACCEL_MAX, 1, slow)),
        *(Case((vector(near, v, ACCEL_MAX),)) for v in (10, 1000, SPEED_MAX, 1 / SPEED_UNITS)),
        Case((vector((2, 1, 0, 0), slow, slow), vector((0, 0, 1, -1), slow, slow))),
        Case((vector((1, 1, 1, 1), SPEED_MAX, ACCEL_MAX),) * VECTORS_MAX),
        Case(
            (
                vector((1, -1, 0, 1), SPEED_MAX, ACCEL_MAX),
                vector((-1, 1, 1, 1), SPEED_MAX, ACCEL_MAX),
            )
            * 64
        ),
        *(
            Case((vector((3, 20, -20, 19), 10_000, 1e6, border=b, extent2=e),) * VECTORS_MAX)
            for b, e in ((0, 0), (1, 0), (5, 809), (76_800, 809))
        ),
    ]


def long_corners() -> list[Case]:
    """Vectors of millions of steps, and hours of motion with the longest there is.

    Some pulses are compared, those at the ends of segments among them, where roundings show most.
    """
    steep, longest = (1, 16_000_000, 3, 7), (STEPS_MAX, STEPS_MAX - 1, 12_345, 1)
    limits = ((SPEED_MAX, ACCEL_MAX), (10_000, 1e6), (500_000, 1e5))
    return [
        *(Case((vector(steep, v, a),), stride=9973) for v, a in limits),
        *(Case((vector(longest, v, a),), stride=1_000_003) for v, a in limits),
        Case((vector(steep, SPEED_MAX, 1000),), stride=9973),
        Case((vector(steep, 16_000, 1),), stride=9973),
        Case((vector(longest, SPEED_MAX, 1000),), stride=1_000_003),
    ]
