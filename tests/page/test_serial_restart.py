"""A unit on the line of the page without a service that restarts in the midst of an order."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from alone_page import write, write_alone
from fake_unit import FakeLine, FakeUnit
from playwright.sync_api import expect
from serial_bridge import SerialBridge
from serial_page import NODE, connect


@dataclass
class Restarting(FakeUnit):
    """Once, where a table is asked for after a certain message."""

    before: bytes = b""

    def take(self, number: int, message: bytes) -> bytes:
        if message == b"\x061" and self.done[-1:] == [self.before]:
            self.before = b""
            self.restart()
        return super().take(number, message)


@pytest.mark.parametrize("act", ["start", "speed"])
def test_what_is_begun_does_not_go_on_with_a_unit_that_has_restarted(browser, tmp_path, act):
    """It restarts before it is asked for the table, which the page asks again."""
    before = b"\xc8" if act == "speed" else b"\x022\\[F2R"
    unit = Restarting(NODE, states=[3] * 4 if act == "speed" else [0] * 4, before=before)
    fake = FakeLine(unit)
    bridge = SerialBridge(fake.port)
    try:
        page = browser.new_context(locale="en-GB").new_page()
        page.add_init_script(bridge.script)
        page.goto(write_alone(tmp_path / "page").as_uri())
        expect(page.locator("body")).to_have_attribute("data-connected", "true")
        connect(page)
        if act == "speed":
            page.locator("#motors label").first.click()
            page.locator("#speed").fill("900")
            page.locator("#speed-form button").click()
        else:
            write(page, "\\ F1 R")
            page.locator("#tab-2").click()
            write(page, "\\ F2 R")
            page.locator("#together").check()
            page.locator("#send-all").click()

        expect(page.locator("#log .log-item").first).to_contain_text("the unit has restarted")
        assert not {b"\x020]", b"\x021V900"} & set(unit.done)
        page.context.close()
    finally:
        bridge.close()
        fake.close()
