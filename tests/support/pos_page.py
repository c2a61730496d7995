"""The page of a positioning unit in a browser, as a user has it before them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Self

from playwright.sync_api import Browser, Locator, expect
from service_page import NOT_KNOWN
from tab import DESK, PATIENCE_SECONDS, shown_number
from unit_page import UnitPage, UnitService, unit_shown


class PosService(UnitService):
    """A running `positioning service`."""

    module = "rkm04_tools.positioning"


class PosPage(UnitPage):
    """One page in one browser. It fails at its end if a script of the page has failed."""

    def ready(self) -> Self:
        """Wait until it shows a unit."""
        expect(self.at("state")).to_have_attribute("data-kind", "good")
        expect(self.at("position-1")).not_to_have_text(NOT_KNOWN)
        return self

    def doing(self, name: str, axis: int = 1) -> None:
        """Wait for the state of an axis, by its name."""
        expect(self.at(f"state-{axis}")).to_have_text(re.compile(f"^{name} "))

    def bit(self, name: str, axis: int = 1) -> Locator:
        """A bit of an axis; `data-level` is 1 or 0."""
        return self.at(f"bits-{axis}").get_by_text(name, exact=True)

    def move(self, mm: str, feed: str = "600", axis: int = 1) -> None:
        """Fill in a motion and begin it, after the danger was confirmed."""
        self.confirm_danger()
        self.at(f"way-{axis}").fill(mm)
        self.at(f"feed-value-{axis}").fill(feed)
        self.at(f"move-{axis}").click()

    def mm(self, axis: int = 1) -> float:
        """The position of an axis, once it is known."""
        return shown_number(self.at(f"position-{axis}"))

    def beyond(self, mm: float, axis: int = 1) -> None:
        """Wait until an axis has gone beyond a position."""
        for _ in range(10 * PATIENCE_SECONDS):
            if self.mm(axis) > mm:
                return
            self.page.wait_for_timeout(100)
        raise AssertionError(f"axis {axis} stays at {self.mm(axis)}, wanted beyond {mm}")

    def setting(self, name: str) -> Locator:
        """The field of a setting."""
        return self.at(f"setting-{name}")

    def part(self, name: str) -> None:
        """Choose whose settings are shown."""
        self.page.locator(f"input[name=part][value={name}]").check(force=True)


@contextmanager
def pos_shown(
    browser: Browser, url: str, size: tuple[int, int] = DESK, locale: str = "en-GB"
) -> Iterator[PosPage]:
    """Open the page in a browser of its own."""
    with unit_shown(PosPage, browser, url, size, locale) as page:
        yield page
