"""The commands of `gve134` that talk to a unit, on a fake one: what they say and send."""

from __future__ import annotations

import io
import os
import pty
import re
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine
from rkm04_tools.completion import commands_of, offered
from rkm04_tools.gve134.cli import make_parser
from rkm04_tools.gve134.client import RUNS
from rkm04_tools.gve134.client_options import COMMANDS, MEMORY

Tool = Any
Result = Any

PARSER = make_parser()
TALKING = [row.name for row in COMMANDS] + [f"memory {row.name}" for row in MEMORY]


@pytest.fixture
def gve_unit() -> FakeGve:
    return FakeGve(vector_s=0.001)


@pytest.fixture
def unit(gve_unit: FakeGve, gve_line: FakeGveLine) -> FakeGve:
    """The unit at the end of the line."""
    return gve_unit


def typed(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))


# ---- all of them ----


@pytest.mark.parametrize("words", TALKING)
def test_each_command_has_help_with_an_example(
    words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        PARSER.parse_args([*words.split(), "--help"])

    shown = capsys.readouterr().out
    assert end.value.code == 0
    assert re.search(rf"example:\n  gve134 {words}\b", shown)
    assert max(map(len, shown.splitlines())) <= 100


def test_each_command_does_something() -> None:
    assert set(RUNS) == set(TALKING)


def test_shells_complete_commands_and_their_words() -> None:
    assert {name for name, _ in commands_of(PARSER)} >= {"send", "memory", "backup", "completion"}
    assert offered(PARSER, ["memory", "re"]) == ["restore"]
    assert offered(PARSER, ["output", "co"]) == ["cooling", "cover"]
    assert "921600" in offered(PARSER, ["watch", "--baud", ""])


def test_ports_are_completed_from_their_own_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GVE134_PORT", "/dev/ttyS9")
    monkeypatch.setenv("RKM04_PORT", "/dev/ttyS8")

    found = offered(PARSER, ["send", "a.gve", "--port", ""])

    assert "/dev/ttyS9" in found
    assert "/dev/ttyS8" not in found


def test_the_script_for_a_shell_is_that_of_this_tool(gve: Tool) -> None:
    script = gve("completion", "bash").out

    assert "tools/gve134' completion --words" in script
    assert script.endswith("complete -o default -F _gve134 gve134\n")


EXAMPLES = [
    "position", "status", "halt", "go", "delete", "home X 1 10 1 10", "override up", "jog X1",
    "output blow on", "spindle 5", "memory get 0", "memory set 0 0", "memory backup -", "watch",
    "console",
]  # fmt: skip


@pytest.mark.parametrize("words", EXAMPLES)
def test_without_a_port_it_says_how_to_name_one(
    gve: Tool, monkeypatch: pytest.MonkeyPatch, words: str
) -> None:
    monkeypatch.delenv("GVE134_PORT", raising=False)

    result = gve(*words.split())

    assert result.status == 2
    assert "name it with --port" in result.complaint
    assert "GVE134_PORT" in result.complaint


@pytest.mark.parametrize("words", EXAMPLES)
def test_a_port_that_there_is_not_is_status_3(gve: Tool, words: str) -> None:
    result = gve(*words.split(), "--port", "/dev/ttyNOSUCH7")

    assert result.status == 3
    assert "no such port" in result.complaint


@pytest.mark.parametrize("words", ["position", "status", "go", "delete", "output blow on", "watch"])
def test_a_port_that_answers_garbage_is_status_3(
    gve: Tool, gve_line: FakeGveLine, words: str
) -> None:
    gve_line.unit.mute = True
    gve_line.garbage = b"error: 20\r\n"

    result = gve(*words.split())

    assert result.status == 3
    assert "damaged or not from a GVE134" in result.complaint


def test_a_silent_port_is_status_3(gve: Tool, unit: FakeGve) -> None:
    unit.mute = True

    result = gve("position")

    assert result.status == 3
    assert "does not answer; check power, cable" in result.complaint


def test_another_device_is_status_3(gve: Tool, unit: FakeGve) -> None:
    unit.name = "OTHER v1"

    result = gve("position")

    assert result.status == 3
    assert "another device answers, OTHER v1" in result.complaint


def test_a_terminal_is_a_port_too(gve: Tool) -> None:
    line = FakeGveLine(FakeGve(), on_pty=True)
    try:
        assert gve("position", "--port", line.port).status == 0
    finally:
        line.close()


def test_a_pty_without_anybody_is_silent(gve: Tool) -> None:
    master, slave = pty.openpty()
    try:
        assert gve("position", "--port", os.ttyname(slave)).status == 3
    finally:
        os.close(master)
        os.close(slave)


def test_it_can_do_without_checksums(gve: Tool, unit: FakeGve) -> None:
    assert gve("position", "--no-sums").status == 0
    assert not unit.receiver.sums


# ---- reading ----


def test_positions_are_shown(gve: Tool, unit: FakeGve) -> None:
    unit.positions, unit.latched = [1, -2_000_000, 3, 4], [5, 6, 7, 8]

    assert gve("position").out.splitlines()[2].split() == ["Y", "-2", "000", "000"]
    assert gve("position", "--json").json == {"X": 1, "Y": -2_000_000, "Z": 3, "A": 4}
    assert gve("position", "--latched", "--json").json["A"] == 8


def test_status_is_told_in_words(gve: Tool, unit: FakeGve) -> None:
    unit.status[:4] = [0x03, 0x80, 0x01, 0x00]
    unit.ports["I1"] = 0xFD
    unit.take(b"!0L1000\r")
    unit.vector_s = 1000.0
    unit.causes = (2, 0)
    unit._stand()

    shown = gve("status").out
    told = gve("status", "--json").json

    assert "stopped by    RefY" in shown
    assert re.search(r"RefX +1, interrupts at 1\n", shown)
    assert re.search(r"RefY +0, interrupts at 0\n", shown)
    assert re.search(r"sensor plate +1, interrupts at 0\n", shown)
    assert told["causes"] == ["RefY"]
    assert told["inta"] is True
    assert told["interrupts"]["RefY"] == {"enabled": 1, "active_at": 0, "input": 0}
    assert told["registers"]["ST4"] == "02"


@pytest.mark.parametrize(
    ("set_up", "text"),
    [
        (b"", "at rest"),
        (b"!0L1000\r", "moving"),
        (b"!0L1000\r!0C5\r!0H\r", "stopped, the rest of the vectors waits"),
        (b"!0H\r", "stopped, nothing waits"),
    ],
)
def test_each_state_has_words(gve: Tool, unit: FakeGve, set_up: bytes, text: str) -> None:
    unit.vector_s = 1000.0
    unit.take(set_up)
    time.sleep(0.05)

    assert gve("status", "--json").json["state"].startswith(text)


def test_a_restart_by_a_fault_is_told(gve: Tool, unit: FakeGve) -> None:
    unit.restart(by_fault=True)

    assert "restarted by its watchdog or a fault" in gve("status").out


def test_a_unit_without_sr7_is_known(gve: Tool, unit: FakeGve) -> None:
    unit.codes["SR7"] = 5

    assert gve("status", "--json").json["late_pulses"] is None
    assert "not counted by this unit" in gve("status").out


def test_watch_shows_a_line_each_time(gve: Tool, unit: FakeGve) -> None:
    unit.ports["I2"] = 0x7F
    shown = gve("watch", "--count", "2", "--interval", "0.01").out.splitlines()

    assert len(shown) == 2
    assert re.match(r"0.0 s  X 0 \(\+0/s\).*at rest; inputs at 0: sensor plate$", shown[0])


def test_watch_tells_a_restart_and_goes_on(gve: Tool, gve_line: FakeGveLine) -> None:
    looks = [0]
    original = FakeGve._execute

    def execute(unit: FakeGve, text: str) -> None:
        looks[0] += text == "0P4"
        if text == "0P4" and looks[0] == 2:
            unit.restart()
        original(unit, text)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FakeGve, "_execute", execute)
        result = gve("watch", "--count", "3", "--interval", "0.01")

    lines = result.out.splitlines()
    assert "HAS RESTARTED" in lines[1]
    assert "at rest" in lines[2]


@pytest.mark.parametrize("wrong", [["--interval", "0"], ["--count", "0"]])
def test_watch_refuses_what_is_no_time(gve: Tool, unit: FakeGve, wrong: list[str]) -> None:
    assert gve("watch", *wrong).status == 2


# ---- acting ----


def test_halt_tells_where_the_axes_stand(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    result = gve("halt")

    assert result.status == 0
    assert result.out.startswith("the axes stand at X 0  Y 0  Z 0  A 0; stopped, the rest")
    assert unit.inta


def test_a_halt_that_nobody_answers_is_shouted(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rkm04_tools.gve134.unit.HALT_SECONDS", 0.5)
    unit.mute = True

    result = gve("halt")

    assert result.status == 3
    assert "STOP NOT CONFIRMED: " in result.err
    assert "USE THE EMERGENCY STOP" in result.err


def test_on_a_terminal_the_letters_are_large(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rkm04_tools.gve134.unit.HALT_SECONDS", 0.5)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    unit.mute = True

    shown = gve("halt").err

    assert shown.count("\x1b[1;41;97m") == 19
    assert "##### " in shown


def test_go_and_delete(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r!0H\r")
    time.sleep(0.05)

    assert gve("go").out.startswith("it goes on from X 0")
    assert gve("delete").complaint.endswith("the axes move; gve134 halt comes first (answer 7)")
    assert gve("halt").status == 0
    assert gve("delete").out.startswith("the queue is empty")
    assert "nothing waits to go on" in gve("go").complaint


def test_home_stands_where_the_switch_lets_go(gve: Tool, unit: FakeGve) -> None:
    assert gve("home", "y", "-20000", "1000", "20", "500").status == 0
    assert "WY-20000,1000,20,500" in unit.done


def test_a_switch_that_is_not_found_is_status_1(gve: Tool, unit: FakeGve) -> None:
    unit.home_answer = 5

    result = gve("home", "X", "100", "1000", "20", "500")

    assert result.status == 1
    assert "its switch was not found" in result.complaint


def test_home_while_something_moves_is_refused(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    result = gve("home", "X", "100", "1000", "20", "500")

    assert result.status == 1
    assert "X was not homed: the unit is moving" in result.complaint


@pytest.mark.parametrize(
    "words",
    [
        "home Q 1 10 1 10", "home X 0 10 1 10", "home X 5 9 1 10", "home X 5 10 -1 10",
        "home X 5 10 1 x", "home X;Y 5 10 1 10", "override 0", "override 1001", "override fast",
        "jog X0", "jog Q5", "jog X5 X6", "jog X99999999999", "jog X5 --speed 1", "spindle 100.1",
        "spindle -1", "spindle 3.55", "spindle x", "output relay on", "output blow maybe",
        "output blow off --keep blow", "memory get 100", "memory get G", "memory get FF --count 2",
        "memory get FD --as word", "memory get 0 --count 0", "memory set 0 100",
        "memory set FE 1 --as word", "memory set 0 x --as float", "memory set 0 1,2",
    ],
)  # fmt: skip
def test_bad_input_is_one_line_and_nothing_is_sent(gve: Tool, unit: FakeGve, words: str) -> None:
    result = gve(*words.split())

    assert result.status == 2
    assert result.complaint.startswith("gve134: ")
    assert unit.done == []


@pytest.mark.parametrize(
    ("given", "sent"),
    [("80", "XM80"), ("150%", "XM150"), ("up", "XU"), ("down", "XD"), ("last", "XA")],
)  # fmt: skip
def test_override(gve: Tool, unit: FakeGve, given: str, sent: str) -> None:
    assert gve("override", given).status == 0
    assert unit.done[-1] == sent


def test_jog_says_from_where_to_where_before_it_moves(gve: Tool, unit: FakeGve) -> None:
    unit.positions = [5, 0, 0, 0]

    result = gve("jog", "x1000", "Y-20", "--speed", "300")

    assert result.status == 0
    assert "X from 5 to 1005, Y from 0 to -20; Ctrl-C halts" in result.err
    assert "stand at X 1005  Y -20" in result.out
    assert unit.modal["V"] == "300"


def test_jog_does_not_add_to_what_moves(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    assert "nothing was moved: the unit is moving" in gve("jog", "X5").complaint
    assert len(unit.taken) == 1


def test_jog_that_is_held_stops_at_enter(
    gve: Tool, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    unit.vector_s = 1000.0
    read, write = os.pipe()
    os.write(write, b"\n")
    with os.fdopen(read) as keys:
        monkeypatch.setattr(sys, "stdin", keys)
        result = gve("jog", "X100000", "--hold")
    os.close(write)

    assert result.status == 0
    assert unit.done.count("H") >= 1
    assert unit.done.count("D") == 1
    assert not unit.queue
    assert not unit.inta


def test_a_jog_that_is_interrupted_is_told(gve: Tool, gve_line: FakeGveLine) -> None:
    original = FakeGve._begin

    def begin(unit: FakeGve) -> None:
        original(unit)
        if unit.queue:
            unit.interrupt(1)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FakeGve, "_begin", begin)
        result = gve("jog", "X5")

    assert result.status == 1
    assert "INTERRUPTED by RefX" in result.err


def test_output_writes_the_whole_port_and_says_so(gve: Tool, unit: FakeGve) -> None:
    result = gve("output", "blow", "on", "--keep", "cooling", "spindle")

    assert unit.ports["O"] == 0b11110010
    assert result.out.startswith("on: spindle, cooling, blow; off: brake, lock")
    assert gve("output", "blow", "off", "--json").json["port"] == "FF"


@pytest.mark.parametrize(("given", "permille"), [("30.5", 305), ("0", 0), ("100.0%", 1000)])
def test_spindle(gve: Tool, unit: FakeGve, given: str, permille: int) -> None:
    assert gve("spindle", given).status == 0
    assert unit.ports["spindle"] == permille


# ---- memory ----


def test_memory_is_read_and_written(gve: Tool, unit: FakeGve) -> None:
    assert gve("memory", "set", "0c", "3").out == "0C: 03\n"
    assert unit.memory[0x0C] == 3
    assert gve("memory", "get", "0B", "--count", "2").out == "0B: FF\n0C: 03\n"
    assert gve("memory", "set", "10", "12345678", "--as", "word").status == 0
    assert unit.memory[0x10:0x14] == bytes([0x78, 0x56, 0x34, 0x12])


def test_a_byte_that_is_not_kept_is_told(gve: Tool, unit: FakeGve) -> None:
    unit.stuck = {5}

    result = gve("memory", "set", "05", "3")

    assert result.status == 1
    assert "3 was written, and reads as FF" in result.complaint


def test_what_is_written_while_the_axes_move_is_refused(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    result = gve("memory", "set", "05", "3")

    assert result.status == 1
    assert "not while a vector runs" in result.complaint


def test_a_backup_comes_back_and_only_what_differs_is_written(
    gve: Tool, unit: FakeGve, tmp_path: Path
) -> None:
    unit.memory[:] = bytes(range(256))
    path = tmp_path / "unit.mem"
    assert gve("memory", "backup", path).status == 0
    assert gve("memory", "diff", path).status == 0
    unit.memory[7:9] = b"\0\0"

    assert gve("memory", "diff", path).out == "07: file 07, unit 00\n08: file 08, unit 00\n"
    result = gve("memory", "restore", path)

    assert result.out == f"{path}: 2 bytes written, the others were so already\n"
    assert unit.memory == bytes(range(256))
    assert [each for each in unit.done if each.startswith("EW")] == ["EW07,07", "EW08,08"]


def test_bytes_that_are_not_kept_are_named(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    unit.stuck = {8}
    path = tmp_path / "unit.mem"
    path.write_text("07: 01 02 03 ; three\n")

    result = gve("memory", "restore", path)

    assert result.status == 1
    assert "08: NOT KEPT: 02 was written" in result.out
    assert unit.memory[7:10] == bytes([1, 0xFF, 3])


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("07 01", ":1: write a place, a colon and bytes"), ("\nFF: 01 02", ":2: place 100 is past"),
        ("00: 1\n", ":1: write a place"), ("00: 01\n00: 01", ":2: place 00 is there twice"),
        ("; nothing", "has no bytes"), (None, "no such file"), ("00: 0g", ":1: write a place"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("command", ["restore", "diff"])
def test_a_file_that_is_no_backup_is_one_line(
    gve: Tool, unit: FakeGve, tmp_path: Path, text: str | None, complaint: str, command: str
) -> None:
    path = tmp_path / "a.mem"
    if text is not None:
        path.write_text(text)

    result = gve("memory", command, path)

    assert result.status in (1, 2)
    assert complaint in result.complaint
    assert unit.done == []


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

    assert "sending [" in shown
    assert "300/300, 100 %, the axes move" in shown


def test_send_turns_g_code(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    mill = Path(__file__).resolve().parents[2] / "tools/examples/gve/mill.rkm"
    path = write(tmp_path, "G21 G90\nG1 X1 F300\nM2\n", "a.nc")

    result = gve("send", path, "--machine", mill)

    assert result.status == 0
    assert unit.positions == [320, 0, 0, 0]
    wrong = write(tmp_path, "G99\n", "b.nc")
    assert "b.nc:1:1: error: G99 is not known" in gve("send", wrong, "--machine", mill).err


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
