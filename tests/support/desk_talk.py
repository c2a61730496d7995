"""What is behind the page of a unit, without browsers: what they say, and what they are told."""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Callable
from typing import Any

from rkm04_tools.service.unit_desk import TurnsDesk

PATIENCE_SECONDS = 20.0
CLIENT = 1
Told = dict[str, Any]


class DeskTalk:
    """A desk at work. `told` is all that it has said; `late`: what is said is from long ago."""

    def __init__(self, desk_of: Callable[[Callable[[Told], None]], TurnsDesk]) -> None:
        self.told: list[Told] = []
        self.late = False
        self._desk = desk_of(self.told.append)
        self._desk.start()
        self._numbers = itertools.count(1)
        self._seen = 0

    def close(self) -> None:
        self._desk.close()

    def until(self, wanted: Callable[[Told], bool]) -> Told:
        """The next message that is wanted."""
        end = time.monotonic() + PATIENCE_SECONDS
        while True:
            while self._seen < len(self.told):
                message = self.told[self._seen]
                self._seen += 1
                if wanted(message):
                    return message
            assert time.monotonic() < end, [m for m in self.told if m["type"] != "live"][-3:]
            time.sleep(0.005)

    def state(self, wanted: Callable[[Told], bool]) -> Told:
        """The next state that is wanted."""
        return self.until(lambda m: m["type"] == "state" and wanted(m))

    @property
    def now(self) -> Told:
        """The state as it is now."""
        return next(m for m in self._desk.greetings() if m["type"] == "state")

    def live(self, wanted: Callable[[Told], bool] = lambda m: True) -> Told:
        """The next look at the unit from now on that is wanted."""
        self._seen = len(self.told)
        return self.until(lambda m: m["type"] == "live" and wanted(m))

    def say(self, kind: str, **told: Any) -> int:
        """Say something, and return the number by which the answer is known."""
        number = next(self._numbers)
        text = json.dumps({"type": kind, "id": number, "beat": 1, **told})
        aside = self._desk.take(text, CLIENT, lambda beat: self.late)
        if aside:
            aside()
        return number

    def answer(self, number: int) -> Told:
        return self.until(lambda m: m["type"] == "answer" and m["id"] == number)

    def ask(self, kind: str, **told: Any) -> Told:
        """Say something and wait for its answer."""
        return self.answer(self.say(kind, **told))

    def connected(self) -> Told:
        return self.state(lambda m: m["connected"] and m["version"] and not m["busy"])
