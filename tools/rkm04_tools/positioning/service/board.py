"""What all browsers know about connection and unit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rkm04_tools.service import unit_board
from rkm04_tools.service.unit_board import LineState


@dataclass(frozen=True)
class State(LineState):
    """`doubt`: something that moves an axis was asked for and not answered, and nobody has looked
    since then. `unheld`: the axes of which no stop is confirmed since one was asked for."""

    node: int = 1
    doubt: bool = False
    unheld: tuple[int, ...] = ()


Board = unit_board.Board[State]

NOT_CONNECTED: dict[str, Any] = {
    "connected": False, "version": None, "error": None, "away": False, "restarted": False,
    "doubt": False,
}  # fmt: skip
