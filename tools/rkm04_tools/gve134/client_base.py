"""What the commands that talk to a unit share."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext

from rkm04_tools.client_base import port_of
from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.unit import Unit, open_unit
from rkm04_tools.holding import UNKNOWN, held, holder_of
from rkm04_tools.line_errors import PortBusy

PORT_VARIABLE = "GVE134_PORT"
TOOL = "gve134"
ADVICE = "use its keys (gve134 send: + - 0, space, g) or its page (gve134 service), or end it"
ADVICE_BUSY = f"nothing was sent; {ADVICE} (Ctrl-C halts the axes)"


@contextmanager
def unit_of(options: Namespace, shared: bool = False) -> Iterator[Unit]:
    """Open the line that is named by option or environment. Nothing is sent yet.

    `shared`: whoever has it as well is not asked, for what must come through.
    """
    port = port_of(options, PORT_VARIABLE)
    with (
        nullcontext() if shared else held(port, TOOL, ADVICE),
        _opened(port, options, shared) as unit,
    ):
        yield unit


def _opened(port: str, options: Namespace, shared: bool) -> Unit:
    try:
        return open_unit(port, options.baud, options.sums)
    except PortBusy:
        who = holder_of(port) if shared else UNKNOWN  # the note that there is then is our own
        raise PortBusy(f"{port}: {who} has this line; {ADVICE_BUSY}") from None


def require_good(command: str, what: str) -> None:
    """Refuse a command that the unit's own parser refuses, before anything is sent."""
    if "\n" in command or "\r" in command or ";" in command:
        raise Failure(f"{what}: the characters of this cannot be of a command; write it anew")
    parsed = host.check(command)
    if parsed.errors:
        raise Failure(f"{what}: {parsed.errors[0].message}")
