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

from playwright.sync_api import Browser, Locator, Page, WebSocket
from service_page import DESK, PATIENCE_SECONDS

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


class UnitPage:
    """One page in one browser. It fails at its end if a script of the page has failed."""

    def __init__(self, page: Page, url: str) -> None:
        self.page = page
        self.sent: list[str] = []
        self.faults: list[str] = []
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("websocket", self._listen)
        page.goto(url)

    def _listen(self, socket: WebSocket) -> None:
        socket.on("framesent", lambda frame: self.sent.append(json.loads(frame)["type"]))

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
    """Open the page in a browser of its own."""
    width, height = size
    context = browser.new_context(viewport={"width": width, "height": height}, locale=locale)
    context.set_default_timeout(PATIENCE_SECONDS * 1000)
    try:
        page = kind(context.new_page(), url)
        yield page
        assert page.faults == []
    finally:
        context.close()
