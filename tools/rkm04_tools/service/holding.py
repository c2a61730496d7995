"""Buttons that make a motor run as long as they are held: who still holds one."""

from __future__ import annotations

import time
from threading import Lock

HOLD_SECONDS = 0.7
"""A page says several times a second that its button is held; after this silence it has let go."""


class Holds:
    """The browsers that hold a button, by number; any thread may call."""

    def __init__(self) -> None:
        self._ends: dict[int | None, float] = {}
        self._lock = Lock()

    def hold(self, client: int | None) -> None:
        """Say that a browser holds its button, also from now on."""
        with self._lock:
            self._ends[client] = time.monotonic() + HOLD_SECONDS

    def let_go(self, client: int | None) -> None:
        """Say that a browser has let go, and sees to the stop itself."""
        with self._lock:
            self._ends.pop(client, None)

    def lose(self, client: int | None) -> None:
        """Say that a browser will say nothing more: what it holds is lost now."""
        with self._lock:
            if client in self._ends:
                self._ends[client] = time.monotonic()

    def rest_seconds(self) -> float | None:
        """Until the first of them is lost; None: nobody holds a button."""
        with self._lock:
            return max(0.0, min(self._ends.values()) - time.monotonic()) if self._ends else None

    def is_lost(self) -> bool:
        """Whether a browser that held a button has fallen silent."""
        return self.rest_seconds() == 0.0

    def forget(self) -> None:
        """Nobody holds a button any more."""
        with self._lock:
            self._ends.clear()
