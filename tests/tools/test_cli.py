"""The command line as a whole: usage, interruptions, and any bytes for a program."""

from __future__ import annotations

import contextlib
import io
import json
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rkm04_tools import host
from rkm04_tools.cli import main
from rkm04_tools.source import Source, decode, why_no_text

EXAMPLES = Path(__file__).resolve().parents[2] / "tools" / "examples"
COMMANDS = ["check", "sim", "bench"]


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_has_help_with_an_example(tool, command):
    result = tool(command, "--help")

    assert (result.status, result.err) == (0, "")
    assert f"example:\n  rkm04 {command}" in result.out
    assert "--json" in result.out


def test_the_help_lists_the_commands(tool):
    result = tool("--help")

    assert result.status == 0
    assert all(f"    {command}" in result.out for command in COMMANDS)


@pytest.mark.parametrize("arguments", [[], ["fly"], ["check"], ["sim", "--jso"], ["bench", "x"]])
def test_wrong_usage_is_one_line_and_status_2(tool, arguments):
    result = tool(*arguments)

    assert result.status == 2
    assert result.complaint.startswith("rkm04: ")
    assert "--help shows how it is used" in result.complaint


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--foo"], "unrecognized arguments: --foo; rkm04 --help"),
        (["--verion"], "unrecognized arguments: --verion; did you mean --version?; rkm04 --help"),
        (["board", "--foo=1"], "unrecognized arguments: --foo=1; rkm04 board --help"),
        (["--foo", "check", "a.rks"], "unrecognized arguments: --foo; rkm04 --help"),
    ],
)
def test_an_unknown_option_is_told_where_the_command_is_missing_too(tool, arguments, words):
    assert words in tool(*arguments).complaint


def test_commands_of_several_actions_have_examples_in_their_help_too(tool):
    assert "example:\n  rkm04 board build --board" in tool("board", "--help").out
    assert "example:\n  rkm04 machine check" in tool("machine", "--help").out


def test_ctrl_c_ends_a_command_without_a_traceback_or_half_a_file(start, write, tmp_path):
    steps = tmp_path / "steps.csv"
    program = write("S2000 V16000 A60000 G+")
    process = start("sim", program, "--for", "100000", "--steps", steps)
    while process.poll() is None and len(list(tmp_path.iterdir())) == 1:
        time.sleep(0.02)

    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)

    assert (process.returncode, out, err) == (130, "", "")
    assert list(tmp_path.iterdir()) == [program]


def test_a_reader_that_goes_away_ends_a_command_without_a_traceback(start, write):
    process = start("check", write("Q\n" * 50_000))
    assert process.stdout is not None
    assert process.stderr is not None

    process.stdout.read(10)
    process.stdout.close()

    assert process.stderr.read() == ""
    assert process.wait(timeout=20) == 1
    process.stderr.close()


def test_the_words_for_the_commands_cover_the_firmwares_table():
    meanings = [row.meaning for row in host.opcode_rows()]

    assert all(re.fullmatch("[a-z01/ ]+", meaning) for meaning in meanings)
    assert len(set(meanings)) == len(meanings)


def test_a_crash_of_the_simulator_is_named(tool, write, monkeypatch, tmp_path):
    fake = tmp_path / "build" / "bin" / "rkm04-host"
    fake.parent.mkdir(parents=True)
    fake.write_text("#!/bin/sh\nkill -SEGV $$\n")
    fake.chmod(0o755)
    monkeypatch.setenv("RKM04_BUILD", str(tmp_path / "build"))

    result = tool("check", write("R"))

    assert (result.status, result.complaint) == (
        2,
        "rkm04: rkm04-host ended with signal 11: this is a fault of the tool",
    )


CHARACTERS = st.sampled_from(
    "\\@ABCDEFGHIJKLMNORSTUVWXYZ)(='.[]{}+-0123456789 \t\n\rqQ\0\x7fř\N{ACUTE ACCENT}"
)
NUMBERS = st.integers(-1, 2_000_000_001).map(str) | st.integers(0, 110).map(str)
PIECES = st.tuples(st.sampled_from("\\@ABCDEFGHIJKLMNORSTUVWXYZ)(='.[]"), NUMBERS).map("".join)
BARE = st.sampled_from(["\\", "D ", "E ", "H ", "R ", "U ", "Y ", ". ", "[", "]", "K", "I05H10 "])
TEXTS = (
    st.lists(PIECES | BARE, max_size=40).map(" ".join)
    | st.text(CHARACTERS, max_size=200)
    | st.text(max_size=50)
)
ANYTHING = st.binary(max_size=200) | TEXTS.map(lambda text: text.encode("utf-8", "replace"))


def quietly(*arguments: str | Path) -> tuple[int, str, str]:
    """Run a command without fixtures, which would not be renewed for each example."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main([str(argument) for argument in arguments])
    return status, out.getvalue(), err.getvalue()


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return tmp_path_factory.mktemp("random") / "a.rks"


@given(content=ANYTHING)
@settings(max_examples=60, deadline=None)
def test_check_takes_any_bytes_and_agrees_with_the_unit(program, content):
    program.write_bytes(content)

    status, out, _ = quietly("check", program, "--json")

    assert (status == 2) == bool(why_no_text(content))
    if status == 2:
        return
    (file,) = json.loads(out)["files"]
    lines = len(decode(content).splitlines()) + 1
    assert status == (1 if file["errors"] else 0)
    assert all(1 <= e["line"] <= lines for e in file["errors"] + file["warnings"])
    assert accepted_by_the_unit(program, content) == (status == 0)


@given(content=ANYTHING)
@settings(max_examples=25, deadline=None)
def test_any_program_runs_or_is_refused_in_order(program, content):
    program.write_bytes(content)

    status, out, err = quietly("sim", program, "--for", "0.5")

    assert (status == 2) == bool(why_no_text(content))
    assert (out == "") == (status == 2 or not accepted_by_the_unit(program, content))
    assert "Traceback" not in err


def accepted_by_the_unit(program: Path, content: bytes) -> bool:
    """Whether the unit answers a Set Command with this text with flag 0 or 3."""
    program.write_bytes(Source("", decode(content)).message)
    command = [str(host.program_path()), "sim", "--motor", f"1={program}", "--for", "0.000001"]
    done = subprocess.run(command, capture_output=True)
    program.write_bytes(content)
    assert done.returncode in (0, 1)
    return done.returncode == 0
