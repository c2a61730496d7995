"""Keys that are pressed on a terminal while a command works, without Enter.

Only the process in the foreground of its terminal may look: others would be stopped by the system.
"""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Any

READ_BYTES = 64

if sys.platform == "win32":
    import msvcrt
else:
    import termios
    import tty


def are_there() -> bool:
    """Whether somebody sees what is shown, and can press keys."""
    if sys.stdin.closed:  # it was the file
        return False
    return sys.stdin.isatty() and sys.stderr.isatty() and _in_foreground()


def _in_foreground() -> bool:
    if sys.platform == "win32":
        return True
    try:
        return os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except OSError:
        return False


class Keys:
    """While the block runs, keys are not shown, and come one by one. Ctrl-C stays a signal."""

    def __init__(self) -> None:
        self._before: list[Any] | None = None

    def __enter__(self) -> Keys:
        self._take()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._give_back()

    @contextmanager
    def lines(self) -> Iterator[None]:
        """Inside this the terminal is as it was, for whole lines."""
        self._give_back()
        try:
            yield
        finally:
            self._take()

    def read(self) -> str:
        """What was pressed since the last call."""
        if sys.platform == "win32":
            pressed = ""
            while msvcrt.kbhit():
                pressed += msvcrt.getwch()
            return pressed
        number = sys.stdin.fileno()
        if (
            self._before is None
            or not _in_foreground()
            or not select.select([number], [], [], 0)[0]
        ):
            return ""
        try:
            return os.read(number, READ_BYTES).decode("latin-1")
        except OSError:
            return ""

    def _take(self) -> None:
        if sys.platform != "win32" and _in_foreground():
            with suppress(termios.error):
                self._before = termios.tcgetattr(sys.stdin)
                tty.setcbreak(sys.stdin, termios.TCSANOW)

    def _give_back(self) -> None:
        if sys.platform != "win32" and self._before is not None and _in_foreground():
            with suppress(termios.error):
                termios.tcsetattr(sys.stdin, termios.TCSANOW, self._before)
            self._before = None
