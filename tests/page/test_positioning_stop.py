"""The page of a positioning unit: which stops are confirmed, and how long others are told."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Page, expect
from pos_page import PosPage, PosService, pos_shown
from relay import Relay
from served import POSITIONING_COMMAND, Served
from tab import visited

NOT_CONFIRMED = "STOP NOT CONFIRMED: USE THE EMERGENCY STOP"
HOLD_NOT_CONFIRMED = "HOLD OF AXIS 2 NOT CONFIRMED: USE THE EMERGENCY STOP"


@pytest.fixture
def relay(tmp_path: Path) -> Iterator[Relay]:
    more = ("--tcp", "0", "--control", "0", "--unpaced")
    served = Served(*more, cwd=tmp_path, command=POSITIONING_COMMAND)
    relay = Relay(served.place)
    yield relay
    relay.close()
    served.end()


@pytest.fixture
def service(relay: Relay) -> Iterator[PosService]:
    service = PosService("--port", relay.port)
    yield service
    service.end()


@pytest.fixture
def page(tab: Page, service: PosService) -> Iterator[PosPage]:
    with visited(PosPage, tab, service.url) as page:
        yield page.ready()


def test_a_hold_has_words_of_its_own_and_confirms_its_axis_alone(
    page: PosPage, relay: Relay, browser: Browser, service: PosService
) -> None:
    page.move("1000", axis=2)
    page.beyond(1, 2)
    relay.muted = True
    page.at("hold-2").click()
    expect(page.at("alarm")).to_have_text(HOLD_NOT_CONFIRMED)
    expect(page.answers.first.locator("b")).to_have_text("Hold")
    relay.muted = False
    page.ready()
    page.at("take-1").click()
    page.doing("TAKEN")
    page.at("hold-1").click()
    expect(page.answers.first).to_contain_text("axis 1 stands at")
    expect(page.at("alarm")).to_have_text(HOLD_NOT_CONFIRMED)
    page.at("hold-2").click()
    expect(page.at("alarm")).to_contain_text("Hold is confirmed: axis 2 stands at")
    expect(page.at("alarm")).to_be_hidden()

    relay.muted = True
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_text(NOT_CONFIRMED)
    relay.muted = False
    page.ready()
    page.at("hold-1").click()
    expect(page.answers.first).to_contain_text("axis 1 stands at")
    with pos_shown(browser, service.url) as second:
        for each in (page, second.ready()):
            expect(each.at("alarm")).to_have_text(NOT_CONFIRMED)
        page.page.keyboard.press("Escape")
        expect(page.at("alarm")).to_contain_text("STOP is confirmed: all axes stand")
        for each in (page, second):
            expect(each.at("alarm")).to_be_hidden()


def test_a_stop_that_is_not_confirmed_outlives_the_service(
    page: PosPage, relay: Relay, service: PosService
) -> None:
    page.move("1000")
    page.beyond(1)
    relay.muted = True
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_text(NOT_CONFIRMED)
    service.end(signal.SIGKILL)
    relay.muted = False
    again = PosService("--port", relay.port, listen=urlsplit(service.url).port or 0)
    try:
        for _ in range(2):
            page.page.goto(again.url)
            page.ready()
            page.doing("MOVING")
            expect(page.at("alarm")).to_have_text(NOT_CONFIRMED)
        page.at("hold-1").click()
        page.doing("READY")
        expect(page.at("alarm")).to_have_text(NOT_CONFIRMED)
        page.page.keyboard.press("Escape")
        expect(page.at("alarm")).to_contain_text("STOP is confirmed")
        page.page.reload()
        page.ready()
        expect(page.at("alarm")).to_be_hidden()
    finally:
        again.end()
