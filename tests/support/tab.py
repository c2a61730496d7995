"""A tab of a browser, which tests may have one after the other: to open one is half of a test."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Callable, Iterator
from typing import TypeVar

from playwright.sync_api import Browser, Error, Locator, Page, WebSocket, expect

PATIENCE_SECONDS = 30
DESK = (1400, 900)
FORGET = "localStorage.clear(); sessionStorage.clear()"


class Visit:
    """What is done in a tab from one address on. A script of the page that fails is a fault."""

    def __init__(self, page: Page, url: str) -> None:
        self.page = page
        self.sent: list[str] = []
        """Types of all that the page has sent to the service."""
        self.has_acted = False
        """Whether it has ever sent more than a question for ports."""
        self.faults: list[str] = []
        page.on("pageerror", self._note)
        page.on("websocket", self._listen)
        page.goto(url)

    def _note(self, error: Error) -> None:
        self.faults.append(str(error))

    def _listen(self, socket: WebSocket) -> None:
        socket.on("framesent", self._note_sent)

    def _note_sent(self, frame: str | bytes) -> None:
        kind = json.loads(frame)["type"]
        self.sent.append(kind)
        self.has_acted = self.has_acted or kind != "ports"

    def leave(self) -> None:
        """Leave the tab as if it were new."""
        self.page.remove_listener("pageerror", self._note)
        self.page.remove_listener("websocket", self._listen)
        self.page.unroute_all()
        self.page.evaluate(FORGET)
        self.page.goto("about:blank")
        self.page.emulate_media(media="null", color_scheme="null")
        self.page.set_viewport_size({"width": DESK[0], "height": DESK[1]})


def shown_number(place: Locator) -> float:
    """What stands there, once it is known; it may become unknown at any time."""
    while not re.search(r"\d", text := place.inner_text()):
        expect(place).to_have_text(re.compile(r"\d"))
    return float(re.sub(r"[^\d.-]", "", text.replace("\N{MINUS SIGN}", "-")))


@contextlib.contextmanager
def opened_tab(
    browser: Browser, size: tuple[int, int] = DESK, locale: str = "en-GB", touch: bool = False
) -> Iterator[Page]:
    """One that shares nothing with other ones."""
    width, height = size
    context = browser.new_context(
        viewport={"width": width, "height": height}, locale=locale, has_touch=touch
    )
    context.set_default_timeout(PATIENCE_SECONDS * 1000)
    try:
        yield context.new_page()
    finally:
        context.close()


Visited = TypeVar("Visited", bound=Visit)


@contextlib.contextmanager
def visited(kind: Callable[[Page, str], Visited], tab: Page, url: str) -> Iterator[Visited]:
    """Show an address in a tab that was shown before, and will be again."""
    visit = kind(tab, url)
    try:
        yield visit
        assert visit.faults == []
    finally:
        visit.leave()
