"""What all browsers know about connection and job of a GVE134."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from rkm04_tools.gve134.known import Known
from rkm04_tools.service import unit_board
from rkm04_tools.service.unit_board import LineState, Tell


@dataclass(frozen=True)
class State(LineState):
    """`reference`: a reference run, in which the unit tells nothing. `wanted`: the speed that is
    being brought about, per cent.
    """

    reference: bool = False
    known: Known = field(default_factory=Known)
    wanted: int | None = None
    job: dict[str, Any] | None = None
    file: dict[str, Any] | None = None
    machine: dict[str, Any] | None = None


NOT_CONNECTED: dict[str, Any] = {
    "connected": False, "version": None, "reference": False, "error": None, "away": False,
    "restarted": False, "known": Known(), "wanted": None, "job": None,
}  # fmt: skip

Board = unit_board.Board[State]


def make_board(tell: Tell) -> Board:
    """The board of a unit that is not connected."""
    return Board(tell, State(), _words)


def _words(state: State) -> dict[str, Any]:
    return {"known": {**asdict(state.known), "percent": state.known.percent}}
