"""What the commands that talk to a unit share."""

from __future__ import annotations

from argparse import Namespace

from rkm04_tools.client_base import port_of
from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.unit import Unit, open_unit

PORT_VARIABLE = "GVE134_PORT"


def unit_of(options: Namespace) -> Unit:
    """Open the line that is named by option or environment. Nothing is sent yet."""
    return open_unit(port_of(options, PORT_VARIABLE), options.baud, options.sums)


def require_good(command: str, what: str) -> None:
    """Refuse a command that the unit's own parser refuses, before anything is sent."""
    if "\n" in command or "\r" in command or ";" in command:
        raise Failure(f"{what}: the characters of this cannot be of a command; write it anew")
    parsed = host.check(command)
    if parsed.errors:
        raise Failure(f"{what}: {parsed.errors[0].message}")
