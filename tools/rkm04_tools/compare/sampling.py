"""How finely a capture tells times: by its sample rate, as told or as seen in its times."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rkm04_tools.compare.recording import Floats, Recording
from rkm04_tools.failure import Failure

RATES_MHZ = (
    0.02, 0.025, 0.05, 0.1, 0.2, 0.25, 0.5, 1, 2, 2.5, 3, 3.125, 4, 5, 6, 6.25, 8, 10, 12, 12.5,
    16, 20, 24, 25, 32, 40, 48, 50, 62.5, 80, 96, 100, 125, 150, 160, 192, 200, 240, 250, 400, 500,
    800, 1000,
)  # fmt: skip
"""What analysers offer."""
EDGES_MIN, EDGES_MAX = 16, 200_000
"""So many edges on the same grid are no chance; more tell nothing more."""
GRID_PART_MAX = 0.3
"""How far from the grid a time may be written, in parts of it."""
TOLD_PART_MAX = 1e-3
"""A file may tell its rate rounded."""

TOLD, GIVEN, SEEN, DIGITS = "told", "given", "seen", "digits"
"""Where a resolution comes from: the file, an option, the times of its edges, their last digit."""


@dataclass(frozen=True)
class Resolution:
    """The time of a sample, its rate if there is one, and where that comes from."""

    seconds: float
    hz: float
    source: str


def resolution(recording: Recording, given_hz: float) -> Resolution:
    """The resolution of a recording: by the rate that the file tells, or else the user."""
    digit = recording.digit_seconds
    if given_hz and recording.sample_hz:
        _require_told(recording.sample_hz, given_hz)
    elif given_hz:
        _require_possible(recording, given_hz)
    for hz, source in ((recording.sample_hz, TOLD), (given_hz, GIVEN)):
        if hz:
            return Resolution(max(1 / hz, digit), hz, source)
    hz = _seen(recording, digit)
    return Resolution(1 / hz, hz, SEEN) if hz else Resolution(digit, 0.0, DIGITS)


def _require_told(told_hz: float, given_hz: float) -> None:
    if abs(given_hz - told_hz) > TOLD_PART_MAX * told_hz:
        raise Failure(
            f"--sample-rate {_shown(given_hz)}: the capture itself tells {_shown(told_hz)}; leave "
            "the option out"
        )


def _shown(hz: float) -> str:
    return f"{hz / 1e6:g} MHz" if hz >= 1e5 else f"{hz:g} Hz"


def _require_possible(recording: Recording, given_hz: float) -> None:
    """A rate that is too low would make any pulse near enough."""
    apart = [np.diff(trace.edges).min(initial=np.inf) for trace in recording.traces.values()]
    nearest = float(min(apart, default=np.inf))
    if nearest + recording.digit_seconds < (1 - GRID_PART_MAX) / given_hz:
        raise Failure(
            f"--sample-rate {given_hz:g} Hz: the capture has edges of a wire {nearest:.3g} s "
            "apart, nearer than two samples; write the rate at which it was recorded"
        )


def _seen(recording: Recording, digit: float) -> float:
    """The lowest usual rate on whose samples all edges are; 0 if there is none."""
    times = _some(trace.edges for trace in recording.traces.values())
    if len(times) < EDGES_MIN:
        return 0.0
    from_first = times - times[0]
    for megahertz in RATES_MHZ:
        period = 1e-6 / megahertz
        away = np.abs(from_first - np.rint(from_first / period) * period)
        if period > digit and away.max() <= min(1.01 * digit, GRID_PART_MAX * period):
            return 1e6 * megahertz
    return 0.0


def _some(edges: Iterable[Floats]) -> Floats:
    return np.unique(np.concatenate([*(each[:EDGES_MAX] for each in edges), np.empty(0)]))
