"""A unit that was left while something moved is told until it is connected again, or dealt with."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import statuses
from alone_page import write_alone
from fake_unit import FakeUnit
from gve_page import GveService, gve_shown
from playwright.sync_api import Browser, Locator, expect
from pos_page import PosService, pos_shown
from serial_bridge import SerialBridge
from serial_page import NODE, PORT, connect, send
from served import GVE_COMMAND, POSITIONING_COMMAND, Served
from service_page import Service, ServicePage, shown
from tab import DESK

RUNS = statuses.Vector("", motors=[3, 0, 0, 0]).whole
STANDS = statuses.Vector("").whole
OTHER = 5
CANNOT = "NOT CONNECTED: THIS PAGE CANNOT STOP"
NOT_CONFIRMED = "NOT CONFIRMED: use the emergency stop"


@pytest.fixture(scope="module")
def lines_service() -> Iterator[Service]:
    """One that has seen no other units of the line: a stop waits for all that it has seen."""
    service = Service()
    yield service
    service.end()


@pytest.fixture
def left(lines_page: ServicePage, unit: FakeUnit) -> Locator:
    """What is told of units that were left; the one of the line runs."""
    unit.status = RUNS
    expect(lines_page.page.locator(".card").first).to_have_attribute("data-moving", "true")
    return lines_page.page.locator("#left-units")


def leave(page: ServicePage) -> None:
    page.page.locator("#connect").click()
    expect(page.page.locator("#port")).to_be_enabled()


def connect_virtual(page: ServicePage) -> None:
    page.page.locator("#port").select_option("virtual")
    page.page.locator("#node").select_option("1")
    page.page.locator("#connect").click()
    expect(page.page.locator("#state")).to_contain_text("virtual unit, node 1")


def test_neither_loading_the_page_nor_another_unit_forgets_it(lines_page, line, unit, left):
    expect(left).to_be_hidden()
    leave(lines_page)
    unit_name = f"node {NODE} of {line.port}"
    expect(left).to_contain_text(f"{CANNOT} {unit_name}")
    lines_page.page.reload()
    expect(left).to_contain_text(f"{CANNOT} {unit_name}")
    lines_page.page.set_viewport_size({"width": 320, "height": 568})
    assert lines_page.page.evaluate("document.documentElement.scrollWidth") <= 320
    lines_page.page.set_viewport_size({"width": DESK[0], "height": DESK[1]})
    connect_virtual(lines_page)
    expect(left).to_contain_text(f"{CANNOT} {unit_name}")
    lines_page.page.keyboard.press("Escape")
    expect(lines_page.alarm).to_have_text(f"{NOT_CONFIRMED} ({unit_name})")
    expect(lines_page.alarm).to_have_attribute("data-kind", "failed")

    lines_page.connect(line.port, NODE)
    expect(left).to_be_hidden()
    unit.status = STANDS
    lines_page.stopped()
    leave(lines_page)
    expect(left).to_be_hidden()


def test_who_says_that_it_is_dealt_with_is_believed(lines_page, line, left):
    leave(lines_page)
    connect_virtual(lines_page)
    lines_page.page.keyboard.press("Escape")
    expect(lines_page.alarm).to_have_attribute("data-kind", "failed")
    lines_page.page.locator("#dealt").click()
    expect(left).to_be_hidden()
    expect(lines_page.alarm).to_have_text(NOT_CONFIRMED)
    lines_page.stopped()
    lines_page.page.reload()
    lines_page.ready()
    expect(left).to_be_hidden()
    lines_page.stopped()


def test_a_stop_that_is_not_confirmed_by_a_port_that_was_left_can_be_dealt_with(
    browser, lines_page, lines_service, line
):
    """In any window, and for all of them; until then it stays."""
    left = lines_page.page.locator("#left-units")
    with shown(browser, lines_service.url) as second:
        expect(lines_page.page.locator(".card").first).to_have_attribute("data-moving", "false")
        del line.units[NODE]
        lines_page.page.keyboard.press("Escape")
        expect(lines_page.alarm).to_have_attribute("data-kind", "failed")
        expect(left).to_be_hidden()
        leave(lines_page)
        connect_virtual(lines_page)
        unit_name = f"node {NODE} of {line.port}"
        lines_page.page.reload()
        lines_page.ready()
        lines_page.page.keyboard.press("Escape")
        for page in (lines_page, second):
            expect(page.answers.first).to_have_attribute("data-message", "stop")
            expect(page.alarm).to_have_text(f"{NOT_CONFIRMED} ({unit_name})")
            expect(page.page.locator("#left-units")).to_contain_text(f"{CANNOT} {unit_name}")

        lines_page.page.locator("#dealt").click()
        for page in (lines_page, second):
            expect(page.page.locator("#left-units")).to_be_hidden()
            expect(page.alarm).to_have_text(NOT_CONFIRMED)
        second.stopped()
        lines_page.stopped()


def test_a_program_whose_answer_was_lost_may_run(lines_page, line, unit):
    page = lines_page
    expect(page.page.locator(".card").first).to_have_attribute("data-moving", "false")
    del line.units[NODE]
    page.send("\\ C100 F1000 R")
    leave(page)
    expect(page.page.locator("#left-units")).to_contain_text(f"{CANNOT} node {NODE} of {line.port}")


def test_a_stop_reaches_the_other_units_of_the_port(lines_page, line, unit, left):
    leave(lines_page)
    lines_page.connect(line.port, OTHER)
    expect(left).to_be_hidden()
    del line.units[NODE]
    lines_page.page.keyboard.press("Escape")
    expect(lines_page.alarm).to_have_text(f"{NOT_CONFIRMED} (node {NODE})")
    line.units[NODE] = unit
    unit.status = STANDS
    lines_page.stopped()
    leave(lines_page)
    expect(left).to_be_hidden()


def test_a_stop_from_elsewhere_confirms_nothing_of_it(lines_page, left, browser, lines_service):
    leave(lines_page)
    connect_virtual(lines_page)
    with browser.new_context().new_page() as other:
        other.goto(lines_service.url)
        expect(other.locator("#state")).to_have_attribute("data-kind", "good")
        other.keyboard.press("Escape")
        expect(other.locator("#alarm")).to_have_attribute("data-kind", "done")
        expect(lines_page.answers.first).to_have_attribute("data-message", "stop")
        assert lines_page.alarm.get_attribute("data-kind") != "done"
        other.context.close()


def test_a_gve134_is_not_forgotten_either(browser: Browser, tmp_path: Path) -> None:
    unit = Served("--tcp", "0", cwd=tmp_path, command=GVE_COMMAND)
    service = GveService("--port", unit.place)
    try:
        with gve_shown(browser, service.url) as page:
            page.ready().confirm_danger()
            page.at("typed").fill("L100000")
            page.page.keyboard.press("Enter")
            page.beyond(100)
            page.at("connect").click()
            expect(page.at("left-units")).to_contain_text(f"{CANNOT} {unit.place}")
            page.page.reload()
            expect(page.at("left-units")).to_contain_text(f"{CANNOT} {unit.place}")
            page.at("port").select_option("virtual")
            page.at("connect").click()
            page.ready()
            page.page.keyboard.press("Escape")
            expected = f"HALT NOT CONFIRMED: USE THE EMERGENCY STOP ({unit.place})"
            expect(page.at("alarm")).to_have_text(expected)
            page.at("dealt").click()
            expect(page.at("left-units")).to_be_hidden()
            page.page.keyboard.press("Escape")
            expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    finally:
        service.end()
        unit.end()


def test_a_positioning_unit_is_not_forgotten_either(browser: Browser, tmp_path: Path) -> None:
    unit = Served("--tcp", "0", cwd=tmp_path, command=POSITIONING_COMMAND)
    service = PosService("--port", unit.place)
    try:
        with pos_shown(browser, service.url) as page:
            page.ready().move("1000")
            page.beyond(1)
            page.at("connect").click()
            page.page.reload()
            expect(page.at("left-units")).to_contain_text(f"{CANNOT} {unit.place} #1")
            page.at("port").select_option("virtual")
            page.at("connect").click()
            page.ready().page.keyboard.press("Escape")
            expected = f"STOP NOT CONFIRMED: USE THE EMERGENCY STOP ({unit.place} #1)"
            expect(page.at("alarm")).to_have_text(expected)
            page.at("connect").click()
            page.at("port").select_option("")
            page.at("port-other").fill(unit.place)
            page.at("connect").click()
            page.doing("MOVING")
            expect(page.at("left-units")).to_be_hidden()
            page.page.keyboard.press("Escape")
            expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    finally:
        service.end()
        unit.end()


def test_a_page_without_a_service_knows_it_when_it_is_loaded_again(
    browser: Browser, tmp_path: Path
) -> None:
    unit = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path)
    bridge = SerialBridge(unit.place)
    name = f"node {NODE} of {PORT}"
    try:
        with browser.new_context(locale="en-GB").new_page() as page:
            page.add_init_script(bridge.script)
            page.goto(write_alone(tmp_path / "page").as_uri())
            expect(page.locator("#state")).to_have_attribute("data-kind", "good")
            connect(page)
            send(page, "\\ C100 S1000 V1000 A1000 F1000000 R")
            expect(page.locator("#state-1")).to_contain_text("moves")
            page.reload()
            expect(page.locator("#left-units")).to_contain_text(f"{CANNOT} {name}")
            page.keyboard.press("Escape")
            expect(page.locator("#alarm")).to_have_text(f"{NOT_CONFIRMED} ({name})")
            connect(page)
            expect(page.locator("#left-units")).to_be_hidden()
            page.keyboard.press("Escape")
            expect(page.locator("#alarm")).to_have_attribute("data-kind", "done")
            expect(page.locator("#state-1")).to_have_text("stopped by K")
            page.context.close()
    finally:
        bridge.close()
        unit.end()
