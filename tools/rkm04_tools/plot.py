"""The picture of a simulation: speed and position of each motor, inputs and outputs below.

Made for a printed page: A4 across, nothing smaller than 8 points, and no meaning in colours. A line
has a few points for each column of pixels, so millions of pulses cost little to draw.
"""

from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rkm04_tools.curve import position_line, speed_line, thinned
from rkm04_tools.failure import Failure, finished_or_absent, writing_failed
from rkm04_tools.host import BUILD_VARIABLE
from rkm04_tools.record import Event, Record
from rkm04_tools.signals import Signal
from rkm04_tools.table import thousands

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FORMATS = {".svg": "svg", ".png": "png"}
PAGE_INCHES = (11.69, 8.27)
DOTS_PER_INCH = 150
SPEED_INCHES, POSITION_INCHES, SIGNAL_INCHES = 0.75, 0.55, 0.2
"""The least heights; what is left of the page goes to speeds and positions."""
LEFT_INCHES, RIGHT_INCHES, TOP_INCHES, BOTTOM_INCHES, GAP_INCHES = 1.7, 0.3, 0.5, 0.5, 0.1
LABEL_INCHES = 0.2

STYLE: Any = {
    "font.size": 9,
    "axes.labelsize": 9,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.unicode_minus": False,
    "grid.color": "0.85",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.1,
    "svg.hashsalt": "rkm04",
    "savefig.dpi": DOTS_PER_INCH,
}
SPEED_COLOUR, POSITION_COLOUR, SIGNAL_COLOUR = "#0b3d91", "#8a3b12", "#222222"
TICK_INCHES = 0.22
"""About the distance of the labels of a vertical axis."""
TICK_STEPS = [1, 2, 5, 10]
TICKS_MAX, TIME_TICKS = 9, 14
STOPS_SHOWN_MAX = 12


def require_format(path: Path) -> None:
    """Refuse a picture that cannot be drawn before anything is done."""
    if path.suffix.lower() not in FORMATS:
        raise Failure(f"{path}: a plot is .svg or .png; give it a name that ends so")


def draw(
    record: Record,
    title: str,
    signals: Sequence[Signal],
    path: Path,
    names: Mapping[int, str] | None = None,
) -> None:
    """Draw a simulation into a file; its name says the format. `names` are those of the motors."""
    save(path, lambda: _figure(record, title, signals, names or {}))


def save(path: Path, make_figure: Callable[[], Figure]) -> None:
    """Draw a figure into a file."""
    _prepare_library()
    import matplotlib

    kind = FORMATS[path.suffix.lower()]
    with matplotlib.rc_context(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        figure = make_figure()
        try:
            with finished_or_absent(path) as part:
                dateless = {"Date": None} if kind == "svg" else None
                figure.savefig(part, format=kind, metadata=dateless)
        except OSError as error:
            raise writing_failed(path, error) from None


def _prepare_library() -> None:
    """Keep the library's cache in the build folder, and keep it quiet."""
    if build := os.environ.get(BUILD_VARIABLE):
        os.environ.setdefault("MPLCONFIGDIR", str(Path(build) / "matplotlib"))
    logging.getLogger("matplotlib").setLevel(logging.ERROR)


def _figure(
    record: Record, title: str, signals: Sequence[Signal], names: Mapping[int, str]
) -> Figure:
    from matplotlib.figure import Figure

    motors = sorted(record.pulses)
    heights = [SPEED_INCHES, POSITION_INCHES] * len(motors)
    heights += [SIGNAL_INCHES * (len(signals) + 0.5)] if signals else []
    page = _stretch(heights, 2 * len(motors))
    figure = Figure(figsize=(PAGE_INCHES[0], page))
    panels = _panels(figure, heights or [1.0], page)
    for index, motor in enumerate(motors):
        name = names.get(motor, f"motor {motor}")
        _draw_speed(panels[2 * index], record, motor, name)
        _draw_position(panels[2 * index + 1], record, motor, name)
    if signals:
        _draw_signals(panels[-1], signals, record.seconds)
    if not motors:
        title += " (no motor moved)"
    _finish(figure, panels, title, record.seconds)
    return figure


def _stretch(heights: list[float], motor_panels: int) -> float:
    """Share out what is left of the page; return the height of the page, more where it must be."""
    used = TOP_INCHES + BOTTOM_INCHES + GAP_INCHES * (len(heights) - 1) + sum(heights)
    left = max(0.0, PAGE_INCHES[1] - used)
    least = sum(heights[:motor_panels])
    for panel in range(motor_panels):
        heights[panel] *= 1 + left / least
    return used + left


def _panels(figure: Figure, heights: Sequence[float], page: float) -> list[Axes]:
    """Make panels below each other that share the time axis."""
    grid = figure.add_gridspec(
        len(heights),
        1,
        height_ratios=heights,
        left=LEFT_INCHES / PAGE_INCHES[0],
        right=1 - RIGHT_INCHES / PAGE_INCHES[0],
        top=1 - TOP_INCHES / page,
        bottom=BOTTOM_INCHES / page,
        hspace=GAP_INCHES * len(heights) / sum(heights),
    )
    panels: list[Axes] = []
    for row in range(len(heights)):
        panels.append(figure.add_subplot(grid[row], sharex=panels[0] if panels else None))
    return panels


def _draw_speed(axes: Axes, record: Record, motor: int, name: str) -> None:
    moves = record.moves(motor)
    signs = record.signs(motor)
    time, speed = speed_line(record.pulses[motor], moves, record.tick_hz, signs)
    axes.axhline(0, color="0.5", linewidth=0.6)
    time, speed = thinned(time, speed, record.seconds)
    axes.plot([0, *time, record.seconds], [0, *speed, speed[-1]], color=SPEED_COLOUR)
    _label(axes, f"{name}\nspeed\n(steps/s)")
    stops = [e for e in record.events if e.motor in (0, motor) and e.name in ("stop", "error")]
    for event in stops[:STOPS_SHOWN_MAX]:
        _mark_stop(axes, event, record)


def _mark_stop(axes: Axes, event: Event, record: Record) -> None:
    """Mark when and why a motor was stopped; the words stand where there is room for them."""
    at = event.tick / record.tick_hz
    is_late = at > 0.8 * record.seconds
    axes.axvline(at, color="0.3", linewidth=0.8, linestyle=":")
    axes.annotate(
        f"error: {event.value}" if event.name == "error" else f"stop {event.value}",
        (at, 1),
        xycoords=("data", "axes fraction"),
        xytext=(-3 if is_late else 3, -10),
        textcoords="offset points",
        horizontalalignment="right" if is_late else "left",
        fontsize=8,
    )


def _draw_position(axes: Axes, record: Record, motor: int, name: str) -> None:
    first = record.first_position(motor)
    line = position_line(record.positions(motor), first, record.seconds, record.tick_hz)
    time, position = thinned(*line, record.seconds)
    axes.plot(time, position, color=POSITION_COLOUR, drawstyle="steps-post")
    _label(axes, f"{name}\nposition\n(steps)")


def _label(axes: Axes, text: str) -> None:
    """Write what the axis shows beside it, and whole numbers, as many as there is room for."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    axes.margins(y=0.12)
    width = PAGE_INCHES[0] - LEFT_INCHES - RIGHT_INCHES
    axes.set_ylabel(text, rotation=0, horizontalalignment="left", verticalalignment="center")
    axes.yaxis.set_label_coords((LABEL_INCHES - LEFT_INCHES) / width, 0.5)
    inches = axes.get_window_extent().height / axes.figure.dpi
    ticks = min(max(3, round(inches / TICK_INCHES)), TICKS_MAX)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=ticks, integer=True, steps=TICK_STEPS))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: thousands(round(value))))


def _draw_signals(axes: Axes, signals: Sequence[Signal], seconds: float) -> None:
    """Draw logic traces, the first one on top."""
    for row, signal in enumerate(reversed(signals)):
        time, level = signal.corners(seconds)
        height = [row + 0.65 * value for value in level]
        axes.fill_between(time, row, height, step="post", color="0.8", linewidth=0)
        axes.plot(time, height, color=SIGNAL_COLOUR, drawstyle="steps-post", linewidth=0.9)
    axes.set_ylim(-0.2, len(signals) - 0.1)
    axes.set_yticks([row + 0.33 for row in range(len(signals))], [s.name for s in signals][::-1])
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")


def _finish(figure: Figure, panels: Sequence[Axes], title: str, seconds: float) -> None:
    """Label the common time axis and the page."""
    from matplotlib.ticker import MaxNLocator

    for panel in panels[:-1]:
        panel.tick_params(axis="x", labelbottom=False)
    span = seconds or 1.0
    panels[-1].set_xlim(-0.005 * span, 1.005 * span)
    panels[-1].xaxis.set_major_locator(MaxNLocator(nbins=TIME_TICKS, steps=TICK_STEPS))
    panels[-1].set_xlabel("time (s)")
    shown = title.encode("utf-8", "replace").decode()
    figure.suptitle(shown, fontsize=11, y=1 - 0.15 / figure.get_figheight(), parse_math=False)
