"""Sessions with a GVE134 unit, and records of what it did in them."""

from __future__ import annotations

from dataclasses import dataclass, field

from gve_course import MS, Record
from gve_line import Byte
from reference import TICK_HZ

BYTE_TICKS = -(-10 * TICK_HZ // 115_200)
"""What a byte takes on the line."""


@dataclass(frozen=True)
class Edge:
    """An input, BI1 to BI8, that has a new level from a tick on."""

    tick: int
    number: int
    level: int


@dataclass(frozen=True)
class Session:
    """What comes to a unit and when, sorted by tick; ticks count from power-on."""

    line: tuple[Byte, ...]
    edges: tuple[Edge, ...] = ()
    end: int = 0
    epoch: int = 0
    ahead: int = 0
    cause: str = "power"
    """Why the unit starts: power, watchdog or crystal (it does not run)."""

    @property
    def text(self) -> str:
        """What comes, for people."""
        events = [(edge.tick, f"BI{edge.number}={edge.level}") for edge in self.edges]
        text, begin = "", 0
        for byte in self.line:
            begin = begin if text else byte.tick
            text += chr(byte.value) + ("~" if byte.broken else "")
            if byte.value == 13:
                events.append((byte.tick, text.replace("\r", "")))
                text = ""
        if text:
            events.append((self.line[-1].tick, text))
        return "\n".join(f"{tick / MS:10.3f} {what}" for tick, what in sorted(events))


@dataclass(frozen=True)
class Answer:
    """An answer without its CR: when its first byte began, and when its last one ended."""

    begin: int
    out: int
    text: str


@dataclass
class Done:
    """What a unit did in a session."""

    motors: Record
    answers: list[Answer] = field(default_factory=list)
    signals: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    """Of each signal the levels that it has from a tick on; 0 at first."""
    growing: bool = False
    """The model makes the answers, too, as it goes."""
    complaints: list[str] = field(default_factory=list)
    """Of those who watched the unit."""
