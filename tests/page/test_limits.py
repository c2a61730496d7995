"""The limits of the machine that is open: what is beyond is told, no faster speed is sent."""

from __future__ import annotations

import json
from typing import Any

import pytest
from playwright.sync_api import FilePayload, expect
from service_page import ServicePage, shown

LIMITS = {"position_min_steps": 0, "position_max_steps": 500, "speed_max_steps_per_s": 1000}
ABOVE = "motor 1, line 2: V1001 is above the machine's limit, 1,000 steps/s; nothing was sent"


def opened(page: ServicePage, program: str, **more: Any) -> None:
    """Open a machine whose first motor has limits."""
    motors = [{"program": program, "limits": LIMITS, **more}, *({"program": ""},) * 3]
    content = {"format": "rkm04-machine", "version": 1, "name": "Press", "motors": motors}
    file: FilePayload = {
        "name": "a.rkm", "mimeType": "application/json", "buffer": json.dumps(content).encode(),
    }  # fmt: skip
    page.page.locator("#machine-file").set_input_files(file)
    expect(page.page.locator("#machine-shown")).to_have_text("Press")
    expect(page.page.locator("#verdict")).to_have_text("no errors")


@pytest.mark.parametrize("button", ["#send", "#send-all"])
def test_a_program_above_the_limit_of_speed_is_not_sent_and_leads_to_the_command(page, button):
    opened(page, "\\ C100 S100\nV1001 F400 R")
    page.page.locator("#log-clear").click()
    page.page.locator(button).click()
    expect(page.answers.first).to_contain_text(ABOVE)
    assert "request" not in page.sent
    expect(page.page.locator(".cm-activeLine")).to_have_text("V1001 F400 R")

    page.send("\\ C100 S100 V1000 F400 R")
    expect(page.position(1)).to_have_text("400")


def test_nor_is_one_that_begins_with_a_speed_above_the_limit(page):
    opened(page, "\\ C100\nF400 R", limits={"speed_max_steps_per_s": 999})
    page.page.locator("#log-clear").click()
    page.page.locator("#send").click()
    expect(page.answers.first).to_contain_text(
        "motor 1, line 2: R (V1000) is above the machine's limit, 999 steps/s; nothing was sent"
    )
    page.send("\\ C100 V999 F400 R")
    expect(page.position(1)).to_have_text("400")


def test_a_program_for_all_motors_is_held_against_the_limits_of_each(page):
    opened(page, "\\ F1 R")
    page.page.locator("#tab-2").click()
    page.write("S100\nV1001 F400 R")
    page.page.locator("#motors label").first.click()
    page.page.locator("#send").click()
    expect(page.answers.first).to_contain_text(ABOVE)
    page.page.locator("#motors label").nth(2).click()
    page.page.locator("#send").click()
    expect(page.position(2)).to_have_text("400")


def test_a_speed_above_the_limit_is_not_sent_to_a_motor_in_motion(page):
    opened(page, "\\ C100 S100 V200 G400")
    page.send()
    page.page.locator("#speed").fill("1001")
    page.page.locator("#speed-form button").click()
    expect(page.answers.first).to_contain_text("V1001 is above the machine's limit")
    assert "speed" not in page.sent
    page.page.locator("#speed").fill("1000")
    page.page.locator("#speed-form button").click()
    expect(page.answers.first).to_contain_text("speed 1,000 steps/s")


def test_a_motor_is_not_run_by_hand_above_the_limit(page):
    opened(page, "\\ F1 R")
    page.page.locator("#commission").evaluate("(panel) => (panel.open = true)")
    page.page.locator("#commission-confirm").check()
    page.page.locator("#commission-speed").fill("1001")
    expect(page.page.locator("#commission-why")).to_contain_text("limit, 1,000 steps/s")
    expect(page.page.locator("#jog-forth")).to_be_disabled()
    page.page.locator("#commission-speed").fill("1000")
    expect(page.page.locator("#jog-forth")).to_be_enabled()
    page.page.locator("#commission").evaluate("(panel) => (panel.open = false)")


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("\\ C100 S100 V900 F400 R F101 R B501 R", "goes up to 12.525 mm, above its limit"),
        ("\\ C100 S100 V900 F500 R B501 R", "goes down to \N{MINUS SIGN}0.025 mm, below"),
    ],
)
def test_where_a_motor_leaves_its_limits_is_told_beside_its_curve(page, program, words):
    opened(page, program, steps_per_mm=40)
    page.page.locator("#scaled").check()
    legend = page.page.locator("#plan-motors .legend-words").first
    expect(legend).to_contain_text(words)
    page.write("\\ C100 S100 V900 F500 R B500 R")
    expect(legend).to_contain_text("pulses 1,000")
    page.page.locator("#scaled").uncheck()


def test_the_words_are_czech_too(browser, service):
    with shown(browser, service.url, locale="cs-CZ") as page:
        content = {
            "format": "rkm04-machine", "version": 1, "name": "Lis",
            "motors": [{"program": "F501 R", "limits": LIMITS}, *({"program": ""},) * 3],
        }  # fmt: skip
        file: FilePayload = {
            "name": "a.rkm", "mimeType": "application/json", "buffer": json.dumps(content).encode(),
        }  # fmt: skip
        page.page.locator("#machine-file").set_input_files(file)
        legend = page.page.locator("#plan-motors .legend-words").first
        expect(legend).to_contain_text("jede až na 501 kroků, nad svou mez")
