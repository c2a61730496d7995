"""The page of a GVE134 in a browser, as a user has it before them."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, WebSocket, expect
from service_page import DESK, NOT_KNOWN, PATIENCE_SECONDS

ROOT = Path(__file__).resolve().parents[2]
COMMAND = [
    sys.executable, "-P", "-m", "rkm04_tools.gve134", "service", "--no-browser", "--json",
]  # fmt: skip


class GveService:
    """A running `gve134 service`."""

    def __init__(self, *arguments: str, listen: int = 0) -> None:
        self._process = subprocess.Popen(
            [*COMMAND, "--listen", str(listen), *arguments], stdout=subprocess.PIPE, text=True,
            env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        )  # fmt: skip
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        assert line
        self.url: str = json.loads(line)["url"]

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


class GvePage:
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

    def ready(self) -> GvePage:
        """Wait until it shows a unit."""
        expect(self.at("state")).to_have_attribute("data-kind", "good")
        expect(self.at("position-X")).not_to_have_text(NOT_KNOWN)
        return self

    def open(self, name: str, text: str) -> None:
        """Open a file of the user."""
        file = {"name": name, "mimeType": "text/plain", "buffer": text.encode()}
        self.at("file").set_input_files(file)  # type: ignore[arg-type]
        expect(self.at("file-name")).to_have_text(name)

    def example(self, name: str) -> None:
        """Open an example, and wait until it is drawn."""
        self.at("examples").select_option(name)
        expect(self.at("file-name")).to_have_text(name)
        expect(self.at("canvas")).to_have_attribute("data-plan", re.compile(r"[1-9]\d*"))

    def doing(self, words: str | re.Pattern[str]) -> None:
        """Wait for what the unit does."""
        expect(self.at("live-state")).to_have_text(words)

    @property
    def answers(self) -> Locator:
        """The log, the youngest answer first."""
        return self.page.locator("#log .log-item")

    def steps(self, axis: str = "X") -> int:
        """The position of an axis, pulses."""
        text = self.at(f"steps-{axis}").inner_text().replace("\N{MINUS SIGN}", "-")
        return int(re.sub(r"[^\d-]", "", text))

    def beyond(self, steps: int, axis: str = "X") -> None:
        """Wait until an axis has gone beyond a position."""
        for _ in range(10 * PATIENCE_SECONDS):
            if self.steps(axis) > steps:
                return
            self.page.wait_for_timeout(100)
        raise AssertionError(f"{axis} stays at {self.steps(axis)}, wanted beyond {steps}")


@contextlib.contextmanager
def gve_shown(
    browser: Browser, url: str, size: tuple[int, int] = DESK, locale: str = "en-GB"
) -> Iterator[GvePage]:
    """Open the page in a browser of its own."""
    width, height = size
    context = browser.new_context(viewport={"width": width, "height": height}, locale=locale)
    context.set_default_timeout(PATIENCE_SECONDS * 1000)
    try:
        page = GvePage(context.new_page(), url)
        yield page
        assert page.faults == []
    finally:
        context.close()
