"""What a step of the walk is, and what it has to do with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rkm04_tools.board_header import Board
from rkm04_tools.bringup.findings import Seen
from rkm04_tools.bringup.person import Person
from rkm04_tools.bringup.talk import Talk


@dataclass(frozen=True)
class Bench:
    """The board on the bench, and who stands before it."""

    board: str
    header: Board
    talk: Talk
    person: Person
    patience: float
    """Seconds without anything new after which waiting for the person's hands ends."""
    seen: list[Seen] = field(default_factory=list)
    """Of the step under way, where it asks in between: kept if it does not come to its end."""

    def has(self, signal: str) -> bool:
        """Whether the board has a pin for it."""
        return any(pin.signal == signal for pin in self.header.pins)

    def pin_of(self, signal: str) -> str:
        """The pin of a signal, as in PA15."""
        return next(f"P{pin.pin}" for pin in self.header.pins if pin.signal == signal)


@dataclass(frozen=True)
class Step:
    """One screen."""

    name: str
    do: str
    """What to connect, and what will happen."""
    expect: str
    run: Callable[[Bench], list[Seen]]
