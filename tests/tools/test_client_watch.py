"""`watch`: what it prints of a unit that moves, is away for a while, or reads and writes levels."""

from __future__ import annotations

import json
import re
import signal
import time

import fake_unit
import pytest
import statuses
from fake_unit import FakeUnit

NODE = 3
TABLE = b"  4;[(1;100),(248;1000),(4753;1000),(5000;0)]"


@pytest.fixture
def unit():
    return FakeUnit(NODE, positions=[5000, -5, 0, 16_000_000], tables={1: TABLE})


def test_watch_prints_a_line_each_time(call, unit):
    text = call("watch", "--motor", "1", "--interval", "0.05", "--count", "2")

    assert text.splitlines()[0] == (
        "0.0 s  1: 5000 +0 steps/s, step 247 of 5000, command 3  BI none  BO none"
    )
    assert text.count("\n") == 2


def test_watch_tells_the_speed(call, unit, monkeypatch):
    asked = []

    def move(unit: FakeUnit, message: bytes) -> bytes:
        asked.append((time.monotonic(), message))
        if message == b"\x041":
            unit.positions[0] += 1000
        return original(unit, message)

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", move)

    lines = call("watch", "--json", "--interval", "0.1", "--count", "3").splitlines()

    motor = json.loads(lines[2])["motors"][0]
    assert motor["position"] == 8000
    # The unit is seen between the question for its position and the next one.
    looks = [i for i, (_, message) in enumerate(asked) if message == b"\x041"]
    (first, first_end), (last, last_end) = [(asked[i][0], asked[i + 1][0]) for i in looks[1:]]
    assert 1000 / (last_end - first) - 0.1 <= motor["speed"] <= 1000 / (last - first_end) + 0.1
    assert (motor["steps_made"], motor["steps"], motor["command"]) == (247, 5000, 3)
    assert json.loads(lines[2])["motors"][1]["steps"] is None


def test_watch_tells_backward_moves_inputs_and_outputs_apart(call, unit, monkeypatch):
    def move(unit: FakeUnit, message: bytes) -> bytes:
        if message == b"\x042":
            unit.positions[1] -= 1000
        return original(unit, message)

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", move)
    unit.status = statuses.Vector("", inputs=0b101, outputs=0b10).whole
    unit.tables[2] = b"  2;[(1;100),(248;1000)]"
    started = time.monotonic()

    text = call("watch", "--motor", "2", "--interval", "0.2", "--count", "3")

    took = time.monotonic() - started
    last = re.fullmatch(
        r"(.+) s  2: -3005 -\d+ steps/s, step 247 of -, command 3  BI 1 3  BO 2",
        text.splitlines()[2],
    )
    assert last
    assert 0.4 <= float(last[1]) <= took + 0.05


def test_watch_goes_on_when_a_unit_is_away_for_a_while(call, fake):
    fake.faults += [bytes] * 6 + [fake_unit.lost] * 4

    text = call("watch", "--motor", "1", "--interval", "0.05", "--count", "3")

    lines = text.splitlines()
    assert "unit 3 does not answer" in lines[1]
    assert "1: 5000" in lines[2]


def test_watch_is_redrawn_on_a_terminal(call, fake, monkeypatch, capsys):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)

    text = call("watch", "--motor", "2", "--interval", "0.05", "--count", "2")

    first, again = text.split("\x1b[3A\r\x1b[J")
    assert first == again
    assert first.splitlines()[1].split() == ["2", "-5", "0", "247", "-", "3"]
    assert first.splitlines()[2] == "BI none  BO none"


def test_ctrl_c_ends_watch_in_order(start, fake):
    process = start("watch", "--interval", "0.05")
    assert process.stdout is not None
    process.stdout.readline()

    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=10)

    assert (process.returncode, err) == (0, "")


def test_a_reader_that_goes_away_ends_watch_without_a_traceback(start, fake):
    process = start("watch", "--interval", "0.01", "--motor", "1")
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.readline()
    process.stdout.close()

    assert process.stderr.read() == ""
    assert process.wait(timeout=10) == 1
    process.stderr.close()
