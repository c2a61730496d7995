"""An open port of a line, with its clock, and what is done while an answer is waited for."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rkm04_tools.gve134.answers import Answer
from rkm04_tools.transport import Port

SLICE_SECONDS = 0.02
"""How long a wait goes on before it is looked whether it is to end."""
STALE_BYTES_MAX = 65_536
SLEPT_SECONDS = 2.0
"""Who has not looked at the line for so long has slept."""


@dataclass(eq=False)
class Wire:
    """An open port.

    `look` is called again and again while an answer is waited for, and may raise what ends that.
    `calendar` goes on while the computer sleeps, in which `clock` may stand.
    """

    port: Port
    baud: int
    clock: Callable[[], float] = time.monotonic
    look: Callable[[], None] = lambda: None
    calendar: Callable[[], float] = time.time
    _stirred: float = math.inf
    _slept: float = 0.0

    def write(self, data: bytes) -> None:
        """Send bytes."""
        self.port.write(data)

    def read(self, seconds: float) -> bytes:
        """What comes within a slice of the time."""
        self.look()
        data = self.port.read(min(seconds, SLICE_SECONDS))
        self._stir()
        return data

    def _stir(self) -> None:
        now = self.calendar()
        passed, self._stirred = now - self._stirred, now
        self._slept += passed if passed > SLEPT_SECONDS else 0.0

    def take_slept(self) -> float:
        """For how long the computer has slept since this was asked last, in seconds."""
        self._stir()
        slept, self._slept = self._slept, 0.0
        return slept

    def read_waiting(self) -> bytes:
        """What has come already."""
        data = b""
        while len(data) < STALE_BYTES_MAX and (more := self.port.read(0)):
            data += more
        return data

    def begin(self, commands: Sequence[str]) -> None:
        """Commands are going to be sent."""

    def end(self, commands: Sequence[str], answer: Answer | None) -> None:
        """They had an answer; None: it is not known whether they were executed."""

    def lose(self) -> None:
        """The unit may have executed what was not sent from here."""
