"""Vectors of the GVE134 unit as they were entered, and the limits that follow for their path.

Written from the contract alone (`gve134.md`, section 5); all of it is whole numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from exact import Fraction
from path_reference import ACCEL_UNITS, SPEED_UNITS, Vector

SPEED_MAX = 200_000
VECTOR_US_MIN = 500
ACCEL_PER_A = 1000
PERCENT = 65_536
"""Units of the factor f in 1 %."""

FACTOR_MIN, FACTOR_MAX = PERCENT, 1000 * PERCENT
Four = tuple[int, int, int, int]


@dataclass(frozen=True)
class Entry:
    """A vector with what was in force when it was entered."""

    steps: Four
    speed: int
    accel: int
    border: int
    short_below: int
    corrected: bool
    limits: Four | None
    jumps: Four
    pause_ms: int
    factor: int
    """f, as it was at the last X command that was meant for it."""
    own_speed: int = 0
    """Of a reference run: what it goes at, whatever V, f, VK and B are."""

    @property
    def length(self) -> int:
        """L."""
        return max(map(abs, self.steps))

    @property
    def extent2(self) -> int:
        """E²."""
        root = sum(d * d for d in self.steps[:3])
        return root if self.corrected and root else self.length**2

    @property
    def scaled_extent(self) -> int:
        """N, 2^16·E rounded up."""
        square = self.extent2 << 32
        root = math.isqrt(square)
        return root + (root * root < square)

    def speed_limit(self) -> int:
        """U."""
        length = self.length
        limits = [
            SPEED_UNITS * SPEED_MAX,
            SPEED_UNITS * length * 10**6 // VECTOR_US_MIN,
            *(
                SPEED_UNITS * limit * length // abs(d)
                for limit, d in zip(self.limits or (), self.steps, strict=bool(self.limits))
                if d != 0
            ),
        ]
        if self.own_speed:
            return max(1, min(SPEED_UNITS * self.own_speed, *limits))
        exact = Fraction(SPEED_UNITS * self.speed * self.factor, 100 * PERCENT)
        wanted = max(1, math.floor(exact + HALF))
        if length < self.short_below:
            wanted = min(wanted, SPEED_UNITS * self.border)
        twice = math.isqrt(4 * wanted**2 * length**2 // self.extent2)
        return max(1, min((twice + 1) // 2, *limits))


HALF = Fraction(1, 2)


def jump_cap(before: Entry, after: Entry) -> int | None:
    """The speed at a border, in 1/256 pulse/s, that VJ allows; None: any."""
    n, m = before.scaled_extent, after.scaled_extent
    caps = []
    for d, e, jump in zip(before.steps, after.steps, after.jumps, strict=True):
        change = abs(e * n - d * m)
        if jump > 0 and change != 0:
            caps.append(SPEED_UNITS * jump * n * m // (change << 16))
    return min(caps, default=None)


def limited(entry: Entry, before: Entry | None) -> Vector:
    """Return a vector of a path; its border is the one to the vector before it."""
    border = SPEED_UNITS * (before or entry).border
    cap = jump_cap(before, entry) if before else None
    return Vector(
        entry.steps,
        entry.speed_limit(),
        entry.accel * ACCEL_PER_A * ACCEL_UNITS,
        border if cap is None else min(border, cap),
        entry.extent2,
    )


def path_of(entries: Sequence[Entry]) -> tuple[Vector, ...]:
    """Return the vectors of a chain."""
    before = [None, *entries][: len(entries)]
    return tuple(limited(a, b) for a, b in zip(entries, before, strict=True))


def scaled(factor: int, sixteenths: int) -> int:
    """Return f after XU (17) or XD (15)."""
    return max(FACTOR_MIN, min(FACTOR_MAX, (factor * sixteenths * 2 + 16) // 32))


def with_speed(entry: Entry, speed: int | None, factor: int, limits: Four | None) -> Entry:
    """Return a vector after an X command."""
    speed = entry.speed if speed is None else speed
    return replace(entry, speed=speed, factor=factor, limits=limits)
