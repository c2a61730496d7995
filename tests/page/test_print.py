"""The machine on paper."""

from __future__ import annotations

import json
import re
from pathlib import Path

from playwright.sync_api import expect
from scaled_machine import MACHINE

NOTES = "Drill 3 is the left one.\nGrease each month."


def test_all_of_the_machine_is_printed_and_nothing_else(page, tmp_path: Path):
    motors = [{**MACHINE["motors"][0], "name": "carriage", "limits": {"position_max_steps": 5000}}]
    machine = {**MACHINE, "notes": NOTES, "motors": motors + MACHINE["motors"][1:]}
    machine["motors"][0]["program"] = "{ go there } S100 V1000 F400 R"
    machine |= {"inputs": "500,3,1\n", "input_names": {"3": "door"}, "output_names": {"2": "lamp"}}
    content = json.dumps(machine).encode()
    page.page.locator("#machine-file").set_input_files(
        {"name": "table.rkm", "mimeType": "application/json", "buffer": content}
    )
    page.expect_pulses(990)
    page.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    page.page.emulate_media(media="print")

    paper = page.page.locator("#print")
    wanted = ("Table", NOTES, "carriage", "{ go there } S100", "F500 R", "500,3,1", "door", "lamp",
              "40 steps per mm", "highest position 5,000")  # fmt: skip
    for words in wanted:
        expect(paper).to_contain_text(words)
    expect(paper.locator("polyline.m1[points*=',']")).to_have_count(2)
    expect(page.page.locator("main")).to_be_hidden()
    expect(page.page.locator("#top")).to_be_hidden()
    expect(paper).to_be_visible()
    page.page.emulate_media(media="screen")
    expect(paper).to_be_hidden()


def test_the_button_prints(page):
    page.page.evaluate("window.print = () => (window.printed = true)")
    page.page.locator("#machine-print").click()
    page.page.wait_for_function("window.printed === true")


def test_the_paper_is_in_the_language_of_the_page(page):
    page.write("F400 R")
    page.expect_pulses(400)
    page.page.locator("#language").select_option("cs")
    page.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    expect(page.page.locator("#print h2").first).to_have_text(re.compile("Motor 1"))
    expect(page.page.locator("#print figcaption").first).to_contain_text("Rychlost")
    page.page.locator("#language").select_option("en")
