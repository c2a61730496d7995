"""The tool's own client at the line of an image on the virtual board, in virtual time.

Between the two is a USB converter as computers have them: what is sent waits for the next frame of
the bus, and what comes back is kept until a timer in the converter is over.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.virtual_board import Talk

MS_PER_SECOND = 1000.0
FRAME_MS = 1.0
"""Of USB."""


@dataclass
class Converter:
    """A port (`transport.Port`) whose time is that of the board.

    A byte of the unit is handed on `latency_ms` after it came, with all that have come by then.
    """

    talk: Talk
    latency_ms: float
    name: str = "the virtual board"
    heard_ms: float = 0.0
    """When the last byte came from the unit."""

    def __post_init__(self) -> None:
        self._out: deque[tuple[float, bytes]] = deque()
        self._in = b""
        self._due_ms = 0.0

    def seconds(self) -> float:
        """The clock."""
        return self.talk.ms / MS_PER_SECOND

    def write(self, data: bytes) -> None:
        """Send bytes."""
        self._out.append((self.talk.ms + FRAME_MS, data))

    def read(self, seconds: float) -> bytes:
        """Return what has been handed on; wait for that until the time is over."""
        end = self.talk.ms + seconds * MS_PER_SECOND
        while not (self._in and self.talk.ms >= self._due_ms):
            if self.talk.ms >= end:
                return b""
            self._go_on(end)
        data, self._in = self._in, b""
        return data

    def _go_on(self, end: float) -> None:
        """Let time pass until something happens."""
        moments = [end]
        moments += [self._due_ms] if self._in else []
        moments += [self._out[0][0]] if self._out else []
        heard = self.talk.until(min(moments))
        if heard:
            self.heard_ms = self.talk.ms
            self._due_ms = self._due_ms if self._in else self.talk.ms + self.latency_ms
            self._in += heard
        while self._out and self._out[0][0] <= self.talk.ms:
            self.talk.say(self._out.popleft()[1])

    def close(self) -> None:
        """Nothing is to be given back."""

    def abandon(self) -> None:
        """Nothing is to be given back."""

    def take_back(self) -> None:
        """Nothing waits here for long."""

    def unit(self, baud: int) -> Unit:
        """The unit at the other end."""
        return Unit(Link(Wire(self, baud, clock=self.seconds, calendar=self.seconds)))
