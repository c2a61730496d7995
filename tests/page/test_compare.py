"""The programs of the page beside those of the unit: it is only read, differences have places."""

from __future__ import annotations

from playwright.sync_api import expect
from service_page import ServicePage

LONG = "\\ " + "F1 R W10\n" * 200


def compared(page: ServicePage) -> list[str]:
    """What is told of each motor."""
    page.page.locator("#machine-compare").click()
    rows = page.page.locator("#compared li")
    expect(rows).to_have_count(4)
    expect(page.page.locator("#compared")).not_to_contain_text("asked")
    return rows.all_inner_texts()


def test_programs_that_the_unit_holds_are_the_same_until_they_are_edited(page):
    page.page.locator("#motors label").first.click()
    page.send("\\")
    page.page.locator("#motors label").nth(1).click()
    page.send("\\ C100 S100\nV1000 F4 R { there }")
    kept = ": no program here, and none in the unit"
    words = ["Motor 1: the same here and in the unit", *(f"Motor {n}{kept}" for n in (2, 3, 4))]
    assert compared(page) == words
    assert set(page.sent) <= {"request", "ports"}

    page.write("\\ C100 S100\nV1000 F5 R")
    expect(page.page.locator("#compared")).to_be_hidden()
    place = "command 4, line 2: here F5, in the unit F4"
    assert compared(page)[0] == f"Motor 1: NOT THE SAME: {place}"
    page.write("\\ C100 S100\nV1000 F4")
    assert compared(page)[0].endswith("command 5: here nothing, in the unit R")
    page.write("")
    assert compared(page)[0].endswith("command 1: here nothing, in the unit C100")


def test_a_program_that_went_in_several_messages_is_the_same(page):
    page.send(LONG)
    assert compared(page)[0] == "Motor 1: the same here and in the unit"


def test_what_cannot_be_read_is_not_called_the_same(page):
    page.write("F99999999999 R")
    assert compared(page)[0].startswith("Motor 1: not compared")


def test_a_program_that_is_sent_takes_the_findings_away(page):
    compared(page)
    page.send("\\ F1 R")
    expect(page.page.locator("#compared")).to_be_hidden()
