"""Whether an order was taken whose answer was lost, on a serial port of the page."""

from __future__ import annotations

from pathlib import Path

from alone_page import write_alone
from playwright.sync_api import Browser, expect
from serial_bridge import SerialBridge
from serial_page import NODE, connect, send
from served import Served

MAYBE = "NOT CONFIRMED: it may have been taken"
SILENT = f"unit {NODE} does not answer; check power"


def test_an_order_whose_answer_was_lost_may_have_been_taken(
    browser: Browser, tmp_path: Path
) -> None:
    """The first Resume needs no session, as there is one; the second waits for one in vain."""
    unit = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path)
    bridge = SerialBridge(unit.place)
    try:
        with browser.new_context(locale="en-GB").new_page() as page:
            last = page.locator("#log .log-item").first
            page.add_init_script(bridge.script)
            page.goto(write_alone(tmp_path / "page").as_uri())
            expect(page.locator("#state")).to_have_attribute("data-kind", "good")
            connect(page)
            send(page, "\\ C100 S1000 V1000 A1000 F1000000 R")
            page.keyboard.press("Escape")
            expect(page.locator("#state-1")).to_have_text("stopped by K")
            page.locator("#log-clear").click()
            bridge.silent = True
            page.locator("#resume").click()
            expect(last).to_contain_text(f"{MAYBE}; motors may move; {SILENT}")
            page.locator("#log-clear").click()
            page.locator("#resume").click()
            expect(last).to_contain_text(SILENT)
            expect(last).not_to_contain_text(MAYBE)

            bridge.silent = False
            expect(page.locator("#state-1")).to_contain_text("moves")
            page.context.close()
    finally:
        bridge.close()
        unit.end()
