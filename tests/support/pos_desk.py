"""What is behind the page of a positioning unit, without browsers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from desk_talk import DeskTalk, Told
from rkm04_tools.positioning.service.connection import LineForm
from rkm04_tools.positioning.service.desk import UnitDesk
from rkm04_tools.service.unit_orders import Connect

MM_MIN = 65_536


class PosDesk(DeskTalk):
    """A desk at work."""

    def __init__(self, port: str, node: int = 1) -> None:
        super().__init__(lambda tell: UnitDesk(Connect(port, node), LineForm(), tell, lambda: True))

    def axis(self, wanted: Callable[[Told], bool] = lambda m: True, number: int = 1) -> Told:
        """An axis in the next look in which it is as wanted."""
        return dict(self.live(lambda m: wanted(m["axes"][number - 1]))["axes"][number - 1])

    def move(self, mm: float, feed: float = 600, axis: int = 1, **more: Any) -> Told:
        """Take an axis if need be, and let it go."""
        um = round(1000 * mm)
        return self.ask("measure", axis=axis, um=um, accel=500, feed=round(feed * MM_MIN), **more)
