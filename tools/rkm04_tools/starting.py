"""Ctrl-C while Python loads the tools: kept until there is somebody who takes it.

In the middle of an import it would be a traceback, or be lost. tools/rkm04 starts Python with the
signal held back already.
"""

from __future__ import annotations

import signal


def hold_interrupts() -> None:
    """Keep SIGINT for later."""
    _mask("SIG_BLOCK")


def take_interrupts() -> None:
    """Take SIGINT from now on; one that was kept is raised here."""
    _mask("SIG_UNBLOCK")


def _mask(how: str) -> None:
    if hasattr(signal, "pthread_sigmask"):  # not on Windows
        signal.pthread_sigmask(getattr(signal, how), {signal.SIGINT})
