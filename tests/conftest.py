"""What holds for all tests in Python."""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Generator
from types import FrameType

import pytest
from chance import SEED

HANG_SECONDS = 600
"""No test takes a tenth of it, but the sweeps of the long run."""


def pytest_configure() -> None:
    """Give the same chance to all processes that share the tests.

    A shell lets what it starts in the background ignore SIGINT and SIGQUIT, which processes of
    tests would inherit: those that wait for a Ctrl+C would wait for ever.
    """
    os.environ["RKM04_SEED"] = str(SEED)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)
    gc.disable()


def pytest_collection_finish() -> None:
    """Have garbage sought among what tests make only: they are thousands themselves."""
    gc.freeze()
    gc.enable()


@pytest.hookimpl(wrapper=True)
def fail_that_hangs(item: pytest.Item) -> Generator[None, object, object]:
    """Have a test fail that hangs, as on a child that does not end, and go on with the next.

    The alarm comes again, as a test may be tried anew to find its shortest failure.
    """

    def fail(_number: int, _frame: FrameType | None) -> None:
        pytest.fail(f"{item.nodeid} has not ended after {HANG_SECONDS} s")

    if "RKM04_LONG" not in os.environ:
        signal.signal(signal.SIGALRM, fail)
        signal.setitimer(signal.ITIMER_REAL, HANG_SECONDS, HANG_SECONDS / 10)
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


pytest_runtest_setup = pytest_runtest_call = pytest_runtest_teardown = fail_that_hangs


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Tell what repeats the run."""
    terminalreporter.write_line(f"RKM04_SEED={SEED}")
