"""The programs of all motors at once, all units at once, and who is on the line."""

from __future__ import annotations

import json

import pytest
from playwright.sync_api import WebSocket, expect
from service_page import ServicePage

NODES = [str(node) for node in range(1, 17)]
SCANS = 3
"""A scan waits 45 ms for a unit: a busy machine may take longer."""


@pytest.fixture
def requests(page: ServicePage) -> list[dict[str, object]]:
    """What the page asks for, to be emptied by the test. Opened anew, so that all of it is seen."""
    asked: list[dict[str, object]] = []

    def note(payload: str | bytes) -> None:
        told = json.loads(payload)
        if told["type"] in ("request", "connect"):
            asked.append({key: told[key] for key in told if key not in ("id", "beat")})

    def listen(socket: WebSocket) -> None:
        socket.on("framesent", note)

    page.page.on("websocket", listen)
    page.page.reload()
    page.ready()
    return asked


def write_for(page: ServicePage, motor: int, text: str) -> None:
    page.page.locator(f"#tab-{motor}").click()
    page.write(text)


def test_all_programs_are_sent_each_to_its_own_motor(page, requests):
    for motor in (3, 1, 4):
        write_for(page, motor, f"\\ C100 F{motor} R")
    write_for(page, 2, "")
    page.page.locator("#send-all").click()

    for motor, position in ((1, "1"), (2, "0"), (3, "3"), (4, "4")):
        expect(page.position(motor)).to_have_text(position)
    expect(page.answers.first).to_contain_text("motor 1: commands 3, motor 3: commands 3, motor 4")
    expect(page.answers.first).to_contain_text("each runs since it arrived")
    (asked,) = requests
    assert asked["together"] is False

    page.forget(2)
    page.page.locator("#together").check()
    page.page.locator("#send-all").click()
    expect(page.answers.first).to_contain_text("started together")
    assert requests[-1] == {**asked, "together": True}

    page.page.locator("#store-all").click()
    expect(page.answers.first).to_contain_text("motor 4: commands stored: 5")
    assert requests[-1] == {"type": "request", "message": "store", "motor": 0}


def test_an_error_in_one_program_leads_to_it_and_nothing_is_sent(page):
    write_for(page, 1, "\\ C100 F10 R")
    write_for(page, 3, "F10 R\nR S0")
    page.page.locator("#tab-1").click()
    page.page.locator("#send-all").click()

    expect(page.answers.first).to_contain_text("motor 3: S (start/stop speed)")
    expect(page.answers.first).to_contain_text("nothing was sent to any motor")
    expect(page.page.locator("#tab-3")).to_have_attribute("aria-selected", "true")
    page.page.keyboard.insert_text("V")
    assert page.text() == "F10 R\nR VS0"
    assert page.steps() == 0


def test_all_units_are_meant_once_and_the_page_says_that_none_answers(page, requests):
    units, send = page.page.locator("#units"), page.page.locator("#send")
    write_for(page, 2, "\\ C100 F7 R")
    units.select_option("0")
    expect(send).to_have_text("Send to all units")
    expect(page.page.locator("#send-hint")).to_contain_text("None of them answers")
    page.send()
    expect(page.answers.first).to_contain_text("node 0: all units")
    expect(page.answers.first).to_contain_text("it is not known who has got it")
    assert requests[-1]["everywhere"] is True
    expect(units).to_have_value("")

    page.page.locator("#message").select_option("position")
    units.select_option("0")
    expect(send).to_be_disabled()
    units.select_option("")
    page.send()
    assert "everywhere" not in requests[-1]


def test_a_scan_finds_the_units_and_a_click_goes_to_one(page, requests):
    found = page.page.locator("#found button")
    for _ in range(SCANS):
        answers = page.answers.count()
        page.page.locator("#scan").click()
        expect(page.answers).to_have_count(answers + 1)
        if found.count() == len(NODES):
            break
    assert found.all_text_contents() == NODES
    expect(found.nth(0)).to_have_attribute("aria-pressed", "true")
    assert {asked["message"] for asked in requests} == {"scan"}

    found.nth(10).click()
    expect(page.page.locator("#state")).to_contain_text("node 11")
    assert requests[-1] == {"type": "connect", "port": "virtual", "node": 11}
    expect(found.nth(10)).to_have_attribute("aria-pressed", "true")
    found.nth(0).click()
    expect(page.page.locator("#state")).to_contain_text("node 1 ")


def test_k_and_c75_in_the_editor_go_alone_to_the_motor_that_is_chosen(page):
    for motor in (1, 2):
        write_for(page, motor, "\\ C100 S500 V500 A20000 G+")
    page.page.locator("#send-all").click()
    page.expect_beyond(100, 2)
    page.page.locator("#tab-1").click()
    page.send("K")
    expect(page.answers.first.locator(".log-message code").first).to_have_text("02 31 4B")
    expect(page.answers.first).to_contain_text("K sent and accepted")
    stands = page.expect_standing(1)
    page.expect_beyond(page.steps(2), 2)

    page.send("C75")
    page.expect_beyond(stands)
    page.send("V900")
    expect(page.answers.first.locator(".log-message code").first).to_have_text("02 31 56 39 30 30")
