"""The desk of a positioning unit."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rkm04_tools.positioning import host
from rkm04_tools.positioning.service.connection import LineForm
from rkm04_tools.positioning.service.orders import ALL_AXES, Hold, Order, read_order
from rkm04_tools.positioning.service.worker import Worker
from rkm04_tools.service.browsers import Tell
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.unit_desk import TurnsDesk
from rkm04_tools.service.unit_orders import HALT, Connect
from rkm04_tools.service.virtual import VirtualLine


class UnitDesk(TurnsDesk):
    """A Desk; it connects to a `first` port when it starts."""

    def __init__(
        self, first: Connect, form: LineForm, tell: Tell, is_watched: Callable[[], bool]
    ) -> None:
        units = VirtualLine(host.program_path, ())
        super().__init__(first, Worker(tell, is_watched, units, form), units)

    def read(self, text: str) -> tuple[Order, Asked]:
        """Read an order."""
        return read_order(text)

    def halted_by(self, order: Any) -> Any:
        """The axes that an order stops."""
        if order == HALT:
            return ALL_AXES
        return order.axes if isinstance(order, Hold) else None
