"""What holds for all tests in Python."""

from __future__ import annotations

import os
import signal

import pytest
from chance import SEED


def pytest_configure() -> None:
    """Give the same chance to all processes that share the tests.

    A shell lets what it starts in the background ignore SIGINT, which processes of tests would
    inherit: those that wait for a Ctrl+C would wait for ever.
    """
    os.environ["RKM04_SEED"] = str(SEED)
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Tell what repeats the run."""
    terminalreporter.write_line(f"RKM04_SEED={SEED}")
