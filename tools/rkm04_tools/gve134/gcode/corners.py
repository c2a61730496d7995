"""How fast a corner may be passed: the speed at which its turn fits beside it.

The rule is that of grbl's $11: an arc that touches both sides and comes as near to the corner as
the deviation says is gone along with the acceleration that the axes have towards its centre. The
path keeps its corner; the arc is only the measure. A flat corner is passed faster than a sharp one.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, sqrt

from rkm04_tools.gve134.gcode.axes import PULSES_LEAST, PULSES_TOP, Mill

Steps = tuple[int, int, int, int]
STRAIGHT = 1e-6
"""A cosine so near to 1: the path goes on as it was, or back."""


@dataclass(frozen=True, slots=True)
class Side:
    """A vector as one side of a corner: its direction, and what V counts of it for each mm."""

    x: float
    y: float
    z: float
    per_mm: float


class Corners:
    """The speeds of a machine's corners of X, Y and Z."""

    def __init__(self, mill: Mill) -> None:
        self._deviation = mill.corner_deviation
        axes = mill.axes[:3]
        self._per_mm = [float(axis.steps_per_unit) if axis else 1.0 for axis in axes]
        self._accels = [
            axis.accel / per_mm if axis else inf
            for axis, per_mm in zip(axes, self._per_mm, strict=True)
        ]

    def side(self, steps: Steps, corrected: bool) -> Side | None:
        """A vector of VK or VN; None: X, Y and Z rest."""
        ways = [each / per_mm for each, per_mm in zip(steps, self._per_mm, strict=False)]
        length = hypot(*ways)
        if not length:
            return None
        x, y, z, _ = steps
        counted = sqrt(x * x + y * y + z * z) if corrected else max(map(abs, steps))
        x_part, y_part, z_part = (way / length for way in ways)
        return Side(x_part, y_part, z_part, counted / length)

    def speed(self, before: Side | None, after: Side | None) -> int:
        """As B has it; the unit's top where A alone moves on a side: VJ is all there is then."""
        if before is None or after is None:
            return PULSES_TOP
        cosine = before.x * after.x + before.y * after.y + before.z * after.z
        if cosine > 1 - STRAIGHT:
            return PULSES_TOP
        if cosine < STRAIGHT - 1:
            return PULSES_LEAST
        turn = (after.x - before.x, after.y - before.y, after.z - before.z)
        size = hypot(*turn)
        accel = min(
            accel * size / abs(part) for accel, part in zip(self._accels, turn, strict=True) if part
        )
        half = sqrt((1 + cosine) / 2)
        speed = sqrt(accel * self._deviation * half / (1 - half))
        return max(PULSES_LEAST, min(PULSES_TOP, int(speed * min(before.per_mm, after.per_mm))))
