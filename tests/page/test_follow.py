"""The line that the unit runs, in the editor."""

from __future__ import annotations

from playwright.sync_api import Locator, expect
from service_page import ServicePage, shown
from statuses import Vector

LOOP = "\\ C100\n@1\nW60000\nJ1"


def running(page: ServicePage) -> Locator:
    """The line that is marked as run by the unit."""
    return page.page.locator(".cm-unit-line")


def words(page: ServicePage) -> Locator:
    return page.page.locator("#follow")


def test_the_line_that_the_virtual_unit_runs_is_marked(page):
    page.send(LOOP)

    expect(running(page)).to_have_text("W60000")
    expect(words(page)).to_have_text("motor 1 runs line 3: W60000")


def test_the_mark_goes_from_line_to_line_and_is_gone_at_the_end(page):
    page.send("\\ C100\nW1500\nV500 F400 R\nB20 R")

    expect(running(page)).to_have_text("W1500")
    expect(running(page)).to_have_text("V500 F400 R")
    expect(running(page)).to_have_count(0)
    expect(words(page)).to_have_text("motor 1 runs no command")


def test_each_motor_has_its_own_line(page):
    page.send(LOOP)
    page.page.locator("#tab-2").click()
    page.page.locator("#motors label").nth(2).click()
    page.send("\\ C100 {two}\nW50000")
    expect(running(page)).to_have_text("W50000")

    page.page.locator("#tab-1").click()
    expect(running(page)).to_have_text("W60000")


def test_a_program_that_was_edited_is_not_the_one_that_runs(page):
    page.send(LOOP)
    expect(running(page)).to_have_count(1)
    page.page.locator(".cm-content").click()
    page.page.keyboard.press("ControlOrMeta+End")
    page.page.keyboard.type(" F1")

    expect(words(page)).to_have_text("motor 1 holds another program: its line is not in this one")
    expect(running(page)).to_have_count(0)
    page.page.keyboard.press("Backspace")
    page.page.keyboard.press("Backspace")
    expect(running(page)).to_have_text("W60000")


def test_what_the_unit_holds_is_read_when_it_is_not_known(page):
    page.send(LOOP)
    page.page.reload()
    page.ready()
    expect(words(page)).to_have_text("which program motor 1 holds is not known here:")
    expect(running(page)).to_have_count(0)

    page.page.locator("#follow-read").click()
    expect(running(page)).to_have_text("W60000")
    assert page.page.locator("#follow-read").is_hidden()


def test_a_program_that_was_added_to_another_is_followed_too(page):
    page.send("\\ C100 F1 R")
    expect(page.position(1)).to_have_text("1")
    page.send("@3\nW40000 J3")

    expect(running(page)).to_have_text("W40000 J3")


def test_what_another_page_sends_is_not_taken_for_known(page, browser, service):
    page.send(LOOP)
    expect(running(page)).to_have_count(1)
    with shown(browser, service.url) as other:
        other.send("\\ W70000")
        expect(running(other)).to_have_text("\\ W70000")

    expect(words(page)).to_have_text("which program motor 1 holds is not known here:")
    expect(running(page)).to_have_count(0)


def test_a_program_of_several_messages_is_followed_too(page):
    filling = "T1 C1\n" * 300
    page.send(f"\\ C100\n{filling}W60000")

    expect(running(page)).to_have_text("W60000")


def test_programs_that_start_together_are_followed(page):
    page.forget(0)
    page.page.reload()
    page.ready()
    page.write("W30000")
    page.page.locator("#tab-2").click()
    page.write("@1 W31000 J1")
    before = page.answers.count()
    page.page.locator("#together").check()
    page.page.locator("#send-all").click()
    expect(page.answers).to_have_count(before + 1)

    expect(words(page)).to_have_text("which program motor 2 holds is not known here:")
    page.page.locator("#follow-read").click()
    expect(running(page)).to_have_text("@1 W31000 J1")


def test_a_unit_that_falls_silent_has_no_marked_line(lines_page, line, unit):
    page = lines_page
    unit.states[0] = 2
    page.send("\\ F1\nF2\nW5")
    expect(running(page)).to_have_text("W5")

    line.units.pop(unit.node)
    expect(words(page)).to_have_text("the unit is silent: which line runs is not known")
    expect(running(page)).to_have_count(0)


def test_a_unit_that_has_counted_less_than_before_has_started_anew(lines_page, unit):
    page = lines_page
    unit.states[0] = 2
    unit.status = Vector("", motors=unit.states, late_steps=7).whole
    page.send("\\ F1\nF2\nW5")
    expect(running(page)).to_have_text("W5")

    unit.status = Vector("", motors=unit.states, late_steps=0).whole
    expect(words(page)).to_have_text("which program motor 1 holds is not known here:")


def test_of_an_original_unit_the_line_is_that_which_runs_or_ran_last(lines_page, unit):
    page = lines_page
    unit.status = b""
    page.send("\\ F1\nF2\nW5")

    expect(running(page)).to_have_text("W5")
    expect(words(page)).to_have_text("motor 1 runs, or ran last, line 3: W5")


def test_a_place_outside_of_the_program_has_no_line(lines_page, unit):
    page = lines_page
    unit.states[0] = 2
    page.send("\\ F1\nF2")

    expect(words(page)).to_have_text("motor 1 runs a command that is not in this program")
    expect(running(page)).to_have_count(0)
