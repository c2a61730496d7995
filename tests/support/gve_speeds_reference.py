"""What V, B, $, VK, VL, VJ and X mean for vectors, in exact numbers.

Written from the formulas of the unit's contract, not from the firmware: fractions and whole roots.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, isqrt

from exact import Fraction

TOP = 200_000
UNITS = 256
"""Of a pulse/s."""
FACTOR_ONE = 100 * 65_536
VECTOR_US_MIN = 500


@dataclass(frozen=True)
class Vector:
    """What is queued of a vector."""

    steps: tuple[int, int, int, int]
    speed: int = 1000
    brake: int = TOP
    short: int = 512
    corrected: bool = False

    @property
    def longest(self) -> int:
        """L."""
        return max(map(abs, self.steps))

    @property
    def extent2(self) -> int:
        """E squared."""
        way = sum(d * d for d in self.steps[:3]) if self.corrected else 0
        return way or self.longest**2

    @property
    def raised(self) -> int:
        """N: E * 2^16, rounded up."""
        square = self.extent2 << 32
        return isqrt(square - 1) + 1


def nearest_root(square: Fraction) -> int:
    """Return floor(root + 1/2)."""
    return (isqrt(floor(4 * square)) + 1) // 2


def limit(vector: Vector, factor: int = FACTOR_ONE, limits: Sequence[int] = (TOP,) * 4) -> int:
    """Return U, in 1/256 pulse/s of the longest axis."""
    wanted = max(1, floor(Fraction(UNITS * vector.speed * factor, FACTOR_ONE) + Fraction(1, 2)))
    if vector.longest < vector.short:
        wanted = min(wanted, UNITS * vector.brake)
    bounds = [
        nearest_root(Fraction((wanted * vector.longest) ** 2, vector.extent2)),
        UNITS * TOP,
        UNITS * vector.longest * 10**6 // VECTOR_US_MIN,
    ]
    bounds += [
        UNITS * most * vector.longest // abs(steps)
        for steps, most in zip(vector.steps, limits, strict=True)
        if steps
    ]
    return max(1, min(bounds))


def border(before: Vector, after: Vector, jumps: Sequence[int]) -> int:
    """Return the highest speed at the border, in 1/256 pulse/s in terms of V."""
    most = UNITS * before.brake
    for d, dash, jump in zip(before.steps, after.steps, jumps, strict=True):
        change = abs(dash * before.raised - d * after.raised)
        if jump and change:
            most = min(most, UNITS * jump * before.raised * after.raised // (change << 16))
    return most


def changed(factor: int, sixteenths: int) -> int:
    """Return the factor after XU (17) or XD (15)."""
    wanted = floor(Fraction(factor * sixteenths, 16) + Fraction(1, 2))
    return min(max(wanted, FACTOR_ONE // 100), FACTOR_ONE * 10)
