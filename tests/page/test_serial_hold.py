"""A button that is held in the page as one file, while the line to the unit is busy or silent."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from alone_page import hold, write_alone
from frames import frame
from playwright.sync_api import Browser, Page, expect
from serial_bridge import SerialBridge
from serial_page import NODE, connect, messages_to, wait_until
from served import Served

UNDER_WAY_MAX = 1
"""Frames that may be on their way when the button is let go."""


@pytest.fixture
def bridge(tmp_path: Path) -> Iterator[SerialBridge]:
    unit = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path)
    bridge = SerialBridge(unit.place)
    yield bridge
    bridge.close()
    unit.end()


@pytest.fixture
def page(browser: Browser, bridge: SerialBridge, tmp_path: Path) -> Iterator[Page]:
    """The page, connected to the unit of the line."""
    context = browser.new_context(locale="en-GB")
    page = context.new_page()
    page.add_init_script(bridge.script)
    page.goto(write_alone(tmp_path / "page").as_uri())
    expect(page.locator("body")).to_have_attribute("data-connected", "true")
    connect(page)
    yield page
    context.close()


def test_a_run_that_waits_for_the_line_is_withdrawn_when_the_button_is_let_go(page, bridge):
    hold(page, farthest=0)
    page.mouse.up()
    expect(page.locator("#commission-motor")).to_be_enabled()
    expect(page.locator("#jog-forth")).to_be_enabled()
    page.locator("#message").select_option("position")
    bridge.sent = b""
    bridge.silent = True
    page.locator("#send").evaluate("(button) => button.click()")
    page.mouse.down()
    page.wait_for_timeout(200)
    page.mouse.up()
    page.wait_for_timeout(200)
    bridge.silent = False
    expect(page.locator("#log .log-item[data-message=position]")).to_be_visible()
    expect(page.locator("#commission-motor")).to_be_enabled()
    sent = {each[2:] for each in messages_to(NODE, bridge.sent) if each[:1] == b"\x02"}
    assert sent <= {b"K", b"\\"}


def test_a_unit_whose_answers_are_lost_hears_k_before_it_is_looked_at_again(page, bridge):
    hold(page, farthest=0)
    bridge.silent = True
    page.wait_for_timeout(300)
    before = len(bridge.sent)
    page.mouse.up()

    letting_go = frame(NODE, 0, b"\x021K")
    wait_until(page, lambda: letting_go in bridge.sent)
    ahead = bridge.sent[before : bridge.sent.index(letting_go)]
    assert len([part for part in ahead.split(b"\x7e") if part]) <= UNDER_WAY_MAX
    bridge.silent = False
    expect(page.locator("#state-1")).to_have_text(re.compile("stopped by K|nothing left"))
