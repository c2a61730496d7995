"""A port that remembers what went over it, and that a stop can get hold of."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from rkm04_tools.frame import ANSWER, Frame, Receiver
from rkm04_tools.line import PATIENCE_SECONDS
from rkm04_tools.messages import VERSION
from rkm04_tools.service.trouble import Stopped
from rkm04_tools.transport import Transport, seconds_on_line

SLICE_SECONDS = 0.05


@dataclass(frozen=True)
class Exchange:
    """A request, and its answer if one has come."""

    request: Frame
    answer: Frame | None


class Wire:
    """A Transport.

    While `is_stop_wanted` and the wire `yields`, nothing more is sent, and no answer is waited for
    longer than one usually takes: Stopped is raised instead. A frame on its way out is completed.
    """

    def __init__(self, inner: Transport, is_stop_wanted: Callable[[], bool]) -> None:
        self.name = inner.name
        self.yields = True
        self._inner = inner
        self._is_stop_wanted = is_stop_wanted
        self._sent = bytearray()
        self._came = bytearray()
        self._answer_due = 0.0

    def read(self, seconds: float) -> bytes:
        """Return what is there, see Transport."""
        end = time.monotonic() + seconds
        while True:
            left = end - time.monotonic()
            data = self._inner.read(min(max(left, 0.0), SLICE_SECONDS))
            self._came += data
            if data or left <= SLICE_SECONDS:
                return data
            if self.yields and self._is_stop_wanted() and time.monotonic() > self._answer_due:
                raise Stopped

    def write(self, data: bytes) -> None:
        """Send bytes."""
        if self.yields and self._is_stop_wanted():
            raise Stopped
        self._inner.write(data)
        self._sent += data
        self._answer_due = time.monotonic() + seconds_on_line(len(data)) + PATIENCE_SECONDS

    def close(self) -> None:
        """Close the port."""
        self._inner.close()

    def forget(self) -> None:
        """Begin a new record."""
        self._sent.clear()
        self._came.clear()

    def exchanges(self) -> list[Exchange]:
        """What has been asked and answered since; repeats and beginnings of sessions left out."""
        requests = list(dict.fromkeys(Receiver().feed(bytes(self._sent))))
        others = [frame for frame in requests if frame.message != bytes([VERSION])]
        answers = {(f.address, f.number): f for f in Receiver().feed(bytes(self._came))}
        return [
            Exchange(frame, answers.get((frame.address | ANSWER, frame.number)))
            for frame in others or requests[-1:]
        ]
