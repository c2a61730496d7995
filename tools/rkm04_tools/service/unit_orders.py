"""Orders that pages of several units have in common, as types."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Connect:
    """Open a port, and find out which unit is there; `node` is its address, where it has one."""

    port: str
    node: int = 1


@dataclass(frozen=True)
class Plain:
    """What needs no more than its name, as disconnect."""

    name: str


@dataclass(frozen=True)
class SetInput:
    """Change an input of the virtual unit."""

    number: int
    level: bool


HALT, PORTS = Plain("halt"), Plain("ports")
OF_PAGES = ("disconnect", "seen", "halt", "ports")
"""`seen`: a restart was taken note of."""


def name_of(order: Any) -> str:
    """The name under which an order is known to the page."""
    return order.name if isinstance(order, Plain) else type(order).__name__.lower()


def is_for_unit(order: Any) -> bool:
    """Whether an order is for the unit, not for the connection to it."""
    is_own = isinstance(order, Plain) and order.name in ("disconnect", "seen")
    return not is_own and not isinstance(order, Connect)
