"""What is behind the page of a GVE134, without browsers."""

from __future__ import annotations

from collections.abc import Callable

from desk_talk import DeskTalk, Told
from rkm04_tools.gve134.service.desk import UnitDesk
from rkm04_tools.service.unit_orders import Connect

MILL = "tools/examples/gve/mill.rkm"


class GveDesk(DeskTalk):
    """A desk at work."""

    def __init__(self, port: str) -> None:
        super().__init__(self._make(port))

    def _make(self, port: str) -> Callable[[Callable[[Told], None]], UnitDesk]:
        def make(tell: Callable[[Told], None]) -> UnitDesk:
            self.desk = UnitDesk(Connect(port), 115_200, None, tell, lambda: True)
            return self.desk

        return make

    def phase(self, phase: str) -> Told:
        """Wait for the job to be in a phase; the job."""
        state = self.state(lambda m: m["job"] is not None and m["job"]["phase"] == phase)
        job: Told = state["job"]
        return job

    def open(self, name: str, text: str) -> int:
        return self.desk.open_file(name, text.encode()).number

    def open_mill(self, content: bytes) -> None:
        self.desk.open_machine("mill.rkm", content)
