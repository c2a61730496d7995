"""What is behind the page of a GVE134, without browsers: what they say, and what they are told."""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Callable
from typing import Any

from rkm04_tools.gve134.service.desk import UnitDesk
from rkm04_tools.service.unit_orders import Connect

PATIENCE_SECONDS = 20.0
CLIENT = 1
MILL = "tools/examples/gve/mill.rkm"
Told = dict[str, Any]


class GveDesk:
    """A desk at work. `told` is all that it has said; `late`: what is said is from long ago."""

    def __init__(self, port: str) -> None:
        self.told: list[Told] = []
        self.late = False
        self.desk = UnitDesk(Connect(port), 115_200, None, self.told.append, lambda: True)
        self.desk.start()
        self._numbers = itertools.count(1)
        self._seen = 0

    def close(self) -> None:
        self.desk.close()

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
        return self.desk.greetings()[0]

    def phase(self, phase: str) -> Told:
        """Wait for the job to be in a phase; the job."""
        state = self.state(lambda m: m["job"] is not None and m["job"]["phase"] == phase)
        job: Told = state["job"]
        return job

    def live(self, wanted: Callable[[Told], bool] = lambda m: True) -> Told:
        """The next look at the unit from now on that is wanted."""
        self._seen = len(self.told)
        return self.until(lambda m: m["type"] == "live" and wanted(m))

    def say(self, kind: str, **told: Any) -> int:
        """Say something, and return the number by which the answer is known."""
        number = next(self._numbers)
        text = json.dumps({"type": kind, "id": number, "beat": 1, **told})
        aside = self.desk.take(text, CLIENT, lambda beat: self.late)
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

    def open(self, name: str, text: str) -> int:
        return self.desk.open_file(name, text.encode()).number

    def open_mill(self, content: bytes) -> None:
        self.desk.open_machine("mill.rkm", content)
