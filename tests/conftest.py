"""What holds for all tests in Python."""

from __future__ import annotations

import os

import pytest
from chance import SEED


def pytest_configure() -> None:
    """Give the same chance to all processes that share the tests."""
    os.environ["RKM04_SEED"] = str(SEED)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Tell what repeats the run."""
    terminalreporter.write_line(f"RKM04_SEED={SEED}")
