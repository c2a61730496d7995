"""A bar for work that takes a while: on a terminal only, and gone when the work is done."""

from __future__ import annotations

import os
import sys
from types import TracebackType

WIDTH = 30
COLUMNS_UNKNOWN = 1000


class Bar:
    """Shows a bar on standard error while the block runs."""

    def __init__(self, what: str) -> None:
        self.what = what
        self._shown = False

    def __enter__(self) -> Bar:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.clear()

    def clear(self) -> None:
        """Take the bar away, before something else is printed."""
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
        self._shown = False

    def show(self, done: int, total: int, more: str = "") -> None:
        """Say how many of how many parts are done, and what else there is to say."""
        if total < 2 or not sys.stderr.isatty():
            return
        words = f"] {done}/{total}, {100 * done // total} %{more}"
        columns = _columns()
        width = max(0, min(WIDTH, columns - len(self.what) - len(words) - 3))
        filled = ("#" * (width * done // total)).ljust(width, ".")
        self._put(f"{self.what} [{filled}{words}"[: columns - 1])

    def say(self, text: str) -> None:
        """Say how it stands where the end is not known."""
        if sys.stderr.isatty():
            self._put(text[: _columns() - 1])

    def _put(self, text: str) -> None:
        self._shown = True
        print(f"\r{text}\x1b[K", end="", file=sys.stderr, flush=True)


def _columns() -> int:
    """Of the terminal: a bar that is longer could not be taken away."""
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns or COLUMNS_UNKNOWN
    except (OSError, ValueError):
        return COLUMNS_UNKNOWN
