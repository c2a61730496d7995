"""`check` names every error of a program with its place, and warns of nothing that is right."""

from __future__ import annotations

from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "tools" / "examples").glob("*.rks"))


def found(result) -> list[tuple[int, int, str]]:
    """Line, column and text of all errors."""
    (file,) = result.json["files"]
    return [(e["line"], e["column"], e["message"]) for e in file["errors"]]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_no_example_has_an_error_or_a_warning(tool, path):
    result = tool("check", path, "--json")

    (file,) = result.json["files"]
    assert (result.status, file["errors"], file["warnings"]) == (0, [], [])


def test_a_good_program_is_counted_on_standard_output(tool, write):
    path = write("\\ F100 R { a comment }")

    result = tool("check", path)

    assert (result.status, result.out, result.err) == (0, f"{path}: 2 commands\n", "")


def test_an_error_shows_its_place_its_line_and_a_caret(tool, write):
    path = write("\\\nS100 V20000\n")

    result = tool("check", path)

    message = "V (maximum speed) takes a number from 1 to 16000, found 20000"
    assert result.status == 1
    assert result.out.splitlines() == [
        f"{path}:2:6: error: {message}",
        "S100 V20000",
        "     ^",
        f"{path}: 1 error",
    ]


def test_every_error_of_a_file_is_found_not_only_the_first(tool, write):
    result = tool("check", write("V0 Q F1\nF0 r R W\n"), "--json")

    assert [place[:2] for place in found(result)] == [(1, 1), (1, 4), (2, 1), (2, 4), (2, 8)]


def test_a_tab_before_an_error_is_kept_above_the_caret(tool, write):
    result = tool("check", write("\tF1\tQ"))

    assert result.out.splitlines()[1:3] == ["\tF1\tQ", "\t  \t^"]


def test_the_caret_of_a_long_line_stays_near_its_error(tool, write):
    result = tool("check", write("F1 " * 1000 + "Q" + " R" * 1000))

    line, caret = result.out.splitlines()[1:3]
    assert len(line) <= 100
    assert line[caret.index("^")] == "Q"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_may_end_in_any_way(tool, write, end):
    result = tool("check", write(f"F1{end}R{end}Q"), "--json")

    assert [place[:2] for place in found(result)] == [(3, 1)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("F0", "F (steps forward) takes a number from 1 to 16000000, found 0"),
        ("F-5", "F (steps forward) takes a number from 1 to 16000000, found -5"),
        ("F", "F (steps forward) takes a number from 1 to 16000000, found the end of the file"),
        ("F R", "F (steps forward) takes a number from 1 to 16000000, found no number"),
        (
            "F 5",
            "F (steps forward) takes a number from 1 to 16000000, found a blank; nothing may"
            " stand between a command and its number",
        ),
        (
            "S" + "9" * 30,
            "S (start/stop speed) takes a number from 1 to 2000,"
            " found 9999999999999999... (30 characters)",
        ),
        (
            "C9",
            "C takes 1 to 8 (clear an output), 40 to 58 (switch a function off), 75 (resume),"
            " 80 to 95 (clear a variable) or 100 (zero the position), found 9",
        ),
        (
            "G0",
            "G takes 1 to 2000000000 (go to a position), + (run forward without end)"
            " or - (run backward without end), found 0",
        ),
        (
            "I09H1",
            "I takes the number of an input (1 to 8) or variable (80 to 95), H or L, and a label"
            " from 1 to 80, as in I05H10, found 09H1",
        ),
        (
            "=2000000001",
            "= (write the position) takes a number from -2000000000 to 2000000000,"
            " found 2000000001",
        ),
        ("'81", "' (call a subroutine) takes a number from 1 to 80, found 81"),
        (
            "\N{ACUTE ACCENT}81",
            "\N{ACUTE ACCENT} (call a subroutine) takes a number from 1 to 80, found 81",
        ),
        ("`81", "` (call a subroutine) takes a number from 1 to 80, found 81"),
        ('"x', '" (call a subroutine) takes a number from 1 to 80, found no number'),
        ("Q", 'unknown command "Q"'),
        ("r", 'unknown command "r"; commands are upper case: R'),
        ("q", 'unknown command "q"'),
        ("7", 'unknown command "7"; this number belongs to no command'),
        ("}", 'unknown command "}"; no comment is open here'),
        ("ř", 'unknown command "ř"'),
        (
            "\N{LEFT SINGLE QUOTATION MARK}3",
            'unknown command "\N{LEFT SINGLE QUOTATION MARK}"; a subroutine is called with \'',
        ),
        ("\7", "unknown command (control character, code 7)"),
        ("\u200b", "unknown command (zero width space, code 8203)"),
        ("R { open", "the comment that begins here has no end; close it with }"),
    ],
)
def test_an_error_says_what_was_found_and_what_is_right(tool, write, text, message):
    result = tool("check", write(text), "--json")

    assert result.status == 1
    assert found(result)[0][2] == message


def test_the_flags_are_those_of_the_unit(tool, write):
    result = tool("check", write("V0 Q"), "--json")

    assert [error["flag"] for error in result.json["files"][0]["errors"]] == [1, 2]


@pytest.mark.parametrize(
    "call", ["'", '"', "`", "\N{ACUTE ACCENT}", "\N{RIGHT SINGLE QUOTATION MARK}", "„"]
)
def test_all_forms_of_the_call_character_are_good(tool, write, call):
    result = tool("check", write(f"F1 {call}3 W1 @2 J2 @3 R ."))

    assert result.status == 0


@pytest.mark.parametrize("code", [0x92, 0xB4, 0x84])
def test_a_file_that_is_not_utf8_is_read_as_windows_1250(tool, write, code):
    program = b"{ p\xf8\xedklad } F1 %c3 W1 @2 J2 @3 R ." % code

    assert tool("check", write(program)).status == 0


def test_columns_count_characters_not_bytes(tool, write):
    result = tool("check", write("{ příklad } Q"), "--json")

    assert [place[:2] for place in found(result)] == [(1, 13)]


def test_a_mark_of_the_byte_order_is_no_character(tool, write):
    result = tool("check", write(b"\xef\xbb\xbfQ"), "--json")

    assert [place[:2] for place in found(result)] == [(1, 1)]


def test_wide_and_combining_characters_keep_the_caret_in_place(tool, write):
    result = tool("check", write("{漢e\u0301} Q"))

    assert result.out.splitlines()[2] == " " * 6 + "^"


def test_control_characters_are_not_sent_to_the_terminal(tool, write):
    result = tool("check", write("\x1b[31m"))

    assert "\x1b" not in result.out


def test_each_of_several_files_is_checked(tool, write):
    good, bad = write("R", "good.rks"), write("Q", "bad.rks")

    result = tool("check", bad, good, "--json")

    assert result.status == 1
    assert [file["ok"] for file in result.json["files"]] == [False, True]


def test_an_empty_file_has_a_warning_and_no_error(tool, write):
    result = tool("check", write(""))

    assert result.status == 0
    assert ":1:1: warning: there is no command in this file" in result.out


def test_a_missing_file_is_wrong_usage_and_the_others_are_still_checked(tool, write, tmp_path):
    result = tool("check", tmp_path / "no.rks", write("Q"))

    assert result.status == 2
    assert result.err == f"rkm04: {tmp_path}/no.rks: no such file; check the name and the folder\n"
    assert "error: unknown command" in result.out


def test_a_directory_is_no_program(tool, tmp_path):
    result = tool("check", tmp_path)

    assert (result.status, result.complaint) == (
        2,
        f"rkm04: {tmp_path}: is a directory; name a file in it",
    )


def test_a_file_far_too_large_is_no_program(tool, write):
    result = tool("check", write(b" " * 4_000_001))

    assert result.status == 2
    assert "larger than 4000000 bytes" in result.complaint


def test_a_file_without_a_name_in_unicode_is_shown(tool, tmp_path):
    path = tmp_path / "p\udcf8.rks"
    path.write_text("Q")

    result = tool("check", path)

    assert "p\\udcf8.rks:1:1: error" in result.out


def test_a_simulator_that_was_not_built_is_named(tool, write, monkeypatch, tmp_path):
    monkeypatch.setenv("RKM04_BUILD", str(tmp_path))

    result = tool("check", write("R"))

    what = "not built; start the command as tools/rkm04, which builds it"
    assert (result.status, result.complaint) == (2, f"rkm04: {tmp_path}/bin/rkm04-host: {what}")
