"""Frames of the line: a message with address, number and FCS between flags.

The rules are those of firmware/rkm04/docs/line.md.

The receiver takes any bytes and gives the good frames among them; what it drops it counts, by the
same names as the unit.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

FLAG, ESCAPE, ESCAPED = 0x7E, 0x7D, 0x20
POLYNOMIAL, START, RESIDUE = 0x8408, 0xFFFF, 0xF0B8
"""FCS-16 of RFC 1662, bits reflected; the residue is what a whole frame gives, FCS included."""

ANSWER = 0x80
"""The bit of the address that marks an answer."""

REFUSED = 0x40
"""The bit set too where the request was not executed, as the unit has no session open."""

BROADCAST = 0
NODES = range(1, 17)
NUMBERS = range(1, 256)
"""Numbers of requests; 0 is none."""

HEAD_BYTES, FCS_BYTES = 2, 2
MESSAGE_BYTES_MAX = 8402
"""The longest answer; requests have up to 8192."""
CONTENT_BYTES_MIN = HEAD_BYTES + 1 + FCS_BYTES
CONTENT_BYTES_MAX = HEAD_BYTES + MESSAGE_BYTES_MAX + FCS_BYTES


def _row(byte: int) -> int:
    for _ in range(8):
        byte = byte >> 1 ^ (POLYNOMIAL if byte & 1 else 0)
    return byte


_TABLE = [_row(byte) for byte in range(256)]


def _run_fcs(data: bytes) -> int:
    register = START
    for byte in data:
        register = register >> 8 ^ _TABLE[(register ^ byte) & 0xFF]
    return register


def fcs16(data: bytes) -> int:
    """The FCS of what stands before it in a frame."""
    return _run_fcs(data) ^ 0xFFFF


@dataclass(frozen=True)
class Frame:
    """A frame without its envelope."""

    address: int
    number: int
    message: bytes

    @property
    def is_answer(self) -> bool:
        """Whether a unit has sent it."""
        return bool(self.address & ANSWER)

    @property
    def node(self) -> int:
        """The DNode, or a number that no unit has."""
        return self.address & ~ANSWER

    def encode(self) -> bytes:
        """The bytes on the line."""
        content = bytes([self.address, self.number]) + self.message
        content += fcs16(content).to_bytes(FCS_BYTES, "little")
        escaped = content.replace(b"\x7d", b"\x7d\x5d").replace(b"\x7e", b"\x7d\x5e")
        return bytes([FLAG]) + escaped + bytes([FLAG])


class Receiver:
    """Takes bytes in pieces of any size.

    `dropped` counts, each by its name: FCS, ABORT, ESCAPE, SHORT, LONG, STRAY. Gaps are no error
    here: adapters and networks make them.
    """

    def __init__(self) -> None:
        self.dropped: Counter[str] = Counter()
        self._content = bytearray()
        self._open = False  # a flag has come, so what follows is a frame
        self._escaping = False
        self._fault = ""

    @property
    def is_inside(self) -> bool:
        """Whether a frame has begun and not ended."""
        return self._open and bool(self._content or self._escaping or self._fault)

    def feed(self, data: bytes) -> Iterator[Frame]:
        """Take bytes; yield the frames that they complete."""
        for byte in data:
            if byte == FLAG:
                frame = self._close()
                if frame:
                    yield frame
            elif not self._open:
                self.dropped["STRAY"] += 1
            elif not self._fault:
                self._take(byte)

    def _take(self, byte: int) -> None:
        if self._escaping:
            self._escaping = False
            byte ^= ESCAPED
            if byte not in (FLAG, ESCAPE):
                self._fault = "ESCAPE"
                return
        elif byte == ESCAPE:
            self._escaping = True
            return
        if len(self._content) == CONTENT_BYTES_MAX:
            self._fault = "LONG"
            return
        self._content.append(byte)

    def _close(self) -> Frame | None:
        """Judge what stands before a flag, and begin anew after it."""
        content, fault = bytes(self._content), self._fault
        if self._escaping:
            fault = "ABORT"
        elif not fault and 0 < len(content) < CONTENT_BYTES_MIN:
            fault = "SHORT"
        elif not fault and content and _run_fcs(content) != RESIDUE:
            fault = "FCS"
        self._content.clear()
        self._open, self._escaping, self._fault = True, False, ""
        if fault:
            self.dropped[fault] += 1
            return None
        if not content:
            return None
        return Frame(content[0], content[1], content[HEAD_BYTES:-FCS_BYTES])
