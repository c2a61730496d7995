"""What all browsers know about connection and job; whoever changes it tells them."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from threading import RLock
from typing import Any

from rkm04_tools.gve134.service.heard import Known

Tell = Callable[[dict[str, Any]], None]


@dataclass(frozen=True)
class State:
    """`busy`: what is being done. `reference`: a reference run, in which the unit tells nothing.

    `halt`: "asked", or "failed" as the last one is not confirmed; None: it is, or there was none.
    `restarted`: the unit has started anew, and nobody has taken note of it yet. `wanted` is the
    speed that is being brought about, per cent. `away`: the port was lost, and is opened again
    when it is there.
    """

    connected: bool = False
    port: str | None = None
    virtual: bool = False
    version: str | None = None
    busy: str | None = None
    reference: bool = False
    error: dict[str, Any] | None = None
    away: bool = False
    halt: str | None = None
    restarted: bool = False
    known: Known = field(default_factory=Known)
    wanted: int | None = None
    job: dict[str, Any] | None = None
    file: dict[str, Any] | None = None
    machine: dict[str, Any] | None = None


NOT_CONNECTED: dict[str, Any] = {
    "connected": False, "version": None, "reference": False, "error": None, "away": False,
    "restarted": False, "known": Known(), "wanted": None, "job": None,
}  # fmt: skip


class Board:
    """The state, for any thread."""

    def __init__(self, tell: Tell) -> None:
        self.tell = tell
        self.lock = RLock()
        self.state = State()
        self.heard_at: float | None = None
        """When the unit answered last."""

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
        known = {**asdict(state.known), "percent": state.known.percent}
        return {"type": "state", **vars(state), "known": known, "seen_ago_s": ago}
