"""The curves of what programs would do."""

from __future__ import annotations

import itertools
import re

import pytest
from playwright.sync_api import Locator, expect
from plot_pixels import coloured, height, pixels
from service_page import ServicePage

LEVELS = """(canvas_of) => {
    const canvas = document.querySelector(canvas_of);
    const probe = document.createElement("span");
    probe.style.color = "var(--motor-1)";
    document.body.append(probe);
    const wanted = getComputedStyle(probe).color.match(/\\d+/g).map(Number);
    probe.remove();
    const context = canvas.getContext("2d");
    const { data, width, height } = context.getImageData(0, 0, canvas.width, canvas.height);
    const is = (x, y) =>
        wanted.every((value, k) => Math.abs(value - data[4 * (y * width + x) + k]) < 8)
        && data[4 * (y * width + x) + 3] > 200;
    let levels = 0;
    let before = false;
    for (let y = 0; y < height; y += 1) {
        let longest = 0;
        for (let x = 0, run = 0; x < width; x += 1) {
            run = is(x, y) ? run + 1 : 0;
            longest = Math.max(longest, run);
        }
        levels += longest > 20 && !before;
        before = longest > 20;
    }
    return levels;
}"""
"""How many horizontal stretches the line of motor 1 has."""


def surface(page: ServicePage, plot: str) -> Locator:
    return page.page.locator(f"#{plot} .u-over")


def drag(page: ServicePage, start: float, end: float) -> None:
    """Choose a part of the time in the plot of the position, from 0 to 1 of what is seen."""
    box = surface(page, "plan-position").bounding_box()
    assert box
    page.page.mouse.move(box["x"] + box["width"] * start, box["y"] + 20)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + box["width"] * end, box["y"] + 30, steps=5)
    page.page.mouse.up()


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
    drag(page, 0.25, 0.75)
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


PLAIN = str.maketrans({"\N{MINUS SIGN}": "-", ",": ""})
WATCH_LABELS = """() => {
    const { fillText: draw, clearRect: clear } = CanvasRenderingContext2D.prototype;
    window.labels = [];
    CanvasRenderingContext2D.prototype.clearRect = function (...rest) {
        if (this.canvas.closest("#plan-position")) {
            window.labels = [];
        }
        return clear.call(this, ...rest);
    };
    CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
        if (this.canvas.closest("#plan-position")) {
            window.labels.push(text);
        }
        return draw.call(this, text, ...rest);
    };
}"""
"""Keeps what was written at the axes of the positions when they were drawn last."""


def test_a_motion_far_from_zero_fills_its_plot(page):
    page.page.evaluate(WATCH_LABELS)
    for place in (900_000, -900_000, 1_999_000_000):
        page.write("F1 R")
        page.expect_pulses(1)
        page.write(f"={place} S100 V1000 A2000 F400 R W300 D R")
        page.expect_pulses(800)
        assert height(page, "plan-position", 1) > 0.5
        assert height(page, "plan-speed", 1) > 0.5
        assert len(set(labels(page)[0])) == len(labels(page)[0]) >= 2


def test_the_numbers_of_an_axis_say_where_they_stand(page):
    page.page.evaluate(WATCH_LABELS)
    for ms in (2_000, 20_000, 700):
        page.write(f"F1 R W{ms} F10 R")
        page.expect_pulses(11)
        for axis in labels(page):
            numbers = [float(text.split()[0].translate(PLAIN)) for text in axis]
            distances = [b - a for a, b in itertools.pairwise(numbers)]
            assert distances == pytest.approx([distances[0]] * len(distances))


def labels(page: ServicePage) -> tuple[list[str], list[str]]:
    """Numbers of the axes of the positions: steps, and seconds."""
    page.page.locator("#zoom-reset").click()
    drawn = page.page.evaluate("window.labels")
    seconds = [text for text in drawn if text.endswith("s")]
    return [text for text in drawn if text not in seconds], seconds


def test_the_axis_follows_what_is_zoomed_to(page):
    page.write("S100 V16000 A60000 G200000 W1000 S100 V100 F50 R")
    page.expect_pulses(200_050)
    _, last = seen(page)
    drag(page, 1 - 1 / last, 1)
    page.page.locator("#zoom-in").click()
    expect(page.plan).to_have_attribute("data-steps", re.compile("^[1-9]"))
    assert height(page, "plan-position", 1) > 0.4


def test_the_zoom_goes_down_to_single_pulses_drawn_as_stairs(page):
    page.write("S2000 V16000 A60000 F16000 R")
    page.expect_pulses(16_000)
    assert page.plan.get_attribute("data-steps") == "0"
    box = surface(page, "plan-position").bounding_box()
    assert box
    page.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
    for _ in range(60):
        page.page.mouse.wheel(0, -100)
    expect(page.plan).to_have_attribute("data-steps", re.compile("^[78]$"))
    start, end = seen(page)
    assert 0.0004 < end - start < 0.0006

    stairs = page.page.evaluate(LEVELS, "#plan-position canvas")
    assert stairs == pytest.approx(8, abs=1)


def test_the_cursor_reads_the_pulse_that_it_is_at(page):
    page.write("S100 V100 F5 R")
    page.expect_pulses(5)
    box = surface(page, "plan-position").bounding_box()
    assert box
    words = page.page.locator("#plan-motors label").first
    for part, steps in ((0.1, 0), (0.3, 1), (0.5, 2), (0.9, 4)):
        page.page.mouse.move(box["x"] + box["width"] * part, box["y"] + 20)
        expect(words).to_contain_text(f"{steps} steps")


def test_another_program_is_seen_whole_and_an_edited_one_where_it_was(page):
    page.write("S100 V1000 A2000 F4000 R")
    page.expect_pulses(4000)
    drag(page, 0.25, 0.5)
    part = seen(page)
    page.page.locator(".cm-content").click()
    page.page.keyboard.press("ControlOrMeta+End")
    page.page.keyboard.type(" R")
    page.expect_pulses(8000)
    assert seen(page) == part

    page.page.locator("#examples").select_option(label="4-loop.rks")
    expect(page.plan).not_to_have_attribute("data-pulses", "8000")
    assert seen(page)[0] == 0
    assert seen(page)[1] > part[1]


def test_what_the_service_refuses_is_not_called_an_error_of_the_program(page):
    page.write("F400 R")
    page.expect_pulses(400)
    page.page.route("**/api/*", lambda route: route.abort())
    page.page.keyboard.type(" R")
    expect(page.page.locator("#plan-status")).to_contain_text("Not computed")
    verdict = page.page.locator("#verdict")
    expect(verdict).to_contain_text("not checked: the service does not answer")
    expect(verdict).to_have_attribute("data-kind", "unknown")
    page.page.unroute("**/api/*")
