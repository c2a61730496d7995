"""Fields of what a browser says over its web socket; each is refused if it is not possible."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rkm04_tools.service.trouble import BadRequest, TooLarge

SCHEMES = ("socket", "rfc2217")
PORT_MAX = 1000
ID_MAX = 1 << 53
"""More than a browser can count exactly."""


@dataclass(frozen=True)
class Asked:
    """By whom something was asked, and the number under which the answer is awaited.

    `beat`: the last sign of life of the service that the page had when the user asked. `is_late`:
    whether that is too long ago by now.
    """

    client: int | None = None
    number: int | None = None
    beat: int | None = None
    is_late: Callable[[], bool] = field(default=lambda: False, compare=False)


def read_object(text: str) -> tuple[dict[str, Any], Asked]:
    """Read a message, and by whom and when it was asked."""
    try:
        told = json.loads(text)
    except (ValueError, RecursionError):
        raise BadRequest("this is not JSON; write an object with a type") from None
    if not isinstance(told, dict):
        raise BadRequest("this is no object; write one with a type")
    number, beat = (
        None if told.get(name) is None else whole_of(told, name, range(ID_MAX))
        for name in ("id", "beat")
    )
    return told, Asked(None, number, beat)


def unknown(kind: object) -> BadRequest:
    """That a type of a message is not known."""
    name = json.dumps(kind)[:40]
    return BadRequest(f"{name} is no type of a message; the page is of another version")


def flag_of(told: Mapping[str, Any], name: str) -> bool:
    """True or false; false where it is not there."""
    value = told.get(name, False)
    if not isinstance(value, bool):
        raise BadRequest(f"{name} is not possible; write true or false")
    return value


def port_of(told: Mapping[str, Any], *more_schemes: str) -> str:
    """A port without those that pyserial has for other purposes, as one that writes a file."""
    port = text_of(told, "port", PORT_MAX).strip()
    scheme, colon, _ = port.partition("://")
    if colon and scheme not in (*SCHEMES, *more_schemes):
        raise BadRequest(f"{scheme}:// is no port of a line; write a device, or socket://HOST:PORT")
    return port


def whole_of(told: Mapping[str, Any], name: str, allowed: range) -> int:
    """A whole number within its range."""
    value = told.get(name)
    if not isinstance(value, int) or isinstance(value, bool) or value not in allowed:
        raise BadRequest(f"{name} is not possible; write {allowed[0]} to {allowed[-1]}")
    return value


def text_of(told: Mapping[str, Any], name: str, longest: int) -> str:
    """A text that is not blank."""
    value = told.get(name)
    if not isinstance(value, str) or not value.strip():
        raise BadRequest(f"{name} is missing; write a text")
    if len(value) > longest:
        raise TooLarge(f"{name} is too long; {longest} characters are the most")
    return value
