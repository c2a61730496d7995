"""Bytes to commands, as a GVE134 unit has it: checksums, damage, packets that are cut off.

It is written from firmware/gve134/docs/line.md for tests of the client, whose code it shares none.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

NEVER = math.inf
SILENCE_S, GAP_S = 0.1, 1.0
CHARACTERS_MAX = 80


def checksum(text: bytes) -> bytes:
    return b"%02X" % (sum(text) % 256)


@dataclass
class Receiver:
    """`keep` gets what came: `command` or `damage`, and its text or the answer to it.

    `packet` has the commands of a packet that is open, `wrong` the code of what was wrong first.
    """

    keep: Callable[[str, bytes], None]
    sums: bool = False
    line: bytes = b""
    state: str = "outside"
    owes: bool = False
    packet: list[tuple[str, list[str]]] | None = None
    wrong: str = ""
    last_byte: float = 0.0

    def wake(self) -> float:
        """When silence means something."""
        if self.state == "throwing":
            return self.last_byte + SILENCE_S
        if self.state == "inside" or self.packet is not None:
            return self.last_byte + GAP_S
        return NEVER

    def take(self, byte: bytes, now: float) -> None:
        """A byte that comes now."""
        self.last_byte = now
        self._take(byte)

    def _take(self, byte: bytes) -> None:
        if byte == b"\n" or self.state == "throwing":
            return
        if self.state == "inside" and byte == b"\r":
            self.state = "outside"
            self._end_line()
        elif self.state == "inside" and byte == b"!":
            if self.sums or self.line[:1] in (b"0", b"7", b""):
                self._damage(self.line[:1] in (b"0", b"7"))
            if self.state != "throwing":
                self.state, self.line = "inside", b""
        elif self.state == "inside":
            self.line += byte
        elif byte == b"!":
            self.state, self.line = "inside", b""
        elif self.state == "skipping":
            self.state = "outside" if byte == b"\r" else "skipping"
        elif self.sums and byte != b"\r":
            self._damage(ours=False)

    def _damage(self, ours: bool) -> None:
        if self.packet is not None:
            self.wrong = self.wrong or "2"
            self.state = "skipping"
            return
        self.state, self.owes = "throwing", ours

    def end_silence(self) -> None:
        owes = (
            self.packet is not None
            or (self.state == "inside" and self.line[:1] in (b"0", b"7"))
            or (self.state == "throwing" and self.owes)
        )
        in_packet, self.packet, self.state = self.packet is not None, None, "outside"
        if owes:
            self.keep("damage", b"2,0" if in_packet else b"2")

    def _end_line(self) -> None:
        line = self.line
        if self.sums:
            whole = re.fullmatch(rb"(.*,)([0-9A-Fa-f]{2})", line, re.DOTALL)
            good = whole and checksum(b"!" + whole[1]) == whole[2].upper()
            if not whole or not good or len(line) > CHARACTERS_MAX:
                self._damage(line[:1] in (b"0", b"7"))
                if self.packet is not None:
                    self.state = "outside"
                return
            line = whole[1][:-1]
        if line[:1] in (b"0", b"7"):
            self.keep("command", line)
