"""STOP: to all at once, then to each unit until it has confirmed."""

from __future__ import annotations

import pytest
import statuses
from fake_unit import FakeLine, FakeUnit
from rkm04_tools.service import stopping
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.orders import Disconnect, Forget, Node
from rkm04_tools.status import parse_status
from service_desk import Desk

K, GET_STATUS = b"\x020K", b"\xc8"
MOVING, RUNNING, WAITING, STOPPED, FAILED, ENDED = (1 << bit for bit in range(6))
STANDS = statuses.Vector("", motors=[STOPPED, 0, FAILED, ENDED]).whole


def status_of(bits: int) -> bytes:
    return statuses.Vector("", motors=[bits, 0, 0, 0], positions_steps=[7, 0, 0, 0]).whole


class Listening(FakeUnit):
    """A unit that says something else after each K."""

    def execute(self, message: bytes) -> bytes:
        if message == K and self.later:
            self.status = self.later.pop(0)
        return super().execute(message)

    later: list[bytes]


@pytest.fixture
def unit():
    unit = Listening(3, status=STANDS)
    unit.later = []
    return unit


@pytest.fixture
def other():
    return FakeUnit(5, status=STANDS)


@pytest.fixture
def line(unit, other):
    line = FakeLine(unit, other)
    yield line
    line.close()


@pytest.fixture
def desk(line, monkeypatch):
    monkeypatch.setattr(stopping, "ANSWERING_SECONDS", 1.0)
    desk = Desk()
    desk.connect(line.port, 3)
    yield desk
    desk.worker.close()


def requests_of_stop(line: FakeLine) -> list[tuple[int, bytes]]:
    asked = [(node, message) for node, _, message in line.requests]
    return asked[asked.index((0, K)) :]


def test_all_units_are_told_at_once_before_one_is_asked(desk, line):
    told = desk.stop()

    assert requests_of_stop(line)[:3] == [(0, K), (3, K), (3, GET_STATUS)]
    assert told["error"] is None
    assert told["values"]["confirmed"] == [{"port": line.port, "node": 3}]
    assert told["request_message"] == "02 30 4B"
    assert told["answer_message"] == "02 30 00 00"
    assert desk.worker.state.stop is None


def test_every_unit_that_was_seen_confirms_not_only_the_one_in_use(desk, line):
    desk.connect(line.port, 5)
    desk.connect(line.port, 3)

    told = desk.stop()

    assert {node for node, message in requests_of_stop(line) if message == K} == {0, 3, 5}
    assert {each["node"] for each in told["values"]["confirmed"]} == {3, 5}


def test_a_unit_that_only_the_page_has_seen_confirms_too(desk, line):
    told = desk.stop([Node(line.port, 5)])

    assert {each["node"] for each in told["values"]["confirmed"]} == {3, 5}


def test_a_silent_unit_is_named_and_holds_no_other_one_up(desk, line, other):
    desk.connect(line.port, 5)
    del line.units[5]
    desk.connect(line.port, 3)

    told = desk.stop()

    assert told["error"] == {
        "kind": "NotConfirmed",
        "cause": "the stop is not confirmed by node 5",
        "next": "use the emergency stop",
    }
    assert desk.worker.state.stop == (Node(line.port, 5),)
    asked = requests_of_stop(line)
    assert asked.index((3, GET_STATUS)) < asked.index((5, K))
    assert asked.count((5, K)) == 4  # an answer can be lost

    line.units[5] = other
    assert desk.stop()["error"] is None
    assert desk.worker.state.stop is None


def test_a_stop_waits_no_more_for_what_the_user_has_dealt_with(desk):
    gone = Node("socket://127.0.0.1:1", 4)
    assert desk.stop([gone])["error"]["kind"] == "NotConfirmed"
    assert desk.stop()["error"]["kind"] == "NotConfirmed"

    desk.worker.give(Forget((gone,)), Asked())

    desk.state(lambda state: state["stop"] == ())
    assert desk.stop()["error"] is None


def test_the_nodes_are_told_before_they_are_asked(desk, line):
    desk.stop()

    states = [m["stop"] for m in desk.told if m["type"] == "state" and m["busy"] == "stop"]
    assert states[0] == ({"port": line.port, "node": 3},)


def test_an_answer_to_k_is_no_confirmation_while_the_motor_goes_on(desk, unit):
    unit.status = status_of(MOVING | RUNNING)

    told = desk.stop()

    assert told["error"]["kind"] == "NotConfirmed"
    assert desk.worker.state.stop == (Node(desk.worker.state.port, 3),)


def test_k_is_sent_again_until_a_motor_that_braked_for_a_reset_has_taken_it(desk, line, unit):
    unit.later = [status_of(MOVING), status_of(MOVING | RUNNING), status_of(MOVING | STOPPED)]

    told = desk.stop()

    assert told["error"] is None
    assert requests_of_stop(line).count((3, K)) >= 2


def test_an_original_unit_confirms_by_taking_k(desk, unit):
    unit.status = b""

    assert desk.stop()["error"] is None


@pytest.mark.parametrize("answer", [b"\xff\x02\0\0", b"\x020\2K", b"\x021\0\0", b"\x020\0"])
def test_another_answer_to_k_confirms_nothing(desk, unit, answer):
    unit.answers[K] = answer

    assert desk.stop()["error"]["kind"] == "NotConfirmed"


@pytest.mark.parametrize("status", [b"\xc8", b"\xc8\2" + bytes(20), b"\xc8\0" + STANDS[2:]])
def test_a_status_that_cannot_be_read_confirms_nothing(desk, unit, status):
    unit.status = status

    assert desk.stop()["error"]["kind"] == "NotConfirmed"


def test_a_port_that_is_lost_in_between_leaves_the_nodes_unconfirmed(desk, line):
    line.units.clear()
    line.close()

    told = desk.stop()

    assert told["error"]["kind"] in ("PortLost", "NotConnected")
    assert desk.worker.state.stop == (Node(line.port, 3),)


def test_a_stop_without_a_port_names_the_units_of_the_port_that_was_closed(desk, line):
    desk.ask(Disconnect())

    told = desk.stop([Node(line.port, 3), Node("virtual", 1)])

    assert told["error"]["kind"] == "NotConnected"
    assert desk.worker.state.stop == (Node(line.port, 3),)


def test_units_of_a_port_that_was_closed_keep_a_stop_open_virtual_ones_do_not(desk, line):
    second = FakeLine(FakeUnit(7, status=STANDS))
    desk.connect(second.port, 7)

    told = desk.stop([Node(line.port, 3), Node("virtual", 1)])

    assert told["error"]["cause"] == f"the stop is not confirmed by node 3 of {line.port}"
    assert desk.worker.state.stop == (Node(line.port, 3),)
    desk.stop()
    assert desk.worker.state.stop == (Node(line.port, 3),)
    second.close()


def test_a_stop_without_any_unit_is_not_confirmed_until_there_is_one(line):
    desk = Desk()
    desk.stop()
    assert desk.worker.state.stop == ()

    desk.connect(line.port, 3)
    assert desk.worker.state.stop is None
    desk.worker.close()


def test_a_node_that_never_answered_is_not_confirmed_while_it_is_the_chosen_one(desk, line):
    desk.connect(line.port, 9)

    told = desk.stop()

    assert "node 9" in told["error"]["cause"]
    assert "node 3" not in told["error"]["cause"]


def test_a_stop_that_failed_is_not_sent_again_when_the_unit_comes_back(desk, line, unit):
    del line.units[3]
    desk.stop()
    line.requests.clear()

    line.units[3] = unit
    desk.live()
    desk.live()

    assert {message[0] for _, _, message in line.requests} <= {1, 200}
    assert desk.worker.state.stop == (Node(line.port, 3),)


@pytest.mark.parametrize(
    ("bits", "is_stopped"),
    [
        (0, True), (MOVING, False), (RUNNING, False), (MOVING | RUNNING, False),
        (RUNNING | WAITING, False), (STOPPED, True), (STOPPED | MOVING, True), (FAILED, True),
        (FAILED | MOVING, True), (ENDED, True), (ENDED | MOVING, True),
    ],
)  # fmt: skip
def test_what_stops_is_what_will_not_go_on_by_itself(bits, is_stopped):
    assert stopping.is_stopped(parse_status(status_of(bits)).motors[0]) is is_stopped
