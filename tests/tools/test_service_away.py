"""Units and ports that are away for a while: nothing of what was asked meanwhile ever happens."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable

import pytest
import statuses
from fake_unit import FakeLine, FakeUnit, lost
from relay import expect_reset
from rkm04_tools.service import browsers, live, worker
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.orders import Act, Connect, Disconnect, Request
from service_desk import CLIENT, Desk

READS = {1, 4, 7, 200}
"""Messages that change nothing: Version, Get Position, Get Status."""
CHANGES = {2, 3}
"""Set Command, Store Flash."""
MAYBE = "NOT CONFIRMED: it may have been taken"
AT_REST = statuses.Vector("").whole
AT_WORK = next(each for each in statuses.VECTORS if each.name == "at work").whole


class Waking(FakeUnit):
    """A unit during whose first answer, or with each change of it, something else happens."""

    on_version: Callable[[], None] | None = None
    on_change: Callable[[], None] | None = None

    def execute(self, message: bytes) -> bytes:
        if message[0] in CHANGES and self.on_change:
            self.on_change()
        if message == b"\1" and self.on_version:
            happens, self.on_version = self.on_version, None
            happens()
        return super().execute(message)


@pytest.fixture
def unit():
    return Waking(3, status=AT_WORK)


@pytest.fixture
def line(unit):
    line = FakeLine(unit)
    yield line
    line.close()


@pytest.fixture
def desk(line, monkeypatch):
    monkeypatch.setattr(worker, "LOOK_AGAIN_SECONDS", 0.05)
    desk = Desk()
    desk.connect(line.port, 3)
    yield desk
    desk.worker.close()


def kinds(line: FakeLine) -> set[int]:
    return {message[0] for _, _, message in line.requests}


def fall_silent(desk: Desk, line: FakeLine) -> None:
    line.units.clear()
    desk.state(lambda m: m["error"] is not None)


def test_a_look_tells_all_that_the_unit_does(desk):
    told = desk.live()

    assert (told["node"], told["inputs"]) == (3, [1, 0, 1, 0, 0, 1, 0, 1])
    assert told["unit"]["late_steps"] == 7
    assert told["unit"]["line"]["fcs"] == 104
    assert told["motors"][1]["awaited"] == {"what": "input", "number": 5, "level": 1}
    assert [motor["speed"] for motor in told["motors"][1::2]] == [0.0, 0.0]


def test_a_unit_that_never_answers_is_told_as_never_seen(desk, line):
    told = desk.connect(line.port, 9)

    assert told["error"]["kind"] == "NoAnswer"
    state = desk.worker.state_as_json()
    assert (state["connected"], state["unit"], state["seen_ago_s"]) == (True, None, None)
    assert [each["node"] for each in state["nodes"]] == [3]
    assert state["error"]["kind"] == "NoAnswer"


def test_a_silent_unit_is_told_with_the_time_since_it_was_seen(desk, line):
    fall_silent(desk, line)
    time.sleep(0.3)

    state = desk.worker.state_as_json()
    assert state["error"]["kind"] == "NoAnswer"
    assert 0.3 <= state["seen_ago_s"] < 5


def test_a_unit_that_comes_back_is_only_read_and_its_version_anew(desk, line, unit):
    fall_silent(desk, line)
    line.requests.clear()
    unit.restart()
    unit.answers[b"\1"] = b"\1\x1009.99,01.01.2020"
    line.units[3] = unit

    state = desk.state(lambda m: m["error"] is None and m["unit"])

    assert state["unit"]["version"] == "09.99"
    assert desk.live()["motors"][0]["position"] == 5000
    assert kinds(line) <= READS


def test_a_click_while_the_unit_is_away_is_refused_there_and_then(desk, line, unit):
    fall_silent(desk, line)

    told = desk.ask(Request("send", 1, "F100 R"))
    line.requests.clear()
    line.units[3] = unit
    desk.state(lambda m: m["error"] is None)
    desk.live()

    assert told["error"]["kind"] == "NoAnswer"
    assert kinds(line) <= READS


def test_what_was_not_answered_is_not_sent_later_by_a_port_that_keeps_it_back(desk):
    with socket.create_server(("127.0.0.1", 0)) as silent:
        told = desk.connect(f"socket://127.0.0.1:{silent.getsockname()[1]}", 3)
        assert told["error"]["kind"] == "NoAnswer"
        expect_reset(silent)
        desk.ask(Disconnect())
        expect_reset(silent)


def test_what_waits_after_a_request_without_an_answer_is_given_up(desk, line):
    line.units.clear()
    for number in (101, 102, 103):
        desk.worker.give(Act("resume", 0), Asked(CLIENT, number))

    refused = [desk.answer(number)["error"]["kind"] for number in (102, 103, 101)]

    assert refused == ["Unsent", "Unsent", "NoAnswer"]


@pytest.mark.parametrize(
    ("order", "may_move"),
    [
        (Request("send", 1, "\\ F100 R"), True),
        (Request("send_all", 0, texts=((1, "\\ F100 R"),)), True),
        (Act("resume", 0), True),
        (Act("reset", 0), True),
        (Request("store", 1), False),
    ],
)
def test_what_was_taken_and_whose_answer_was_lost_is_not_told_as_not_done(
    desk, line, unit, order, may_move
):
    unit.on_change = lambda: line.faults.extend([lost] * 20)

    error = desk.ask(order)["error"]

    assert CHANGES & {message[0] for message in unit.done}
    words = f"{error['cause']}; {error['next']}"
    assert words.startswith(f"{MAYBE}; {'motors may move; ' if may_move else ''}")
    assert "unit 3 does not answer; check power" in words
    assert error["kind"] == "NoAnswer"
    assert MAYBE not in desk.worker.state_as_json()["error"]["cause"]


def test_what_was_not_on_the_line_was_not_taken(desk, line):
    """A session comes first; a question changes nothing."""
    desk.connect(line.port, 9)
    assert MAYBE not in str(desk.ask(Act("resume", 0))["error"])
    assert not CHANGES & kinds(line)
    desk.connect(line.port, 3)
    line.faults.extend([lost] * 20)
    assert MAYBE not in str(desk.ask(Request("position", 0))["error"])


def test_a_click_just_before_the_unit_comes_back_is_refused(desk, line, unit):
    fall_silent(desk, line)
    unit.on_version = lambda: desk.worker.give(Act("resume", 0), Asked(CLIENT, 200))
    unit.restart()
    line.units[3] = unit

    assert desk.answer(200)["error"]["kind"] == "Unsent"
    desk.live()
    assert b"\x020C75" not in unit.done


def test_a_port_that_is_lost_is_opened_again_and_only_read(desk, line, unit):
    line.close()
    lost = desk.state(lambda m: not m["connected"])
    refused = desk.ask(Act("resume", 0))
    again = FakeLine(unit, port=int(line.port.rpartition(":")[2]))

    desk.state(lambda m: m["connected"] and m["unit"] and m["error"] is None)
    desk.live()

    assert (lost["away"], lost["error"]["kind"]) == (True, "PortLost")
    assert refused["error"]["kind"] == "NotConnected"
    assert kinds(again) <= READS
    again.close()


def test_a_port_that_the_user_gives_up_is_not_opened_again(desk, line, unit):
    line.close()
    desk.state(lambda m: m["away"])
    desk.ask(Disconnect())
    again = FakeLine(unit, port=int(line.port.rpartition(":")[2]))

    time.sleep(0.5)

    assert again.requests == []
    state = desk.worker.state
    assert (state.connected, state.away, state.error) == (False, False, None)
    again.close()


def test_a_port_that_could_not_be_opened_is_not_tried_again_by_itself(desk, line, unit):
    second = FakeLine(FakeUnit(3))
    second.close()
    told = desk.connect(second.port, 3)
    again = FakeLine(unit, port=int(second.port.rpartition(":")[2]))

    time.sleep(0.5)

    assert told["error"]["kind"] == "PortMissing"
    assert again.requests == []
    again.close()


def test_the_first_port_of_the_service_is_tried_until_it_is_there(unit, monkeypatch):
    monkeypatch.setattr(worker, "LOOK_AGAIN_SECONDS", 0.05)
    gone = FakeLine(unit)
    gone.close()
    desk = Desk()
    desk.worker.give(Connect(gone.port, 3), Asked())
    desk.state(lambda m: m["away"])
    again = FakeLine(unit, port=int(gone.port.rpartition(":")[2]))

    desk.state(lambda m: m["connected"] and m["unit"])

    assert desk.live()["node"] == 3
    assert kinds(again) <= READS
    desk.worker.close()
    again.close()


def test_an_original_unit_is_asked_for_positions_and_places_in_programs_only(desk, unit, line):
    unit.status = b""
    unit.positions = [10, 20, 30, 40]
    desk.connect(line.port, 3)
    desk.live()
    line.requests.clear()

    told = desk.live()

    assert [motor["position"] for motor in told["motors"]] == [10, 20, 30, 40]
    assert {motor["moving"] for motor in told["motors"]} == {None}
    assert (told["inputs"], told["outputs"], told["unit"]) == (None, None, None)
    assert kinds(line) == {4, 7}


def test_a_unit_that_was_changed_for_another_is_asked_for_its_status_again(desk, unit, line):
    unit.status = b""
    desk.connect(line.port, 3)
    assert desk.live()["unit"] is None
    fall_silent(desk, line)

    unit.status = AT_REST
    line.units[3] = unit
    desk.state(lambda m: m["error"] is None)

    assert desk.live()["unit"]["cause"] == "power-on"


def test_an_answer_of_another_device_is_an_error_and_no_look(desk, unit):
    unit.status = b"\xc8\2"
    state = desk.state(lambda m: m["error"] is not None)
    before = len([m for m in desk.told if m["type"] == "live"])
    time.sleep(0.3)

    assert state["error"]["kind"] == "WrongAnswer"
    assert len([m for m in desk.told if m["type"] == "live"]) <= before + 1


def test_what_has_waited_too_long_for_its_turn_is_refused(desk, line, monkeypatch):
    monkeypatch.setattr(worker, "TURN_SECONDS", -1.0)
    line.requests.clear()

    told = desk.ask(Act("resume", 0))

    assert told["error"]["kind"] == "Late"
    assert kinds(line) <= READS


def test_a_program_that_is_sent_in_parts_leaves_room_for_looks(desk, unit, line):
    unit.status = AT_REST
    before = len(desk.told)

    desk.ask(Request("send", 1, "\\ " + "W16000000 " * 300))

    sent = desk.told[before:]
    parts = [place for place, m in enumerate(sent) if m["type"] == "progress"]
    looks = [place for place, m in enumerate(sent) if m["type"] == "live"]
    assert any(parts[0] < place < parts[-1] for place in looks)


def test_beats_tell_how_old_a_request_is(monkeypatch):
    now = 1000.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    beats = browsers.Beats()
    first = beats.last
    now += browsers.LATE_SECONDS
    assert not beats.is_late(first)
    now += 0.1
    assert beats.is_late(first)
    assert not beats.is_late(beats.next())
    assert beats.is_late(beats.last + 1)


def test_speeds_are_told_where_they_are_known():
    speeds = live.Speeds()

    assert speeds.of(10.0, [0, 0]) == [None, None]
    assert speeds.of(10.5, [100, -50]) == [200.0, -100.0]
    assert speeds.of(10.6, [100_000, -50]) == [None, 0.0]
    assert speeds.of(13.0, [100_000, -50]) == [None, None]
