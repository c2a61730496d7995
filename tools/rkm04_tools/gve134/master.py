"""The master of the line, which tools and page have in common: tools/gve134_master, in C."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import c_bool, c_char_p, c_uint32, c_uint64, c_void_p
from enum import IntEnum
from functools import cache
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.lines import Handle, declared

NO_ANSWER = 2**32 - 1
TEXT_BYTES_MAX = 6400
"""GVE_WIRE_TEXT_BYTES"""
ROOM_BYTES = 16
"""What the line adds to a command at the most."""
MS_PER_SECOND = 1000


class Kind(IntEnum):
    """Enum gve_master_kind."""

    ASK = 0
    PACKET = 1
    PACKET_ONCE = 2
    LONG = 3
    RESET = 4
    CONNECT = 5
    HALT = 6
    OWN = 7


class End(IntEnum):
    """Enum gve_master_end."""

    WAITS = 0
    ANSWERED = 1
    NOT_TAKEN = 2
    SILENT = 3
    ECHOED = 4
    GARBLED = 5
    OTHER_DEVICE = 6
    RESTARTED = 7
    RESTARTED_PERHAPS = 8
    OUT_OF_STEP = 9
    END_UNKNOWN = 10
    NOT_CONFIRMED = 11
    SUMS_OFF = 12


@cache
def _functions() -> dict[str, Any]:
    return declared(
        "lines_gve134_",
        {
            "begin": (c_void_p, c_uint32, c_uint32),
            "end": (None, c_void_p),
            "request": (c_void_p, c_void_p),
            "heard": (c_void_p, c_void_p),
            "ask": (None, c_void_p, c_uint32, c_uint32, c_uint64, c_uint64),
            "take": (None, c_void_p, c_uint32, c_uint64),
            "poll": (c_uint32, c_void_p, c_uint64),
            "forget": (None, c_void_p),
            "until": (c_uint64, c_void_p),
            "out": (c_void_p, c_void_p),
            "take_out": (c_uint32, c_void_p),
            "digit": (c_uint32, c_void_p),
            "values": (c_char_p, c_void_p),
            "other": (c_char_p, c_void_p),
            "version": (c_char_p, c_void_p),
            "repairs": (c_uint32, c_void_p),
            "restarted": (c_bool, c_void_p),
            "others": (c_uint32, c_void_p),
            "long_halt": (c_bool, c_void_p),
            "encode": (c_uint32, c_char_p, c_uint32, c_bool, c_void_p, c_uint32),
            "read": (c_uint32, c_char_p, c_uint32, c_bool, c_void_p),
        },
    )


def encode(command: str, sums: bool) -> bytes:
    """A command as files have it, as the line has it."""
    text = command.encode("latin-1")
    out = ctypes.create_string_buffer(len(text) + ROOM_BYTES)
    length = _functions()["encode"](text, len(text), sums, out, len(out))
    return out.raw[:length]


def read(line: str, sums: bool) -> tuple[int, str] | None:
    """The digit and the values of an answer without its CR; None: it is none."""
    text = line.encode("latin-1")
    values = ctypes.create_string_buffer(len(text) + 1)
    digit = _functions()["read"](text, len(text), sums, values)
    return None if digit == NO_ANSWER else (digit, values.value.decode("latin-1"))


class Master(Handle):
    """A line; see gve_master.h."""

    def __init__(self, baud: int, sums: int) -> None:
        super().__init__(_functions(), baud, sums)

    def ask(self, kind: Kind, commands: Sequence[str], wait_seconds: float, now_ns: int) -> None:
        """Begin a request."""
        text = "\n".join(commands).encode("latin-1")
        if len(text) > TEXT_BYTES_MAX:
            raise Failure(f"{len(commands)} commands are too many for a packet; nothing was sent")
        self._put(text)
        self._call("ask", kind, len(text), round(wait_seconds * MS_PER_SECOND), now_ns)

    def poll(self, now_ns: int) -> End:
        """How the request stands."""
        return End(self._call("poll", now_ns))

    def forget(self) -> None:
        """Give up what is under way; nothing is known of the unit then."""
        self._call("forget")

    @property
    def until_ns(self) -> int:
        """When the next look is due."""
        return int(self._call("until"))

    def take_out(self) -> bytes:
        """What is to be written now."""
        return self._bytes("out", self._call("take_out"))

    @property
    def answer(self) -> tuple[int, str]:
        """The digit of the answer, and its values."""
        return self._call("digit"), self._text("values")

    @property
    def other(self) -> str:
        """What another device has answered."""
        return self._text("other")

    @property
    def version(self) -> str:
        """The unit's answer to ?."""
        return self._text("version")

    @property
    def repairs(self) -> int:
        """The answers that got lost."""
        return int(self._call("repairs"))

    @property
    def restarted(self) -> bool:
        """Whether the unit had started anew when it was connected to again."""
        return bool(self._call("restarted"))

    @property
    def others(self) -> End:
        """What another program has done then: SUMS_OFF; OUT_OF_STEP: that, or a restart."""
        return End(self._call("others"))

    @property
    def long_halt(self) -> bool:
        """Whether the answer to H takes longer than a stop does as a rule."""
        return bool(self._call("long_halt"))

    def _text(self, name: str) -> str:
        return bytes(self._call(name)).decode("latin-1")
