"""Programs in the editor: what the parser finds, files, examples, and drafts."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import expect
from service_page import ServicePage

GOOD = "\\ C100\nS100 V1000 A2000\nF400 R"


def expect_underlined(page: ServicePage, *wanted: tuple[int, int, str]) -> None:
    expect(page.page.locator(".cm-lintRange-error")).to_have_count(len(wanted))
    assert page.underlined() == list(wanted)


def test_a_wrong_value_is_underlined_at_its_line_and_column_until_it_is_corrected(page):
    page.write("\\ C100\nS100 V20000 A2000\nF400 R")
    expect_underlined(page, (2, 6, "V20000"))
    expect(page.page.locator("#verdict")).to_have_attribute("data-kind", "error")

    page.write(GOOD)
    expect_underlined(page)
    expect(page.page.locator("#verdict")).to_have_attribute("data-kind", "good")


def test_every_error_is_underlined_and_not_only_the_first(page):
    page.write("S0 F10 R\nq R\nW")
    expect_underlined(page, (1, 1, "S0"), (2, 1, "q"), (3, 1, "W"))


def test_columns_count_characters_also_behind_those_that_take_two_units(page):
    page.write("{ \N{MICROSCOPE} č } V20000")
    expect_underlined(page, (1, 9, "V20000"))


def test_the_result_of_the_check_leads_to_the_error(page):
    page.write("F10 R\nR S0")
    verdict = page.page.locator("#verdict")
    expect(verdict).to_have_attribute("data-kind", "error")
    verdict.click()
    page.page.keyboard.insert_text("V")
    assert page.text() == "F10 R\nR VS0"


def test_a_warning_does_not_hide_that_the_program_can_run(page):
    page.write("F10 R J7")
    expect(page.page.locator("#verdict")).to_have_attribute("data-kind", "warning")
    expect(page.page.locator(".cm-lintRange-warning")).to_have_count(1)


def test_each_motor_has_a_program_of_its_own_with_its_own_undo(page):
    page.write("F11 R")
    page.page.locator("#tab-3").click()
    page.write("F33 R")
    page.page.locator("#tab-1").click()
    assert page.text() == "F11 R"

    page.page.locator(".cm-content").click()
    page.page.keyboard.press("ControlOrMeta+z")
    assert page.text() != "F11 R"
    page.page.locator("#tab-3").click()
    assert page.text() == "F33 R"


def test_drafts_survive_a_reload(page):
    page.write("F11 R")
    page.page.locator("#tab-2").click()
    page.write("F22 R")
    page.page.reload()
    page.ready()
    assert page.text() == "F11 R"
    page.page.locator("#tab-2").click()
    assert page.text() == "F22 R"


def test_a_program_is_saved_by_key_as_it_stands(page):
    page.page.evaluate("delete window.showSaveFilePicker")
    page.write(GOOD)
    with page.page.expect_download() as download:
        page.page.keyboard.press("ControlOrMeta+s")
    assert download.value.suggested_filename == "motor1.rks"
    assert Path(download.value.path()).read_text(encoding="utf-8") == GOOD


@pytest.mark.parametrize("encoding", ["utf-8", "windows-1250"])
def test_a_file_is_opened_whatever_its_encoding(page, tmp_path, encoding):
    file = tmp_path / "stůl.rks"
    file.write_bytes("{ žlutý kůň } F7 R".encode(encoding))
    page.page.locator("#file").set_input_files(file)
    expect(page.page.locator("#file-name")).to_have_text("stůl.rks")
    assert page.text() == "{ žlutý kůň } F7 R"


def test_an_example_brings_its_inputs(page):
    page.page.locator("#examples").select_option(label="5-wait-for-inputs.rks")
    expect(page.page.locator("#plan-inputs")).not_to_have_value("")
    assert "O02" in page.text()
    page.expect_pulses(5000 + 6000 + 3000 + 2000)


def test_seven_hundred_commands_are_counted_and_drawn(page):
    page.write("\n".join(["F10 R"] * 350))
    expect(page.page.locator("#command-count")).to_contain_text("700")
    page.expect_pulses(3500)


def test_the_command_at_the_cursor_is_explained(page):
    explained = page.page.locator("#command-help")
    for text, words in {
        "{ F1 } V500": "V500: maximum speed",
        "T02": "T02: set output",
        "T55": "T55: switch function",
        "C100": "C100: here is position 0",
        "I05H10": "I05H10: jump to a label if",
        "G+": "G+: run forward without end",
    }.items():
        page.write(text)
        expect(explained).to_contain_text(words)
    page.write("{ F1\nV5")
    expect(explained).to_have_text("")
