"""The master of a line, of tools/master: sessions, numbers, repeats and how long to wait.

It has no port and no clock: its owner writes what it gives out, hands in what has come, and looks
again at `until_ns` at the latest. Times are in ns from any moment. Calls are to take turns.
"""

from __future__ import annotations

import random
from ctypes import c_bool, c_uint32, c_uint64, c_void_p
from enum import IntEnum
from functools import cache
from typing import Any

from rkm04_tools import lines

REQUEST_BYTES_MAX = 8192

LINE, BYTES, NOW = c_void_p, c_void_p, c_uint64


class End(IntEnum):
    """enum master_end of tools/master/master.h."""

    WAITS = 0
    ANSWERED = 1
    SILENT = 2
    ECHOED = 3
    DAMAGED = 4
    RESTARTED = 5
    RESTARTED_SENT = 6


@cache
def _functions() -> dict[str, Any]:
    return lines.declared(
        "lines_rkm04_",
        {
            "begin": (LINE, c_uint32, c_uint32, c_uint32),
            "end": (None, LINE),
            "request": (BYTES, LINE),
            "heard": (BYTES, LINE),
            "ask": (None, LINE, c_uint32, c_bool, c_uint32, c_uint32, c_uint32, NOW),
            "scan": (None, LINE, c_uint32, c_uint32, c_uint32, NOW),
            "take": (None, LINE, c_uint32, NOW),
            "poll": (c_uint32, LINE, NOW),
            "until": (c_uint64, LINE),
            "forget": (None, LINE, c_uint32),
            "sessions": (c_uint32, LINE, c_uint32),
            "echoes": (c_bool, LINE),
            "twice": (c_bool, LINE),
            "out": (BYTES, LINE),
            "take_out": (c_uint32, LINE),
            "answer": (BYTES, LINE),
            "answer_length": (c_uint32, LINE),
        },
    )


class Master(lines.Handle):
    """A line without sessions; `usual_ms` is the patience for what takes a unit no time."""

    def __init__(self, baud: int, usual_ms: int) -> None:
        super().__init__(_functions(), random.randint(1, 2**32 - 1), baud, usual_ms)

    def ask(
        self, node: int, in_session: bool, message: bytes, patience_ms: int, attempts: int, now: int
    ) -> None:
        """Begin a request; what was under way is given up."""
        self._put(message)
        self._call("ask", node, in_session, len(message), patience_ms, attempts, now)

    def scan(self, node: int, patience_ms: int, attempts: int, now: int) -> None:
        """Begin to ask for the version; `twice` is whether another answer has followed it."""
        self._call("scan", node, patience_ms, attempts, now)

    def take_out(self) -> bytes:
        """What is to be written now, once."""
        return self._bytes("out", self._call("take_out"))

    def poll(self, now: int) -> End:
        """How the request has ended, if it has."""
        return End(self._call("poll", now))

    @property
    def until_ns(self) -> int:
        """When it is to be polled at the latest."""
        return int(self._call("until"))

    def answer(self) -> bytes:
        """The answer to the last request; to a broadcast it is empty."""
        return self._bytes("answer", self._call("answer_length"))

    def twice(self) -> bool:
        """Whether the last scan has got two answers."""
        return bool(self._call("twice"))

    def echoes(self) -> bool:
        """Whether something that was sent has come back."""
        return bool(self._call("echoes"))

    def sessions(self, node: int) -> int:
        """How many were begun with a node."""
        return int(self._call("sessions", node))

    def forget(self, node: int) -> None:
        """The next request begins a session."""
        self._call("forget", node)
