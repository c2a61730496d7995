"""Frames of the line: a message with address, number and FCS between flags.

The rules are those of firmware/rkm04/docs/line.md; the unit's own C makes frames and judges them.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from ctypes import c_bool, c_char_p, c_uint8, c_uint32, c_void_p
from dataclasses import dataclass
from functools import cache
from typing import Any

from rkm04_tools import lines

ANSWER = 0x80
"""The bit of the address that marks an answer."""

REFUSED = 0x40
"""The bit set too where the request was not executed, as the unit has no session open."""

BROADCAST = 0
NODES = range(1, 17)

HEAD_BYTES = 2
MESSAGE_BYTES_MAX = 8402
"""The longest answer; requests have up to 8192."""


@cache
def _functions() -> dict[str, Any]:
    return lines.declared(
        "lines_rkm04_",
        {
            "frame_bytes_max": (c_uint32, c_uint32),
            "frame_write": (c_uint32, c_char_p, c_uint8, c_uint8, c_char_p, c_uint32),
            "ear_begin": (c_void_p,),
            "ear_end": (None, c_void_p),
            "ear_take": (c_uint32, c_void_p, c_char_p, c_uint32),
            "ear_content": (c_void_p, c_void_p),
            "ear_length": (c_uint32, c_void_p),
            "ear_is_damaged": (c_bool, c_void_p),
        },
    )


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
        c, count = _functions(), len(self.message)
        room = ctypes.create_string_buffer(c["frame_bytes_max"](count))
        length = c["frame_write"](room, self.address, self.number, self.message, count)
        return room.raw[:length]


class Receiver:
    """Takes bytes in pieces of any size, gives the good frames among them.

    Gaps are no error here: adapters and networks make them.
    """

    def __init__(self) -> None:
        self._c = _functions()
        self._ear = lines.owned(self, self._c["ear_begin"](), self._c["ear_end"])

    @property
    def is_damaged(self) -> bool:
        """Whether something came that was no whole frame, or is none yet."""
        return bool(self._c["ear_is_damaged"](self._ear))

    def feed(self, data: bytes) -> Iterator[Frame]:
        """Take bytes; yield the frames that they complete."""
        while data:
            data = data[self._c["ear_take"](self._ear, data, len(data)) :]
            if length := self._c["ear_length"](self._ear):
                content = ctypes.string_at(self._c["ear_content"](self._ear), length)
                yield Frame(content[0], content[1], content[HEAD_BYTES:])
