"""The service's worker without browsers: orders in, and all that browsers would be told."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence
from typing import Any

from rkm04_tools.service.fields import Asked
from rkm04_tools.service.orders import Connect, Node, Work
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.service.worker import Worker

PATIENCE_SECONDS = 20.0
CLIENT = 1


class Desk:
    """A worker at work. `told` is all that it has said."""

    def __init__(self) -> None:
        self.told: list[dict[str, Any]] = []
        self.units = VirtualLine()
        self.worker = Worker(self.told.append, lambda: True, self.units)
        self.worker.start()
        self._numbers = itertools.count(1)
        self._seen = 0

    def until(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """The next message that is wanted."""
        end = time.monotonic() + PATIENCE_SECONDS
        while True:
            while self._seen < len(self.told):
                message = self.told[self._seen]
                self._seen += 1
                if wanted(message):
                    return message
            assert time.monotonic() < end, self.told[-5:]
            time.sleep(0.005)

    def state(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """The next state that is wanted."""
        return self.until(lambda m: m["type"] == "state" and wanted(m))

    def live(self) -> dict[str, Any]:
        """The next look at the unit from now on."""
        self._seen = len(self.told)
        return self.until(lambda m: m["type"] == "live")

    def answer(self, number: int) -> dict[str, Any]:
        return self.until(lambda m: m["type"] == "answer" and m["id"] == number)

    def ask(self, order: Work) -> dict[str, Any]:
        """Give an order and wait for its answer."""
        number = next(self._numbers)
        self.worker.give(order, Asked(CLIENT, number))
        return self.answer(number)

    def connect(self, port: str, node: int = 1) -> dict[str, Any]:
        return self.ask(Connect(port, node))

    def stop(self, nodes: Sequence[Node] = ()) -> dict[str, Any]:
        number = next(self._numbers)
        self.worker.stop(Asked(CLIENT, number), nodes)
        return self.answer(number)
