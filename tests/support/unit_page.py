"""The page of a unit in a browser, as a user has it before them."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar

from playwright.sync_api import Browser, Locator
from tab import DESK, PATIENCE_SECONDS, Visit, opened_tab

ROOT = Path(__file__).resolve().parents[2]


class UnitService:
    """A running `service` of a unit's `module`."""

    module = ""

    def __init__(self, *arguments: str, listen: int = 0) -> None:
        self._process = subprocess.Popen(
            [*self._command(), "--listen", str(listen), *arguments], stdout=subprocess.PIPE,
            text=True, env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        )  # fmt: skip
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        assert line
        self.url: str = json.loads(line)["url"]

    def _command(self) -> list[str]:
        return [sys.executable, "-P", "-m", self.module, "service", "--no-browser", "--json"]

    def tell(self, number: int) -> None:
        """Send it a signal."""
        self._process.send_signal(number)

    def end(self, number: int = signal.SIGTERM) -> None:
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGCONT)
            self._process.send_signal(number)
        self._process.wait(PATIENCE_SECONDS)
        if self._process.stdout:
            self._process.stdout.close()


class UnitPage(Visit):
    """The page of a unit's service."""

    def at(self, name: str) -> Locator:
        """The part of an id."""
        return self.page.locator(f"#{name}")

    def confirm_danger(self) -> None:
        """Say that the danger was read, before which nothing is moved by hand."""
        self.at("danger-confirm").check()

    @property
    def answers(self) -> Locator:
        """The log, the youngest answer first."""
        return self.page.locator("#log .log-item")


Shown = TypeVar("Shown", bound=UnitPage)


@contextlib.contextmanager
def unit_shown(
    kind: type[Shown], browser: Browser, url: str,
    size: tuple[int, int] = DESK, locale: str = "en-GB",
) -> Iterator[Shown]:  # fmt: skip
    """Open the page in a tab of its own."""
    with opened_tab(browser, size, locale) as tab:
        page = kind(tab, url)
        yield page
        assert page.faults == []
