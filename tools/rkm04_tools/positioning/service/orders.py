"""What a browser may ask for over its web socket, as types."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from rkm04_tools.frame import NODES
from rkm04_tools.positioning.settings import Values, part_of
from rkm04_tools.positioning.state import INPUTS
from rkm04_tools.positioning.table import AXES, WORD_MAX, registers
from rkm04_tools.service.fields import Asked, flag_of, port_of, read_object, unknown, whole_of
from rkm04_tools.service.trouble import BadRequest
from rkm04_tools.service.unit_orders import OF_PAGES, Connect, Plain, SetInput

ALL_AXES = tuple(range(1, AXES + 1))
WAYS_UM = range(-(2**31) + 1, 2**31)
FEEDS = range(1 << 32)
METHODS = (19, 21, 37)


@dataclass(frozen=True)
class Hold:
    """Take the permission away from axes, and see them stand."""

    axes: tuple[int, ...]


@dataclass(frozen=True)
class Take:
    """POS_INIT."""

    axis: int


@dataclass(frozen=True)
class Release:
    """POS_RESET."""

    axis: int


@dataclass(frozen=True)
class Capture:
    """POS_CAPTURE."""

    axis: int


@dataclass(frozen=True)
class Control:
    """POS_CONTROL: a feed in 1/65 536 mm/min, the permission; None: it stays."""

    axis: int
    feed: int | None
    permitted: bool | None


@dataclass(frozen=True)
class Measure:
    """A way in µm, or a position; with a `feed` the axis is taken if need be, and moves."""

    axis: int
    um: int
    accel: int
    absolute: bool
    feed: int | None


@dataclass(frozen=True)
class Home:
    """Find the reference, which is at a position; 37: it is here."""

    axis: int
    method: int
    um: int
    accel: int
    feed: int


@dataclass(frozen=True)
class Write:
    """Settings by part and name."""

    values: Values


Work: TypeAlias = Connect | Plain | Take | Release | Capture | Control | Measure | Home | Write
Order: TypeAlias = Work | Hold | SetInput

PLAIN = (*OF_PAGES, "settings", "store", "deliver")
"""`settings`: read them all."""


def read_order(text: str) -> tuple[Order, Asked]:
    """Read a message of a browser."""
    told, asked = read_object(text)
    return _order(told), asked


def _order(told: Mapping[str, Any]) -> Order:
    kind = told.get("type")
    if kind in PLAIN:
        return Plain(str(kind))
    if kind == "connect":
        return Connect(port_of(told, "modbus"), whole_of(told, "node", NODES_RANGE))
    if kind == "write":
        return Write(_values(told.get("values")))
    if kind == "input":
        number = whole_of(told, "input", range(1, INPUTS + 1))
        return SetInput(number, whole_of(told, "level", range(2)) == 1)
    if kind in OF_AXIS:
        order: Order = OF_AXIS[kind](whole_of(told, "axis", range(1, AXES + 1)), told)
        return order
    raise unknown(kind)


NODES_RANGE = range(min(NODES), max(NODES) + 1)


def _feed(told: Mapping[str, Any]) -> int | None:
    return None if told.get("feed") is None else whole_of(told, "feed", FEEDS)


def _control(axis: int, told: Mapping[str, Any]) -> Control:
    permitted = None if told.get("permitted") is None else flag_of(told, "permitted")
    return Control(axis, _feed(told), permitted)


def _measure(axis: int, told: Mapping[str, Any]) -> Measure:
    um, accel = whole_of(told, "um", WAYS_UM), whole_of(told, "accel", range(WORD_MAX + 1))
    return Measure(axis, um, accel, flag_of(told, "absolute"), _feed(told))


def _home(axis: int, told: Mapping[str, Any]) -> Home:
    method = told.get("method")
    if type(method) is not int or method not in METHODS:
        raise BadRequest("method is not possible; write 19, 21 or 37")
    um, accel = whole_of(told, "um", WAYS_UM), whole_of(told, "accel", range(WORD_MAX + 1))
    return Home(axis, method, um, accel, whole_of(told, "feed", FEEDS))


OF_AXIS: dict[Any, Any] = {
    "hold": lambda axis, told: Hold((axis,)),
    "take": lambda axis, told: Take(axis),
    "release": lambda axis, told: Release(axis),
    "capture": lambda axis, told: Capture(axis),
    "control": _control,
    "measure": _measure,
    "home": _home,
}


def _values(told: Any) -> Values:
    """Settings that there are, with values that they can have."""
    parts = {part_of(axis): "A" if axis else "U" for axis in range(AXES + 1)}
    if not isinstance(told, dict) or not told.keys() <= parts.keys() or not told:
        raise BadRequest(f"values is not possible; write settings of {', '.join(parts)}")
    for part, own in told.items():
        if not isinstance(own, dict):
            raise BadRequest(f"{part} is not possible; write settings by their names")
        for name, value in own.items():
            row = registers().get(name)
            if row is None or not row.is_setting or row.scope != parts[part]:
                raise BadRequest(f"{part} has no setting {str(name)[:40]}; reload the page")
            if type(value) is not int or not row.takes(value):
                raise BadRequest(f"{part}: {name} cannot be {str(value)[:20]}; look at its range")
    return told
