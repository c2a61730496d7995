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
from rkm04_tools.service.trouble import BadRequest, TooLarge

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
ACTS = ("resume", "reset", "speed")
SCHEMES = ("socket", "rfc2217")
TEXT_MAX = 200_000
"""Characters: more than 700 commands with comments; a stop must not wait for a longer check."""
PORT_MAX = 1000
ID_MAX = 1 << 53
"""More than a browser can count exactly."""


@dataclass(frozen=True)
class Asked:
    """By whom something was asked, and the number under which the answer is awaited.

    `beat`: the last sign of life of the service that the page had when the user asked.
    """

    client: int | None = None
    number: int | None = None
    beat: int | None = None


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
    programs by motor; they start `together` or as they arrive.
    """

    name: str
    motor: int
    text: str = ""
    everywhere: bool = False
    texts: tuple[tuple[int, str], ...] = ()
    together: bool = False


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
class SetInput:
    """Change an input of the virtual unit."""

    number: int
    level: bool


@dataclass(frozen=True)
class ListPorts:
    """Tell which ports there are."""


Work: TypeAlias = Connect | Disconnect | Request | Act
Order: TypeAlias = Connect | Disconnect | Request | Act | Stop | SetInput | ListPorts


def read_order(text: str) -> tuple[Order, Asked]:
    """Read a message of a browser."""
    try:
        told = json.loads(text)
    except (ValueError, RecursionError):
        raise BadRequest("this is not JSON; write an object with a type") from None
    if not isinstance(told, dict):
        raise BadRequest("this is no object; write one with a type")
    number, beat = (
        None if told.get(name) is None else _whole(told, name, range(ID_MAX))
        for name in ("id", "beat")
    )
    return _order(told), Asked(None, number, beat)


def name_of(order: Work) -> str:
    """The name under which an order is known to the page."""
    if isinstance(order, Request | Act):
        return order.name
    return "connect" if isinstance(order, Connect) else "disconnect"


def motor_of(order: Work) -> int | None:
    """The motor that is meant, 0 for all; None: it is no matter of motors."""
    return order.motor if isinstance(order, Request | Act) else None


def _order(told: Mapping[str, Any]) -> Order:
    kind = told.get("type")
    if kind == "connect":
        return Connect(_port(told), _whole(told, "node", NODES))
    if kind == "request":
        return _request(told)
    if kind in ACTS:
        value = _whole(told, "value", range(1, 16_001)) if kind == "speed" else 0
        return Act(str(kind), _motor(told, ALL_MOTORS), value)
    if kind == "input":
        return SetInput(_whole(told, "input", range(1, 9)), _whole(told, "level", range(2)) == 1)
    if kind == "stop":
        return Stop(_nodes(told.get("nodes")))
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
        together = _flag(told, "together")
        return Request(SEND_ALL, ALL_MOTORS, texts=_texts(told), together=together)
    if not isinstance(name, str) or name not in MESSAGES:
        raise BadRequest(f"message is none of {', '.join(MESSAGES)}; name one of them")
    motor = _motor(told, ALL_MOTORS if name == "version" else None)
    everywhere = _flag(told, "everywhere")
    if everywhere and name not in TO_ALL_UNITS:
        raise BadRequest("node 0 means all units, and none of them answers; ask one of them")
    has_text = name == "send" or (name == "store" and told.get("text") is not None)
    return Request(name, motor, _text(told, "text", TEXT_MAX) if has_text else "", everywhere)


def _texts(told: Mapping[str, Any]) -> tuple[tuple[int, str], ...]:
    """Programs by motor, in the order of the motors."""
    texts = told.get("texts")
    if not isinstance(texts, dict) or not texts or not set(texts) <= set(map(str, MOTORS)):
        raise BadRequest('texts is not possible; write {"1": "F100 R"}')
    return tuple((int(motor), _text(texts, motor, TEXT_MAX)) for motor in sorted(texts))


def _flag(told: Mapping[str, Any], name: str) -> bool:
    value = told.get(name, False)
    if not isinstance(value, bool):
        raise BadRequest(f"{name} is not possible; write true or false")
    return value


def _port(told: Mapping[str, Any]) -> str:
    """A port without those that pyserial has for other purposes, as one that writes a file."""
    port = _text(told, "port", PORT_MAX).strip()
    scheme, colon, _ = port.partition("://")
    if colon and scheme not in SCHEMES:
        raise BadRequest(f"{scheme}:// is no port of a line; write a device, or socket://HOST:PORT")
    return port


def _nodes(told: Any) -> tuple[Node, ...]:
    """The nodes of a stop. A stop is never refused, so what is no node is left out."""
    rows = [row for row in told if isinstance(row, dict)] if isinstance(told, list) else []
    nodes = [Node(str(row.get("port")), row.get("node", 0)) for row in rows[: len(NODES)]]
    return tuple(each for each in nodes if each.node in NODES)


def _motor(told: Mapping[str, Any], default: int | None) -> int:
    if default is not None and told.get("motor") is None:
        return default
    return _whole(told, "motor", range(ALL_MOTORS, MOTORS[-1] + 1))


def _whole(told: Mapping[str, Any], name: str, allowed: range) -> int:
    value = told.get(name)
    if not isinstance(value, int) or isinstance(value, bool) or value not in allowed:
        raise BadRequest(f"{name} is not possible; write {allowed[0]} to {allowed[-1]}")
    return value


def _text(told: Mapping[str, Any], name: str, longest: int) -> str:
    value = told.get(name)
    if not isinstance(value, str) or not value.strip():
        raise BadRequest(f"{name} is missing; write a text")
    if len(value) > longest:
        raise TooLarge(f"{name} is too long; {longest} characters are the most")
    return value
