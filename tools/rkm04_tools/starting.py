"""Signals of a tool that starts.

Ctrl-C in the middle of an import would be a traceback, or be lost, so it is kept until there is
somebody who takes it. tools/rkm04 starts Python with the signal held back already. SIGTERM ends a
tool as an error does, so that nothing temporary and no half of a file is left.
"""

from __future__ import annotations

import signal
from types import FrameType
from typing import NoReturn

ENDED_BY = 128
"""What a shell adds to the number of a signal for the exit status."""


def begin_signals() -> None:
    """Keep SIGINT for later; end by SIGTERM in order."""
    _mask("SIG_BLOCK")
    signal.signal(signal.SIGTERM, _end)


def take_interrupts() -> None:
    """Take SIGINT from now on; one that was kept is raised here."""
    _mask("SIG_UNBLOCK")


def _end(number: int, frame: FrameType | None) -> NoReturn:
    raise SystemExit(ENDED_BY + number)


def _mask(how: str) -> None:
    if hasattr(signal, "pthread_sigmask"):  # not on Windows
        signal.pthread_sigmask(getattr(signal, how), {signal.SIGINT})
