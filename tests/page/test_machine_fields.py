"""Scales, limits and names of a machine, edited in the page: what is right counts at once."""

from __future__ import annotations

import copy
from typing import Any

from machine_page import open_machine, save
from playwright.sync_api import Locator, expect
from scaled_machine import MACHINE
from service_page import ServicePage

LIMITS = {"position_min_steps": 0, "position_max_steps": 300}


def told(**more: Any) -> dict[str, Any]:
    """The machine, with limits and a name."""
    content = copy.deepcopy(MACHINE)
    content["motors"][0]["limits"] = LIMITS
    return {**content, "input_names": {"3": "door"}, **more}


def at(page: ServicePage, name: str) -> Locator:
    return page.page.locator(f"#machine-{name}")


def enter(page: ServicePage, name: str, value: str) -> None:
    """Type it as a user does, and go on to the next field."""
    at(page, name).focus()
    page.page.keyboard.press("ControlOrMeta+a")
    page.page.keyboard.press("Delete")
    page.page.keyboard.type(value)
    page.page.keyboard.press("Tab")


def opened(page: ServicePage) -> None:
    open_machine(page, told())
    page.expect_pulses(990)
    page.page.locator("#scaled").check()
    page.page.locator("#machine summary").click()


def test_what_is_edited_counts_at_once_is_saved_and_kept_until_the_file_is_opened_again(page):
    opened(page)
    words = page.page.locator("#plan-motors .legend-words")
    expect(words.nth(0)).to_contain_text("goes up to 10 mm, above its limit")
    enter(page, "1-scale", "80.5")
    expect(words.nth(0)).to_contain_text("goes up to 4.969 mm, above its limit")
    enter(page, "1-highest", "400")
    expect(words.nth(0)).not_to_contain_text("limit")
    expect(page.page.locator("label[for=machine-1-highest] ~ .hint")).to_have_text("= 4.969 mm")
    expect(words.nth(2)).to_contain_text("not drawn")
    enter(page, "3-scale", "10")
    at(page, "3-unit").select_option("degree")
    expect(words.nth(2)).to_contain_text("°/s")
    enter(page, "2-scale", "")
    expect(words.nth(1)).to_contain_text("not drawn")
    enter(page, "1-fastest", "900")
    enter(page, "1-name", "feed")
    enter(page, "input-3", "")
    enter(page, "output-8", " left lamp ")
    expect(page.page.locator("#tab-1")).to_have_text("Motor 1 · feed")
    expect(page.page.locator("#live-outputs .lamp").nth(7)).to_have_text("8 left lamp")
    expect(page.page.locator("#live-inputs button").nth(2)).to_have_text("3")
    page.page.locator("#send").click()
    expect(page.answers.first).to_contain_text("V1000 is above the machine's limit, 900 steps/s")

    page.page.reload()
    page.ready()
    expect(at(page, "3-unit")).to_have_value("degree")
    wanted = told(output_names={"8": "left lamp"})
    del wanted["input_names"], wanted["motors"][1]["steps_per_degree"]
    limits = {**LIMITS, "position_max_steps": 400, "speed_max_steps_per_s": 900}
    wanted["motors"][0] |= {"name": "feed", "steps_per_mm": 80.5, "limits": limits}
    wanted["motors"][2]["steps_per_degree"] = 10
    assert save(page)[1] == wanted
    open_machine(page, told())
    expect(at(page, "1-scale")).to_have_value("40")
    assert save(page)[1] == told()
    page.page.locator("#scaled").uncheck()


def test_what_is_wrong_is_told_beside_its_field_changes_nothing_and_is_not_saved(page):
    opened(page)
    wrong = {
        "1-scale": ("-1", "-1 must be more than 0"),
        "2-scale": ("-", "must be a number"),
        "1-lowest": ("0.5", "must be a whole number"),
        "1-highest": ("-5", "the lowest position is above the highest one"),
        "2-fastest": ("16001", "16001 is too large; 16,000 is the most"),
        "input-1": ("a" * 61, "is too long; 60 characters are the most"),
    }
    for name, (value, words) in wrong.items():
        enter(page, name, value)
        expect(at(page, f"{name}-trouble")).to_have_text(words)
        expect(at(page, name)).to_have_attribute("aria-invalid", "true")
    page.page.locator("#machine-save").click()
    trouble = page.page.locator("#machine-trouble")
    expect(trouble).to_have_text("Not saved: Motor 1, Steps per mm or °: -1 must be more than 0")
    expect(page.page.locator("#live-inputs button").first).to_have_text("1")
    page.page.locator("#language").select_option("cs")
    expect(at(page, "1-highest-trouble")).to_have_text("nejnižší poloha je nad nejvyšší")
    page.page.locator("#language").select_option("en")

    enter(page, "1-lowest", "-9")
    for name in ("1-lowest", "1-highest"):
        expect(at(page, f"{name}-trouble")).to_be_empty()
    for name, value in (("1-scale", "40"), ("2-scale", "20"), ("2-fastest", ""), ("input-1", "")):
        enter(page, name, value)
    wanted = told()
    wanted["motors"][0]["limits"] = {"position_min_steps": -9, "position_max_steps": -5}
    assert save(page)[1] == wanted
    page.page.locator("#scaled").uncheck()
