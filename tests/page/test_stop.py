"""STOP: from everywhere, at every size, and believed only when it is confirmed."""

from __future__ import annotations

import signal

import statuses
from fake_unit import FakeLine
from playwright.sync_api import expect
from service_page import Service, ServicePage, free_port, shown

K = b"\x020K"
STANDS = statuses.Vector("").whole
RUNS = statuses.Vector("", motors=[3, 0, 0, 0]).whole
BRAKES = statuses.Vector("", motors=[9, 0, 0, 0]).whole
SOON_MS = 1500
"""Much less than a confirmation is shown for."""

NODE, OTHER = 3, 5
RED = "NOT CONFIRMED: use the emergency stop"
SMALLEST, ZOOMED = (320, 568), (320, 200)
"""A narrow telephone; a window of 1280 by 800 at 400 %."""


def make_alarm(page: ServicePage, line: FakeLine) -> None:
    """Press STOP while the unit is silent."""
    del line.units[NODE]
    page.page.keyboard.press("Escape")
    expect(page.alarm).to_have_attribute("data-kind", "failed")


def test_escape_stops_wherever_the_focus_is_and_once_for_each_press(lines_page):
    page = lines_page
    page.page.evaluate(
        """for (const kind of ["keydown", "keyup"]) {
            document.addEventListener(kind, (event) => event.stopPropagation());
        }"""
    )
    places = {
        "the editor": lambda: page.page.locator(".cm-content").click(),
        "its search": lambda: page.page.locator("#find").click(),
        "a list that is open": lambda: page.page.locator("#message").click(),
        "another one": lambda: page.page.locator("#examples").click(),
        "a number": lambda: page.page.locator("#speed").click(),
        "a button": lambda: page.page.locator("#connect").focus(),
        "a radio button": lambda: page.page.locator("#motors input").first.focus(),
        "nothing": lambda: page.page.evaluate("document.activeElement.blur()"),
    }
    for count, (place, go) in enumerate(places.items(), 1):
        go()
        page.page.wait_for_timeout(100)
        page.page.keyboard.down("Escape")
        if place != "a list that is open":
            page.page.keyboard.down("Escape")
        page.page.keyboard.up("Escape")
        expect(page.answers.first).to_have_attribute("data-message", "stop")
        page.expect_sent("stop", count)
    expect(page.page.locator(".cm-search")).to_have_count(0)


def test_the_button_stops_when_it_is_pressed_and_not_only_when_it_is_let_go(lines_page):
    page = lines_page
    box = page.page.locator("#stop").bounding_box()
    assert box
    page.page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.page.mouse.down()
    expect(page.answers.first).to_have_attribute("data-message", "stop")
    page.page.mouse.move(5, 400)
    page.page.mouse.up()
    page.expect_sent("stop", 1)
    page.page.wait_for_timeout(1100)
    page.page.locator("#stop").press("Enter")
    page.expect_sent("stop", 2)


def test_its_name_is_its_text(lines_page):
    expect(lines_page.page.locator("#stop")).to_have_accessible_name("STOP")
    expect(lines_page.page.locator("#stop b")).to_have_text("STOP")


def test_stop_and_its_line_are_on_the_smallest_screens_and_work_by_touch(
    browser, lines_page, lines_service, line, unit
):
    with shown(browser, lines_service.url, size=SMALLEST, touch=True) as page:
        page.page.locator("#stop").tap()
        expect(page.alarm).to_have_attribute("data-kind", "done")
        page.expect_sent("stop", 1)
        make_alarm(page, line)
        for width, height in (SMALLEST, ZOOMED):
            page.page.set_viewport_size({"width": width, "height": height})
            page.page.evaluate("window.scrollTo(0, 2000)")
            expect(page.page.locator("#stop")).to_be_in_viewport(ratio=1)
            expect(page.alarm).to_be_in_viewport(ratio=1)
            box = page.alarm.bounding_box()
            assert box
            assert (box["x"], box["width"]) == (0, width)
            assert page.page.evaluate("document.documentElement.scrollWidth") <= width


def test_a_stop_that_is_confirmed_says_by_whom_and_goes_away(lines_page, line):
    lines_page.page.locator("#stop").click()

    expect(lines_page.alarm).to_have_text(f"STOP is confirmed: node {NODE}")
    expect(lines_page.alarm).to_be_hidden(timeout=10_000)
    nodes = [node for node, _, message in line.requests if message == K]
    assert nodes == [0, NODE]


def test_a_stop_is_not_confirmed_any_more_when_a_motor_moves_again(
    browser, lines_page, lines_service, unit
):
    """BRAKES is still what was stopped; an original unit tells no motion, but takes an order."""
    with shown(browser, lines_service.url) as second:
        unit.status = BRAKES
        lines_page.stopped()
        lines_page.page.wait_for_timeout(500)
        for page in (lines_page, second):
            expect(page.alarm).to_have_attribute("data-kind", "done", timeout=0)
        unit.status = RUNS
        for page in (lines_page, second):
            expect(page.alarm).to_be_hidden(timeout=SOON_MS)

        unit.status = b""
        expect(lines_page.state(1)).not_to_contain_text("moves")
        lines_page.page.locator("#log-clear").click()
        lines_page.stopped()
        second.page.locator("#resume").click()
        for page in (lines_page, second):
            expect(page.alarm).to_be_hidden(timeout=SOON_MS)
            expect(page.answers.first).to_have_attribute("data-message", "resume")


def test_a_stop_without_an_answer_is_a_red_line_until_it_is_confirmed(
    browser, lines_page, lines_service, line, unit
):
    make_alarm(lines_page, line)

    expect(lines_page.alarm).to_have_text(f"{RED} (node {NODE})")
    with shown(browser, lines_service.url, waits=False) as second:
        expect(second.alarm).to_have_text(f"{RED} (node {NODE})")

    line.units[NODE] = unit
    expect(lines_page.position(1)).to_have_text("0")
    expect(lines_page.alarm).to_have_text(f"{RED} (node {NODE})")
    lines_page.page.locator("#stop").click()
    expect(lines_page.alarm).to_have_attribute("data-kind", "done")


def test_the_line_is_red_from_the_press_on(lines_page, line, unit):
    unit.status = RUNS
    lines_page.page.keyboard.press("Escape")
    expect(lines_page.alarm).to_have_attribute("data-kind", "asked")
    expect(lines_page.alarm).to_have_text(f"{RED} (node {NODE})")

    unit.status = STANDS
    expect(lines_page.alarm).to_have_attribute("data-kind", "done")


def test_every_unit_that_was_seen_is_stopped_and_named(lines_page, line):
    lines_page.connect(line.port, OTHER)
    expect(lines_page.page.locator("#state")).to_have_attribute("data-kind", "good")
    line.requests.clear()
    make_alarm(lines_page, line)

    expect(lines_page.alarm).to_have_text(f"{RED} (node {NODE})")
    assert (OTHER, 0, K) in line.requests


def test_a_port_that_is_lost_leaves_the_line_red(lines_page, line, reopen):
    line.close()
    lines_page.page.locator("#stop").click()

    expect(lines_page.alarm).to_have_attribute("data-kind", "failed")
    expect(lines_page.alarm).to_contain_text(RED)
    expect(lines_page.alarm).to_contain_text(f"node {NODE}")
    reopen()
    expect(lines_page.page.locator("#state")).to_have_attribute("data-kind", "good")
    expect(lines_page.alarm).to_contain_text(f"node {NODE}")


def test_a_service_that_was_killed_and_started_again_is_only_read(browser):
    port = free_port()
    service = Service(listen=port)
    with shown(browser, service.url) as page:
        service.end(signal.SIGKILL)
        expect(page.page.locator("#state")).to_have_text("service not reached")
        expect(page.page.locator("#live")).to_have_attribute("data-fresh", "false")
        for button in ("#resume", "#send"):
            page.page.locator(button).click()
            expect(page.answers.first).to_contain_text("Not sent")
        page.page.keyboard.press("Escape")
        expect(page.alarm).to_have_attribute("data-kind", "failed")
        expect(page.alarm).to_contain_text(RED)
        page.sent.clear()

        again = Service(listen=port)
        page.ready()
        page.page.wait_for_timeout(500)
        assert set(page.sent) <= {"ports"}
        assert page.steps() == 0
        expect(page.alarm).to_contain_text(RED)
        page.page.keyboard.press("Escape")
        expect(page.alarm).to_have_attribute("data-kind", "done")
        again.end()


def test_a_service_that_stands_still_is_noticed_and_clicks_meanwhile_never_act(
    own_page, own_service
):
    page = own_page
    page.write("\\ C100 F300 R")
    own_service.tell(signal.SIGSTOP)
    page.page.locator("#send").click()
    expect(page.page.locator("#banner")).to_contain_text("cannot stop anything", timeout=5000)
    page.page.keyboard.press("Escape")
    expect(page.alarm).to_contain_text(RED)
    page.page.locator("#send").click()
    expect(page.answers.first).to_contain_text("Not sent")

    own_service.tell(signal.SIGCONT)
    page.ready()
    page.page.wait_for_timeout(1000)
    assert page.steps() == 0
    page.page.locator("#message").select_option("program")
    page.send()
    expect(page.answers.first.locator(".log-message code").last).to_have_text("05 31")


def test_a_reset_that_was_not_confirmed_is_not_meant_any_more(lines_page, browser, lines_service):
    page = lines_page
    reset = page.page.locator("#reset")

    def expect_calm() -> None:
        expect(reset).to_have_text("Reset \\")
        assert "reset" not in page.sent

    reset.evaluate("button => { button.click(); button.click(); }")
    expect(reset).to_have_text("Really reset?")
    assert "reset" not in page.sent
    page.page.wait_for_timeout(4200)
    expect_calm()

    reset.click()
    expect(reset).to_have_text("Really reset?")
    with shown(browser, lines_service.url) as second:
        second.page.locator("#reset").click()
        expect(second.page.locator("#reset")).to_have_text("Really reset?")
        assert "reset" not in second.sent
    page.page.keyboard.press("Escape")
    expect_calm()
    page.page.wait_for_timeout(500)
    reset.click()
    expect(reset).to_have_text("Really reset?")
    assert "reset" not in page.sent
