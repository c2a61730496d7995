"""The worker of a positioning unit: orders go to its axes one by one, stops ahead of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import LineError
from rkm04_tools.positioning.service import acting
from rkm04_tools.positioning.service.board import Board, State
from rkm04_tools.positioning.service.connection import Connection, LineForm
from rkm04_tools.positioning.service.orders import ALL_AXES, Capture, Release, Write
from rkm04_tools.positioning.service.stopping import Stop
from rkm04_tools.positioning.table import Register, registers
from rkm04_tools.positioning.unit import Unit
from rkm04_tools.service.trouble import BadRequest, Late, NotConnected
from rkm04_tools.service.turns import Turns
from rkm04_tools.service.unit_board import Tell
from rkm04_tools.service.unit_orders import Plain
from rkm04_tools.service.virtual import VirtualLine


class Worker(Turns[Unit]):
    """Takes orders from any thread; `tell` gets all that browsers are to know.

    `is_watched` says whether anybody wants to know what the unit does.
    """

    def __init__(
        self, tell: Tell, is_watched: Callable[[], bool], units: VirtualLine, form: LineForm
    ) -> None:
        board = Board(tell, State())
        self._line = Connection(board, units, form, self._mind_halt)
        super().__init__(board, self._line, is_watched)
        self._unheld: set[int] = set()
        """Axes of which a stop was asked for: only one of that axis ends it."""
        self._asked: set[int] = set()

    def greetings(self) -> list[dict[str, Any]]:
        """What a browser that comes is told."""
        rows = [_row(row) for row in registers().values() if row.is_setting]
        return [
            {"type": "rows", "rows": rows}, self.board.as_json(), self._line.settings_as_json()
        ]  # fmt: skip

    def _act(self, unit: Unit, order: Any) -> str:
        if isinstance(order, Plain):
            return acting.keep(self._line, unit, order)
        if isinstance(order, Write):
            return acting.write(self._line, unit, order)
        if self.board.state.restarted and not isinstance(order, Release | Capture):
            raise BadRequest("the unit has restarted; take note of that first")
        is_late = self._asked_now.is_late
        if is_late():
            raise Late
        try:
            with unit.wire.until(is_late):
                return acting.act(self._line, unit, order)
        except LineError:
            self.board.change(doubt=True)
            raise

    def halt_name(self, what: Any) -> str:
        """A stop is one of all axes."""
        return "halt" if what == ALL_AXES else "hold"

    def _begin_halt(self) -> dict[str, Any]:
        self._asked = set()
        with self._wakes:
            return self._note_asked([what for _, what in self._halts])

    def _more_halts(self) -> list[Any]:
        whats = super()._more_halts()
        self.board.change(**self._note_asked(whats))
        return whats

    def _note_asked(self, whats: list[Any]) -> dict[str, Any]:
        self._asked.update(axis for axes in whats for axis in axes)
        self._unheld |= self._asked
        return {"unheld": tuple(sorted(self._unheld))}

    def _end_halt(self, got: str | Failure) -> dict[str, Any]:
        if not isinstance(got, Failure):
            self._unheld -= self._asked
        unheld = tuple(sorted(self._unheld))
        return {"halt": "failed" if unheld else None, "unheld": unheld}

    def _send_halt(self, whats: list[Any]) -> str:
        """Stop, and see the axes stand."""
        if not self._line.unit:
            raise NotConnected
        first = [whats]
        return Stop(
            self._line, self._line.unit, lambda: first.pop() if first else self._more_halts()
        ).run()

    def _pause_seconds(self, looked_seconds: float) -> float:
        """A quarter of the line's time is left to orders; a stop waits for one request at most."""
        return min(looked_seconds / 4, self._line.pause_most_seconds)


def _row(row: Register) -> dict[str, Any]:
    """A setting, for the page."""
    return {
        "name": row.name, "part": "axis" if row.scope == "A" else "unit", "form": row.form,
        "least": row.all_values[0] if row.form == "ANY" else row.least,
        "most": row.all_values[-1] if row.form == "ANY" else row.most,
        "delivered": row.start, "unit": row.unit, "text": row.text,
    }  # fmt: skip
