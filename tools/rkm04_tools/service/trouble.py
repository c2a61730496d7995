"""Errors as the page gets them: what is wrong, and what to do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import LineError, PortError, PortLost

Got = TypeVar("Got")


class BadRequest(Failure):
    """The page has asked for something that is not possible."""


class TooLarge(BadRequest):
    """More than a program can be."""


class NotConnected(Failure):
    """There is no line to send anything on."""

    def __init__(self) -> None:
        super().__init__("no port is open; connect first")


class Stopped(Failure):
    """A stop went ahead of it."""

    def __init__(self) -> None:
        super().__init__("a stop went ahead of this; send it again if it is still wanted")


class Late(Failure):
    """It has taken too long to get here, so that whoever asked may not count on it any more."""

    def __init__(self) -> None:
        super().__init__("this came too late and was not sent; look at the unit, then ask again")


class Unsent(Failure):
    """There was no connection to the unit when it was asked for."""

    def __init__(self) -> None:
        super().__init__(
            "the unit was not reached at that time, so this was not sent; "
            "look at the unit, then send it again"
        )


class NotConfirmed(Failure):
    """A stop that not every unit has confirmed."""

    def __init__(self, who: str) -> None:
        super().__init__(f"the stop is not confirmed by {who}; use the emergency stop")


class Fault(PortLost):
    """A fault of this program; the port is closed, as nobody knows what was under way."""

    def __init__(self, what: str) -> None:
        super().__init__(f"{what}; this is a fault of the tool, connect again")


class Superseded(Failure):
    """A newer request of the same page has made it useless."""

    def __init__(self) -> None:
        super().__init__("a newer request has taken the place of this one; wait for that")


def nothing_kept_back(work: Callable[[], Got], take_back: Callable[[], None]) -> Got:
    """What comes of it; what was not answered is not sent later, by a port that has kept it."""
    try:
        return work()
    except LineError as error:
        if not isinstance(error, PortError):
            take_back()
        raise


def as_json(failure: Failure, **place: int) -> dict[str, Any]:
    """Divide the line of a failure before its advice; `kind` names its class, for translation."""
    cause, semicolon, advice = str(failure).partition("; ")
    if not semicolon and ": write " in cause:
        cause, _, advice = cause.partition(": ")
    return {"kind": type(failure).__name__, "cause": cause, "next": advice, **place}
