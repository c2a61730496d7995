"""What a browser may ask for over its web socket, as types."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from rkm04_tools.gve134.service.files import File
from rkm04_tools.gve134.state import AXES, Positions
from rkm04_tools.service.fields import Asked, port_of, read_object, text_of, unknown, whole_of
from rkm04_tools.service.trouble import BadRequest
from rkm04_tools.service.unit_orders import OF_PAGES, Connect, Plain, SetInput

STEPS_MAX = 2_147_483_647
SPEEDS = range(10, 200_001)
PERCENTS = range(1, 1001)
COMMAND_MAX = 80
INPUTS = (1, 2, 3, 4, 7, 8)


@dataclass(frozen=True)
class Start:
    """Send a file to the unit, which executes it; a page names it by its number."""

    file: File | int


@dataclass(frozen=True)
class Home:
    """Reference runs as the machine file has them: of an axis, or of all that have one."""

    axis: str | None


@dataclass(frozen=True)
class Jog:
    """A way of all axes, pulses, at a speed of the longest."""

    parts: Positions
    speed: int


@dataclass(frozen=True)
class Override:
    """The speed of all vectors, per cent."""

    percent: int


@dataclass(frozen=True)
class Output:
    """Port 0."""

    port: int


@dataclass(frozen=True)
class Spindle:
    """The speed of the spindle, 0.1 %."""

    permille: int


@dataclass(frozen=True)
class Typed:
    """A command as the console has it."""

    text: str


Work: TypeAlias = Connect | Start | Home | Jog | Override | Output | Spindle | Typed | Plain
Order: TypeAlias = Work | SetInput

PLAIN = (*OF_PAGES, "go", "delete", "resume")
"""`resume`: the person whom a job waits for is ready."""


def read_order(text: str) -> tuple[Order, Asked]:
    """Read a message of a browser."""
    told, asked = read_object(text)
    return _order(told), asked


def _order(told: Mapping[str, Any]) -> Order:
    kind = told.get("type")
    if kind in PLAIN:
        return Plain(str(kind))
    if kind == "connect":
        return Connect(port_of(told))
    if kind == "start":
        return Start(whole_of(told, "file", range(1, 1 << 53)))
    if kind == "home":
        return Home(_axis(told.get("axis")))
    if kind == "jog":
        return Jog(_parts(told.get("parts")), whole_of(told, "speed", SPEEDS))
    if kind == "override":
        return Override(whole_of(told, "percent", PERCENTS))
    if kind == "output":
        return Output(whole_of(told, "port", range(256)))
    if kind == "spindle":
        return Spindle(whole_of(told, "permille", range(1001)))
    if kind == "typed":
        return Typed(text_of(told, "text", COMMAND_MAX).strip())
    if kind == "input" and told.get("input") in INPUTS:
        return SetInput(int(told["input"]), whole_of(told, "level", range(2)) == 1)
    raise unknown(kind)


def _axis(told: Any) -> str | None:
    if told is None or told in AXES:
        return None if told is None else str(told)
    raise BadRequest("axis is not possible; write X, Y, Z, A or none")


def _parts(told: Any) -> Positions:
    good = isinstance(told, list) and len(told) == len(AXES)
    if not good or not all(type(part) is int and abs(part) <= STEPS_MAX for part in told):
        raise BadRequest("parts is not possible; write four whole numbers")
    if not any(told):
        raise BadRequest("that is no way at all; write pulses other than 0")
    x, y, z, a = told
    return x, y, z, a
