"""The commands of `gve134` that talk to a unit, on a fake one: what they say and send."""

from __future__ import annotations

import json
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
    assert gve("spindle", "0", "--no-sums").status == 0
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


def test_halt_tells_where_the_axes_stand_and_that_the_spindle_may_turn(
    gve: Tool, unit: FakeGve
) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    result = gve("halt")

    assert result.status == 0
    assert result.out.startswith("the axes stand at X 0  Y 0  Z 0  A 0; stopped, the rest")
    assert "whether the spindle turns is NOT KNOWN" in result.out
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


def test_going_on_tells_where_the_axes_stood_and_not_how_far_they_are(
    gve: Tool, unit: FakeGve
) -> None:
    unit.vector_s = 0.02
    unit.take(b"!0L2\r!0L5\r!0L90\r!0H\r")
    time.sleep(0.05)
    stood = unit.positions[0]

    went_on = gve("go", "--json")

    told = json.loads(went_on.out)
    assert told["from"] == {"X": stood, "Y": 0, "Z": 0, "A": 0}
    assert told["positions"]["X"] > stood


def test_home_stands_where_the_switch_lets_go(gve: Tool, unit: FakeGve) -> None:
    assert gve("home", "y", "-20000", "1000", "20", "500").status == 0
    assert "WY-20000,1000,20,500" in unit.done


def test_a_switch_that_is_not_found_is_status_1(gve: Tool, unit: FakeGve) -> None:
    unit.home_answer = 5

    result = gve("home", "X", "100", "1000", "20", "500")

    told = result.err.splitlines()
    assert (result.status, result.out, len(told)) == (1, "", 2)
    assert told[0] == (
        "gve134: X goes up to 100 pulses to its switch at 1000 pulses/s, then up to -20 off it at "
        "500; Ctrl-C halts"
    )
    assert "its switch was not found" in told[1]


def test_home_after_a_stop_tells_what_comes_first(gve: Tool, unit: FakeGve) -> None:
    unit.take(b"!0H\r")
    time.sleep(0.05)

    result = gve("home", "X", "100", "1000", "20", "500")

    assert result.status == 1
    assert "X was not homed: not after a stop or a fault: D comes first" in result.complaint
    assert "gve134 delete clears it" in result.complaint


def test_home_while_something_moves_is_refused(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    result = gve("home", "X", "100", "1000", "20", "500")

    assert result.status == 1
    assert "the axes are moving, at X 0" in result.complaint
    assert unit.moves


@pytest.mark.parametrize(
    "words",
    [
        "home Q 1 10 1 10", "home X 0 10 1 10", "home X 5 9 1 10", "home X 5 10 -1 10",
        "home X 5 10 1 x", "home X;Y 5 10 1 10", "override 0", "override 1001", "override fast",
        "jog X0", "jog Q5", "jog X5 X6", "jog X99999999999", "jog X5 --speed 1",
        "jog X5 --speed 200001", "jog X5 --speed K", "jog X5 --speed N",
        "jog X5 --speed L20,20,20,20", "jog X5 --speed nan", "jog X5 --speed 1\N{SUPERSCRIPT TWO}0",
        "spindle 100.1", "spindle -1", "spindle 3.55", "spindle x", "output relay on",
        "output blow maybe", "output blow off --keep blow", "memory get 100", "memory get G",
        "memory get FF --count 2",
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


def test_jog_does_not_go_past_the_positions_that_there_are(gve: Tool, unit: FakeGve) -> None:
    unit.positions[0] = 2_147_483_000

    refused = gve("jog", "X740")
    assert refused.status == 1
    assert "X would go from 2147483000 to 2147483740" in refused.complaint
    assert unit.taken == []
    assert gve("jog", "X647").status == 0


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


def test_digits_of_other_scripts_move_nothing(gve: Tool, gve_line: FakeGveLine) -> None:
    result = gve("jog", "X\N{ARABIC-INDIC DIGIT THREE}")

    assert result.status == 2
    assert not gve_line.unit.taken


def test_where_nothing_was_sent_nothing_is_said_to_go_on(
    gve: Tool, gve_line: FakeGveLine, tmp_path: Path
) -> None:
    path = tmp_path / "a.gve"
    path.write_text("C1\n")
    gve_line.unit.mute = True

    result = gve("send", str(path))

    assert result.status == 3
    assert "; no vector was sent: whether the axes move is NOT KNOWN" in result.complaint
