"""The page of a GVE134 in a browser, as a user has it before them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, Locator, expect
from service_page import NOT_KNOWN
from tab import PATIENCE_SECONDS, shown_number
from unit_page import UnitPage, UnitService, unit_shown


class GveService(UnitService):
    """A running `gve134 service`."""

    module = "rkm04_tools.gve134"


class GvePage(UnitPage):
    """One page in one browser. It fails at its end if a script of the page has failed."""

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

    def jog(self, button: str) -> None:
        """Press the button of a step, such as X+, after the danger was confirmed."""
        self.confirm_danger()
        self.jog_button(button).click()

    def jog_button(self, button: str) -> Locator:
        """Such as X+."""
        name = button.replace("-", "\N{MINUS SIGN}")
        return self.page.locator("#axes button").get_by_text(name, exact=True)

    def home(self, axis: str = "X") -> None:
        """Begin the reference run of an axis, likewise."""
        self.confirm_danger()
        self.page.locator("#axes").get_by_role("button", name=re.compile(f"^Home {axis}:")).click()

    def steps(self, axis: str = "X") -> int:
        """The position of an axis, pulses."""
        return int(shown_number(self.at(f"steps-{axis}")))

    def beyond(self, steps: int, axis: str = "X") -> None:
        """Wait until an axis has gone beyond a position."""
        for _ in range(10 * PATIENCE_SECONDS):
            if self.steps(axis) > steps:
                return
            self.page.wait_for_timeout(100)
        raise AssertionError(f"{axis} stays at {self.steps(axis)}, wanted beyond {steps}")


@contextmanager
def gve_shown(browser: Browser, url: str) -> Iterator[GvePage]:
    """Open the page in a browser of its own."""
    with unit_shown(GvePage, browser, url) as page:
        yield page
