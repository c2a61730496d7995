"""A port and the unit at its end. To be used from the worker's thread."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, Generic, TypeVar

from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import LineError, PortError
from rkm04_tools.service import virtual
from rkm04_tools.service.trouble import Fault, NotConnected
from rkm04_tools.service.unit_board import Board, State
from rkm04_tools.service.unit_orders import Connect
from rkm04_tools.service.words import Words

Unit = TypeVar("Unit")


class UnitLine(ABC, Generic[Unit, State]):
    """`unit` is None where no port is open; `gone` is what a state has then."""

    restarted: type[LineError]
    """The error by which the client tells that the unit has started anew."""

    def __init__(self, board: Board[State], gone: Mapping[str, Any], words: Words) -> None:
        self.unit: Unit | None = None
        self.look_due = 0.0
        self.words = words
        self._board = board
        self._gone = dict(gone)

    # ---- what each unit has of its own ----

    @abstractmethod
    def _open(self, port: str) -> None:
        """Open a port, and set `unit`."""

    @abstractmethod
    def _greet(self, unit: Unit) -> str:
        """See whether the unit is there, and what it does; its version."""

    @abstractmethod
    def take_back(self) -> None:
        """What waits in the port is not sent any more."""

    @abstractmethod
    def _drop(self) -> None:
        """Close what was opened; what waits in it is not sent any more."""

    @abstractmethod
    def look(self, unit: Unit) -> None:
        """Look at the unit, and tell what there is to be seen."""

    @abstractmethod
    def version_of(self, unit: Unit) -> str:
        """The version, after a look."""

    @abstractmethod
    def forget(self) -> None:
        """The unit has started anew: what it was told is gone."""

    def of_connect(self, order: Connect) -> dict[str, Any]:
        """What a state has of the connection that is asked for."""
        return {"port": order.port, "virtual": order.port == virtual.NAME}

    # ---- the port ----

    def connect(self, order: Connect) -> str:
        """Open the port if it is not open, and ask what is there: nothing moves."""
        wanted = self.of_connect(order)
        if not self.unit or any(vars(self._board.state)[name] != wanted[name] for name in wanted):
            self.close()
            self._board.heard_at = None
            self._board.change(**{**self._gone, **wanted})
            self._open(order.port)
        self._board.change(connected=True)
        assert self.unit is not None
        version = self._greet(self.unit)
        self._board.change(version=version, error=None)
        return version

    def disconnect(self) -> str:
        """Close the port."""
        self.close()
        self._board.change(**{**self._gone, "port": None, "virtual": False})
        return "the port is closed; the unit is left as it is"

    def reopen(self) -> Unit:
        """The unit; a port that was lost is opened again."""
        if not self.unit:
            self._open(self._board.state.port or "")
            self._board.change(connected=True, away=False, version=None)
        assert self.unit is not None
        return self.unit

    def close(self) -> None:
        """Close the port; what waits in it is not sent any more."""
        self._drop()
        self.unit = None

    # ---- what has come of it ----

    def restart(self) -> None:
        """The unit has started anew."""
        self.forget()
        self._board.change(restarted=True)

    def note(self, got: object, comes_back: bool = True) -> None:
        """Keep what says that there is no connection; a port that is lost is closed.

        A port that `comes_back` is opened again when it is there; virtual units need the user.
        """
        board = self._board
        if not isinstance(got, Failure):
            board.change(error=None)
        elif isinstance(got, self.restarted):
            self.restart()
        elif isinstance(got, PortError):
            self.close()
            is_virtual = board.state.virtual
            error = virtual.ended() if is_virtual and not isinstance(got, Fault) else got
            away = comes_back and not is_virtual
            lost = {**self._gone, "error": self.words.told(error), "away": away}
            board.change(**{**lost, **self.kept_when_lost()})
        elif isinstance(got, LineError):
            board.change(error=self.words.told(got), **self.when_silent())
        elif not self.unit and not isinstance(got, NotConnected):
            board.change(connected=False, error=self.words.told(got))

    def kept_when_lost(self) -> dict[str, Any]:
        """What of a state stays as it is when the port is lost."""
        return {"restarted": self._board.state.restarted}

    def when_silent(self) -> dict[str, Any]:
        """What of a state changes where the unit does not answer."""
        return {}
