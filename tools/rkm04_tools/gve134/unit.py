"""A GVE134 unit, for scripts and for the commands.

    from rkm04_tools.gve134.unit import open_unit

    with open_unit("COM5") as unit:
        print(unit.positions())

Every call ends: with what was asked for, or with an error that says what to do. How the line finds
out what has become of a command is in `link`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType

from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.gve134.link import BAUD, HALT_SECONDS, Link, open_link
from rkm04_tools.gve134.link_errors import (
    LineError,
    NotConfirmed,
    OutOfStep,
    Refused,
    Restarted,
)
from rkm04_tools.gve134.state import Flags, Positions, Status
from rkm04_tools.gve134.sums import Sums

POLL_SECONDS = 0.05
MEMORY_BYTES = 256
WORD_BYTES = 4


@dataclass(frozen=True)
class Halted:
    """How the axes stand after H. `restarted`: the unit has started anew since it was known.

    `others`: what another program has done instead, or perhaps; empty: nothing of that.
    """

    flags: Flags
    positions: Positions
    restarted: bool
    others: str = ""

    def require_known(self, where: str) -> None:
        """Nothing goes on at a unit that is not as it was left."""
        if self.restarted:
            raise Restarted(where, executed=False)
        if self.others:
            raise OutOfStep(where)


def open_unit(port: str, baud: int = BAUD, sums: int = Sums.ON) -> Unit:
    """Open the line to a unit: a serial device, a pty, or socket://HOST:PORT."""
    return Unit(open_link(port, baud, sums))


class Unit:
    """A unit at the end of a line."""

    def __init__(self, link: Link) -> None:
        self.link = link

    def __enter__(self) -> Unit:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.link.__exit__(kind, error, trace)

    def order(self, command: str, what: str = "") -> Answer:
        """Have a command executed; what is refused is an error that begins with `what`."""
        answer = self.link.ask(command)
        if answer.code != answers.DONE:
            raise Refused(what or command, answer)
        return answer

    # ---- reading ----

    def positions(self, latched: bool = False) -> Positions:
        """The positions of X, Y, Z, A: as they are, or at the last interrupt."""
        x, y, z, a = self.order("PL" if latched else "P4").numbers
        return x, y, z, a

    def flags(self) -> Flags:
        """ST6."""
        return Flags(self._byte("SR6"))

    def status(self) -> Status:
        """Everything that the unit tells of itself."""
        registers = tuple(self._byte(f"SR{n}") for n in range(7))
        late = self.link.ask("SR7")
        return Status(
            registers,
            Flags(self._byte("F")),
            (self._byte("I1"), self._byte("I2")),
            int(late.values, 16) if late.code == answers.DONE else None,
        )

    def _byte(self, command: str) -> int:
        return int(self.order(command).values, 16)

    # ---- motion ----

    def wait_until_stands(self, tell: Callable[[], None] = lambda: None) -> Flags:
        """Ask again and again until no axis moves."""
        while not (flags := self.flags()).stands:
            tell()
            self.link.pause(POLL_SECONDS)
        return flags

    def halt(self, waits: Callable[[], None] = lambda: None) -> Halted:
        """Stop down the ramp, and make sure that the axes stand; else NotConfirmed."""
        try:
            self.link.halt(HALT_SECONDS, waits)
            flags = self.flags()
        except NotConfirmed:
            raise
        except LineError as error:
            raise NotConfirmed(str(error)) from None
        if not flags.stands:
            raise NotConfirmed(f"{self.link.name}: the unit tells that it is {flags.text}")
        return Halted(flags, self.positions(), self.link.restarted, self.link.others)

    # ---- memory ----

    def read_memory(self, first: int, count: int) -> bytes:
        """Bytes of the EEPROM, read four at a time where they can be."""
        found = b""
        while (left := count - len(found)) > 0:
            place = first + len(found)
            if left >= WORD_BYTES:
                word = int(self.order(f"EUR{place:02X}").values, 16)
                found += word.to_bytes(WORD_BYTES, "little")
            else:
                found += bytes([self._byte(f"ER{place:02X}")])
        return found

    def write_byte(self, place: int, value: int) -> bool:
        """Write a byte of the EEPROM. False: it reads as another one."""
        self.order(f"EW{place:02X},{value:02X}", f"memory {place:02X}")
        return self._byte(f"ER{place:02X}") == value
