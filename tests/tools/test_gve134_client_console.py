"""`gve134 console` and `gve134 send` on a fake unit: what they say and send."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine
from rkm04_tools.gve134 import client_send

Tool = Any
Result = Any


@pytest.fixture
def gve_unit() -> FakeGve:
    return FakeGve(vector_s=0.001)


@pytest.fixture
def unit(gve_unit: FakeGve, gve_line: FakeGveLine) -> FakeGve:
    """The unit at the end of the line."""
    return gve_unit


def typed(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))


# ---- console ----


def console(
    gve: Tool, monkeypatch: pytest.MonkeyPatch, text: str, *options: str
) -> tuple[Result, list[str]]:
    typed(monkeypatch, text)
    result = gve("console", *options)
    return result, result.out.splitlines()


def test_the_console_shows_answers_with_words(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "p4 ; where\n\nV9\nZ\nH\nG\n!7V300\nSR6\n!0V50\n"
    result, lines = console(gve, monkeypatch, text)

    assert lines == [
        "0,0,0,0,0  done", "5  a parameter is out of bounds", "3  unknown command",
        "8  done, INTA is set", "6  nothing to go on with", "0  done", "0,00  done", "0  done",
    ]  # fmt: skip
    assert result.status == 1
    assert unit.ports["spindle"] == 300


def test_the_console_answers_scripts_in_objects(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, lines = console(gve, monkeypatch, "p4\nH\nV9\n", "--json")

    assert [json.loads(line) for line in lines] == [
        {"command": "P4", "code": 0, "inta": False, "values": "0,0,0,0", "words": "done"},
        {"command": "H", "code": 0, "inta": True, "values": "", "words": "done, INTA is set"},
        {"command": "V9", "code": 5, "inta": True, "values": "",
         "words": "a parameter is out of bounds, INTA is set"},
    ]  # fmt: skip


def test_a_script_in_which_all_was_done_is_status_0(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert console(gve, monkeypatch, "V500\nP4\n")[0].status == 0


def test_a_packet_is_sent_when_it_is_whole(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, lines = console(gve, monkeypatch, "*S\nC1\nC2\n*E2\n*S\nC3\n*E5\n*S\nC4\nH\n")

    assert lines == ["0,2  done", "8  done, INTA is set"]
    assert [parts[0] for parts in unit.taken] == [1, 2]


@pytest.mark.parametrize("line", ["%+", "%-", "V1!0H", "V\t5", "č", "C" + "1," * 40])
def test_what_would_harm_the_line_is_not_sent(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch, line: str
) -> None:
    result, lines = console(gve, monkeypatch, f"{line}\nV500\n")

    assert "not sent" in result.err
    assert lines == ["0  done"]
    assert unit.done[-1] == "V500"


def test_what_is_not_sent_is_shown_without_what_a_terminal_cannot_show(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    odd = io.TextIOWrapper(io.BytesIO(b"\xff\xfe\n"), "utf-8", "surrogateescape")
    monkeypatch.setattr(sys, "stdin", odd)

    result = gve("console")

    assert "\N{REPLACEMENT CHARACTER}" * 2 + ": not sent" in result.err


def test_a_console_without_checksums_tells_no_one_to_begin_one(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    result, _ = console(gve, monkeypatch, "%+\n", "--no-sums")

    assert "checksums are the line's; this console began without them" in result.err


def test_a_console_tells_of_a_reference_run_without_its_switch(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    unit.home_answer = 5

    _, lines = console(gve, monkeypatch, "WX-100,100,10,100\n")

    assert lines == [
        "D  its switch was not found, or not let go, within the ways that were given, INTA is set"
    ]


def test_a_console_goes_along_with_a_reset(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    result, lines = console(gve, monkeypatch, "NX5\nJ\nP4\n")

    assert lines == ["0  done", "0  done", "0,0,0,0,0  done"]
    assert result.status == 0


def test_a_script_ends_when_the_unit_has_restarted(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    original = FakeGve._execute

    def execute(unit: FakeGve, text: str) -> None:
        original(unit, text)
        if text == "0V500":
            unit.restart()

    monkeypatch.setattr(FakeGve, "_execute", execute)

    result, lines = console(gve, monkeypatch, "V500\nL5\nL6\n")

    assert result.status == 3
    assert "HAS RESTARTED" in result.err
    assert unit.taken == []
    assert lines in (["0  done"], [])


# ---- send ----


def write(tmp_path: Path, text: str, name: str = "a.gve") -> Path:
    path = tmp_path / name
    path.write_text(text)
    return path


def test_send_tells_what_became_of_a_file(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    path = write(tmp_path, "V500\n" + "C1,2,3,4\n" * 100)

    result = gve("send", path)

    assert (result.status, result.err) == (0, "")
    assert result.out == (
        f"{path}: 100 vectors sent; the unit is at rest, "
        "the axes stand at X 100  Y 200  Z 300  A 400\n"
    )


def test_send_for_scripts(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    answer = gve("send", write(tmp_path, "V500\n%+\nC1\nC2\n"), "--json").json

    assert answer["commands"] == 3
    assert answer["vectors"] == 2
    assert answer["state"] == "at rest"


def test_send_need_not_wait(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    unit.vector_s = 1000.0

    result = gve("send", write(tmp_path, "C1\nC2\n"), "--no-wait")

    assert "the unit is moving, the axes are at" in result.out


def test_send_takes_standard_input(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    typed(monkeypatch, "C7\n")

    assert gve("send", "-").status == 0
    assert unit.taken == [(7, 0, 0, 0)]


def test_of_a_file_with_errors_nothing_is_sent(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    result = gve("send", write(tmp_path, "V500\nC1\nV9\nfoo\n"))

    assert result.status == 1
    assert ":3:2: error: V takes a number from 10 to 200000" in result.err
    assert "nothing was sent" in result.err
    assert unit.done == []


@pytest.mark.parametrize("text", ["@5 H\n", ";@other\n", ";@pause look\n"])
def test_what_send_does_not_do_is_said_before_anything_is_sent(
    gve: Tool, unit: FakeGve, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    typed(monkeypatch, "")

    assert gve("send", write(tmp_path, text)).status in (1, 2)
    assert unit.done == []


def test_send_shows_progress_on_a_terminal_only(
    gve: Tool, unit: FakeGve, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)

    shown = gve("send", write(tmp_path, "C1\n" * 300)).err

    assert "executing [" in shown
    assert "/300, " in shown


def test_send_turns_g_code(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    mill = Path(__file__).resolve().parents[2] / "tools/examples/gve/mill.rkm"
    path = write(tmp_path, "G21 G90\nG1 X1 F300\nM2\n", "a.nc")

    result = gve("send", path, "--machine", mill)

    assert result.status == 0
    assert unit.positions == [320, 0, 0, 0]
    assert "position 0 of the program is where the axes stand, X 0  Y 0  Z 0  A 0" in result.err
    open_end = write(tmp_path, "G21 G90\nM3 S1000\nG1 X1 F300\n", "c.nc")
    assert "warning: the program ends without M2" in gve("send", open_end, "--machine", mill).err
    taken = list(unit.taken)
    wrong = write(tmp_path, "G21 G91\nG1 X1 F300\nG99\n", "b.nc")
    result = gve("send", wrong, "--machine", mill)
    assert (result.status, unit.taken) == (1, taken)
    assert "b.nc:3:1: error: G99 is not known" in result.err
    assert result.err.endswith("b.nc: nothing was sent\n")


def test_no_origin_is_told_while_the_axes_move(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0C3000\r")
    mill = Path(__file__).resolve().parents[2] / "tools/examples/gve/mill.rkm"

    result = gve("send", write(tmp_path, "G91 F300\nG1 X1\nM2\n", "a.nc"), "--machine", mill)

    assert result.status == 1
    assert "where the axes stand" not in result.err
    assert "the unit is moving; nothing was sent" in result.complaint
    assert unit.taken == [(3000, 0, 0, 0)]


def test_g_code_that_becomes_too_many_vectors_is_not_sent(
    gve: Tool, unit: FakeGve, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client_send, "FILE_BYTES_MAX", 20_000)
    mill = Path(__file__).resolve().parents[2] / "tools/examples/gve/mill.rkm"
    path = write(tmp_path, "G91 F300\n" + "G1 X1\n" * 2000, "a.nc")

    result = gve("send", path, "--machine", mill)

    assert (result.status, unit.done) == (2, [])
    assert "a.nc: more than 20000 bytes of vectors, cut it into several" in result.complaint


def test_an_interrupt_is_status_1(gve: Tool, gve_line: FakeGveLine, tmp_path: Path) -> None:
    original = FakeGve._end_vector

    def end(unit: FakeGve) -> None:
        original(unit)
        if len(unit.taken) > 250 and not unit.inta:
            unit.interrupt(4)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FakeGve, "_end_vector", end)
        result = gve("send", write(tmp_path, "C1\n" * 600))

    assert result.status == 1
    assert "INTERRUPTED by RefZ" in result.complaint


def test_vectors_whose_answer_is_lost_may_have_been_taken(
    gve: Tool, unit: FakeGve, tmp_path: Path
) -> None:
    path = tmp_path / "a.gve"
    path.write_text("L1\nC1\nC1\n")
    unit.faults.extend([lambda answer: b"" if unit.taken else answer] * 1000)

    result = gve("send", str(path))

    assert result.status == 3
    assert "; 0 to 1 of 3 vectors were sent and go on by themselves: whether" in result.complaint


def test_vectors_that_have_found_no_room_were_not_taken(
    gve: Tool, unit: FakeGve, tmp_path: Path
) -> None:
    path = tmp_path / "a.gve"
    path.write_text("L1000\nL5\n")

    def fault(answer: bytes) -> bytes:
        unit.mute = unit.mute or answer.startswith(b"1")
        return answer

    unit.vector_s = 0.5
    unit.faults.extend([fault] * 1000)

    result = gve("send", str(path))

    assert result.status == 3
    assert "; 1 of 2 vectors were sent and go on by themselves: whether" in result.complaint
