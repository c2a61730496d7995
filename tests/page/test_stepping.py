"""The simulation command by command, and lines of programs beside parts of the curves."""

from __future__ import annotations

from playwright.sync_api import Locator, expect
from service_page import ServicePage

PROGRAM = "S100 V1000\nW500\nF400 R\n@1 W10 J1"


def at(page: ServicePage) -> Locator:
    """The line at which the simulation is."""
    return page.page.locator(".cm-simulated-line")


def words(page: ServicePage) -> Locator:
    return page.page.locator("#steps-words")


def drawn(page: ServicePage, text: str) -> None:
    """Write a program, and wait for its curve."""
    page.write("F1 R")
    page.expect_pulses(1)
    page.write(text)
    page.expect_pulses(400)


def press(page: ServicePage, name: str, times: int = 1) -> None:
    for _ in range(times):
        page.page.locator(f"#steps-{name}").click()
        page.page.wait_for_timeout(20)


def beside(page: ServicePage, line: int) -> None:
    """Click beside a line."""
    box = page.page.locator(".cm-line").nth(line - 1).bounding_box()
    gutter = page.page.locator(".cm-breaks").bounding_box()
    assert box
    assert gutter
    page.page.mouse.click(gutter["x"] + gutter["width"] / 2, box["y"] + box["height"] / 2)


def over_curve(page: ServicePage, part: float) -> tuple[float, float]:
    """A point of the plot of speeds, from 0 to 1 of the time."""
    box = page.page.locator("#plan-speed .u-over").bounding_box()
    assert box
    return box["x"] + box["width"] * part, box["y"] + box["height"] / 2


def test_each_press_goes_on_by_one_command_and_back(page):
    drawn(page, PROGRAM)
    press(page, "one")
    expect(words(page)).to_contain_text("line 1: S100")
    expect(at(page)).to_have_text("S100 V1000")
    press(page, "one", 2)
    expect(words(page)).to_contain_text("line 2: W500")
    press(page, "one", 2)
    expect(words(page)).to_contain_text("at 0.5")
    expect(words(page)).to_contain_text("line 3: R")
    press(page, "back")
    expect(words(page)).to_contain_text("line 3: F400")
    press(page, "start")
    expect(words(page)).to_contain_text("at 0 s")


def test_the_simulation_runs_to_the_cursor_and_further_each_time(page):
    drawn(page, PROGRAM)
    page.page.locator(".cm-line").nth(3).click()
    press(page, "cursor")
    expect(words(page)).to_contain_text("line 4: @1")
    expect(words(page)).to_contain_text("400 steps")

    page.page.locator(".cm-line").nth(1).click()
    press(page, "cursor")
    expect(words(page)).to_contain_text("does not begin again")


def test_it_stops_at_break_points_of_every_motor(page):
    page.page.locator("#tab-2").click()
    page.write("W200\nT1")
    beside(page, 2)
    page.page.locator("#tab-1").click()
    drawn(page, PROGRAM)
    beside(page, 3)
    expect(page.page.locator(".cm-break:visible")).to_have_count(1)

    press(page, "run")
    expect(page.page.locator("#tab-2")).to_have_attribute("aria-selected", "true")
    expect(words(page)).to_contain_text("motor 2, line 2: T01")
    press(page, "run")
    expect(words(page)).to_contain_text("motor 1, line 3: F400")
    press(page, "run")
    expect(words(page)).to_contain_text("no break point is reached")
    page.page.locator("#tab-2").click()
    page.write("")


def test_the_f9_key_sets_a_break_point_and_takes_it_away(page):
    drawn(page, PROGRAM)
    page.page.locator(".cm-line").nth(1).click()
    page.page.keyboard.press("F9")
    press(page, "run")
    expect(at(page)).to_have_text("W500")

    page.page.locator(".cm-line").nth(1).click()
    page.page.keyboard.press("F9")
    press(page, "start")
    press(page, "run")
    expect(words(page)).to_contain_text("no break point is reached")


def test_the_cursor_in_a_curve_marks_its_line_and_a_click_keeps_it(page):
    drawn(page, "W1000\nF400 R\nW1000")
    page.page.mouse.move(*over_curve(page, 0.1))
    expect(at(page)).to_have_text("W1000")
    page.page.mouse.move(*over_curve(page, 0.5))
    expect(at(page)).to_have_text("F400 R")
    page.page.mouse.click(*over_curve(page, 0.5))
    page.page.mouse.move(5, 5)
    expect(at(page)).to_have_text("F400 R")
    expect(words(page)).to_contain_text("line 2: R")


def test_the_line_of_the_cursor_is_shown_in_the_curve(page):
    drawn(page, "W1000\nF400 R\nW1000")
    count = """(part) => {
        const canvas = document.querySelector("#plan-speed canvas");
        const over = document.querySelector("#plan-speed .u-over").getBoundingClientRect();
        const left = over.left - canvas.getBoundingClientRect().left + over.width * part;
        const data = canvas.getContext("2d").getImageData(left * devicePixelRatio, 12, 1, 1).data;
        return data[3];
    }"""
    page.page.locator(".cm-line").nth(1).click()
    page.page.wait_for_function(count, arg=0.43)
    assert page.page.evaluate(count, 0.1) == 0
    page.page.locator(".cm-line").nth(0).click()
    page.page.wait_for_function(count, arg=0.1)
    assert page.page.evaluate(count, 0.43) == 0


def test_a_loop_with_more_commands_than_are_told_is_followed_to_its_end(page):
    page.write("F1 R")
    page.expect_pulses(1)
    page.write("L90 L30 W1 E E\nF7 R")
    page.expect_pulses(7)
    page.page.locator(".cm-line").nth(1).click()
    press(page, "cursor")

    expect(words(page)).to_contain_text("line 2: F7")
    expect(at(page)).to_have_text("F7 R")


def test_an_edited_program_keeps_the_time_and_an_error_takes_the_marks_away(page):
    drawn(page, PROGRAM)
    press(page, "one", 3)
    expect(at(page)).to_have_count(1)
    page.page.locator(".cm-content").click()
    page.page.keyboard.press("ControlOrMeta+End")
    page.page.keyboard.type("V0")
    expect(at(page)).to_have_count(0)
