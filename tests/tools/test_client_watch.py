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
    text = call("watch", "--motor", "1", "--interval", "0.4", "--count", "2")

    assert text.splitlines()[0] == (
        "0.0 s  1: 5000 - steps/s, step 247 of 5000, command 3  BI none  BO none"
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

    lines = call("watch", "--json", "--interval", "0.4", "--count", "3").splitlines()

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

    text = call("watch", "--motor", "1", "--interval", "0.4", "--count", "3")

    lines = text.splitlines()
    assert "unit 3 does not answer" in lines[1]
    assert "1: 5000" in lines[2]
    assert "RESTARTED" not in text


RESTARTED = (
    "unit 3 HAS RESTARTED (power-on): positions count anew, and stored programs may run by "
    "themselves"
)


def restarts(unit: FakeUnit, monkeypatch, when, then=lambda: None) -> None:
    """The unit restarts at the second question that is meant."""
    asked: list[bytes] = []

    def take(unit: FakeUnit, number: int, message: bytes) -> bytes:
        asked.append(message)
        if asked.count(when) == 2 and message == when:
            unit.restart()
            unit.positions[:] = [0] * 4
            then()
        return original(unit, number, message)

    original = FakeUnit.take
    monkeypatch.setattr(FakeUnit, "take", take)


@pytest.mark.parametrize("when", [b"\xc8", b"\x072"])
def test_watch_says_that_a_unit_has_restarted_and_takes_no_speed_across_it(call, unit, monkeypatch,
                                                                           when):  # fmt: skip
    """One that was away for less than a look, between two looks or in the midst of one."""
    restarts(unit, monkeypatch, when)

    lines = call("watch", "--interval", "0.4", "--count", "3").splitlines()

    assert len(lines) == 4
    assert lines[1].split("  ", 1)[1] == RESTARTED
    assert "1: 0 - steps/s" in lines[2]
    assert "1: 0 +0 steps/s" in lines[3]


def test_so_it_does_of_one_that_was_silent_meanwhile(call, fake, unit, monkeypatch):
    restarts(unit, monkeypatch, b"\xc8", lambda: fake.faults.extend([fake_unit.lost] * 4))

    text = call("watch", "--json", "--interval", "0.4", "--count", "4")

    looks = [json.loads(line) for line in text.splitlines()]
    assert "does not answer" in looks[1]["error"]
    assert [look.get("restarted") for look in looks] == [False, None, True, False]
    assert [look["motors"][0]["speed"] for look in (looks[0], looks[2])] == [None, None]
    assert looks[3]["motors"][0]["speed"] == 0


def test_of_a_unit_that_tells_no_counts_a_restart_is_not_known(tool, fake, unit):
    unit.status = b""
    fake.faults += [bytes] * 6 + [fake_unit.lost] * 4

    result = tool("watch", "--motor", "1", "--interval", "0.4", "--count", "3")

    assert "unit 3 was away, and whether it has restarted is NOT KNOWN\n" in result.out
    assert "1: 5000 - steps/s" in result.out.splitlines()[-1]


def test_a_restart_stays_above_what_is_redrawn(call, unit, monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    restarts(unit, monkeypatch, b"\xc8")

    text = call("watch", "--motor", "2", "--interval", "0.4", "--count", "3")

    _, second, third = text.split("\x1b[3A\r\x1b[J")
    assert RESTARTED in second.splitlines()[0]
    assert len(third.splitlines()) == 3


def test_an_interval_that_cannot_be_kept_is_told_once(tool, fake):
    fake.delay_seconds = 0.02

    result = tool("watch", "--motor", "1", "--interval", "0.05", "--count", "4")

    assert result.err.count("\n") == 1
    assert re.fullmatch(
        r"rkm04: a look takes 0\.\d+ s, more than --interval 0\.05: looks come every 0\.\d+ s, as "
        r"long as they take so long\n",
        result.err,
    )


def test_watch_is_redrawn_on_a_terminal(call, fake, monkeypatch, capsys):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)

    text = call("watch", "--motor", "2", "--interval", "0.4", "--count", "2")

    first, again = text.split("\x1b[3A\r\x1b[J")
    assert first.splitlines()[1].split() == ["2", "-5", "-", "247", "-", "3"]
    assert again.splitlines()[1].split() == ["2", "-5", "0", "247", "-", "3"]
    assert first.splitlines()[2] == "BI none  BO none"


def test_ctrl_c_ends_watch_in_order(start, fake):
    process = start("watch", "--interval", "0.4")
    assert process.stdout is not None
    process.stdout.readline()

    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=10)

    assert (process.returncode, err) == (0, "")


def test_a_reader_that_goes_away_ends_watch_without_a_traceback(start, fake):
    process = start("watch", "--interval", "0.4", "--motor", "1")
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.readline()
    process.stdout.close()

    assert process.stderr.read() == ""
    assert process.wait(timeout=10) == 1
    process.stderr.close()
