"""The path of a simulation in X and Y, drawn to scale and coloured by the speed along it.

Between two pulses of an axis its place is taken to change evenly, so the line has no stairs. A path
of millions of pulses is thinned to so many places that no line of the picture can show more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rkm04_tools.plot import PAGE_INCHES, TICK_STEPS, save
from rkm04_tools.record import Floats, Ints, Move, Pulses, Record
from rkm04_tools.table import thousands

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

X, Y = 1, 2
PLACES_MAX = 20_000
"""Of the whole path."""
LEVELS = 64
"""Of speed, that are told apart by colours."""
PIXELS = 1600
"""Across the picture; what is straight within a part of one is one line."""
COLOURS, PALEST = "viridis_r", 0.12
"""The palest of them is left out: it cannot be seen on paper."""
LINE_WIDTH, MARK_SIZE, TICKS = 1.2, 8, 9


@dataclass(frozen=True)
class Path2:
    """Places in X and Y, one after the other, and the speed on the way to each from the one before.

    There is no line to a place whose speed is NaN: a move begins there.
    """

    x: Floats
    y: Floats
    speed: Floats


@dataclass(frozen=True)
class Units:
    """What the numbers of a path are."""

    place: str
    speed: str
    is_whole: bool


PULSES = Units("pulses", "pulses/s", True)


def path_of(record: Record) -> Path2:
    """The path of all moves."""
    moves = record.moves(X)
    pulses = {axis: record.pulses.get(axis) for axis in (X, Y)}
    parts = [_part(record, move, pulses, _places(moves, pulses)) for move in moves]
    if not parts:
        return Path2(np.zeros(0), np.zeros(0), np.zeros(0))
    x, y, speed = (np.concatenate(each) for each in zip(*parts, strict=True))
    return Path2(x, y, speed)


def _places(moves: Sequence[Move], pulses: dict[int, Pulses | None]) -> int:
    """Every so many-th pulse becomes a place."""
    total = sum(len(each.tick) for each in pulses.values() if each) + 2 * len(moves)
    return max(1, -(-total // PLACES_MAX))


def _part(
    record: Record, move: Move, pulses: dict[int, Pulses | None], every: int
) -> tuple[Floats, Floats, Floats]:
    """The places of one move, and the speeds."""
    corners = {axis: _corners(record, axis, move) for axis in (X, Y)}
    ticks = np.union1d(corners[X][0], corners[Y][0])
    ticks = np.unique(np.append(ticks[::every], ticks[-1]))
    x, y = (np.interp(ticks, *corners[axis]) for axis in (X, Y))
    seconds = np.maximum(np.diff(ticks), 1) / record.tick_hz
    speed = np.hypot(np.diff(x), np.diff(y)) / seconds
    return x, y, np.concatenate(([np.nan], speed))


def _corners(record: Record, axis: int, move: Move) -> tuple[Ints, Ints]:
    """Ticks and positions of an axis in a move: its begin, every pulse, its end."""
    pulses = record.pulses.get(axis, Pulses(np.zeros(0, np.int64), np.zeros(0, np.int64)))
    first, end = np.searchsorted(pulses.tick, [move.start + 1, move.end + 1])
    ticks, positions = pulses.tick[first:end], pulses.position[first:end]
    before = _position_before(record, axis, move.start, pulses, int(first))
    ticks = np.concatenate(([move.start], ticks, [move.end]))
    return ticks, np.concatenate(([before], positions, [*positions[-1:], before][:1]))


def _position_before(record: Record, axis: int, tick: int, pulses: Pulses, first: int) -> int:
    """Where an axis stands at a tick: as its last pulse says, or a command after that."""
    last, position = (pulses.tick[first - 1], pulses.position[first - 1]) if first else (0, 0)
    written = [
        int(event.value)
        for event in record.events
        if event.name == "position" and event.motor == axis and last <= event.tick <= tick
    ]
    return written[-1] if written else int(position)


def draw_path(record: Record, title: str, file: Path) -> None:
    """Draw the path of a simulation; the file's name says the format."""
    draw(path_of(record), title, file)


def draw(path: Path2, title: str, file: Path, units: Units = PULSES) -> None:
    """Draw a path; the file's name says the format."""
    save(file, lambda: _figure(path, title, units))


def _figure(path: Path2, title: str, units: Units) -> Figure:
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=PAGE_INCHES, layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(f"X ({units.place})")
    axes.set_ylabel(f"Y ({units.place})")
    if len(path.x) and np.nanmax(path.speed) > 0:
        _draw(figure, axes, path, units)
    else:
        title += " (nothing moved in X and Y)"
    for axis in (axes.xaxis, axes.yaxis):
        if units.is_whole:
            axis.set_major_formatter(lambda value, _: thousands(round(value)))
        axis.set_major_locator(MaxNLocator(nbins=TICKS, integer=units.is_whole, steps=TICK_STEPS))
    shown = title.encode("utf-8", "replace").decode()
    figure.suptitle(shown, fontsize=11, parse_math=False)
    return figure


def _draw(figure: Figure, axes: Axes, path: Path2, units: Units) -> None:
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection
    from matplotlib.colors import ListedColormap

    colours = ListedColormap(colormaps[COLOURS](np.linspace(PALEST, 1, 256)))
    fastest = float(np.nanmax(path.speed))
    lines, speeds = _lines(path, fastest)
    drawn = LineCollection(lines, cmap=colours, linewidths=LINE_WIDTH, capstyle="round")
    drawn.set_array(np.array(speeds))
    drawn.set_clim(0, fastest)
    axes.add_collection(drawn)
    axes.autoscale_view()
    axes.margins(0.05)
    for at, marker, name in ((0, "o", "start"), (-1, "s", "end")):
        axes.plot(path.x[at], path.y[at], marker, color="black", markersize=MARK_SIZE,
                  markerfacecolor="none", label=name)  # fmt: skip
    axes.legend(loc="upper right", frameon=False, numpoints=1)
    bar = figure.colorbar(
        drawn, ax=axes, shrink=0.8, format=lambda value, _: thousands(round(value))
    )
    bar.set_label(f"speed along the path ({units.speed})")


def _lines(path: Path2, fastest: float) -> tuple[list[Floats], list[float]]:
    """Lines of one colour each, without what is straight in them, and their speeds."""
    level = np.ceil(np.nan_to_num(path.speed, nan=-1.0) / fastest * LEVELS)
    level[np.isnan(path.speed)] = -1
    ends = np.flatnonzero(np.diff(level, append=-2.0))
    places = np.column_stack((path.x, path.y))
    lines, speeds, begin = [], [], 0
    for end in ends:
        if level[end] >= 0:
            lines.append(_straightened(places[max(0, begin - 1) : end + 1], np.ptp(places)))
            speeds.append(float(level[end]) * fastest / LEVELS)
        begin = int(end) + 1
    return lines, speeds


def _straightened(places: Floats, size: float) -> Floats:
    """Leave places out where the line is straight without them."""
    from matplotlib.path import Path as Line

    if len(places) < 3:
        return places
    scale = PIXELS / max(size, 1.0)
    cleaned = Line(places * scale).cleaned(simplify=True)
    corners = np.asarray(cleaned.vertices)[np.asarray(cleaned.codes) != Line.STOP]
    return np.asarray(corners / scale, dtype=np.float64)
