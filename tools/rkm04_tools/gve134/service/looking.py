"""What the unit does now, as the line tells it, and the way that it has made."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from rkm04_tools.gve134.sending import causes_of
from rkm04_tools.gve134.state import INTA, INTERRUPTS, Flags, Positions
from rkm04_tools.gve134.unit import Unit

PAUSE_SECONDS = 2.0
"""Looks that are further apart tell no speed."""
POSSIBLE = 250_000
"""Pulses/s, with a margin for the time of a look; what is faster is a position that was written."""
SELDOM_SECONDS = 2.0
"""From one question for late pulses to the next."""
PLACES_MAX = 20_000
"""Of the way made; of a longer one every other place is left out."""


@dataclass
class Looks:
    """Looks at a unit; to be used from one thread. Nothing here changes anything there."""

    flags: Flags | None = None
    positions: Positions | None = None
    causes: list[str] = field(default_factory=list)
    late: int | None = None
    _inputs: list[int] | None = None
    _seldom_due: float = 0.0
    _before: tuple[float, Positions] | None = None

    def look(self, unit: Unit, with_inputs: bool = True) -> dict[str, Any]:
        """Ask for state and positions, and less often for what seldom changes.

        In this order, so that axes which stand by their flags are at these positions.
        """
        flags = Flags(int(unit.order("F").values, 16))
        positions, now = unit.positions(), time.monotonic()
        if with_inputs or self._inputs is None:
            bits = [int(unit.order(port).values, 16) for port in ("I1", "I2")]
            self._inputs = [(bits[0] | bits[1] << 8) >> n & 1 for n in INTERRUPTS]
        if not flags.has(INTA):
            self.causes = []
        elif not self.causes:
            self.causes = causes_of(unit, flags)
        if with_inputs and now >= self._seldom_due:
            self._seldom_due = now + SELDOM_SECONDS
            late = unit.link.ask("SR7")
            self.late = int(late.values, 16) if late.code == 0 else None
        self.flags, self.positions = flags, positions
        return {
            "type": "live",
            "time_s": round(now, 3),
            "positions": positions,
            "speeds": self._speeds(now, positions),
            "flags": flags.bits,
            "inputs": self._inputs,
            "causes": self.causes,
            "late": self.late,
        }

    def _speeds(self, now: float, positions: Positions) -> list[float | None]:
        """The mean from one look to the next."""
        before, self._before = self._before, (now, positions)
        if before is None or not 0 < now - before[0] < PAUSE_SECONDS:
            return [None] * len(positions)
        passed = now - before[0]
        found = [(new - old) / passed for old, new in zip(before[1], positions, strict=True)]
        return [round(speed, 1) if abs(speed) <= POSSIBLE else None for speed in found]


class Made:
    """The way that the axes have made, as far as it was seen."""

    def __init__(self) -> None:
        self._places: list[Positions] = []

    def clear(self) -> None:
        """Begin anew."""
        self._places = []

    def go(self, corners: Iterable[Positions], at: Positions) -> list[Positions]:
        """Go on by corners that were passed to a place; those that are new."""
        new = [*corners, at]
        if self._places and new == self._places[-1:]:
            return []
        self._places += new
        if len(self._places) > PLACES_MAX:
            self._places = self._places[::2]
        return new

    def as_json(self) -> dict[str, Any]:
        """All of it; only X, Y, Z are drawn."""
        return {"type": "made", "places": [place[:3] for place in self._places]}
