"""The commands that talk to a unit: what they print, as text and as JSON, and their status."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fake_unit import FakeLine, FakeUnit
from rkm04_tools.cli import main
from rkm04_tools.client_options import COMMANDS
from rkm04_tools.line import Wait

NODE = 3
TABLE = b"  4;[(1;100),(248;1000),(4753;1000),(5000;0)]"
QUICK = Wait(0.02, 2)
LONG = "\\S100" + "F16000000R" * 120


@pytest.fixture
def unit():
    programs = {1: b"S100V1000F5000R", 2: b"", 3: b"C100", 4: b""}
    return FakeUnit(NODE, positions=[5000, -5, 0, 16_000_000], programs=programs, tables={1: TABLE})


def acts(unit: FakeUnit) -> list[bytes]:
    return [message for message in unit.done if message[0] in (2, 3)]


POSITIONS = """\
motor    position
    1       5 000
    2          -5
    3           0
    4  16 000 000
"""
PROGRAMS = "{ motor 1 }\nS100V1000F5000R\n{ motor 2 }\n\n{ motor 3 }\nC100\n{ motor 4 }\n\n"
TABLES = """\
motor   step  steps/s
    1      1      100
    1    248    1 000
    1  4 753    1 000
    1  5 000        0
"""
NO_TABLE = "motor  step              steps/s\n    2     -  no move in progress\n"
PROGRESS = "motor  steps  command\n    1    247        3\n"


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["version"], "unit 3: version 01.02 of 2009-03-06\n"),
        (["position"], POSITIONS),
        (["position", "--motor", "2"], "motor  position\n    2        -5\n"),
        (["program"], PROGRAMS),
        (["program", "--motor", "1"], "S100V1000F5000R\n"),
        (["table", "--motor", "1"], TABLES),
        (["table", "--motor", "2"], NO_TABLE),
        (["progress", "--motor", "1"], PROGRESS),
        (["store", "--motor", "1"], "unit 3, motor 1: 4 commands stored\n"),
        (
            ["store", "--node", "0"],
            "all units, motor 1: told to store; NOT CONFIRMED: no unit answers a broadcast; look "
            "at each motor, or ask each unit\n",
        ),
    ],
)
def test_what_is_printed(call, arguments, text):
    assert call(*arguments) == text


@pytest.mark.parametrize(
    ("arguments", "answer"),
    [
        (["version"],
         {"node": 3, "version": "01.02", "date": "2009-03-06", "text": "01.02,06.03.2009"}),
        (["position", "--motor", "2"], {"node": 3, "motors": [{"motor": 2, "position": -5}]}),
        (["program", "--motor", "3"], {"node": 3, "motors": [{"motor": 3, "program": "C100"}]}),
        (["table", "--motor", "2"], {"node": 3, "motors": [{"motor": 2, "points": []}]}),
        (["progress", "--motor", "2"],
         {"node": 3, "motors": [{"motor": 2, "steps": 247, "command": 3}]}),
        (["store", "--motor", "1"],
             {"node": 3, "confirmed": True, "motors": [{"motor": 1, "commands": 4}]}),
    ],
)  # fmt: skip
def test_what_is_printed_as_json(call, arguments, answer):
    assert json.loads(call(*arguments, "--json")) == answer


def test_a_table_as_json_has_all_points(call):
    (motor, *_) = json.loads(call("table", "--json"))["motors"]

    assert motor["points"][1:] == [
        {"step": 248, "speed": 1000},
        {"step": 4753, "speed": 1000},
        {"step": 5000, "speed": 0},
    ]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["reset"], b"\x021\\"),
        (["store", "--motor", "0"], b"\x030"),
    ],
)
def test_what_is_sent(call, unit, arguments, message):
    call(*arguments)

    assert acts(unit) == [message]


def test_send_checks_and_sends_a_program(call, unit, write):
    path = write("\\ S0100 {slow}\nF5000 R")

    text = call("send", path, "--motor", "2")

    sent = f"{path}: 3 commands in 1 message sent to unit 3, motor 2"
    assert text == f"{sent}\nmotor 2: at rest\n"
    assert acts(unit) == [b"\x022\\S100F5000R"]


def test_send_as_json_tells_messages_and_notes(tool, fake, write):
    result = tool("send", write(LONG + "K"), "--json")

    assert result.status == 0
    answer = result.json
    assert {key: answer[key] for key in ("node", "motor", "commands", "messages", "overflow")} == {
        "node": 3,
        "motor": 1,
        "commands": 241,
        "messages": 2,
        "overflow": False,
    }
    assert "K in line 1, column 1206 was not sent" in answer["notes"][0]
    assert answer["notes"][0] in result.err


def test_send_of_a_program_with_errors_sends_nothing(tool, fake, unit, write):
    path = write("\\\nS100 V20000\nQ")

    result = tool("send", path)

    assert (result.status, result.out) == (1, "")
    assert result.err.splitlines()[0] == (
        f"{path}:2:6: error: V (maximum speed) takes a number from 1 to 16000, found 20000"
    )
    assert f'{path}:3:1: error: unknown command "Q"' in result.err
    assert unit.done == []


def test_send_needs_no_port_to_say_what_is_wrong_with_its_arguments(tool, monkeypatch):
    monkeypatch.delenv("RKM04_PORT", raising=False)

    assert "no port; name it with --port" in tool("send", "a.rks").complaint


def test_send_tells_where_the_unit_refuses(tool, fake, unit, write):
    unit.flag = b"\x02R"
    path = write("F5000\n  R")

    result = tool("send", path)

    assert result.status == 1
    assert result.complaint == (
        f"rkm04: {path}:2:3: the unit refuses the command R (flag 2); "
        "nothing of it was stored or run"
    )


def test_send_warns_of_a_full_memory(tool, fake, unit, write):
    unit.flag = b"\x03\x00"

    result = tool("send", write("F5000 R"))

    assert result.status == 0
    assert "warning: the program memory was full, the oldest commands were over" in result.err
    assert result.err.count("\n") == 1


def test_store_of_a_file_stores_what_is_in_the_memory(call, unit, write):
    path = write("\\ S100 V01000 {the same} F5000 R")

    assert call("store", path) == "unit 3, motor 1: 4 commands stored\n"
    assert acts(unit) == [b"\x031"]


def test_store_of_a_long_file_ignores_what_send_has_added(call, unit, write):
    path = write(LONG)
    call("send", path)

    assert call("store", path) == "unit 3, motor 1: 243 commands stored\n"


@pytest.mark.parametrize(
    ("text", "difference"),
    [
        ("S100 V999 F5000 R", "command 2 is V1000, not V999"),
        ("S100 V1000 F5000 R H", "4 commands, not 5"),
        ("S100 V1000", "4 commands, not 2"),
    ],
)
def test_store_of_another_program_stores_nothing(tool, fake, unit, write, text, difference):
    path = write(text)

    result = tool("store", path)

    assert result.status == 1
    assert result.complaint == (
        f"rkm04: unit 3, motor 1: the memory holds another program than {path} ({difference}); "
        f"nothing was stored; rkm04 send {path} comes first"
    )
    assert acts(unit) == []


def test_store_reads_back_what_it_has_stored(tool, fake, unit, monkeypatch):
    def change(unit: FakeUnit, message: bytes) -> bytes:
        answer = original(unit, message)
        if message[0] == 3:
            unit.programs[1] += b"H"
        return answer

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", change)

    result = tool("store")

    assert result.status == 1
    assert "the program has changed while it was stored" in result.complaint


def test_store_tells_of_an_error_of_the_memory(tool, fake, unit):
    unit.answers[b"\x031"] = b"\x031\x01"

    result = tool("store")

    assert result.status == 1
    assert "could not store the program (error 1): the memory reports an error" in result.complaint


def test_scan_lists_who_is_there(call, monkeypatch):
    monkeypatch.setattr("rkm04_tools.line.SCANNING", QUICK)

    text = call("scan")

    assert text == "node  version  date\n   3  01.02    2009-03-06\n"


def test_scan_as_json(call, monkeypatch):
    monkeypatch.setattr("rkm04_tools.line.SCANNING", QUICK)

    assert json.loads(call("scan", "--json")) == {
        "units": [{"node": 3, "version": "01.02", "date": "2009-03-06", "remark": ""}]
    }


def test_scan_of_a_silent_line_is_no_connection(tool, monkeypatch):
    line = FakeLine()
    monkeypatch.setattr("rkm04_tools.line.SCANNING", Wait(0.01, 1))
    try:
        text, as_json = (
            tool("scan", "--port", line.port),
            tool("scan", "--port", line.port, "--json"),
        )
    finally:
        line.close()

    assert (text.status, as_json.status) == (3, 3)
    assert "nobody answers on addresses 1 to 16" in text.complaint
    assert as_json.json == {"units": []}


def test_store_of_a_file_for_all_motors_compares_each(tool, fake, unit, write):
    path = write("S100 V1000 F5000 R")
    unit.programs = {1: b"S100V1000F5000R", 2: b"S100V1000F5000R", 3: b"S100V1000F5000R", 4: b"R"}

    result = tool("store", path, "--motor", "0")

    assert result.status == 1
    assert "unit 3, motor 4: the memory holds another program" in result.complaint
    assert acts(unit) == []


def test_a_slow_line_only_takes_longer(call, fake, unit, write):
    fake.delay_seconds = 0.15  # of the 0.2 s that are waited for

    text = call("send", write("F5000 R"))

    assert "2 commands in 1 message sent" in text
    assert len(acts(unit)) == 1


def test_ctrl_c_ends_a_command_that_waits(start, unit, fake):
    fake.lost_requests = 1000
    process = start("version", "--node", "9")
    deadline = time.monotonic() + 5
    while not fake.requests and time.monotonic() < deadline:
        time.sleep(0.01)

    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=10)

    assert (process.returncode, out, err) == (130, "", "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["version", "--node", "17"], "--node 17: write an address, 1 to 16"),
        (["version", "--node", "x"], "--node x: write an address"),
        (["version", "--node", "0"], "none of them answers; name one"),
        (["watch", "--node", "0"], "none of them answers; name one"),
        (["store", "a.rks", "--node", "0"], "none of them answers; name one"),
        (["position", "--motor", "5"], "invalid choice: 5"),
        (["speed", "0"], "speed 0: write steps/s, 1 to 16000"),
        (["speed", "16001"], "speed 16001: write steps/s, 1 to 16000"),
        (["speed", "fast"], "invalid int value"),
        (["watch", "--interval", "0"], "--interval 0: write seconds"),
        (["watch", "--interval", "nan"], "--interval nan: write seconds"),
        (["watch", "--count", "0"], "--count 0: write how often"),
        (["send"], "required: FILE"),
        (["send", "no-such-file.rks"], "no such file"),
        (["version", "--port", "socket://x"], "socket://HOST:PORT"),
    ],
)
def test_wrong_usage_is_one_line_and_status_2(tool, fake, arguments, words):
    result = tool(*arguments)

    assert result.status == 2
    assert words in result.complaint


def test_a_wrong_address_in_the_environment_is_named(tool, fake, monkeypatch):
    monkeypatch.setenv("RKM04_NODE", "99")

    assert "RKM04_NODE 99: write an address" in tool("version").complaint


def own_arguments(name: str, write) -> list[str]:
    """What a command must have beside the line."""
    path = write("\\ F1 R", "unit-03-motor-2.rks")
    own = {"send": path, "diff": path, "restore": path.parent, "backup": path.parent / "b"}
    return ["5"] if name == "speed" else [str(own[name])] if name in own else []


@pytest.mark.parametrize("row", COMMANDS, ids=lambda row: row.name)
def test_each_command_without_a_port_says_how_to_name_one(tool, monkeypatch, write, row):
    monkeypatch.delenv("RKM04_PORT", raising=False)
    own = own_arguments(row.name, write)

    result = tool(row.name, *own)

    assert result.status == 2
    assert "no port; name it with --port" in result.complaint


@pytest.mark.parametrize("row", COMMANDS, ids=lambda row: row.name)
def test_each_command_has_help_with_an_example(tool, row):
    result = tool(row.name, "--help")

    assert (result.status, result.err) == (0, "")
    assert f"example:\n  rkm04 {row.name}" in result.out
    assert "3 no connection" in result.out


@pytest.mark.parametrize("row", COMMANDS, ids=lambda row: row.name)
def test_each_command_that_finds_nobody_ends_with_status_3(tool, write, row):
    own = own_arguments(row.name, write)

    result = tool(row.name, *own, "--port", "socket://127.0.0.1:1")

    assert result.status == 3
    assert "nobody listens there" in result.complaint


def test_progress_is_shown_on_a_terminal_only(fake, write, monkeypatch, capsys):
    path = str(write(LONG))
    main(["send", path])
    assert capsys.readouterr().err == ""

    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    main(["send", path])

    err = capsys.readouterr().err
    assert "sending [###############...............] 1/2, 50 %" in err
    assert err.endswith("\r\x1b[K")


def test_ports_are_loaded_only_when_they_are_needed():
    code = "import sys, rkm04_tools.cli; print('serial' in sys.modules)"

    done = subprocess.run(
        [sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True,
        env={"PYTHONPATH": str(Path(__file__).resolve().parents[2] / "tools")},
    )  # fmt: skip

    assert done.stdout == "False\n"
