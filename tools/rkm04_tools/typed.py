"""What was typed at a terminal and not read yet."""

from __future__ import annotations

import sys
from contextlib import suppress


def forget_typed() -> None:
    """What was typed before a question was no answer to it; not for piped input."""
    if sys.platform == "win32":
        import msvcrt

        while msvcrt.kbhit():
            msvcrt.getwch()
    else:
        import termios

        with suppress(termios.error, OSError):  # it has gone: the next reading tells that
            termios.tcflush(sys.stdin.fileno(), termios.TCIFLUSH)
