"""The desk of a unit that orders are brought to by pages: they wait for the worker, or not."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

from rkm04_tools.service import virtual
from rkm04_tools.service.browsers import Aside, IsLate
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.ports import ports
from rkm04_tools.service.trouble import BadRequest, Late
from rkm04_tools.service.turns import Turns
from rkm04_tools.service.unit_orders import HALT, PORTS, Connect, SetInput
from rkm04_tools.service.virtual import VirtualLine


class TurnsDesk:
    """A Desk; it connects to a `first` port when it starts."""

    def __init__(self, first: Connect, worker: Turns[Any], units: VirtualLine) -> None:
        self._first = first
        self._turns = worker
        self._units = units

    def start(self) -> None:
        """Begin to work."""
        self._turns.start()
        self._turns.give(self._first, Asked())

    def close(self) -> None:
        """End line, virtual unit and thread."""
        self._turns.close()
        self._units.close()

    def greetings(self) -> list[dict[str, Any]]:
        """What a browser that comes is told."""
        return self._turns.greetings()

    def read(self, text: str) -> tuple[Any, Asked]:
        """Read an order."""
        raise NotImplementedError

    def work_of(self, order: Any) -> Any:
        """An order as the worker takes it."""
        return order

    def halted_by(self, order: Any) -> Any:
        """What an order halts, which then goes ahead of all others; None: nothing."""
        return ... if order == HALT else None

    def take(self, text: str, client: int, is_late: IsLate) -> Aside | None:
        """Take what a browser says."""
        order, asked = self.read(text)
        asked = replace(asked, client=client, is_late=partial(is_late, asked.beat))
        if (what := self.halted_by(order)) is not None:
            self._turns.halt(asked, what)  # better late than never
        elif order == PORTS:
            return ports
        elif is_late(asked.beat):
            if isinstance(order, SetInput):
                raise Late
            self._turns.refuse(self.work_of(order), asked, Late())
        elif isinstance(order, SetInput):
            return partial(self._set_input, order)
        else:
            self._turns.give(self.work_of(order), asked)
        return None

    def leave(self, client: int) -> None:
        """A browser has gone, which changes nothing."""

    def _set_input(self, order: SetInput) -> None:
        state = self._turns.board.state
        if not (state.connected and state.virtual):
            raise BadRequest(
                f"only the port {virtual.NAME} has inputs that can be set here; "
                "those of a unit are wires"
            )
        self._units.set_input(str(order.number), order.level)
