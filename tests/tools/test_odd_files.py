"""Files that are no programs, or written elsewhere; names that are none; streams."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from fake_unit import FakeLine, FakeUnit
from rkm04_tools.service import checking
from rkm04_tools.source import decode, why_no_text

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = "\\ S100 V800 {pomalu, č. 1}\r\nF10 R\r\n"
LOOP = ROOT / "tools" / "examples" / "4-loop.rks"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (PROGRAM.encode("utf-16"), "this is UTF-16; save it as UTF-8 or ANSI"),
        (b"\xfe\xff" + PROGRAM.encode("utf-16-be"), "this is UTF-16; save it as UTF-8 or ANSI"),
        (PROGRAM.encode("utf-16-le"), "this is UTF-16 without a mark; save it as UTF-8 or ANSI"),
        (b"\x7fELF" + bytes(50) + b"text", "is not a text file"),
        (b"F10 R\0", "is not a text file"),
        (bytes(range(1, 255)) * 3, "is not a text file"),
    ],
)
@pytest.mark.parametrize("command", ["check", "sim", "send"])
def test_a_file_that_is_no_text_is_one_line(tool, write, command, content, words):
    path = write(content)
    port = ["--port", "socket://127.0.0.1:1"] if command == "send" else []

    result = tool(command, path, *port)

    assert result.status == 2
    assert result.complaint.startswith(f"rkm04: {path}: {words}")


@pytest.mark.parametrize(
    "content",
    [
        PROGRAM.encode("utf-8"),
        PROGRAM.encode("utf-8-sig"),
        PROGRAM.encode("cp1250"),
        PROGRAM.encode() + b"\x1a",
        PROGRAM.encode() + b"\x1a\r\n\x1a\x1a  ",
    ],
)
def test_texts_of_all_editors_are_the_same_program(tool, write, content):
    assert tool("check", write(content), "--json").json["files"][0]["commands"] == 4


def test_a_program_of_one_wrong_character_is_still_a_text():
    assert why_no_text(b"F10 R \x07 W100 F20 R") == ""
    assert why_no_text(b"") == ""


def test_an_end_of_file_in_the_middle_is_named(tool, write):
    result = tool("check", write(b"F10 R\n\x1aF20 R\n"))

    assert (
        ":2:1: error: unknown command (control character, code 26); the end of a DOS" in result.out
    )
    assert result.status == 1
    assert decode(b"F10 R\n\x1aF20 R\n") == "F10 R\n\x1aF20 R\n"


def test_no_more_than_50_errors_are_shown(tool, write):
    result = tool("check", write("q\n" * 2345))

    lines = result.out.splitlines()
    assert sum(": error: " in line for line in lines) == 50
    assert lines[-2].endswith(": and 2295 more errors")
    assert lines[-1].endswith(": 2345 errors")


def test_50_errors_are_all_shown(tool, write):
    result = tool("check", write("q\n" * 50))

    assert "more" not in result.out
    assert tool("check", write("q\n" * 51)).out.count("and 1 more error\n") == 1


def test_json_has_a_thousand_errors_and_how_many_more(tool, write):
    (file,) = tool("check", write("q\n" * 2345), "--json").json["files"]

    assert (len(file["errors"]), file["more_errors"]) == (1000, 1345)
    assert tool("check", write("q\n" * 1000), "--json").json["files"][0]["more_errors"] == 0


@pytest.mark.parametrize("mark", [";", "//", "#", "--", "%"])
def test_a_comment_of_another_language_is_one_error_with_advice(tool, write, mark):
    result = tool("check", write(f"F10 R {mark} forward, then ř Q\nF5 R\nq\n"))

    found = [line.partition("error: ")[2] for line in result.out.splitlines() if "error: " in line]
    assert found == [
        f"{mark} begins no comment here; write comments in {{ }}",
        'unknown command "q"',
    ]


@pytest.mark.parametrize(
    ("text", "commands"),
    [("\\ F5 R", 2), ("F1 R \\ F5 R", 2), ("F5 K R C75", 2), ("K", 0), ("[ F5 R ]", 4), ("", 0)],
)
def test_check_send_and_the_page_count_the_same(tool, write, text, commands):
    (file,) = tool("check", write(text), "--json").json["files"]
    assert file["commands"] == checking.check(text)["commands"] == commands
    if text:
        line = FakeLine(FakeUnit(1))
        try:
            sent = tool("send", write(text), "--port", line.port, "--json").json
        finally:
            line.close()
        assert sent.get("commands", 0) == commands


@pytest.mark.parametrize(
    "arguments",
    [
        ["check", ""],
        ["sim", ""],
        ["sim", LOOP, "--steps", ""],
        ["sim", LOOP, "--plot", ""],
        ["sim", LOOP, "--inputs", ""],
        ["send", "", "--port", "x"],
        ["diff", "", "--port", "x"],
        ["restore", "", "--port", "x"],
    ],
)
def test_an_empty_file_name_is_told(tool, arguments):
    result = tool(*arguments)

    assert result.status == 2
    assert result.complaint == "rkm04: a file name is empty; name a file"


class Given:
    """Standard input that has this."""

    def __init__(self, content: bytes) -> None:
        self.buffer = io.BytesIO(content)


def test_a_program_may_come_from_standard_input(tool, monkeypatch):
    monkeypatch.setattr(sys, "stdin", Given(b"F10 R Q"))
    assert tool("check", "-").out.startswith('-:1:7: error: unknown command "Q"\n')

    monkeypatch.setattr(sys, "stdin", Given(b"F10 R"))
    assert tool("sim", "-", "--json").json["motors"][0]["position"] == 10

    monkeypatch.setattr(sys, "stdin", Given(b"F10 R"))
    assert "- is for one motor only" in tool("sim", "-", "--motor", "2=-").complaint


@pytest.mark.parametrize(
    "content",
    [
        b"\xef\xbb\xbf10,1,1\r\n",
        b"\xef\xbb\xbf# levels\n10,1,1\n\x1a",
        b"10,1,1\x1a",
        b"10,1,1\r\n\x1a\x1a\r\n",
    ],
)
def test_inputs_may_be_written_by_any_editor(tool, write, tmp_path, content):
    inputs, plot = write(content, "in.csv"), tmp_path / "plot.svg"

    result = tool("sim", write("O01"), "--inputs", inputs, "--json", "--plot", plot)

    assert (result.err, result.json["ended"]) == ("", "idle")
    assert result.json["seconds"] == pytest.approx(0.01, abs=0.001)
    assert "<!-- BI 1 -->" in plot.read_text()


def test_inputs_that_are_no_text_are_one_line(tool, write):
    inputs = write("10,1,1\n".encode("utf-16"), "in.csv")

    result = tool("sim", write("O01"), "--inputs", inputs)

    assert result.complaint == (
        f"rkm04: {inputs}: this is UTF-16; name a file with lines ms,input,level"
    )


def run(command: str) -> str:
    """What a shell prints that knows `rkm04`."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
    tool = f'rkm04() {{ "{sys.executable}" -P -m rkm04_tools "$@"; }}; '
    done = subprocess.run(
        ["bash", "-c", tool + command], env=environment, capture_output=True, text=True, timeout=60
    )
    return done.stdout + done.stderr


def test_outputs_may_be_pipes_and_inputs_too():
    told = run(
        f"rkm04 sim {LOOP} --inputs <(echo 1,1,1) --json --steps >(sort >&2) | cat; wait; sleep 0.2"
    )

    answer, _ = json.JSONDecoder().raw_decode(told)
    assert answer["motors"][0]["pulses"] == 5000
    assert told.count(",1,") >= 5000
    assert "# tick_hz=84000000" in told


@pytest.mark.parametrize("path", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_an_output_where_the_summary_goes_is_refused(tool, path):
    result = tool("sim", LOOP, "--trace", path)

    assert result.status == 2
    assert result.complaint == (
        f"rkm04: {path}: the summary goes there; name a file, or use >(COMMAND)"
    )


def test_a_plot_and_a_pipe_do_not_wait_for_each_other(tool, tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)

    result = tool("sim", LOOP, "--steps", pipe, "--plot", tmp_path / "plot.svg")

    assert result.complaint == f"rkm04: {pipe}: --plot reads it back, so it must be a plain file"
