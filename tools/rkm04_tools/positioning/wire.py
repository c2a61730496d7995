"""Requests to a unit and their answers: Modbus RTU, or Modbus TCP through a gateway.

When something is sent, how long an answer is waited for and what is one is decided by the master of
tools/positioning_master; here are the port, and the words for what goes wrong.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from rkm04_tools.line_errors import GarbledAnswer, LineError, NoAnswer
from rkm04_tools.positioning import modbus
from rkm04_tools.positioning.line_errors import NotBegun, NotRepeated, RequestRefused, WrongUnit
from rkm04_tools.positioning.master import NS_PER_MS, End, Master
from rkm04_tools.transport import SLICE_SECONDS, Port, open_transport

TCP = "modbus://"
PTYS = "/dev/pts/"
RATE, FORMAT = 19_200, "8E1"
FORMATS = ("8E1", "8O1", "8N1", "8N2")
ANSWER_MS = 300
"""How long the first byte of an answer may take on its way, through converters and networks."""
TCP_MS = 3000
"""A gateway waits by itself, and tells that nothing came."""
SENT_MAX = 4
"""How often a request is sent at the most."""
NS_PER_SECOND = 1000 * NS_PER_MS
CHECK = (
    "is it on, are address, rate and format right "
    "(--node, --baud, --format), and are A and B not swapped?"
)


@dataclass
class Counts:
    """What has happened on the line."""

    requests: int = 0
    repeats: int = 0


class Wire:
    """A line to a unit. `look` is called before anything is sent."""

    def __init__(self, port: Port, node: int, rate: int, tcp: bool) -> None:
        self.node = node
        self.counts = Counts()
        self.tries = SENT_MAX
        self.look: Callable[[], None] = lambda: None
        self._is_late: Callable[[], bool] = lambda: False
        self._port = port
        self._patience_ms = TCP_MS if tcp else ANSWER_MS
        self._master = Master(rate, tcp)

    @property
    def name(self) -> str:
        """Where the unit is, for messages."""
        return f"{self._port.name}, unit {self.node}"

    def close(self) -> None:
        """Give the port back."""
        self._port.close()

    def abandon(self) -> None:
        """Give the port back, and let nothing go out any more that still waits."""
        self._port.abandon()

    def take_back(self) -> None:
        """Let nothing go out any more that still waits."""
        self._port.take_back()

    @contextmanager
    def until(self, is_late: Callable[[], bool]) -> Iterator[None]:
        """Send nothing that may begin a motion, and repeat none of it, once it is late."""
        self._is_late = is_late
        try:
            yield
        finally:
            self._is_late = lambda: False

    def read(self, first: int, count: int) -> list[int]:
        """Registers."""
        request = modbus.read_request(first, count)
        return self._words(self._ask(request, f"reading register {first}"), count)

    def write(self, first: int, words: Sequence[int]) -> None:
        """Write registers, all of them or none."""
        self._ask(modbus.write_request(first, words), f"writing register {first}")

    def write_and_read(
        self, first: int, words: Sequence[int], read: int, count: int, begins: bool = False
    ) -> tuple[list[int], bool]:
        """Write registers, then read others; whether the request had to be repeated.

        `begins`: it may begin a motion."""
        before = self.counts.repeats
        request = modbus.exchange_request(first, words, read, count)
        found = self._words(self._ask(request, f"writing register {first}", begins), count)
        return found, self.counts.repeats != before

    def identify(self) -> list[str]:
        """Vendor, product and version."""
        return modbus.texts_in(self._ask(modbus.identify_request(), "the identification"))

    def _words(self, answer: bytes, count: int) -> list[int]:
        words = modbus.words_in(answer, count)
        if words is None:
            raise WrongUnit(self.name)
        return words

    def _ask(self, request: bytes, what: str, begins: bool = False) -> bytes:
        """Send a request until it is answered."""
        master = self._master
        master.ask(self.node, request, self._patience_ms, self.tries, time.monotonic_ns())
        end, sent = End.WAITS, 0
        while end is End.WAITS:
            data = self._come(master.until_ns)
            master.take(data, time.monotonic_ns())
            end = master.poll(time.monotonic_ns())
            if out := master.out:
                self.look()
                if begins and self._is_late():
                    raise NotRepeated(self.name) if sent else NotBegun(self.name)
                self.counts.requests += 1
                self.counts.repeats += sent > 0
                sent += 1
                self._port.write(out)
                master.note_written()
        if end is End.ANSWERED:
            return master.answer
        if end is End.REFUSED:
            raise RequestRefused(self.name, what, master.answer[1])
        raise self._error(end)

    def _come(self, until_ns: int) -> bytes:
        """What has come, or comes until then. A short time is slept, as ports wait longer."""
        seconds = (until_ns - time.monotonic_ns()) / NS_PER_SECOND
        if seconds > SLICE_SECONDS:
            return self._port.read(seconds)
        time.sleep(max(seconds, 0))
        return self._port.read(0)

    def _error(self, end: End) -> LineError:
        if end is End.DAMAGED:
            return GarbledAnswer(
                f"{self.name}: what comes is damaged, or no Modbus; check rate and format of the "
                "line (--baud, --format), cable and terminators"
            )
        if end is End.ABSENT:
            return NoAnswer(
                f"{self.name}: the gateway tells that the unit does not answer; "
                "is it on, and is this its address?"
            )
        echo = ", only the adapter's echo comes back" if end is End.ECHOED else ""
        return NoAnswer(f"{self.name} does not answer{echo}; {CHECK}")


def open_wire(name: str, node: int = 1, rate: int = RATE, form: str = FORMAT) -> Wire:
    """Open a line: a serial device, a pty, socket://HOST:PORT (RTU) or modbus://HOST:PORT (TCP)."""
    if name.startswith(TCP):
        return Wire(open_transport(name, scheme=TCP), node, rate, tcp=True)
    is_pty = os.path.realpath(name).startswith(PTYS)
    return Wire(open_transport(name, rate, "8N1" if is_pty else form), node, rate, tcp=False)
