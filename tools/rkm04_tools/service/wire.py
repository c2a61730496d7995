"""A port that remembers what went over it, and that a stop can get hold of."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from rkm04_tools.frame import ANSWER, NODES, REFUSED, Frame, Receiver
from rkm04_tools.line import PATIENCE_SECONDS
from rkm04_tools.messages import UNKNOWN, VERSION
from rkm04_tools.service.trouble import Stopped
from rkm04_tools.transport import Port, seconds_on_line

SLICE_SECONDS = 0.05


@dataclass(frozen=True)
class Exchange:
    """A request, and its answer if one has come."""

    request: Frame
    answer: Frame | None


class Wire:
    """A Port.

    While `is_stop_wanted` and the wire `yields`, nothing more is sent, and no answer is waited for
    longer than one usually takes: Stopped is raised instead. A frame on its way out is completed.
    `hear` is told of every node that answers, whatever it was asked.
    """

    def __init__(
        self,
        inner: Port,
        is_stop_wanted: Callable[[], bool],
        hear: Callable[[int], None] = lambda node: None,
    ) -> None:
        self.name = inner.name
        self.yields = True
        self._inner = inner
        self._is_stop_wanted = is_stop_wanted
        self._hear = hear
        self._receiver = Receiver()
        self._sent = bytearray()
        self._came = bytearray()
        self._answer_due = 0.0

    def read(self, seconds: float) -> bytes:
        """Return what is there, see Transport."""
        end = time.monotonic() + seconds
        while True:
            left = end - time.monotonic()
            data = self._inner.read(min(max(left, 0.0), SLICE_SECONDS))
            self._note(data)
            if data or left <= SLICE_SECONDS:
                return data
            if self.yields and self._is_stop_wanted() and time.monotonic() > self._answer_due:
                raise Stopped

    def _note(self, data: bytes) -> None:
        self._came += data
        for frame in self._receiver.feed(data):
            node = frame.node & ~REFUSED
            if frame.is_answer and node in NODES:
                self._hear(node)

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

    def abandon(self) -> None:
        """Close the port, see Port."""
        self._inner.abandon()

    def take_back(self) -> None:
        """See Port."""
        self._inner.take_back()

    def forget(self) -> None:
        """Begin a new record."""
        self._sent.clear()
        self._came.clear()

    def exchanges(self) -> list[Exchange]:
        """What has been asked and answered since; repeats and beginnings of sessions left out."""
        requests = list(dict.fromkeys(Receiver().feed(bytes(self._sent))))
        others = [frame for frame in requests if frame.message != bytes([VERSION])]
        answers = list(Receiver().feed(bytes(self._came)))
        return [
            Exchange(frame, next((each for each in answers[::-1] if _answers(each, frame)), None))
            for frame in others or requests[-1:]
        ]


def _answers(answer: Frame, request: Frame) -> bool:
    """Whether it is the answer; several requests may have the number 0."""
    same = (answer.address, answer.number) == (request.address | ANSWER, request.number)
    return same and answer.message[:1] in (request.message[:1], bytes([UNKNOWN]))
