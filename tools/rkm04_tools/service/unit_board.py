"""What all browsers know about a connection and its unit; whoever changes it tells them."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from threading import RLock
from typing import Any, Generic, TypeVar

Tell = Callable[[dict[str, Any]], None]


@dataclass(frozen=True)
class LineState:
    """`busy`: what is being done.

    `halt`: "asked", or "failed" as the last one is not confirmed; None: it is, or there was none.
    `restarted`: the unit has started anew, and nobody has taken note of it yet. `away`: the port
    was lost, and is opened again when it is there.
    """

    connected: bool = False
    port: str | None = None
    virtual: bool = False
    version: str | None = None
    busy: str | None = None
    error: dict[str, Any] | None = None
    away: bool = False
    halt: str | None = None
    restarted: bool = False


State = TypeVar("State", bound=LineState)


class Board(Generic[State]):
    """The state, for any thread. `words` makes more of it for browsers."""

    def __init__(
        self, tell: Tell, first: State, words: Callable[[State], dict[str, Any]] = lambda state: {}
    ) -> None:
        self.tell = tell
        self.lock = RLock()
        self.state = first
        self.heard_at: float | None = None
        """When the unit answered last."""
        self._words = words

    def change(self, **changes: Any) -> None:
        """Change fields, and tell all browsers if that is news."""
        with self.lock:
            before = self.state
            self.state = replace(before, **changes)
            if self.state != before:
                self.tell(self.as_json())

    def as_json(self) -> dict[str, Any]:
        """What browsers know now, and how long ago the unit answered; None: it never has."""
        with self.lock:
            state = self.state
        ago = None if self.heard_at is None else round(time.monotonic() - self.heard_at, 1)
        return {"type": "state", **vars(state), **self._words(state), "seen_ago_s": ago}
