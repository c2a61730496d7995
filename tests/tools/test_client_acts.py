"""stop, resume, reset, speed and send: what is sent, and that what they print is so."""

from __future__ import annotations

import json
import signal
import time
from types import SimpleNamespace
from typing import Any

import fake_unit
import pytest
from client_acts import GOES, NODE, PROGRAMS, acts, lines
from fake_unit import ENDED, FAILED, MOVING, RUNNING, STOPPED, WAITING, FakeUnit
from rkm04_tools import acting
from rkm04_tools.line import open_line
from rkm04_tools.sending import Plan, check_program
from rkm04_tools.streaming import Feeder, stream_program
from statuses import Vector

K, C75 = b"K", b"C75"


@pytest.fixture
def unit():
    return FakeUnit(NODE, programs=dict(PROGRAMS))


@pytest.fixture
def fake(fake, monkeypatch):
    """The same line, beside a tool that has less patience."""
    monkeypatch.setattr(acting, "STAND_SECONDS", 0.05)
    monkeypatch.setattr(acting, "LOOK_SECONDS", 0.1)
    monkeypatch.setattr(acting, "QUIET_SECONDS", 0.06)
    monkeypatch.setattr(acting, "POLL_SECONDS", 0.01)
    return fake


def test_stop_tells_of_each_motor_what_it_does(tool, fake, unit):
    unit.states[:] = [GOES, RUNNING | WAITING, 0, FAILED]
    unit.errors[3] = 1

    result = tool("stop")

    assert acts(unit) == [(0, K)]
    assert result.status == 0
    assert lines(result) == [
        "motor 1 still brakes",
        "motor 2 stands, stopped by K (rkm04 resume goes on)",
        "motor 3 stands",
        "motor 4 stands, failed: label not found",
    ]


def test_stop_waits_a_while_for_motors_that_brake(tool, fake, unit, monkeypatch):
    monkeypatch.setattr(acting, "STAND_SECONDS", 5.0)
    unit.states[0] = GOES
    stands_at = time.monotonic() + 0.2

    def execute(unit: FakeUnit, message: bytes) -> bytes:
        if time.monotonic() > stands_at:
            unit.states[0] &= ~MOVING
        return original(unit, message)

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)

    assert lines(tool("stop", "--motor", "1")) == [
        "motor 1 stands, stopped by K (rkm04 resume goes on)"
    ]
    assert acts(unit) == [(1, K)]
    assert stands_at < time.monotonic() < stands_at + 2


def test_a_motor_that_goes_on_was_not_stopped(tool, fake, unit):
    unit.states[:] = [GOES] * 4
    unit.answers[b"\x020K"] = b"\x020\0\0"

    result = tool("stop")

    assert result.status == 1
    assert lines(result)[1] == "motor 2 WAS NOT STOPPED: moving"


def test_stop_as_json_tells_what_is_confirmed(tool, fake, unit):
    unit.states[:] = [GOES] * 4

    answer = tool("stop", "--motor", "2", "--json").json

    state = {"motor": 2, "state": "still brakes", "done": True}
    assert answer == {"node": NODE, "motor": 2, "confirmed": True, "motors": [state]}


@pytest.mark.parametrize("command", ["stop", "resume", "reset", "store", "send"])
def test_a_broadcast_is_loudly_not_confirmed(tool, fake, unit, write, command):
    file = [write("J9")] if command == "send" else []
    result = tool(command, *file, "--node", "0", "--motor", "0")

    assert result.status == 0
    assert result.out.count("\n") == 1
    assert "all units, all motors" in result.out
    assert result.out.endswith(f"; {acting.BROADCAST_NOTE}\n")
    assert "empty" not in result.out
    answer = tool(command, *file, "--node", "0", "--motor", "0", "--json").json
    assert (answer["confirmed"], answer["motors"]) == (False, [])


def test_a_stop_that_nobody_answers_calls_for_the_emergency_stop(tool, fake, unit):
    result = tool("stop", "--node", "9")

    assert result.status == 3
    assert result.complaint.startswith("rkm04: NOT CONFIRMED: K: ")
    assert result.complaint.endswith("; use the emergency stop")


def test_so_does_one_after_which_the_unit_is_silent(tool, fake, unit):
    fake.faults += [bytes] + [fake_unit.lost] * 20

    result = tool("stop")

    assert result.status == 3
    assert "NOT CONFIRMED: K was taken, but whether the motors stand: " in result.complaint


def test_of_an_original_unit_only_positions_are_known(tool, fake, unit, monkeypatch):
    def execute(unit: FakeUnit, message: bytes) -> bytes:
        unit.positions[1] += 1
        return original(unit, message)

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)
    unit.status = b""

    result = tool("stop")

    assert result.status == 0
    assert lines(result) == [
        "motor 1 has not moved for 0.06 s",
        "motor 2 still moves",
        "motor 3 has not moved for 0.06 s",
        "motor 4 has not moved for 0.06 s",
        "NOT CONFIRMED: the unit has other software and tells positions only",
    ]


def test_resume_tells_which_motors_go_on(tool, fake, unit):
    unit.states[:] = [STOPPED, STOPPED | MOVING, 0, ENDED]

    result = tool("resume")

    assert acts(unit) == [(0, C75)]
    assert result.status == 0
    assert lines(result) == [
        "motor 1 goes on: running",
        "motor 2 goes on: moving",
        "motor 3 was not stopped by K (at rest): C75 does nothing",
        "motor 4 was not stopped by K (ended by X): C75 does nothing",
    ]


def test_resume_of_a_motor_that_still_brakes_acts_when_it_stands(tool, fake, unit):
    unit.states[1] = STOPPED | MOVING
    unit.answers[b"\x022C75"] = b"\x022\0\0"

    result = tool("resume", "--motor", "2")

    assert (result.status, lines(result)) == (0, ["motor 2 goes on when it stands"])


@pytest.mark.parametrize(("state", "status"), [(STOPPED, 1), (0, 1)])
def test_resume_where_nothing_goes_on_is_status_1(tool, fake, unit, state, status):
    unit.states[:] = [state] * 4
    unit.answers[b"\x020C75"] = b"\x020\0\0"

    assert tool("resume").status == status


def test_reset_tells_that_a_motor_still_brakes(tool, fake, unit):
    unit.states[0] = MOVING

    assert lines(tool("reset")) == ["motor 1 still brakes"]


@pytest.mark.parametrize(
    ("text", "sent", "line"),
    [
        ("K", K, "motor 2 still brakes"),
        (" {halt} K\n", K, "motor 2 still brakes"),
        ("C75", C75, "motor 2 was not stopped by K (moving): C75 does nothing"),
    ],
)
def test_send_of_what_acts_alone_is_sent_so(tool, fake, unit, write, text, sent, line):
    unit.states[1] = GOES

    result = tool("send", write(text), "--motor", "2")

    assert acts(unit) == [(2, sent)]
    assert line in result.out


def test_send_of_a_speed_alone_is_one_message(tool, fake, unit, write):
    unit.states[1] = GOES

    assert tool("send", write("V0500"), "--motor", "2").status == 0

    assert acts(unit) == [(2, b"V500")]


@pytest.mark.parametrize(
    ("state", "line", "status"),
    [
        (GOES, "motor 2: moving", 0),
        (STOPPED, "motor 2: stopped by K: what was sent waits for rkm04 resume", 0),
        (FAILED, "motor 2: failed: E without L", 1),
        (ENDED, "motor 2: ended by X", 1),
        (RUNNING | WAITING, "motor 2: waiting for input 5 to become 1", 0),
    ],
)
def test_send_tells_what_the_motor_does_then(tool, fake, unit, write, state, line, status):
    unit.states[1], unit.errors[1], unit.waits[1] = state, 2, 5 + 128

    result = tool("send", write("F5 R"), "--motor", "2")

    assert result.status == status
    assert result.out.splitlines()[1:] == [line]
    assert ("nothing runs there until \\" in result.err) == (status == 1)


def test_send_as_json_tells_it_too(tool, fake, unit, write):
    unit.states[1], unit.errors[1] = FAILED, 1

    answer = json.loads(tool("send", write("F5 R"), "--motor", "2", "--json").out)

    assert answer["motors"] == [
        {"motor": 2, "state": "failed: label not found", "error": "label not found"}
    ]


class Ring:
    """A motor that runs a command each time it is looked at, and knows what it must not lose."""

    def __init__(self, unit: FakeUnit) -> None:
        self.unit = unit
        self.stored: list[bytes] = []
        self.place = 0
        self.most = 0

    def execute(self, message: bytes) -> bytes | None:
        if message[0] == 2:
            text = message[2:].lstrip(b"\\K")
            self.stored += [b"W" + each for each in text.split(b"W") if each]
            self.most = max(self.most, len(self.stored) - max(self.place, 1) + 1)
            self.unit.states[0] = RUNNING
        if message[0] == 7:
            self.place = min(self.place + 30, len(self.stored))
            if self.place == len(self.stored):
                self.unit.states[0] = 0
            return b"\x071     0;%2d" % self.place
        return None


@pytest.fixture
def ring(unit, monkeypatch):
    ring = Ring(unit)

    def execute(unit: FakeUnit, message: bytes) -> bytes:
        usual = original(unit, message)
        return ring.execute(message) or usual

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)
    return ring


def test_a_stream_never_overwrites_what_has_not_run(tool, fake, ring, write):
    commands = [f"W{ms}" for ms in range(1, 1801)]

    result = tool("send", write("\\" + " ".join(commands)), "--stream")

    assert (result.status, result.err) == (0, "")
    assert b"".join(ring.stored).decode() == "".join(commands)
    assert 600 < ring.most <= 700
    assert "1800 commands in " in result.out


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("W1", "begins with an empty memory; begin it with \\"),
        ("\\ @1 W1 J1", "1:9: J1 cannot be streamed: jumps and calls need their label"),
        ("\\ '1 @1 .", "'1 cannot be streamed: jumps and calls"),
        ("\\ T40 W1", "T40 cannot be streamed: with it a full memory ignores"),
        ("\\ L2" + "W1" * 600 + "E", "L2 cannot be streamed: it has more than 600 commands"),
        ("\\ [" + "W1" * 600 + "]", "[ cannot be streamed: it has more than 600 commands"),
    ],
)
def test_what_cannot_be_streamed_is_refused_with_its_place(tool, fake, unit, write, text, words):
    result = tool("send", write(text), "--stream")

    assert result.status == 1
    assert words in result.err
    assert acts(unit) == []


@pytest.mark.parametrize("where", [["--motor", "0"], ["--node", "0"]])
def test_a_stream_is_for_one_motor(tool, fake, unit, write, where):
    result = tool("send", write("\\ W1"), "--stream", *where)

    assert result.status == 2
    assert "feeds one motor of one unit" in result.complaint
    assert unit.done == []


def test_a_stream_ends_when_its_program_fails(tool, fake, ring, unit, write):
    unit.states[0] = FAILED
    unit.errors[0] = 2
    ring.execute = lambda message: None  # it stays so

    result = tool("send", write("\\" + "W1" * 900), "--stream")

    assert result.status == 1
    assert "motor 1 failed: E without L; 100 of 900 commands were sent" in result.complaint


def test_a_unit_with_t40_is_not_streamed_to(tool, fake, unit, write):
    unit.status = Vector("T40", switches=4).whole

    result = tool("send", write("\\" + "W1" * 900), "--stream")

    assert result.status == 1
    assert "send C40 first" in result.complaint
    assert acts(unit) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_an_interruption_of_a_stream_stops_the_motor_and_tells_so(start, serve, write, number):
    served = serve("--node", str(NODE))
    path = write("\\ S100 V1000 A5000" + " F500 R" * 2000)
    process = start("send", path, "--stream", "--port", served.place, "--node", str(NODE))
    with open_line(served.place) as line:
        motor = line.unit(NODE).motor(1)
        while motor.progress().command < 7:
            time.sleep(0.02)

        process.send_signal(number)
        out, err = process.communicate(timeout=10)

        assert (process.returncode, out) == (130, "")
        assert "rkm04: interrupted after " in err
        assert err.endswith(
            f" of 4003 commands; unit {NODE}: motor 1 stands, stopped by K (do not "
            "resume: what is there of the program ends in its middle; rkm04 reset forgets it)\n"
        )
        before = motor.position()
        assert motor.unit.status().motors[0].stopped
        time.sleep(0.2)
        assert motor.position() == before


def test_what_is_restored_does_not_run_until_it_is_told_to(tool, serve, tmp_path, monkeypatch):
    served = serve("--node", str(NODE))
    monkeypatch.setenv("RKM04_PORT", served.place)
    (tmp_path / f"unit-0{NODE}-motor-2.rks").write_text("\\ S1000 V1000 F200 R [ W1 ]")

    assert tool("restore", tmp_path).status == 0

    with open_line(served.place) as line:
        unit = line.unit(NODE)
        assert unit.status().motors[1].stopped
        assert unit.positions() == [0, 0, 0, 0]
        unit.motor(2).resume()
        end = time.monotonic() + 10
        while unit.motor(2).position() != 200:
            assert time.monotonic() < end
            time.sleep(0.02)


@pytest.mark.parametrize(
    ("place", "sent", "room"),
    [(10, 500, 700 - 491), (399, 500, 700 - 491), (400, 500, 700 - 491), (401, 700, 400),
     (9, 500, 700 - 492), (0, 100, 600), (1, 100, 600), (700, 700, 699)],
)  # fmt: skip
def test_what_a_loop_comes_back_to_is_kept(place, sent, room):
    moving = SimpleNamespace(failed=False, ended=False, stopped=False, at_rest=False)
    told = SimpleNamespace(motors=[moving])
    asked: Any = SimpleNamespace(
        number=1,
        unit=SimpleNamespace(status=lambda: told),
        progress=lambda: SimpleNamespace(command=place),
    )
    feeder = Feeder(asked, Plan(check_program("R"), []), [(10, 400), (20, 30)], pytest.fail)
    feeder.sent = sent

    assert feeder._room() == room


def test_a_stream_of_loops_moves_as_it_says(serve):
    served = serve("--node", str(NODE), "--speed", "0")
    text = "\\ S2000 V16000 A60000" + " L3 F2 R E B3 R" * 500
    told: list[tuple[int, int]] = []
    with open_line(served.place) as line:
        motor = line.unit(NODE).motor(2)
        sent = stream_program(
            motor,
            check_program(text),
            lambda done, total: told.append((done, total)),
            pytest.fail,
        )
        end = time.monotonic() + 20
        while not motor.unit.status().motors[1].at_rest:
            assert time.monotonic() < end
            time.sleep(0.02)

        assert motor.position() == 500 * 3
        assert sent.commands == 3003
        assert told[-1] == (3003, 3003)
        assert motor.unit.status().motors[1].error == ""
