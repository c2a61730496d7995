"""What a browser may ask for over its web socket, as types."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from rkm04_tools.frame import NODES
from rkm04_tools.messages import (
    ALL_MOTORS,
    GET_COMMAND,
    GET_POSITION,
    GET_PROGRESS,
    GET_TABLE,
    MOTORS,
    SET_COMMAND,
    STORE_FLASH,
    VERSION,
)
from rkm04_tools.service.fields import Asked, flag_of, port_of, read_object, text_of, whole_of
from rkm04_tools.service.trouble import BadRequest

MESSAGES = {
    "version": VERSION,
    "send": SET_COMMAND,
    "store": STORE_FLASH,
    "position": GET_POSITION,
    "program": GET_COMMAND,
    "table": GET_TABLE,
    "progress": GET_PROGRESS,
}
SCAN, SEND_ALL = "scan", "send_all"
TO_ALL_UNITS = ("send", "store")
LETS_GO = "K"
ACTS = ("resume", "reset", "speed")
TEXT_MAX = 200_000
"""Characters: more than 700 commands with comments; a stop must not wait for a longer check."""


@dataclass(frozen=True)
class Node:
    """A unit: its address on a port."""

    port: str
    node: int


@dataclass(frozen=True)
class Connect:
    """Open a port, and speak to the unit of a node."""

    port: str
    node: int


@dataclass(frozen=True)
class Disconnect:
    """Close the port."""


@dataclass(frozen=True)
class Request:
    """One of the seven messages, or several: a scan, the programs of all motors.

    `everywhere`: to all units of the line (DNode 0), of which none answers. `texts` are the
    programs by motor; they start `together` or as they arrive. `held`: of a button that makes a
    motor run while it is held, the run or the K of letting go.
    """

    name: str
    motor: int
    text: str = ""
    everywhere: bool = False
    texts: tuple[tuple[int, str], ...] = ()
    together: bool = False
    held: bool = False


@dataclass(frozen=True)
class Act:
    """C75, reset or V."""

    name: str
    motor: int
    value: int = 0


@dataclass(frozen=True)
class Stop:
    """K, ahead of everything; `nodes` are those that the page has seen."""

    nodes: tuple[Node, ...] = ()


@dataclass(frozen=True)
class Forget:
    """The user has dealt with `nodes`: no stop waits for them any more."""

    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class SetInput:
    """Change an input of the virtual unit."""

    number: int
    level: bool


@dataclass(frozen=True)
class Hold:
    """A button that makes a motor run is `held`, or has been let go."""

    held: bool


@dataclass(frozen=True)
class ListPorts:
    """Tell which ports there are."""


Work: TypeAlias = Connect | Disconnect | Request | Act
Queued: TypeAlias = Work | Forget
Order: TypeAlias = Queued | Stop | SetInput | Hold | ListPorts


def read_order(text: str) -> tuple[Order, Asked]:
    """Read a message of a browser."""
    told, asked = read_object(text)
    return _order(told), asked


def name_of(order: Work) -> str:
    """The name under which an order is known to the page."""
    if isinstance(order, Request | Act):
        return order.name
    return "connect" if isinstance(order, Connect) else "disconnect"


def runs(order: Work) -> bool:
    """Whether it is not to be sent after its button was let go."""
    return isinstance(order, Request) and order.held and order.text != LETS_GO


def lets_go(order: Queued) -> bool:
    """Whether it is the K of a button that is let go, which only a stop goes ahead of."""
    return isinstance(order, Request) and order.held and order.text == LETS_GO


def motor_of(order: Work) -> int | None:
    """The motor that is meant, 0 for all; None: it is no matter of motors."""
    return order.motor if isinstance(order, Request | Act) else None


def _order(told: Mapping[str, Any]) -> Order:
    kind = told.get("type")
    if kind == "connect":
        return Connect(port_of(told), whole_of(told, "node", NODES))
    if kind == "request":
        return _request(told)
    if kind in ACTS:
        value = whole_of(told, "value", range(1, 16_001)) if kind == "speed" else 0
        return Act(str(kind), _motor(told, ALL_MOTORS), value)
    if kind == "input":
        return SetInput(
            whole_of(told, "input", range(1, 9)), whole_of(told, "level", range(2)) == 1
        )
    if kind == "hold":
        return Hold(flag_of(told, "held"))
    if kind == "stop":
        return Stop(_nodes(told.get("nodes")))
    if kind == "forget":
        return Forget(_nodes(told.get("nodes")))
    for name, order in (("disconnect", Disconnect()), ("ports", ListPorts())):
        if kind == name:
            return order
    raise BadRequest(
        f"{json.dumps(kind)[:40]} is no type of a message; the page is of another version"
    )


def _request(told: Mapping[str, Any]) -> Request:
    name = told.get("message")
    if name == SCAN:
        return Request(SCAN, ALL_MOTORS)
    if name == SEND_ALL:
        together = flag_of(told, "together")
        return Request(SEND_ALL, ALL_MOTORS, texts=_texts(told), together=together)
    if not isinstance(name, str) or name not in MESSAGES:
        raise BadRequest(f"message is none of {', '.join(MESSAGES)}; name one of them")
    motor = _motor(told, ALL_MOTORS if name == "version" else None)
    everywhere = flag_of(told, "everywhere")
    if everywhere and name not in TO_ALL_UNITS:
        raise BadRequest("node 0 means all units, and none of them answers; ask one of them")
    has_text = name == "send" or (name == "store" and told.get("text") is not None)
    text = text_of(told, "text", TEXT_MAX) if has_text else ""
    return Request(name, motor, text, everywhere, held=flag_of(told, "held"))


def _texts(told: Mapping[str, Any]) -> tuple[tuple[int, str], ...]:
    """Programs by motor, in the order of the motors."""
    texts = told.get("texts")
    if not isinstance(texts, dict) or not texts or not set(texts) <= set(map(str, MOTORS)):
        raise BadRequest('texts is not possible; write {"1": "F100 R"}')
    return tuple((int(motor), text_of(texts, motor, TEXT_MAX)) for motor in sorted(texts))


def _nodes(told: Any) -> tuple[Node, ...]:
    """The nodes of a message that is never refused, as a stop: what is no node is left out."""
    rows = [row for row in told if isinstance(row, dict)] if isinstance(told, list) else []
    nodes = [Node(str(row.get("port")), row.get("node", 0)) for row in rows[: len(NODES)]]
    return tuple(each for each in nodes if each.node in NODES)


def _motor(told: Mapping[str, Any], default: int | None) -> int:
    if default is not None and told.get("motor") is None:
        return default
    return whole_of(told, "motor", range(ALL_MOTORS, MOTORS[-1] + 1))
