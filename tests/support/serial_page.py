"""A page without a service whose unit is at the other end of a serial port of the browser."""

from __future__ import annotations

import time
from collections.abc import Callable

from alone_page import write
from frames import unescape
from playwright.sync_api import Page, expect
from tab import PATIENCE_SECONDS

NODE = 3
PORT = "USB 0403:6001"
CHOOSE = "serial"
UNSENT = "the unit was not reached at that time, so this was not sent"
SENDS_MAX = 3
SCANS_MAX = 3


def connect(page: Page, node: int = NODE, port: str = CHOOSE) -> None:
    """Leave what is connected for the serial port; wait until its unit is there."""
    press_connect(page, node, port)
    expect(page.locator("#state")).to_contain_text(f"{PORT}, node {node}")
    expect(page.locator("#state")).to_have_attribute("data-kind", "good")


def press_connect(page: Page, node: int = NODE, port: str = CHOOSE) -> None:
    """Leave what is connected for the serial port; the caller waits for what comes of it."""
    if page.locator("#port").is_disabled():
        page.locator("#connect").click()
    expect(page.locator("#port")).to_be_enabled()
    page.locator("#port").select_option(port)
    page.locator("#node").select_option(str(node))
    page.locator("#connect").click()


def send(page: Page, text: str) -> None:
    """Send a program that begins with a reset; again if the machine was too busy to answer."""
    assert text.startswith("\\")
    write(page, text)
    for _ in range(SENDS_MAX):
        page.locator("#log-clear").click()
        page.locator("#send").click()
        expect(page.locator("#log .log-item")).to_have_count(1)
        if "sent and accepted" in last_answer(page):
            return
    raise AssertionError(last_answer(page))


def send_once(page: Page) -> None:
    """Send what is shown; again only if it was not sent, as the machine was too busy for a look."""
    for _ in range(SENDS_MAX):
        expect(page.locator("#state")).to_have_attribute("data-kind", "good")
        page.locator("#log-clear").click()
        page.locator("#send").click()
        expect(page.locator("#log .log-item")).to_have_count(1)
        if UNSENT not in last_answer(page):
            break
    assert "sent and accepted" in last_answer(page), last_answer(page)


def scan(page: Page, *nodes: int) -> None:
    """Look for all of these units; again if the machine was too busy to answer."""
    for _ in range(SCANS_MAX):
        page.locator("#log-clear").click()
        page.locator("#scan").click()
        expect(page.locator("#log .log-item")).to_have_count(1)
        found = page.locator("#found button").all_inner_texts()
        if len(found) >= len(nodes):
            break
    assert found == [str(node) for node in nodes]


def last_answer(page: Page) -> str:
    """What stands first in the log."""
    return page.locator("#log .log-item").first.inner_text()


def wait_until(page: Page, is_so: Callable[[], bool]) -> None:
    """Wait for something outside the page."""
    end = time.monotonic() + PATIENCE_SECONDS
    while not is_so():
        assert time.monotonic() < end
        page.wait_for_timeout(20)


def messages_to(node: int, sent: bytes) -> list[bytes]:
    """What went to a node, sessions and looks left out."""
    found = [unescape(part) for part in sent.split(b"\x7e") if part]
    return [each[2:-2] for each in found if each[0] == node and each[2] not in (1, 7, 200)]
