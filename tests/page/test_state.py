"""What the page says of a unit is true now, or is shown as not known."""

from __future__ import annotations

import re
import time

import pytest
import statuses
from fake_unit import FakeUnit
from playwright.sync_api import expect
from service_page import NOT_KNOWN, ServicePage, shown

MOVING, RUNNING, WAITING, STOPPED, FAILED, ENDED, SIMULATED = (1 << bit for bit in range(7))
NODE, OTHER = 3, 5
SOON_MS = 3000
"""A second until the page goes grey, and what a busy machine takes."""


def status(*states: int, **more) -> bytes:
    return statuses.Vector("", motors=[*states, 0, 0, 0, 0][:4], **more).whole


@pytest.fixture
def unit():
    return FakeUnit(NODE, status=status(positions_steps=[5000, -5, 77, 0], inputs=5, outputs=2))


def expect_not_known(page: ServicePage) -> None:
    expect(page.page.locator("#live")).to_have_attribute("data-fresh", "false", timeout=SOON_MS)
    expect(page.page.locator("#state")).not_to_have_attribute("data-kind", "good")
    for motor in (1, 2, 3, 4):
        expect(page.position(motor)).to_have_text(NOT_KNOWN)
        expect(page.page.locator(f"#speed-{motor}")).to_have_text("")
        expect(page.state(motor)).to_contain_text("not known")
    lamps = page.page.locator(".lamp")
    assert {lamp.get_attribute("data-level") for lamp in lamps.all()} == {"unknown"}
    expect(page.page.locator(".card[data-moving=true]")).to_have_count(0)
    expect(page.page.locator("#live-facts")).to_be_hidden()


def test_a_unit_that_restarts_is_told_until_somebody_has_noted_it(lines_page, unit):
    loud = lines_page.page.locator("#loud")
    unit.status = status(late_steps=7)
    expect(lines_page.page.locator("#live-facts")).to_contain_text("late steps 7")
    expect(loud).to_be_hidden()
    unit.status = status()
    expect(loud).to_contain_text("THE UNIT HAS RESTARTED")
    assert loud.evaluate("part => parseFloat(getComputedStyle(part).fontSize)") >= 22
    lines_page.page.wait_for_timeout(500)
    lines_page.page.reload()
    lines_page.ready()
    expect(loud).to_contain_text("THE UNIT HAS RESTARTED")
    lines_page.page.locator("#seen").click()
    expect(loud).to_be_hidden()
    lines_page.page.reload()
    lines_page.ready()
    expect(loud).to_be_hidden()


def test_another_unit_has_not_restarted(lines_page, line, unit):
    loud = lines_page.page.locator("#loud")
    unit.status = status(late_steps=7)
    expect(lines_page.page.locator("#live-facts")).to_contain_text("late steps 7")
    unit.status = status()
    expect(loud).to_be_visible()
    lines_page.connect(line.port, OTHER)
    lines_page.ready()
    expect(loud).to_be_hidden()
    lines_page.connect(line.port, NODE)
    expect(loud).to_be_visible()
    lines_page.page.locator("#seen").click()
    expect(loud).to_be_hidden()


def test_each_motor_says_what_it_does(lines_page, unit):
    everything = [
        (status(MOVING | RUNNING, 0, RUNNING, MOVING),
         ["moves", "rests, nothing left to run", "runs commands", "slows down"]),
        (statuses.Vector("", motors=[6] * 4, waits=[5 + 128, 81, 96, 97]).whole,
         ["waits for input 5 = 1", "waits for variable 81 = 0", "waits for a time", "waits for ]"]),
        (status(STOPPED, STOPPED | MOVING, ENDED, ENDED | MOVING),
         ["stopped by K", "stopped by K, slows down", "stopped by X",
          "stopped by X, slows down"]),
        (status(MOVING | RUNNING | SIMULATED, SIMULATED, MOVING | RUNNING, STOPPED | SIMULATED),
         ["moves, simulated", "rests, nothing left to run, simulated", "moves",
          "stopped by K, simulated"]),
        (status(FAILED, FAILED | MOVING, 0, 0, errors=[1, 6, 0, 0]),
         ["failed: label not found", "failed: more than 10 sections, slows down",
          "rests, nothing left to run", "rests, nothing left to run"]),
    ]  # fmt: skip
    for answer, words in everything:
        unit.status = answer
        for motor, text in enumerate(words, 1):
            expect(lines_page.state(motor)).to_have_text(text)
    cards = lines_page.page.locator(".card")
    expect(cards.nth(0)).to_have_attribute("data-state", "failed")
    expect(cards.nth(1)).to_have_attribute("data-moving", "true")
    expect(cards.nth(2)).to_have_attribute("data-state", "rests")
    lines_page.page.locator("#language").select_option("cs")
    expect(lines_page.state(1)).to_have_text("chyba: návěští nenalezeno")
    lines_page.page.locator("#language").select_option("en")


def test_inputs_outputs_late_steps_and_counters_of_a_line_are_shown(lines_page, unit):
    inputs, outputs = (
        lines_page.page.locator(f"#live-{kind} .lamp") for kind in ("inputs", "outputs")
    )
    expect(inputs.nth(2)).to_have_attribute("data-level", "1")
    expect(inputs.nth(1)).to_have_attribute("data-level", "0")
    expect(inputs.nth(2)).to_be_disabled()
    expect(outputs.nth(1)).to_have_attribute("data-level", "1")
    facts = lines_page.page.locator("#live-facts")
    expect(facts).to_contain_text("late steps 0")

    counts = [9, 0, 1, 2, 3, 0, 0, 0, 0, 0, 4, 0]
    unit.status = statuses.Vector("", cause=2, switches=15, late_steps=12, line_counts=counts).whole

    for words in ("late steps 12", "faults on the line 6, repeats 4", "restarted by the watchdog",
                  "stored programs were not started", "crystal missing", "T41", "T40"):  # fmt: skip
        expect(facts).to_contain_text(words)
    facts.locator("summary").click()
    expect(facts).to_contain_text("FCS 3")


def test_a_silent_unit_is_grey_a_second_later_and_its_age_is_told(
    browser, lines_page, lines_service, line, unit
):
    line.units.clear()
    started = time.monotonic()
    live = lines_page.page.locator("#live")

    expect(live).to_have_attribute("data-fresh", "false", timeout=SOON_MS)
    assert time.monotonic() - started > 0.7
    expect_not_known(lines_page)
    expect(lines_page.state(1)).to_have_text("state not known, was at 5,000")
    head = lines_page.page.locator("#state")
    expect(head).to_contain_text(re.compile(r"last seen \d+ s ago"))
    expect(lines_page.page.locator("#live-hint")).to_contain_text("The unit is silent (last seen")
    with shown(browser, lines_service.url, waits=False) as second:
        expect(second.page.locator("#state")).to_contain_text(re.compile(r"last seen \d+ s ago"))
        expect_not_known(second)
    first = head.inner_text()
    expect(head).not_to_have_text(first)

    line.units[NODE] = unit
    expect(lines_page.position(1)).to_have_text("5,000")
    expect(head).to_have_attribute("data-kind", "good")


def test_a_node_that_never_answered_is_never_green(lines_page, line):
    head = lines_page.page.locator("#state")
    lines_page.page.evaluate("""() => {
        window.greens = 0;
        const head = document.querySelector("#state");
        new MutationObserver(() => {
            greens += head.dataset.kind === "good" && head.textContent.includes("node 9");
        }).observe(head, { attributes: true, childList: true });
    }""")
    lines_page.connect(line.port, 9)

    expect(head).to_contain_text("has never answered")
    expect_not_known(lines_page)
    lines_page.page.wait_for_timeout(1500)
    assert lines_page.page.evaluate("greens") == 0
    expect(lines_page.page.locator("#banner")).to_contain_text("unit 9 does not answer")


def test_an_original_unit_shows_positions_only_and_says_so(lines_page, line, unit):
    unit.status = b""
    unit.positions = [10, 20, 30, -40]

    expect(lines_page.position(4)).to_have_text("\N{MINUS SIGN}40")
    expect(lines_page.page.locator("#live-hint")).to_contain_text("does not know Get Status")
    expect(lines_page.page.locator("#state")).to_have_attribute("data-kind", "good")
    expect(lines_page.state(1)).to_have_text("state not known")
    expect(lines_page.page.locator("#live-inputs .lamp").first).to_have_attribute(
        "data-level", "unknown"
    )


def test_a_port_that_is_lost_comes_back_by_itself_and_is_only_read(lines_page, line, reopen):
    line.close()
    banner = lines_page.page.locator("#banner")
    expect(banner).to_contain_text("sends nothing that moves")
    expect_not_known(lines_page)
    lines_page.page.locator("#resume").click()
    expect(lines_page.answers.first).to_have_class("log-item is-bad")

    again = reopen()
    expect(lines_page.position(1)).to_have_text("5,000")
    expect(banner).to_be_hidden()
    lines_page.page.wait_for_timeout(300)
    assert {message[0] for _, _, message in again.requests} <= {1, 4, 200}
