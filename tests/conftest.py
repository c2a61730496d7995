"""What holds for all tests in Python."""

from __future__ import annotations

import os
import signal
from collections.abc import Generator
from pathlib import Path
from types import FrameType

import pytest
from chance import SEED

HANG_SECONDS = 600
"""No test takes a tenth of it, but the sweeps of the long run."""


def pytest_configure() -> None:
    """Give the same chance to all processes that share the tests.

    A shell lets what it starts in the background ignore SIGINT, which processes of tests would
    inherit: those that wait for a Ctrl+C would wait for ever.
    """
    os.environ["RKM04_SEED"] = str(SEED)
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Spread the files whose tests mostly wait, those of pages, among the others.

    Processes that share the tests take file after file, so that some wait while others compute.
    """
    files: dict[Path, list[pytest.Item]] = {}
    for item in items:
        files.setdefault(item.path, []).append(item)
    pages = [path for path in files if path.parent.name == "page"]
    others = [path for path in files if path.parent.name != "page"]
    place = {
        path: (at + 0.5) / len(group) for group in (pages, others) for at, path in enumerate(group)
    }
    order = sorted(files, key=lambda path: place[path])
    items[:] = [item for path in order for item in files[path]]


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
