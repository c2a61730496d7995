"""The curves of what programs would do."""

from __future__ import annotations

import re

from playwright.sync_api import expect
from service_page import ServicePage

PIXELS = """([canvas_of, colour]) => {
    const probe = document.createElement("span");
    probe.style.color = `var(${colour})`;
    document.body.append(probe);
    const wanted = getComputedStyle(probe).color.match(/\\d+/g).map(Number);
    probe.remove();
    const canvas = document.querySelector(canvas_of);
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
        count += wanted.every((value, k) => Math.abs(value - data[i + k]) < 8) && data[i + 3] > 200;
    }
    return count;
}"""


def pixels(page: ServicePage, plot: str, motor: int) -> int:
    """Pixels of a plot that have the colour of a motor."""
    return coloured(page, f"#{plot} canvas", f"--motor-{motor}")


def coloured(page: ServicePage, canvas: str, colour: str) -> int:
    count: int = page.page.evaluate(PIXELS, [canvas, colour])
    return count


def seen(page: ServicePage) -> tuple[float, float]:
    first, last = (page.plan.get_attribute("data-range") or "").split()
    return float(first), float(last)


def test_the_curve_follows_the_text_while_it_is_typed(page):
    page.write("S100 V1000 A2000 F400 R")
    page.expect_pulses(400)
    assert pixels(page, "plan-speed", 1) > 100
    assert pixels(page, "plan-position", 1) > 100

    page.page.keyboard.type(" R")
    page.expect_pulses(800)


def test_motors_are_drawn_together_and_can_be_switched_off(page):
    page.write("F400 R")
    page.page.locator("#tab-2").click()
    page.write("B300 R")
    page.expect_pulses(700)
    assert pixels(page, "plan-position", 2) > 100

    page.page.locator("#plan-motors input").nth(1).uncheck()
    assert pixels(page, "plan-position", 2) == 0
    assert pixels(page, "plan-position", 1) > 100


def test_an_error_leaves_the_last_curve_and_says_so(page):
    page.write("F400 R")
    page.expect_pulses(400)
    page.page.keyboard.type(" V0")
    expect(page.plan).to_have_attribute("data-state", "old")
    page.expect_pulses(400)
    page.page.keyboard.press("Backspace")
    page.page.keyboard.type("500")
    expect(page.plan).to_have_attribute("data-state", "new")


def test_no_program_means_no_curve(page):
    page.write("F400 R")
    page.expect_pulses(400)
    page.write(" ")
    expect(page.plan).to_have_attribute("data-state", "empty")
    assert pixels(page, "plan-speed", 1) == 0


def test_the_wheel_zooms_around_the_cursor_and_a_double_click_shows_all(page):
    page.write("S100 V1000 A2000 F4000 R")
    page.expect_pulses(4000)
    first, last = seen(page)
    box = page.page.locator("#plan-speed .u-over").bounding_box()
    assert box
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
    page.page.mouse.wheel(0, -100)
    page.page.wait_for_function("old => document.querySelector('#plan').dataset.range !== old",
                                arg=f"{first:g} {last:g}")  # fmt: skip
    assert first < seen(page)[0] < seen(page)[1] < last

    page.page.locator("#plan-position .u-over").dblclick()
    assert seen(page) == (first, last)


def test_dragging_zooms_both_plots_to_what_was_chosen(page):
    page.write("S100 V1000 A2000 F4000 R")
    page.expect_pulses(4000)
    _, last = seen(page)
    box = page.page.locator("#plan-position .u-over").bounding_box()
    assert box
    page.page.mouse.move(box["x"] + box["width"] * 0.25, box["y"] + 20)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + box["width"] * 0.75, box["y"] + 30, steps=5)
    page.page.mouse.up()
    start, end = seen(page)
    assert abs(start - last / 4) < last / 50
    assert abs(end - last * 3 / 4) < last / 50


def test_the_cursor_reads_speed_and_position_with_their_units(page):
    page.write("S100 V1000 A2000 F4000 R")
    page.expect_pulses(4000)
    box = page.page.locator("#plan-speed .u-over").bounding_box()
    assert box
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
    expect(page.page.locator("#plan-status")).to_contain_text(" s")
    words = page.page.locator("#plan-motors label").first
    expect(words).to_contain_text("1,000 steps/s")
    expect(words).to_contain_text(re.compile("(1,99|2,00). steps"))


def test_inputs_that_change_belong_to_the_curve(page):
    page.write("O05 F400 R")
    page.expect_pulses(0)
    page.page.locator("#plan-inputs").fill("500,5,1")
    page.expect_pulses(400)


def test_outputs_that_the_program_sets_are_drawn_below(page):
    rows = page.page.locator("#plan-outputs")
    page.write("F400 R T05 W1000 C05 W1000")
    expect(rows).to_be_visible()
    assert coloured(page, "#plan-outputs", "--output") > 100
    page.write("F400 R")
    expect(rows).to_be_hidden()
