"""The master of a line of units, tools/positioning_master, for tools in Python."""

from __future__ import annotations

from ctypes import POINTER, c_bool, c_char_p, c_ubyte, c_uint32, c_uint64, c_void_p
from enum import IntEnum
from functools import cache
from typing import Any

from rkm04_tools.lines import Handle, declared

NODE_MAX = 255
REQUEST_BYTES_MAX = 253
CRC_BYTES = 2
NS_PER_MS = 1_000_000
BYTES = POINTER(c_ubyte)


class End(IntEnum):
    """How a request has ended; `pos_master_end`."""

    WAITS = 0
    ANSWERED = 1
    REFUSED = 2
    SILENT = 3
    ECHOED = 4
    DAMAGED = 5
    ABSENT = 6


@cache
def _library() -> dict[str, Any]:
    return declared(
        "lines_positioning_",
        {
            "begin": (c_void_p, c_uint32, c_bool),
            "end": (None, c_void_p),
            "request": (c_void_p, c_void_p),
            "heard": (c_void_p, c_void_p),
            "ask": (None, c_void_p, c_uint32, c_uint32, c_uint32, c_uint32, c_uint64),
            "take": (None, c_void_p, c_uint32, c_uint64),
            "poll": (c_uint32, c_void_p, c_uint64),
            "until_ns": (c_uint64, c_void_p),
            "out": (c_void_p, c_void_p),
            "out_length": (c_uint32, c_void_p),
            "note_written": (None, c_void_p),
            "answer": (c_void_p, c_void_p),
            "answer_length": (c_uint32, c_void_p),
            "seal": (c_uint32, BYTES, c_uint32),
            "more_ms": (c_uint32, c_char_p, c_uint32),
        },
    )


class Master(Handle):
    """A line. It waits for nothing: see `pos_master.h`. `tcp`: a gateway is asked."""

    def __init__(self, baud: int, tcp: bool = False) -> None:
        super().__init__(_library(), baud, tcp)

    def ask(
        self, node: int, request: bytes, patience_ms: int, attempts: int, now_ns: int
    ) -> None:  # fmt: skip
        """Begin a request; one that is under way is given up."""
        if not (0 <= node <= NODE_MAX and 0 < len(request) <= REQUEST_BYTES_MAX and attempts > 0):
            raise ValueError(f"unit {node}: a request of {len(request)} bytes, {attempts} times")
        self._put(request)
        self._call("ask", node, len(request), patience_ms, attempts, now_ns)

    def poll(self, now_ns: int) -> End:
        """What has become of the request."""
        return End(self._call("poll", now_ns))

    @property
    def until_ns(self) -> int:
        """When to poll at the latest."""
        return int(self._call("until_ns"))

    @property
    def out(self) -> bytes:
        """What is to be written now; `note_written` tells that it was."""
        return self._bytes("out", self._call("out_length"))

    def note_written(self) -> None:
        """What stood in `out` has been written."""
        self._call("note_written")

    @property
    def answer(self) -> bytes:
        """The answer, from its function on."""
        return self._bytes("answer", self._call("answer_length"))


def sealed(frame: bytes) -> bytes:
    """A frame with its CRC."""
    room = (c_ubyte * (len(frame) + CRC_BYTES)).from_buffer_copy(frame + bytes(CRC_BYTES))
    _library()["seal"](room, len(frame))
    return bytes(room)


def more_seconds(request: bytes) -> float:
    """How much longer than others the answer to a request may take."""
    return float(_library()["more_ms"](request, len(request))) / 1000
