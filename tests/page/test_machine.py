"""A machine file in the page: opened, shown, edited, saved, and refused in plain words."""

from __future__ import annotations

import json

from machine_page import CLAMP, FEED, content, open_bytes, open_machine, save
from page_looks import AXE, CUT, OUTSIDE, OVER, SIZES, VIOLATIONS
from playwright.sync_api import expect
from service_page import shown


def test_a_machine_brings_its_programs_inputs_and_names(page):
    open_machine(page, content())

    expect(page.page.locator(".cm-line")).to_have_text([*FEED.splitlines(), ""])
    expect(page.page.locator("#tab-1")).to_contain_text("feed")
    expect(page.page.locator("#live-inputs button").nth(2)).to_have_text("3 door")
    output = page.page.locator("#live-outputs .lamp").first
    expect(output).to_have_attribute("title", "1 lamp: Output 1")
    expect(page.page.locator("#plan-inputs")).to_have_value("500,3,1")
    page.expect_pulses(450)
    page.page.locator("#machine summary").click()
    expect(page.page.locator("#machine-notes")).to_have_value("grease it")
    shown = {"1-name": "feed", "1-scale": "200.5", "1-unit": "mm", "1-highest": "60000"}
    for name, value in {**shown, "1-lowest": "", "input-3": "door", "output-1": "lamp"}.items():
        expect(page.page.locator(f"#machine-{name}")).to_have_value(value)
    page.page.locator("#tab-2").click()
    assert page.text() == CLAMP


def test_a_machine_is_saved_as_it_was_opened(page):
    open_machine(page, content())
    assert save(page) == ("Podavač.rkm", content())


def test_the_part_for_a_gve134_unit_is_saved_as_it_was_opened(page):
    axis = {"speed_steps_per_s": 1000, "accel_steps_per_s2": 20_000, "jump_steps_per_s": 200}
    told = content(gve134={"axes": {"x": axis}, "probe": {"interrupt": 15, "opens": True}})
    open_machine(page, told)
    assert save(page)[1] == told


def test_what_is_edited_is_saved_and_the_rest_stays(page):
    open_machine(page, content())
    page.page.locator("#tab-2").click()
    page.write("F7 R")
    page.page.locator("#machine summary").click()
    page.page.locator("#machine-name").fill("Press / 2")
    page.page.locator("#machine-notes").fill("oil")
    page.page.locator("#plan-inputs").fill("500,3,1; 700,3,0")

    name, saved = save(page)

    assert name == "Press _ 2.rkm"
    wanted = content(name="Press / 2", notes="oil", inputs="500,3,1\n700,3,0\n")
    wanted["motors"][1]["program"] = "F7 R"
    assert saved == wanted


def test_texts_with_quotes_and_colons_are_texts(page):
    told = content(notes='a "name": \\":\\": [{}] \U0001f980', name=': "')
    open_machine(page, told)
    assert save(page)[1] == told


def test_programs_that_are_there_become_a_machine(page):
    page.write("F11 R")
    name, saved = save(page)

    assert name == "Machine.rkm"
    assert [motor["program"] for motor in saved["motors"]] == ["F11 R", "", "", ""]


def test_undo_brings_back_the_programs_from_before(page):
    page.write("F11 R")
    open_machine(page, content())
    page.page.locator(".cm-content").click()
    page.page.keyboard.press("ControlOrMeta+z")
    assert page.text() == "F11 R"


def test_the_machine_survives_a_reload(page):
    open_machine(page, content())
    page.page.reload()
    page.ready()
    expect(page.page.locator("#machine-shown")).to_have_text("Podavač")
    assert save(page)[1] == content()


NO_MACHINES = [
    (b"{" * 10_000_000, "larger than 2,000,000 bytes"),
    (
        b'{"format": ',
        "not JSON, perhaps it was cut off; not opened, what is here stays",
    ),
    (b"\xff\xfe{\0}\0", "is not UTF-8"),
    (b"[]", "this is no machine file"),
    (b'{"a": [{"x": 1}, {"x": 2}], "b": {"c\\"": ":", "c\\"" : 2}}', "stands there twice"),
    (json.dumps(content(notes="\ud800")).encode(), "half a character"),
    (json.dumps(content(version=2)).encode(), "was written by later tools"),
    (json.dumps(content(colour=1)).encode(), "nothing is known of colour"),
    (json.dumps(content(name=5)).encode(), "name: must be a text"),
    (
        json.dumps(content(gve134={"axes": {}, "probe": {"interrupt": 14, "opens": 1}})).encode(),
        "gve134, probe, opens: must be true or false",
    ),
    (json.dumps(content(motors=[{}] * 4)).encode(), "motor 1: lacks program"),
    (json.dumps(content(motors=[])).encode(), "motors: must be a list of 4, one for each"),
    (json.dumps(content(inputs="x")).encode(), "inputs: lines of milliseconds"),
    (
        json.dumps(content(motors=[{"program": "", "steps_per_mm": -1}] * 4)).encode(),
        "motor 1, steps_per_mm: -1 must be more than 0",
    ),
]


def test_what_is_no_machine_is_refused_in_words_and_all_stays(page):
    page.write("F11 R")
    for data, words in NO_MACHINES:
        open_bytes(page, data)
        expect(page.page.locator("#machine-trouble")).to_contain_text(words)
        assert page.text() == "F11 R"
        expect(page.page.locator("#machine-shown")).to_have_text("none is open")
    open_machine(page, content())
    expect(page.page.locator("#machine-trouble")).to_be_hidden()


def test_the_words_are_czech_too(browser, service):
    with shown(browser, service.url, locale="cs-CZ") as page:
        open_bytes(page, json.dumps(content(version=2)).encode())
        trouble = page.page.locator("#machine-trouble")
        expect(trouble).to_contain_text("soubor zapsaly novější nástroje")


def test_long_names_cut_nothing_off_and_axe_finds_nothing_serious(page):
    names = {str(number): f"input of a long name {number}" for number in range(1, 9)}
    open_machine(page, content(input_names=names, output_names=names))
    page.page.locator("#machine summary").click()
    page.page.locator("#machine-1-lowest").fill("70000")
    page.page.keyboard.press("Tab")
    expect(page.page.locator("#machine-1-lowest-trouble")).to_be_visible()
    page.page.evaluate(AXE.read_text())
    assert page.page.evaluate(VIOLATIONS) == []
    for width, height in SIZES:
        page.page.set_viewport_size({"width": width, "height": height})
        for finds in (OUTSIDE, OVER, CUT):
            assert page.page.evaluate(finds) == []
