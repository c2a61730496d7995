"""Programs in the editor: what the parser finds, files, examples, and drafts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from playwright.sync_api import FilePayload, Locator, expect
from service_page import ServicePage

GOOD = "\\ C100\nS100 V1000 A2000\nF400 R"
LINES = "{ žlutý kůň }\nF7 R\nW5"
DOS = LINES.replace("\n", "\r\n")
SAVES_AT_ONCE_MAX = 10


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


def test_columns_count_characters_also_after_those_that_take_two_units(page):
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


def save(page: ServicePage) -> tuple[str, bytes]:
    """Save the shown program by key; return name and content of the file.

    Chromium lets a page begin ten downloads within a second, and drops the next without a word.
    """
    page.page.evaluate("() => { delete window.showSaveFilePicker; }")
    with page.page.expect_download() as download:
        page.page.keyboard.press("ControlOrMeta+s")
    return download.value.suggested_filename, Path(download.value.path()).read_bytes()


def open_file(page: ServicePage, name: str, content: bytes) -> None:
    file: FilePayload = {"name": name, "mimeType": "text/plain", "buffer": content}
    page.page.locator("#file").set_input_files(file)


def name_of(page: ServicePage) -> Locator:
    return page.page.locator("#file-name")


def test_a_program_is_saved_by_key_as_it_stands(page):
    page.write(GOOD)
    assert save(page) == ("motor1.rks", GOOD.encode())


def saved(page: ServicePage, files: Sequence[bytes]) -> Iterator[bytes]:
    """Open and save one file after the other."""
    assert len(files) <= SAVES_AT_ONCE_MAX
    for number, content in enumerate(files):
        open_file(page, f"{number}.rks", content)
        expect(name_of(page)).to_have_text(f"{number}.rks")
        name, bytes_ = save(page)
        assert name == f"{number}.rks"
        yield bytes_


def test_a_file_is_saved_as_it_was_opened_in_every_encoding_and_with_every_end_of_line(page):
    texts = (LINES, DOS, LINES.replace("\n", "\r"))
    files = [text.encode(code) for text in texts for code in ("utf-8", "utf-8-sig", "cp1250")]

    for content, bytes_ in zip(files, saved(page, files), strict=True):
        assert bytes_ == content
        assert page.text() == LINES


def test_a_file_of_an_old_tool_or_without_a_text_is_saved_as_it_was_opened(page):
    files = [
        b"F1 R\r\nF2 R\nF3 R\rF4 R\r\n",
        (DOS + "\r\n\x1a").encode("cp1250"),
        (DOS + "\x1a\x1a\0\0").encode(),
        bytes(range(32, 256)).replace(b"{", b"").replace(b"}", b"") + b"\r\n",
        b"\xef\xbb\xbf",
        b"",
    ]
    assert list(saved(page, files)) == files


def test_a_key_that_is_held_down_saves_once(page):
    page.page.evaluate(
        """() => {
            delete window.showSaveFilePicker;
            window.saves = 0;
            const click = HTMLAnchorElement.prototype.click;
            HTMLAnchorElement.prototype.click = function () {
                window.saves += 1;
                click.call(this);
            };
        }"""
    )
    page.page.keyboard.down("ControlOrMeta")
    for _ in range(20):
        page.page.keyboard.down("s")
    page.page.keyboard.up("s")
    page.page.keyboard.up("ControlOrMeta")
    assert page.page.evaluate("window.saves") == 1


def test_what_was_not_edited_of_a_file_keeps_its_bytes(page):
    open_file(page, "a.rks", "{ kůň }\r\nF7 R\r\n\x1a".encode("cp1250"))
    expect(page.page.locator("#file-form")).to_have_text("ANSI (1250) · CRLF · 1A")
    type_in_line(page, "F7 R", " W9\nW8")
    assert save(page)[1] == "{ kůň }\r\nF7 R W9\r\nW8\r\n\x1a".encode("cp1250")

    page.page.reload()
    page.ready()
    assert save(page)[1] == "{ kůň }\r\nF7 R W9\r\nW8\r\n\x1a".encode("cp1250")

    open_file(page, "b.rks", b"F1 R\nF2 R\r\nF3 R\r\nF4 R\nF5 R\n")
    expect(name_of(page)).to_have_text("b.rks")
    type_in_line(page, "F3 R", "\nW3")
    assert save(page)[1] == b"F1 R\nF2 R\r\nF3 R\r\nW3\nF4 R\nF5 R\n"


def type_in_line(page: ServicePage, line: str, text: str) -> None:
    page.page.locator(".cm-line", has_text=line).click()
    page.page.keyboard.press("End")
    page.page.keyboard.insert_text(text)


def test_characters_that_the_encoding_lacks_make_the_file_utf_8_and_the_page_says_so(page):
    open_file(page, "a.rks", "{ kůň }\r\nF7 R".encode("cp1250"))
    type_in_line(page, "F7 R", " { Ω }")
    assert save(page)[1] == "{ kůň }\r\nF7 R { Ω }".encode()
    expect(page.page.locator("#file-trouble")).to_contain_text("saved as UTF-8")
    expect(page.page.locator("#file-form")).to_have_text("CRLF")


def test_undo_brings_back_the_program_and_its_file(page):
    open_file(page, "a.rks", b"F1 R\r\n")
    type_in_line(page, "F1 R", " W1")
    open_file(page, "b.rks", b"\xef\xbb\xbfF2 R")
    expect(name_of(page)).to_have_text("b.rks")
    page.page.locator(".cm-content").click()

    page.page.keyboard.press("ControlOrMeta+z")
    expect(name_of(page)).to_have_text("a.rks")
    assert save(page) == ("a.rks", b"F1 R W1\r\n")
    page.page.keyboard.press("ControlOrMeta+y")
    assert save(page) == ("b.rks", b"\xef\xbb\xbfF2 R")


def test_what_is_no_program_is_refused_by_name_and_the_program_stays(page):
    page.write(GOOD)
    trouble = page.page.locator("#file-trouble")
    for content, words in (
        (b"F1 R\n" * 40_001, "a.rks: larger than 200,000 bytes"),
        ("F1 R".encode("utf-16"), "this is UTF-16; save it as UTF-8 or ANSI"),
        (b"\x7fELF\0\0\0", "this is not a text file"),
    ):
        open_file(page, "a.rks", content)
        expect(trouble).to_contain_text(words)
        assert page.text() == GOOD
    open_file(page, "good.rks", b"F1 R")
    expect(trouble).to_be_hidden()


def test_a_text_that_is_too_long_is_told_in_words_and_the_page_stays_quick(page):
    paste(page, "{ a }\n" * 40_000)
    expect(page.page.locator("#verdict")).to_have_text(
        "not checked: the text is too long; 200000 characters are the most"
    )
    expect(page.page.locator("#plan-status")).to_contain_text("Not computed: the text is too long")
    paste(page, "Q\n" * 99_000)
    expect(page.page.locator("#verdict")).to_have_text("errors: 99,000")
    paste(page, GOOD)
    expect(page.page.locator("#verdict")).to_have_text("no errors")


def paste(page: ServicePage, text: str) -> None:
    """Put a text in the place of the shown program as the clipboard does."""
    page.page.locator(".cm-content").click()
    page.page.keyboard.press("ControlOrMeta+a")
    page.page.evaluate(
        """(text) => {
            const clipboardData = new DataTransfer();
            clipboardData.setData("text/plain", text);
            const event = { clipboardData, bubbles: true, cancelable: true };
            document.querySelector(".cm-content").dispatchEvent(new ClipboardEvent("paste", event));
        }""",
        text,
    )


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
