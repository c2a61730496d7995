"""Two clocks: when something of the simulation's time is seen in a capture.

A line is an offset and a rate. A clock is lines one after the other, since no crystal keeps its
rate to a sample over many seconds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rkm04_tools.compare.recording import Floats

RATE_MAX = 400e-6
"""Two cheap crystals differ by 200 ppm at most; twice as much for those that are worse."""
ROUNDS = 12
WIDTHS_OF_MEDIAN = 4.5
"""About three standard deviations, as a multiple of the median deviation."""


@dataclass(frozen=True)
class Line:
    """At `x` of the simulation the capture is at `x + y + rate * (x - x0)`; all in seconds."""

    x0: float
    y: float
    rate: float

    def capture(self, x: Floats) -> Floats:
        """The times in the capture."""
        return x + (self.y + self.rate * (x - self.x0))


@dataclass(frozen=True)
class Clock:
    """Lines, each from its start on; the first one also before it."""

    starts: Sequence[float]
    lines: Sequence[Line]

    def capture(self, x: Floats) -> Floats:
        """The times in the capture."""
        if len(self.lines) == 1:
            return self.lines[0].capture(x)
        at = np.clip(np.searchsorted(self.starts, x, side="right") - 1, 0, len(self.lines) - 1)
        x0, y, rate = np.array([(line.x0, line.y, line.rate) for line in self.lines]).T
        seen: Floats = x + (y[at] + rate[at] * (x - x0[at]))
        return seen


def fit(x: Floats, captured: Floats, resolution: float, rate_max: float) -> Line:
    """The line through most of the pairs; what is far from it does not count.

    With `rate_max` 0 it has an offset only.
    """
    difference = captured - x
    kept = np.ones(len(x), dtype=bool)
    line = Line(0.0, 0.0, 0.0)
    for _ in range(ROUNDS):
        line = _least_squares(x[kept], difference[kept], resolution, rate_max)
        away = np.abs(captured - line.capture(x))
        width = max(resolution, WIDTHS_OF_MEDIAN * float(np.median(away)))
        now = away <= width
        if (now == kept).all():
            break
        kept = now
    return line


def _least_squares(x: Floats, difference: Floats, resolution: float, rate_max: float) -> Line:
    x0 = float(x.mean())
    if rate_max == 0:
        # The mean is drawn away by outliers that the first round cannot tell yet.
        middle = float(np.median(difference))
        near = np.abs(difference - middle) <= 2 * resolution
        return Line(x0, float(difference[near].mean()) if near.any() else middle, 0.0)
    y = float(difference.mean())
    from_middle = x - x0
    square = float((from_middle**2).sum())
    rate = float((from_middle * (difference - y)).sum()) / square if square > 0 else 0.0
    return Line(x0, y, float(np.clip(rate, -rate_max, rate_max)))
