"""Store all: what the unit holds is read first; where it is not what is shown, the page asks."""

from __future__ import annotations

import pytest
from fake_unit import FakeLine, FakeUnit
from playwright.sync_api import expect
from service_page import ServicePage

STORE_ALL = b"\x030"
GET_COMMAND_2 = b"\x052"
REFUSED = b"\xff\x05\0\0"


@pytest.fixture
def page(lines_page: ServicePage, unit: FakeUnit) -> ServicePage:
    """With a unit that holds the program of the page."""
    lines_page.page.locator("#tab-1").click()
    lines_page.write("\\ C100\nF5 R { there }")
    unit.programs[1] = b"C100F5R"
    unit.programs[4] = b"]"  # sending has left it there
    return lines_page


def asked(page: ServicePage) -> list[str]:
    """What is told of the motors when the page asks."""
    page.page.locator("#store-all").click()
    expect(page.page.locator("#store-ask")).to_be_visible()
    return page.page.locator("#store-others li").all_inner_texts()


def test_a_unit_that_holds_what_is_shown_stores_without_a_question(page, unit: FakeUnit):
    page.page.locator("#store-all").click()
    expect(page.answers.first).to_contain_text("motor 1: commands stored: 3")
    assert unit.done.count(STORE_ALL) == 1
    assert page.page.locator("#store-ask").is_hidden()


def test_what_is_not_shown_is_stored_only_after_a_confirmation(page, unit: FakeUnit):
    unit.programs |= {1: b"C100F6R", 3: b"F7R"}
    differences = [
        "Motor 1: NOT THE SAME: command 2, line 2: here F5, in the unit F6",
        "Motor 3: NOT THE SAME: command 1: here nothing, in the unit F7",
    ]
    assert asked(page) == differences
    expect(page.page.locator("#store-ask")).to_contain_text("stored is what the unit holds, not")
    expect(page.page.locator("#store-anyway")).to_be_disabled()
    page.page.locator("#store-not").click()
    expect(page.page.locator("#store-words")).to_have_text("Nothing was stored.")

    assert asked(page) == differences
    page.page.locator("#store-confirm").focus()
    page.page.keyboard.press("Space")
    assert unit.done.count(STORE_ALL) == 0
    page.page.keyboard.press("Tab")
    page.page.keyboard.press("Enter")
    expect(page.answers.first).to_contain_text("motor 3: commands stored: 2")
    expect(page.page.locator("#store-ask")).to_be_hidden()
    assert unit.done.count(STORE_ALL) == 1


def test_what_a_unit_does_not_tell_is_not_known_and_nothing_is_stored(
    page, unit: FakeUnit, line: FakeLine
):
    not_known = "not known: the unit told no program that can be read"
    unit.answers[GET_COMMAND_2] = REFUSED
    assert asked(page) == [f"Motor 2: {not_known}"]
    page.write("\\ C100 F5 R R")
    expect(page.page.locator("#store-ask")).to_be_hidden()
    expect(page.page.locator("#store-words")).to_contain_text("Nothing was stored: the programs")

    del line.units[unit.node]
    assert asked(page) == [f"Motor {motor}: {not_known}" for motor in (1, 2, 3, 4)]
    page.page.locator("#language").select_option("cs")
    expect(page.page.locator("#store-others li").first).to_have_text(
        "Motor 1: není známo: jednotka neřekla žádný program, který lze přečíst"
    )
    page.page.locator("#language").select_option("en")
    page.page.locator("#store-not").click()
    assert STORE_ALL not in unit.done
