"""The desk of RKM04 units: what browsers ask for goes to the worker, or is done aside."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from rkm04_tools.service import virtual
from rkm04_tools.service.browsers import Aside, IsLate, Tell
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.orders import Connect, Forget, Hold, ListPorts, SetInput, Stop, read_order
from rkm04_tools.service.ports import ports
from rkm04_tools.service.trouble import BadRequest, Late
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.service.worker import Worker


class UnitDesk:
    """A Desk; it connects to a `first` port when it starts."""

    def __init__(self, first: Connect, tell: Tell, is_watched: Callable[[], bool]) -> None:
        self._first = first
        self._units = VirtualLine()
        self._worker = Worker(tell, is_watched, self._units)

    def start(self) -> None:
        """Begin to work."""
        self._worker.start()
        self._worker.give(self._first, Asked())

    def close(self) -> None:
        """End line, virtual units and thread."""
        self._worker.close()
        self._units.close()

    def greetings(self) -> list[dict[str, Any]]:
        """The state of the connection."""
        return [self._worker.state_as_json()]

    def take(self, text: str, client: int, is_late: IsLate) -> Aside | None:
        """Take what a browser says."""
        order, asked = read_order(text)
        asked = replace(asked, client=client)
        late = is_late(asked.beat)
        if isinstance(order, Stop):
            self._worker.stop(asked, order.nodes)  # better late than never
        elif isinstance(order, ListPorts):
            return ports
        elif isinstance(order, Hold):
            self._hold(order, client, late)
        elif isinstance(order, SetInput):
            if late:
                raise Late
            return partial(self._set_input, order)
        elif late and not isinstance(order, Forget):
            self._worker.refuse(order, asked, Late())
        else:
            self._worker.give(order, asked)
        return None

    def leave(self, client: int) -> None:
        """A browser has gone."""
        self._worker.lose(client)

    def _hold(self, order: Hold, client: int, late: bool) -> None:
        """What comes too late, or without a line, holds nothing."""
        if not order.held:
            self._worker.let_go(client)
        elif not late and self._worker.state.connected:
            self._worker.holds.hold(client)

    def _set_input(self, order: SetInput) -> None:
        state = self._worker.state
        if not (state.connected and state.virtual):
            raise BadRequest(
                f"only the port {virtual.NAME} has inputs that can be set here; "
                "those of a unit are wires"
            )
        self._units.set_input(f"{state.node}.{order.number}", order.level)
