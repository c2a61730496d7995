"""Inputs that are clicked in time, and their file."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect
from service_page import ServicePage


def click(page: ServicePage, number: int, part: float) -> None:
    """Click into the row of an input, from 0 to 1 of the time."""
    plot = page.page.locator("#plan-position .u-over").bounding_box()
    assert plot
    rows = page.page.locator("#input-rows")
    rows.scroll_into_view_if_needed()
    box = rows.bounding_box()
    assert box
    x = plot["x"] - box["x"] + plot["width"] * part
    rows.click(position={"x": x, "y": box["height"] * (number - 0.5) / 8})


def opened(page: ServicePage) -> None:
    page.page.locator("#plan-seconds").select_option("5")
    page.page.locator("#plan-inputs").fill("")
    page.write("O3 F20 R W60000")
    expect(page.plan).to_have_attribute("data-range", "0 5")
    page.page.locator("#inputs-box summary").click()


def test_a_click_changes_an_input_from_there_on_and_another_takes_it_away(page):
    opened(page)
    click(page, 3, 0.5)
    field = page.page.locator("#plan-inputs")
    ms, number, level = field.input_value().split(",")
    assert abs(int(ms) - 2500) < 20
    assert (number, level) == ("3", "1")
    page.expect_pulses(20)

    click(page, 3, 0.5)
    expect(field).to_have_value("")
    page.expect_pulses(0)
    page.page.locator("#plan-seconds").select_option("60")


def test_the_inputs_are_kept_as_a_file_and_opened_again(page, tmp_path: Path):
    opened(page)
    field = page.page.locator("#plan-inputs")
    field.fill("2500,3,1; 3000,4,0")
    page.expect_pulses(20)
    page.page.evaluate("delete window.showSaveFilePicker; window.showSaveFilePicker = undefined")
    with page.page.expect_download() as download:
        page.page.locator("#inputs-save").click()
    saved = tmp_path / "inputs.csv"
    download.value.save_as(saved)
    assert saved.read_text() == "2500,3,1\n3000,4,0\n"

    field.fill("")
    page.expect_pulses(0)
    page.page.locator("#inputs-file").set_input_files(saved)
    page.expect_pulses(20)
    saved.write_text("2500,9,1\n")
    page.page.locator("#inputs-file").set_input_files(saved)
    expect(page.page.locator("#inputs-trouble")).to_contain_text(
        "lines of milliseconds,input,level"
    )
    page.expect_pulses(20)
    page.page.locator("#plan-seconds").select_option("60")
    field.fill("")
