"""The page as one file on a real line: a fake navigator.serial, whose bytes go to a served unit."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from alone_page import forget, hold, write, write_alone
from frames import frame
from noisy_line import NoisyLine
from page_looks import AXE, CUT, OUTSIDE, OVER, SIZES, VIOLATIONS
from playwright.sync_api import Browser, Page, expect
from serial_bridge import SerialBridge
from serial_page import (
    CHOOSE,
    NODE,
    PORT,
    UNSENT,
    connect,
    messages_to,
    press_connect,
    scan,
    send,
    send_once,
    wait_until,
)
from served import Served

OTHER = 5
K = "\x020K"
LONG = "\\ C100 S1000 V1000 A1000 F1000000 R"
NOT_KNOWN = "STATE NOT KNOWN: the line was lost. A STOP IS NOT CONFIRMED: use the emergency stop"
SEED = 5
UNDER_WAY_MAX = 1
"""Frames that may be on their way when a stop is asked for; without haste there are three more."""
PIECES, HARMED = 8, 3
"""Programs that are sent over a bad line at least, and what comes to harm meanwhile."""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_alone(tmp_path_factory.mktemp("serial") / "page")


@pytest.fixture(scope="module")
def unit(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path_factory.mktemp("unit"))
    yield served
    served.end()


@pytest.fixture(scope="module")
def bridge(unit: Served) -> Iterator[SerialBridge]:
    bridge = SerialBridge(unit.place)
    yield bridge
    bridge.close()


@pytest.fixture(scope="module")
def open_for_all(browser: Browser, written: Path) -> Iterator[Callable[[str], Page]]:
    context = browser.new_context(locale="en-GB")
    faults: list[str] = []

    def begin(script: str) -> Page:
        page = context.new_page()
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.add_init_script(script)
        page.goto(written.as_uri())
        expect(page.locator("body")).to_have_attribute("data-connected", "true")
        return page

    yield begin
    context.close()
    assert faults == []


@pytest.fixture
def open_page(open_for_all: Callable[[str], Page]) -> Iterator[Callable[[str], Page]]:
    """Pages that are open no longer than their test."""
    opened: list[Page] = []

    def begin(script: str) -> Page:
        opened.append(open_for_all(script))
        return opened[-1]

    yield begin
    for page in opened:
        page.close()


@pytest.fixture(scope="module")
def shared_page(open_for_all: Callable[[str], Page], bridge: SerialBridge) -> Page:
    """One page for many tests, since it takes seconds to be drawn."""
    page = open_for_all(bridge.script)
    connect(page)
    return page


@pytest.fixture
def page(shared_page: Page, bridge: SerialBridge) -> Iterator[Page]:
    """The page, connected to the unit of the line, whose motors stand without programs at 0."""
    if PORT not in shared_page.locator("#state").inner_text():
        connect(shared_page)
    shared_page.keyboard.press("Escape")
    expect(shared_page.locator("#alarm")).to_have_attribute("data-kind", "done")
    shared_page.locator("#motors label").first.click()
    shared_page.locator("#message").select_option("send")
    send(shared_page, "\\ C100")
    for motor in (1, 2, 3, 4):
        expect(shared_page.locator(f"#position-{motor}")).to_have_text("0")
    shared_page.locator("#tab-1").click()
    shared_page.locator("#motors label").nth(1).click()
    bridge.sent = b""
    yield shared_page
    bridge.silent = False


def test_it_connects_shows_the_state_sends_runs_and_stops(page, bridge):
    assert page.evaluate("fakeSerial.opened[0].baudRate") == 19_200
    expect(page.locator("#state")).to_contain_text(f"{PORT}, node {NODE}")
    expect(page.locator("#alone-hint")).to_be_hidden()
    send(page, "\\ C100 S100 V2000 A4000 F300 R")
    expect(page.locator("#position-1")).to_have_text("300")
    expect(page.locator("#state-1")).to_contain_text("rests")

    send(page, LONG)
    expect(page.locator("#state-1")).to_contain_text("moves")
    page.keyboard.press("Escape")

    expect(page.locator("#alarm")).to_have_text(f"STOP is confirmed: node {NODE}")
    expect(page.locator("#state-1")).to_have_text("stopped by K")
    assert frame(0, 0, K.encode()) in bridge.sent
    page.locator("#resume").click()
    expect(page.locator("#state-1")).to_contain_text("moves")
    page.keyboard.press("Escape")
    expect(page.locator("#alarm")).to_have_attribute("data-kind", "done")


def test_all_messages_are_answered_over_the_line(page):
    send(page, "\\ C100 S100 V2000 A4000 F300 R")
    for message, words in (
        ("store", "commands stored: 6"),
        ("program", "C100S100V2000A4000F300R"),
        ("position", "motor 1: "),
        ("version", "version 01.01"),
        ("progress", "command number"),
    ):
        page.locator("#message").select_option(message)
        page.locator("#send").click()
        expect(page.locator("#log .log-item").first).to_contain_text(words)


def test_programs_of_several_motors_start_together_if_the_others_are_empty(page):
    write(page, "\\ C100 S500 V500 A1000 F100000 R")
    page.locator("#tab-2").click()
    write(page, "\\ C100 S500 V500 A1000 F100000 R")
    page.locator("#together").check()
    page.locator("#send-all").click()
    last = page.locator("#log .log-item").first
    expect(last).to_contain_text("motor 3 holds another program, and ] to all motors")
    forget(page)
    page.locator("#send-all").click()
    expect(last).to_contain_text("started together")
    expect(page.locator("#state-2")).to_contain_text("moves")
    page.keyboard.press("Escape")
    expect(page.locator("#alarm")).to_have_attribute("data-kind", "done")
    expect(page.locator("#state-2")).to_have_text("stopped by K")
    assert page.locator("#position-1").inner_text() == page.locator("#position-2").inner_text()


def test_a_long_program_goes_in_several_messages_and_runs_when_all_have_come(page, bridge):
    send(page, "\\ C100 " + "V12000 " * 300 + "S100 V2000 F77 R")

    expect(page.locator("#position-1")).to_have_text("77")
    texts = [each for each in messages_to(NODE, bridge.sent) if each[0] == 2]
    assert len(texts) > 1
    assert all(len(each) <= 1015 for each in texts)
    assert texts[0].startswith(b"\x021\\[C100")
    assert texts[-1].endswith(b"F77R]")


def test_a_scan_finds_the_unit_and_nobody_else(page):
    scan(page, NODE)


class Twice(SerialBridge):
    """Each frame of the units comes twice."""

    rest = b""

    def to_page(self, data: bytes) -> bytes:
        self.rest += data
        if self.rest.count(b"\x7e") % 2:
            return b""
        whole, self.rest = self.rest, b""
        return 2 * whole


def test_a_scan_tells_of_two_units_with_one_address(open_page, tmp_path):
    unit = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path)
    bridge = Twice(unit.place)
    try:
        page = open_page(bridge.script)
        connect(page)
        scan(page, NODE)
        found = page.locator("#found button")
        told = re.compile("answers twice: two units with this address")
        expect(found).to_have_attribute("title", told)
        expect(found).to_have_class(re.compile("danger"))
    finally:
        bridge.close()
        unit.end()


def test_a_cable_pulled_in_motion_is_told_in_the_largest_letters_and_nothing_happens_later(
    page, bridge
):
    send(page, LONG)
    expect(page.locator("#state-1")).to_contain_text("moves")
    page.evaluate("fakeSerial.pull()")

    alarm = page.locator("#alarm")
    expect(alarm).to_have_text(f"{NOT_KNOWN} (node {NODE})")
    largest = page.evaluate(
        """() => Math.max(...[...document.querySelectorAll("body *")]
            .filter((one) => one.id !== "alarm")
            .map((one) => parseFloat(getComputedStyle(one).fontSize)))"""
    )
    assert float(alarm.evaluate("one => parseFloat(getComputedStyle(one).fontSize)")) > largest
    expect(page.locator("#banner")).to_contain_text(f"{PORT} was lost (unplugged)")
    expect(page.locator("#live")).to_have_attribute("data-fresh", "false")
    bridge.wait_until_free()
    sent = bridge.sent
    write(page, "\\ F1 R")
    page.locator("#send").click()
    expect(page.locator("#log .log-item").first).to_contain_text("was lost")
    page.keyboard.press("Escape")
    expect(page.locator("#log .log-item").first).to_contain_text("was lost")
    expect(alarm).to_contain_text("STATE NOT KNOWN")
    assert bridge.sent == sent

    connect(page, port=PORT)

    expect(page.locator("#state-1")).to_contain_text("moves")
    expect(alarm).to_have_text(f"NOT CONFIRMED: use the emergency stop (node {NODE})")
    assert messages_to(NODE, bridge.sent[len(sent) :]) == []
    page.keyboard.press("Escape")
    expect(alarm).to_have_attribute("data-kind", "done")
    expect(page.locator("#state-1")).to_have_text("stopped by K")


def test_a_page_that_is_left_while_a_button_is_held_asks_and_stops_the_motor(
    open_page, page, bridge
):
    page.locator("#connect").click()
    expect(page.locator("#port")).to_be_enabled()
    leaving = open_page(bridge.script)
    connect(leaving)
    hold(leaving, farthest=0)
    leaving.on("dialog", lambda dialog: dialog.accept())
    with leaving.expect_event("dialog") as asked:
        leaving.goto("about:blank")
    assert asked.value.type == "beforeunload"
    bridge.wait_until_free()
    assert frame(0, 0, K.encode()) in bridge.sent

    connect(page)
    expect(page.locator("#state-1")).to_contain_text("stopped by K")


def test_a_cable_pulled_while_a_button_is_held_is_told_and_the_run_has_an_end(page, bridge):
    hold(page, farthest=3000)
    page.evaluate("fakeSerial.pull()")

    alarm = page.locator("#alarm")
    expect(alarm).to_have_text(f"{NOT_KNOWN} (node {NODE})")
    bridge.wait_until_free()
    page.mouse.up()
    sent = bridge.sent
    connect(page, port=PORT)
    expect(page.locator("#position-1")).to_have_text("3,000")
    expect(alarm).to_contain_text("NOT CONFIRMED")
    assert messages_to(NODE, bridge.sent[len(sent) :]) == []
    expect(page.locator("#commission-confirm")).not_to_be_checked()
    expect(page.locator("#jog-forth")).to_be_disabled()
    page.keyboard.press("Escape")
    expect(alarm).to_have_attribute("data-kind", "done")
    page.locator("#commission").evaluate("(panel) => (panel.open = false)")


def test_a_cable_pulled_while_a_stop_is_under_way_leaves_it_unconfirmed(page, bridge):
    send(page, LONG)
    page.evaluate("words => fakeSerial.lastWords = words", K)
    page.keyboard.press("Escape")

    expect(page.locator("#alarm")).to_have_attribute("data-kind", "failed")
    expect(page.locator("#alarm")).to_have_text(f"{NOT_KNOWN} (node {NODE})")
    expect(page.locator("#log .log-item").first).to_contain_text("was lost")
    bridge.wait_until_free()
    assert frame(0, 0, K.encode()) in bridge.sent
    connect(page, port=PORT)
    page.keyboard.press("Escape")
    expect(page.locator("#alarm")).to_have_attribute("data-kind", "done")


def test_a_cable_pulled_while_all_stands_is_no_alarm(page):
    page.evaluate("fakeSerial.pull()")

    expect(page.locator("#banner")).to_contain_text("was lost")
    expect(page.locator("#alarm")).to_be_hidden()


def test_a_port_that_another_program_holds_is_told_in_plain_words(open_page, bridge):
    page = open_page(bridge.script)
    page.evaluate("fakeSerial.busy = true")
    press_connect(page)

    expect(page.locator("#banner")).to_contain_text("another program, or another page, may have it")
    expect(page.locator("#state")).to_have_attribute("data-kind", "bad")
    page.evaluate("fakeSerial.busy = false")
    page.locator("#connect").click()
    expect(page.locator("#state")).to_have_attribute("data-kind", "good")


def test_a_choice_that_is_not_made_is_no_connection(open_page, bridge):
    page = open_page(bridge.script)
    page.evaluate("fakeSerial.refused = true")
    press_connect(page)

    expect(page.locator("#banner")).to_contain_text("no port was chosen")
    assert page.evaluate("fakeSerial.opened") == []


def test_connect_may_be_pressed_twice(open_page, bridge):
    page = open_page(bridge.script)
    page.locator("#connect").click()
    expect(page.locator("#port")).to_be_enabled()
    page.evaluate("fakeSerial.choice_ms = 300")
    page.locator("#port").select_option(CHOOSE)
    page.locator("#node").select_option(str(NODE))
    page.locator("#connect").dblclick()

    expect(page.locator("#state")).to_contain_text(f"{PORT}, node {NODE}")
    expect(page.locator("#state")).to_have_attribute("data-kind", "good")
    assert page.evaluate("fakeSerial.opened.length") == 1


def test_a_silent_unit_is_told_and_its_stop_is_not_confirmed(page, bridge):
    send(page, LONG)
    bridge.silent = True

    expect(page.locator("#banner")).to_contain_text(f"unit {NODE} does not answer")
    expect(page.locator("#live")).to_have_attribute("data-fresh", "false")
    page.keyboard.press("Escape")
    expect(page.locator("#alarm")).to_have_attribute("data-kind", "failed")
    expect(page.locator("#alarm")).to_contain_text("NOT CONFIRMED: use the emergency stop")
    write(page, "\\ F1 R")
    page.locator("#send").click()
    expect(page.locator("#log .log-item").first).to_contain_text("does not answer")

    bridge.silent = False
    expect(page.locator("#state-1")).to_have_text("stopped by K")
    page.keyboard.press("Escape")
    expect(page.locator("#alarm")).to_have_attribute("data-kind", "done")


@pytest.mark.parametrize("leaves", [False, True])
def test_what_a_port_has_kept_back_is_not_sent_when_it_takes_bytes_again(page, bridge, leaves):
    write(page, LONG)
    page.evaluate("fakeSerial.stall()")
    page.locator("#log-clear").click()
    page.locator("#send").click()
    expect(page.locator("#log .log-item").first).to_contain_text("does not answer")
    if leaves:
        page.locator("#connect").click()
        expect(page.locator("#port")).to_be_enabled()
    else:
        page.wait_for_timeout(1500)
    page.evaluate("fakeSerial.resume()")
    if leaves:
        connect(page, port=PORT)
    expect(page.locator("#state-1")).to_contain_text("rests")
    assert messages_to(NODE, bridge.sent) == []


def test_what_waits_for_a_scan_of_a_silent_line_is_not_done_when_the_unit_is_back(page, bridge):
    write(page, LONG)
    bridge.silent = True
    expect(page.locator("#banner")).to_contain_text(f"unit {NODE} does not answer")
    page.locator("#log-clear").click()
    page.locator("#scan").click()
    page.locator("#send").click()
    bridge.silent = False

    sent = page.locator("#log .log-item[data-message=send]")
    expect(sent).to_contain_text(UNSENT)
    expect(page.locator("#state")).to_have_attribute("data-kind", "good")
    expect(page.locator("#position-1")).to_have_text("0")


def test_a_stop_does_not_wait_for_what_is_under_way(page, bridge):
    send(page, LONG)
    bridge.silent = True
    page.locator("#message").select_option("store")
    page.locator("#send").click()
    expect(page.locator("#state")).to_contain_text("busy")
    page.evaluate(
        """() => document.addEventListener(
            "keydown", () => { window.fakeSerial.said = []; }, { capture: true, once: true }
        )"""
    )
    page.keyboard.press("Escape")

    wait_until(page, lambda: frame(0, 0, K.encode()) in bridge.sent)
    said = bytes(page.evaluate("window.fakeSerial.said"))
    ahead = said[: said.index(frame(0, 0, K.encode()))]
    assert len([part for part in ahead.split(b"\x7e") if part]) <= UNDER_WAY_MAX


def test_a_stop_is_confirmed_by_every_unit_that_has_answered(open_page, tmp_path):
    units = Served("--tcp", "0", "--node", str(NODE), "--node", str(OTHER), cwd=tmp_path)
    bridge = SerialBridge(units.place)
    try:
        page = open_page(bridge.script)
        connect(page)
        scan(page, NODE, OTHER)
        page.locator("#found button").nth(1).click()
        expect(page.locator("#state")).to_contain_text(f"node {OTHER}")
        page.keyboard.press("Escape")

        expect(page.locator("#alarm")).to_have_attribute("data-kind", "done")
        assert {"node 3", "node 5"} <= set(re.findall(r"node \d", page.inner_text("#alarm")))
        for node in (NODE, OTHER):
            assert set(messages_to(node, bridge.sent)) == {K.encode()}
    finally:
        bridge.close()
        units.end()


def test_damaged_characters_do_not_end_the_connection(page):
    page.evaluate("fakeSerial.damage()")
    send(page, "\\ C100 F5 R")

    expect(page.locator("#position-1")).to_have_text("5")


def test_noise_lost_bytes_and_echoes_are_made_good_by_repeats(open_page, tmp_path):
    unit = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path)
    line = NoisyLine(unit.place, SEED, probability=0.01, echo=True)
    bridge = SerialBridge(line.port)
    try:
        page = open_page(bridge.script)
        connect(page)
        sent = 0
        while sent < PIECES or line.harmed < HARMED:
            sent += 1
            assert sent <= 10 * PIECES
            write(page, "\\ F3 R")
            send_once(page)
            expect(page.locator("#position-1")).to_have_text(str(3 * sent))
    finally:
        bridge.close()
        line.close()
        unit.end()


def test_disconnecting_gives_the_port_back_and_the_virtual_unit_is_there_again(page):
    page.locator("#connect").click()
    expect(page.locator("#port")).to_be_enabled()
    expect(page.locator("#banner")).to_be_hidden()
    page.wait_for_function("fakeSerial.readable === null")
    page.locator("#port").select_option("virtual")
    page.locator("#connect").click()

    expect(page.locator("#state")).to_contain_text("virtual unit in this page")
    expect(page.locator("#alone-hint")).to_be_visible()
    expect(page.locator("#position-1")).to_have_text("0")


def test_axe_finds_nothing_serious_in_an_alarm_on_a_line(page):
    send(page, LONG)
    page.evaluate("fakeSerial.pull()")
    expect(page.locator("#alarm")).to_be_visible()
    page.evaluate(AXE.read_text())
    width, height = SIZES[0]
    page.set_viewport_size({"width": width, "height": height})
    assert page.evaluate(VIOLATIONS) == []
    for finds in (OUTSIDE, OVER, CUT):
        assert page.evaluate(finds) == []
    page.set_viewport_size({"width": 1280, "height": 720})


def test_a_browser_without_webserial_says_what_to_use_instead(open_page):
    page = open_page("delete Navigator.prototype.serial")

    expect(page.locator("#serial-hint")).to_contain_text("take tools/rkm04 service")
    expect(page.locator("#connection-form")).to_be_hidden()
    assert re.search("virtual unit", page.locator("#state").inner_text())
