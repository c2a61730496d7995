"""What two crystals do between each other: a rate that changes, but never fast.

Where one rate and an offset do not explain a capture, the clock may bend. How much it has to says
whether crystals can have done it: a jump of the pulses needs a bend that none does, however long
the pause is that it hides in.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rkm04_tools.compare.clock import Clock, Line
from rkm04_tools.compare.recording import Floats, Ints

BEND_MAX = 0.1e-6
"""By how much the rate of two crystals may change in a second, as after power-on."""
BEND_USUAL = 0.05e-6
"""What a bend is weighed with against the deviations that it avoids."""
KNOT_SECONDS = 1.0
KNOTS_MAX = 100_000
NOISE_PART = 0.25
"""The deviation of a pulse that a bend is weighed with, in parts of what it may be off."""
PULSES_MAX = 4
"""More pulses in a stretch say no more: they may all fall alike between samples."""


def follow(x: Floats, y: Floats, overall: Line, noise: float) -> Clock:
    """One line if it explains all pairs, else the straightest clock near them.

    `x` and `y` are the times of good pairs, `noise` what one may be off.
    """
    if bool((np.abs(y - overall.capture(x)) <= noise).all()):
        return Clock([overall.x0], [overall])
    return _bent(x, y, overall, noise)


def _bent(x: Floats, y: Floats, overall: Line, noise: float) -> Clock:
    """A knot a second, straight between them."""
    span = float(x[-1] - x[0])
    count = min(max(int(np.ceil(span / KNOT_SECONDS)), 1), KNOTS_MAX)
    if count < 2:
        return Clock([float(x[0])], [overall])
    step = span / count
    at = np.clip(((x - x[0]) / step).astype(np.int64), 0, count - 1)
    part = (x - x[0]) / step - at
    weight = _weights(at, count) * (BEND_USUAL * step**2 / (NOISE_PART * noise)) ** 2
    away = _solve(*_equations(at, part, weight, y - overall.capture(x), count + 1))
    starts = x[0] + step * np.arange(count)
    ys = overall.y + overall.rate * (starts - overall.x0) + away[:-1]
    rates = overall.rate + np.diff(away) / step
    return Clock(starts.tolist(), list(map(Line, starts.tolist(), ys.tolist(), rates.tolist())))


def bend(clock: Clock) -> float:
    """By how much its rate changes in a second, at most."""
    if len(clock.lines) < 2:
        return 0.0
    rates = np.array([line.rate for line in clock.lines])
    return float(np.abs(np.diff(rates) / np.diff(clock.starts)).max())


def _weights(at: Ints, count: int) -> Floats:
    """Of each pair, so that no stretch has more than some."""
    held = np.bincount(at, minlength=count)
    weights: Floats = np.minimum(1.0, PULSES_MAX / np.maximum(held, 1))
    return weights[at]


def _equations(
    at: Ints, part: Floats, weight: Floats, wanted: Floats, knots: int
) -> tuple[Floats, Floats, Floats, Floats]:
    """Least squares of deviations and bends: three diagonals of a matrix, and its right side."""

    def summed(values: Floats, first: int) -> Floats:
        return np.bincount(at + first, weights=values, minlength=knots).astype(np.float64)

    main = summed(weight * (1 - part) ** 2, 0) + summed(weight * part**2, 1)
    near = summed(weight * part * (1 - part), 0)[: knots - 1]
    right = summed(weight * (1 - part) * wanted, 0) + summed(weight * part * wanted, 1)
    far = np.ones(knots - 2)
    main[:-2] += 1
    main[1:-1] += 4
    main[2:] += 1
    near[:-1] -= 2
    near[1:] -= 2
    return main, near, far, right


def _solve(main: Floats, near: Floats, far: Floats, right: Floats) -> Floats:
    """Solve for a symmetric matrix of five diagonals, by its factors L D L'."""
    count = len(main)
    d, e, f = [0.0] * count, [0.0] * count, [0.0] * count
    z: list[float] = [0.0] * count
    beside, beyond = [*near.tolist(), 0.0], [*far.tolist(), 0.0, 0.0]
    for i, (diagonal, value) in enumerate(zip(main.tolist(), right.tolist(), strict=True)):
        # Of the first rows, the elements before them are the zeros at the end of the lists.
        before = d[i - 1] * e[i - 1]
        d[i] = diagonal - before * e[i - 1] - d[i - 2] * f[i - 2] ** 2
        e[i] = (beside[i] - before * f[i - 1]) / d[i]
        f[i] = beyond[i] / d[i]
        z[i] = value - e[i - 1] * z[i - 1] - f[i - 2] * z[i - 2]
    return _backward(d, e, f, z)


def _backward(
    d: Sequence[float], e: Sequence[float], f: Sequence[float], z: Sequence[float]
) -> Floats:
    """From the last row up."""
    found = [0.0] * (len(d) + 2)
    for i in reversed(range(len(d))):
        found[i] = z[i] / d[i] - e[i] * found[i + 1] - f[i] * found[i + 2]
    return np.array(found[:-2])
