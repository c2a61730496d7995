"""`gve134 check` names everything that the unit would refuse of a vector file, with its place."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rkm04_tools.cli import run_tool
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.cli import make_parser

Check = Callable[..., tuple[int, str, str]]

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "firmware/gve134/docs/commands.md"
SPINDLE = 2


@pytest.fixture
def check(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Check:
    """Check a text; the exit status, and what is printed."""

    def run(text: str | bytes, *options: str) -> tuple[int, str, str]:
        path = tmp_path / "a.gve"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        status = run_tool(make_parser(), ["check", str(path), *options])
        told = capsys.readouterr()
        return status, told.out.replace(str(path), "a.gve"), told.err.replace(str(path), "a.gve")

    return run


def places(text: str) -> list[tuple[int, int, int]]:
    """Line, column and code of all errors."""
    return [(each.line, each.column, each.code) for each in host.check(text).errors]


def test_a_good_file_is_counted(check: Check) -> None:
    assert check("V1000 ; slow\n\n  L1000,0,0\r\n!7V300\n@250.5 H\n") == (
        0,
        "a.gve: 4 commands\n",
        "",
    )


def test_gcode_is_sent_to_where_it_becomes_vectors(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "a.NC"
    path.write_text("G0 X1\n")

    for command in ("check", "sim"):
        assert run_tool(make_parser(), [command, str(path)]) == 2
        assert f"{path}: is G-code; gve134 gcode {path} -o OUT.gve" in capsys.readouterr().err


def test_an_error_shows_its_place_its_line_and_a_caret(check: Check) -> None:
    status, out, err = check("; č\nT5\n  V9 ; too slow\n")

    assert (status, err) == (1, "")
    assert out.splitlines() == [
        "a.gve:3:4: error: V takes a number from 10 to 200000 as parameter 1, found 9",
        "  V9 ; too slow",
        "   ^",
        "a.gve: 1 error",
    ]


def test_what_is_found_is_shown_in_its_letters_and_in_whole_ones(check: Check) -> None:
    _, out, _ = check("V1000 ä\nV" + "1" * 19 + "žž\nT\x01\nA👍\n")

    takes = "error: V takes a number from 10 to 200000 as parameter 1, found"
    assert f"a.gve:1:2: {takes} 1000 ä\n" in out
    assert f"a.gve:2:2: {takes} {'1' * 19}\n" in out
    assert "found 👍\n" in out


@pytest.mark.parametrize(
    ("single", "is_taken"),
    [("5", 1), ("-1.5", 1), ("1E-6", 1), ("1.5E+6", 1), ("5.", 0), (".5", 0), ("5.E1", 0)],
)
def test_a_single_has_digits_on_both_sides_of_its_point(single: str, is_taken: bool) -> None:
    assert (not host.check(f"EFW10,{single}").errors) == bool(is_taken)


def test_a_spindle_speed_without_its_sign_is_told_how_to_be_written(check: Check) -> None:
    _, out, _ = check("7V5\n!0\n!7Z\n")

    assert "no command that begins like this; to the spindle write !7V5\n" in out
    assert out.count("to the spindle") == 1


def test_the_answer_for_scripts_is_one_object(check: Check) -> None:
    status, out, _ = check("V9\n", "--json")

    (file,) = json.loads(out)["files"]
    message = "V takes a number from 10 to 200000 as parameter 1, found 9"
    error = {"line": 1, "column": 2, "code": 5, "message": message}
    assert status == 1
    assert file == {
        "file": "a.gve", "ok": False, "commands": 1, "errors": [error], "more_errors": 0,
        "warnings": [],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (None, "gve134: a.gve: no such file; check the name and the folder\n"),
        (bytes(100), "gve134: a.gve: is not a text file; name a vector file (.gve)\n"),
    ],
)
def test_a_file_that_is_none_is_one_line(
    check: Check, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    content: bytes | None, complaint: str,
) -> None:  # fmt: skip
    if content is not None:
        assert check(content) == (2, "", complaint)
        return
    status = run_tool(make_parser(), ["check", str(tmp_path / "a.gve")])
    assert status == 2
    assert capsys.readouterr().err.replace(str(tmp_path / "a.gve"), "a.gve") == complaint


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("L", [(1, 2, 4)]),
        ("L1,2,3,4,5", [(1, 10, 4)]),
        ("L1,,2", [(1, 4, 4)]),
        ("X", [(1, 1, 3)]),
        ("NQ5", [(1, 2, 4)]),
        ("WX0,10,1,10", [(1, 3, 5)]),
        ("ERxx", [(1, 3, 4)]),
        ("ER100", [(1, 3, 5)]),
        ("EFW10,1.", [(1, 7, 4)]),
        ("V 10", [(1, 2, 4)]),
        ("!7V1001", [(1, 4, 5)]),
        ("!7H", [(1, 3, 3)]),
        ("!3H", [(1, 1, 4)]),
        ("!", [(1, 1, 4)]),
        ("@5", [(1, 1, 4)]),
        ("@5.5H", [(1, 1, 4)]),
        ("@5.5 ", [(1, 1, 4)]),
        ("@5.5 V9", [(1, 7, 5)]),
        ("@", []),
        ("L" + "0" * 78, []),
        ("L" + "0" * 79, [(1, 1, 4)]),
        ("V9\rV10\r\nV9", [(1, 2, 5), (3, 2, 5)]),
        ("; V9\n\t\n;", []),
    ],
)
def test_each_kind_of_error_has_its_place_and_its_code(
    text: str, expected: list[tuple[int, int, int]]
) -> None:
    assert places(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("*S\nC1\nB10\n*E2", []),
        ("*S\n*E0", []),
        ("*S\nC1\n*E2", [(3, 3, 2)]),
        ("*S\nC1\nA5\n*E2", [(3, 1, 4)]),
        ("*S\nC1\nX\n*E2", [(3, 1, 3)]),
        ("*E0", [(1, 1, 4)]),
        ("T1\n *S\nC1", [(2, 2, 2)]),
        ("*S\nC1\n*S\nC1\n*E1", []),
        ("*S\nC1\nH\nA5", []),
        ("*S\nC1\n*E129", [(3, 3, 5)]),
        ("*S\n" + "C1\n" * 128 + "*E128", []),
        ("*S\n" + "C1\n" * 129 + "*E128", [(131, 1, 5)]),
        ("*S\nC1\n@5 H\nC1\n*E2", []),
    ],
)
def test_packets_are_checked_as_the_unit_takes_them(
    text: str, expected: list[tuple[int, int, int]]
) -> None:
    assert places(text) == expected


def test_no_more_errors_are_listed_than_anybody_reads(check: Check) -> None:
    status, out, _ = check("V9\n" * 1500)

    assert status == 1
    assert out.splitlines()[-2:] == ["a.gve: and 1450 more errors", "a.gve: 1500 errors"]


def value_of(parameter: dict[str, Any], number: int) -> str:
    """A parameter as it is written."""
    kind = parameter["kind"]
    if kind == "AXIS":
        return "XYZA"[number]
    if kind in ("BYTE", "PLACE", "PLACE_OF_4"):
        return f"{number:02X}"
    return f"{number:X}" if kind == "WORD" else str(number)


@st.composite
def commands(draw: st.DrawFn) -> tuple[str, bool]:
    """A line of a file, and whether the unit takes it: a parameter may be one past its limits."""
    row = draw(st.sampled_from([r for r in host.commands() if not r.text.startswith("*")]))
    count = draw(st.integers(row.least, len(row.parameters)))
    wrong = draw(st.none() | st.integers(0, count - 1)) if count else None
    values = []
    good = True
    for place, parameter in enumerate(row.parameters[:count]):
        low, high = parameter["min"], parameter["max"]
        number = draw(st.sampled_from([low, high]) | st.integers(low, high))
        if parameter["kind"] == "WAY" and number == 0:
            number = 1
        if place == wrong and parameter["kind"] in ("RATE", "PULSES", "JUMP", "PERMILLE", "COUNT"):
            number, good = draw(st.sampled_from([low - 1, high + 1])), False
        if parameter["kind"] == "SINGLE":
            values.append(draw(st.sampled_from(["0", "-1.5", "1E38", "0.1e-40"])))
        else:
            values.append(value_of(parameter, number))
    address = "!7" if row.address == SPINDLE else draw(st.sampled_from(["", "!0"]))
    letters = draw(st.sampled_from([str.upper, str.lower]))
    return f"{address}{letters(row.text + ','.join(values))}", good


@given(st.lists(commands(), max_size=20), st.sampled_from(["\n", "\r\n", " ; why\n", "\n\n"]))
@settings(max_examples=60, deadline=None)
def test_what_is_in_the_bounds_of_the_table_is_taken_and_what_is_past_them_is_not(
    lines: list[tuple[str, bool]], end: str
) -> None:
    parsed = host.check(end.join(line for line, _ in lines))

    step = 2 if end == "\n\n" else 1
    assert parsed.commands == len(lines)
    wrong = [1 + step * place for place, (_, good) in enumerate(lines) if not good]
    assert [(error.line, error.code) for error in parsed.errors] == [(each, 5) for each in wrong]


@given(st.text(alphabet="!07@*SECBLVWNX,-1.9; \t\n\r\x00\x7fč", max_size=60))
@settings(max_examples=100, deadline=None)
def test_any_text_has_its_errors_inside_it(text: str) -> None:
    lines = re.split(r"\r\n|\n|\r", text)
    for error in host.check(text).errors:
        assert 1 <= error.line <= len(lines)
        assert 1 <= error.column <= len(lines[error.line - 1]) + 1
        assert error.code in (2, 3, 4, 5)


def test_the_document_has_each_command_once_with_its_example_and_its_answer() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    shown = re.findall(r"`!([07])(\S+)` → (?:`([^`]*)`|no answer)", text)
    expected = [
        (7 if row.address == SPINDLE else 0, row.example, row.answer) for row in host.commands()
    ]
    assert sorted((int(a), b, c) for a, b, c in shown) == sorted(expected)


def test_the_document_has_the_refusals_of_the_table() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    section = text[text.index("## What a state refuses") :]
    rows = re.findall(r"^\| ([A-Z, ]+) \|(.*)\|$", section, re.MULTILINE)
    shown = {
        name: "".join(cell.strip() or "0" for cell in cells.split("|"))
        for names, cells in rows
        for name in names.split(", ")
    }
    assert shown == {row.text: row.states for row in host.commands() if row.states != "00000"}


def test_what_is_for_the_host_after_a_command_is_warned_of(check: Check) -> None:
    status, out, err = check("L100 ;@wait 1\n;@wait 2\nL1 ; see ;@probe\n  ;@probe\n")

    assert (status, err) == (0, "")
    assert out.splitlines()[0] == (
        "a.gve:1:6: warning: ;@wait after a command is only a comment; give it a line of its own"
    )
    assert out.count("warning") == 1
