"""What a page may have done with a unit, besides stopping."""

from __future__ import annotations

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.positioning import settings
from rkm04_tools.positioning.client import axis_text
from rkm04_tools.positioning.service.connection import Connection
from rkm04_tools.positioning.service.orders import (
    ALL_AXES,
    Capture,
    Control,
    Home,
    Measure,
    Release,
    Take,
    Write,
)  # fmt: skip
from rkm04_tools.positioning.settings import UNIT_PART, part_of
from rkm04_tools.positioning.state import FEED_PER_MM_MIN, UM_PER_MM, AxisState, error_text
from rkm04_tools.positioning.table import AXES
from rkm04_tools.positioning.unit import Axis, Unit
from rkm04_tools.service.unit_orders import Plain

HERE = 37
"""The method that sets the position of where the axis is."""
OfAxis = Take | Release | Capture | Control | Measure | Home


def act(line: Connection, unit: Unit, order: OfAxis) -> str:
    """Do what is for one axis."""
    line.looks.touch(order.axis)
    state = _act(unit.axis(order.axis), order)
    line.looks.touch(order.axis)
    return axis_text(state)


def _act(axis: Axis, order: OfAxis) -> AxisState:
    if isinstance(order, Take):
        return axis.init()
    if isinstance(order, Release):
        return axis.reset()
    if isinstance(order, Capture):
        return axis.capture()
    if isinstance(order, Control):
        feed = None if order.feed is None else order.feed / FEED_PER_MM_MIN
        return axis.control(feed, order.permitted)
    if isinstance(order, Measure):
        return _measure(axis, order)
    return _home(axis, order)


def _measure(axis: Axis, order: Measure) -> AxisState:
    give = axis.mode_abs if order.absolute else axis.mode
    if order.feed is None:
        return give(order.um / UM_PER_MM, order.accel)
    _be_taken(axis)
    give(order.um / UM_PER_MM, order.accel)
    return axis.control(order.feed / FEED_PER_MM_MIN, permitted=True)


def _home(axis: Axis, order: Home) -> AxisState:
    _be_taken(axis)
    axis.prepare_home(order.method, order.um / UM_PER_MM, order.accel)
    if order.method == HERE:
        return axis.read()
    return axis.control(order.feed / FEED_PER_MM_MIN, permitted=True)


def _be_taken(axis: Axis) -> None:
    """Take an axis that nobody has; an error is not cleared by the way."""
    state = axis.read()
    if state.has_fault:
        text = error_text(state.error)
        raise Failure(f"axis {axis.number}: {text}; nothing was moved: init clears it", NOT_SO)
    if not state.is_taken:
        axis.init()


# ---- settings ----


def write(line: Connection, unit: Unit, order: Write) -> str:
    """Write those settings that differ."""
    concerned = [axis for axis in ALL_AXES if part_of(axis) in order.values]
    settings.require_free(unit, ALL_AXES if UNIT_PART in order.values else concerned)
    found = settings.read_all(unit)
    line.tell_settings(None)  # until they are read again
    try:
        settings.write(unit, order.values, found)
    finally:
        line.read_settings(unit)
    assert line.settings
    names = [
        f"{part} {name}"
        for part, own in order.values.items()
        for name in own
        if found[part][name] != line.settings[part][name]
    ]
    return f"written: {', '.join(names)}; not stored yet" if names else "all of them were so"


def keep(line: Connection, unit: Unit, order: Plain) -> str:
    """Read, store, or take the delivered ones."""
    if order.name == "store":
        unit.store()
    elif order.name == "deliver":
        line.looks.touch(*range(1, AXES + 1))
        line.tell_settings(None)
        unit.deliver()
    line.read_settings(unit)
    return {
        "store": "all settings are stored",
        "deliver": "the delivered settings are in force; not stored yet",
    }.get(order.name, "all settings were read")
