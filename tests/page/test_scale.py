"""Curves and fields in mm and degrees, where the machine says how far a step goes."""

from __future__ import annotations

import json

from playwright.sync_api import expect
from plot_pixels import pixels
from scaled_machine import MACHINE
from service_page import ServicePage


def opened(page: ServicePage) -> None:
    """Open the machine, and show it in its units."""
    content = json.dumps(MACHINE).encode()
    page.page.locator("#machine-file").set_input_files(
        {"name": "table.rkm", "mimeType": "application/json", "buffer": content}
    )
    page.expect_pulses(990)
    page.page.locator("#scaled").check()


def test_without_scales_there_is_no_switch(page):
    assert page.page.locator("#scaled").is_hidden()


def test_curves_are_in_mm_and_degrees_and_back_in_steps(page):
    opened(page)
    heading = page.page.locator("#plan h3").nth(0)
    expect(heading).to_have_text("Speed, mm/s, °/s")
    words = page.page.locator("#plan-motors .legend-words")
    expect(words.nth(0)).to_contain_text("mm/s")
    expect(words.nth(1)).to_contain_text("°/s")
    expect(words.nth(2)).to_contain_text("not drawn: no mm or °")
    assert pixels(page, "plan-position", 1) > 100
    assert pixels(page, "plan-position", 3) == 0

    page.page.locator("#scaled").uncheck()
    expect(heading).to_have_text("Speed, steps/s")
    assert pixels(page, "plan-position", 3) > 100


def test_the_unit_is_shown_in_mm_too_and_the_field_of_the_speed(page):
    opened(page)
    page.page.locator("#motors label").nth(1).click()
    page.send("\\ C100 S100 V1000 F400 R")
    expect(page.position(1)).to_have_text("10 mm")
    expect(page.position(3)).to_have_text("0")
    page.page.locator("#speed").fill("500")
    expect(page.page.locator("#speed-scaled")).to_have_text("= 12.5 mm/s")
    page.page.locator("#scaled").uncheck()
    expect(page.position(1)).to_have_text("400")


def test_fields_of_commissioning_say_what_they_are_in_mm(page):
    opened(page)
    page.page.locator("#commission").evaluate("(panel) => (panel.open = true)")
    fields = {
        "speed": ("500", "= 12.5 mm/s"),
        "ramp": ("1000", "= 25 mm/s²"),
        "step": ("10", "= 0.25 mm"),
        "farthest": ("2000", "= 50 mm"),
        "away": ("50", "= 1.25 mm"),
    }
    for name, (value, words) in fields.items():
        page.page.locator(f"#commission-{name}").fill(value)
        expect(page.page.locator(f"#commission-{name}-scaled")).to_have_text(words)
    page.send("\\ C100 S100 V1000 F400 R")
    expect(page.page.locator("#commission-position")).to_have_text("10 mm")
    page.page.locator("#commission-motor").select_option("2")
    expect(page.page.locator("#commission-step-scaled")).to_have_text("= 0.5 °")
    page.page.locator("#commission-motor").select_option("3")
    expect(page.page.locator("#commission-step-scaled")).to_have_text("")
    page.page.locator("#scaled").uncheck()
    page.page.locator("#commission").evaluate("(panel) => (panel.open = false)")
