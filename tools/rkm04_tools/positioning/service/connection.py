"""The port, the unit at its end, and what is seen of it. To be used from the worker's thread."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rkm04_tools.positioning import settings
from rkm04_tools.positioning.line_errors import Restarted
from rkm04_tools.positioning.service.board import NOT_CONNECTED, Board, State
from rkm04_tools.positioning.service.looking import Looks
from rkm04_tools.positioning.settings import Values
from rkm04_tools.positioning.unit import Unit
from rkm04_tools.positioning.wire import FORMAT, RATE, open_wire
from rkm04_tools.service import virtual
from rkm04_tools.service.unit_line import UnitLine
from rkm04_tools.service.unit_orders import Connect
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.service.words import Words

LOOK_SECONDS = 0.1
"""From one look to the next at least."""
WATCHDOG_SHARE = 0.25


@dataclass(frozen=True)
class LineForm:
    """Rate and format of serial devices."""

    rate: int = RATE
    form: str = FORMAT


class Connection(UnitLine[Unit, State]):
    """`looks` is what was seen last; `settings` are None where they are not known."""

    restarted = Restarted

    def __init__(
        self, board: Board, units: VirtualLine, form: LineForm, mind_halt: Callable[[], None]
    ) -> None:
        super().__init__(board, NOT_CONNECTED, Words("positioning"))
        self.looks = Looks()
        self.settings: Values | None = None
        self._units = units
        self._form = form
        self._mind_halt = mind_halt

    def of_connect(self, order: Connect) -> dict[str, Any]:
        """What a state has of the connection that is asked for; the virtual unit is number 1."""
        found = super().of_connect(order)
        return {**found, "node": 1 if found["virtual"] else order.node}

    def connect(self, order: Connect) -> str:
        """Open the port if it is not open, and ask what is there: nothing moves."""
        wanted, state = self.of_connect(order), self._board.state
        if (state.port, state.node) != (wanted["port"], wanted["node"]):
            self.looks = Looks()
        return super().connect(order)

    def _open(self, port: str) -> None:
        place = self._units.open() if port == virtual.NAME else port
        wire = open_wire(place, self._board.state.node, self._form.rate, self._form.form)
        wire.look = self._mind_halt
        self.unit = Unit(wire)

    def _greet(self, unit: Unit) -> str:
        self.look(unit)
        return self.version_of(unit)

    def version_of(self, unit: Unit) -> str:
        """The version, after a look."""
        return self.looks.unit.version if self.looks.unit else ""

    def take_back(self) -> None:
        """What waits in the port is not sent any more."""
        if self.unit:
            self.unit.wire.take_back()

    def _drop(self) -> None:
        if self.unit:
            self.unit.wire.abandon()
        self.tell_settings(None)

    def forget(self) -> None:
        """The unit has started anew: what it was told is gone."""
        self.looks = Looks()
        self.tell_settings(None)
        self._board.change(doubt=False)

    def kept_when_lost(self) -> dict[str, Any]:
        """What of a state stays as it is when the port is lost."""
        return {**super().kept_when_lost(), "doubt": self._board.state.doubt}

    # ---- what is seen ----

    def look(self, unit: Unit) -> None:
        """Look at the unit, and tell what there is to be seen."""
        self.look_due = time.monotonic() + min(LOOK_SECONDS, self.pause_most_seconds)
        seen = self.looks.look(unit)
        self._board.heard_at = time.monotonic()
        self._board.tell(seen)
        self._board.change(doubt=False)
        if self.settings is None:
            self.read_settings(unit)

    @property
    def pause_most_seconds(self) -> float:
        """How long the line may rest, so that the unit's WATCHDOG does not act."""
        watchdog_ms = self.settings[settings.UNIT_PART]["WATCHDOG"] if self.settings else 0
        return watchdog_ms / 1000 * WATCHDOG_SHARE if watchdog_ms else math.inf

    def read_settings(self, unit: Unit) -> None:
        """Read all settings, and tell them."""
        self.tell_settings(settings.read_all(unit))

    def tell_settings(self, found: Values | None) -> None:
        """Tell the settings."""
        if found != self.settings or found is not None:
            self.settings = found
            self._board.tell(self.settings_as_json())

    def settings_as_json(self) -> dict[str, Any]:
        """The settings, and the file that keeps them."""
        file = settings.text_of(self.settings) if self.settings else None
        return {"type": "settings", "values": self.settings, "file": file}
