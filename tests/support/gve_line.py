"""The line of the GVE134 unit: bytes with their times in, requests, packets and damage out.

Written from the contract alone. What the line does (sums, packets, what is thrown away) hangs on
the texts alone and on none of the unit's states, so all bytes of a session are read beforehand.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from gve_words import SYNTAX, TEXT_MAX, UNKNOWN, Command, Refused, name_of, read_command, with_sum
from reference import TICK_HZ

MS = TICK_HZ // 1000
SILENCE = 100 * MS
PATIENCE = 1000 * MS
ADDRESSES = "07"
PACKET_MAX = 128


@dataclass(frozen=True, slots=True)
class Byte:
    """A byte that comes to the unit; the tick of the end of its stop bit."""

    tick: int
    value: int
    broken: bool = False


@dataclass(frozen=True)
class Request:
    """A command, or the code of what is wrong with its text."""

    tick: int
    address: int
    command: Command | int
    index: int
    """Of the last command counted, this one included."""
    sums: bool
    """Whether its answer has a sum."""
    text: str = ""


@dataclass(frozen=True)
class Packet:
    """A packet that has come to its end: what its lines were, 2 for a damaged one."""

    tick: int
    lines: tuple[Command | int, ...]
    number: int
    index: int
    sums: bool


@dataclass(frozen=True)
class Refusal:
    """An answer that only says code 2: of something damaged, or of a packet that broke off."""

    tick: int
    latest: int
    packet: bool
    index: int
    sums: bool


Item = Request | Packet | Refusal


@dataclass
class Line:
    """Reads bytes one after the other."""

    sums: bool = False
    index: int = 0
    last: int = -PATIENCE
    text: str | None = None
    """What has come since the `!`; None: outside of a line."""
    skipping: bool = False
    """The rest of a damaged line of a packet."""
    throwing: bool = False
    known: bool = False
    """Whether what was damaged was for this unit."""
    packet: list[Command | int] | None = None
    items: list[Item] = field(default_factory=list)

    def hear(self, byte: Byte) -> None:
        """Take the next byte."""
        self.pause(byte.tick)
        self.last = byte.tick
        if not self.throwing:
            self._take(byte)

    def pause(self, tick: int) -> None:
        """Nothing comes up to a tick."""
        gap = tick - self.last
        if self.throwing:
            if gap >= SILENCE:
                self._report(self.last + SILENCE, self.last + SILENCE)
        elif self.packet is not None:
            if gap >= PATIENCE:
                at = self.last + PATIENCE
                self.items.append(Refusal(at, at, True, self.index, self.sums))
                self.packet, self.text, self.skipping = None, None, False
        elif self.text is not None and gap >= PATIENCE:
            self._damage()
            self._report(self.last + PATIENCE, self.last + PATIENCE + SILENCE)

    def _report(self, earliest: int, latest: int) -> None:
        self.throwing = False
        if self.known:
            self.items.append(Refusal(earliest, latest, False, self.index, self.sums))

    def _take(self, byte: Byte) -> None:
        value = chr(byte.value)
        if self.text is None:
            self._take_outside(value, byte)
        elif byte.broken or value == "!":
            self._damage()
            if value == "!" and not byte.broken and self.packet is not None:
                self.text, self.skipping = "", False
        elif value == "\r":
            text, self.text = self.text, None
            self._end(text, byte.tick)
        elif value != "\n":
            self.text += value
            if self.sums and len(self.text) > TEXT_MAX:
                self._damage()

    def _take_outside(self, value: str, byte: Byte) -> None:
        if byte.broken or value not in "!\r\n":
            if self.sums and not self.skipping:
                self._damage()
        elif value == "!":
            self.text, self.skipping = "", False
        else:
            self.skipping = False

    def _damage(self) -> None:
        """What was being read is damaged."""
        self.known = bool(self.text) and (self.text or "")[0] in ADDRESSES
        self.text = None
        if self.packet is None:
            self.throwing = True
        else:
            self.packet.append(2)
            self.skipping = True

    def _end(self, line: str, tick: int) -> None:
        text = line
        if self.sums:
            found = re.fullmatch(r"(.*),([0-9A-Fa-f]{2})", line, re.DOTALL)
            if not found or with_sum("!" + found[1]) != f"!{found[1]},{found[2].upper()}":
                self.text = line
                self._damage()
                self.skipping = False
                return
            text = found[1]
        if text[:1] in tuple(ADDRESSES):
            self._request(int(text[0]), text[1:], tick, too_long=len(line) > TEXT_MAX)

    def _request(self, address: int, text: str, tick: int, *, too_long: bool) -> None:
        read: Command | int
        try:
            read = read_command(address, text[: TEXT_MAX + 1])
        except Refused as refused:
            read = refused.code
        if too_long and read != UNKNOWN:
            read = SYNTAX
        name = read.name if isinstance(read, Command) else text[:1]
        if name not in ("@", ">"):
            self.index = (self.index + 1) % 256
        if self.packet is not None and not self._leaves_packet(address, text, read, tick):
            return
        was = self.sums
        if isinstance(read, Command):
            if name == "*S":
                self.packet = []
                return
            if name == "*E":
                read = SYNTAX
            self._switch(name)
        self.items.append(Request(tick, address, read, self.index, self.sums_of(name, was), text))
        if name == "J" and isinstance(read, Command):
            self.index = 0

    def sums_of(self, name: str, was: bool) -> bool:
        """Whether an answer has a sum: that of `%+` has, those of `%-` and J as it was before."""
        return was if name == "J" else self.sums

    def _switch(self, name: str) -> None:
        if name == "%+":
            self.sums = True
        elif name in ("%-", "J"):
            self.sums = False

    def _leaves_packet(self, address: int, text: str, read: Command | int, tick: int) -> bool:
        """Take a line of a packet; tell whether it ends the packet and is executed itself."""
        assert self.packet is not None
        name = read.name if isinstance(read, Command) else ""
        if name in ("H", "J"):
            self.packet = None
            return True
        if name == "*S":
            self.packet = []
        elif text.upper().startswith("*E") and address == 0:
            lines = tuple(self.packet)
            if isinstance(read, Command):
                number = read.args[0]
            else:
                lines, number = (*lines, read), 0
            self.items.append(Packet(tick, lines, number, self.index, self.sums))
            self.packet = None
        else:
            told = name_of(address, text)
            another = bool(told) and (told not in "BC" or address != 0)
            self.packet.append(SYNTAX if another else read)
        return False


def read_line(line: Sequence[Byte], end: int) -> Iterator[Item]:
    """Return what comes by the line up to a tick, in order."""
    reader = Line()
    for byte in line:
        reader.hear(byte)
    reader.pause(end)
    return iter(sorted(reader.items, key=lambda item: item.tick))
