"""The port of the service: its record, and how a stop gets hold of it."""

from __future__ import annotations

import time

import pytest
from rkm04_tools.frame import Frame
from rkm04_tools.service.trouble import Stopped
from rkm04_tools.service.wire import Wire

REQUEST = Frame(1, 7, b"\x041")
ANSWER = Frame(0x81, 7, b"\x041\x0a         0")


class Port:
    """A transport that says what it is told to."""

    name = "a port"

    def __init__(self) -> None:
        self.sent = b""
        self.says = b""

    def read(self, seconds: float) -> bytes:
        if not self.says:
            time.sleep(seconds)
        said, self.says = self.says, b""
        return said

    def write(self, data: bytes) -> None:
        self.sent += data

    def close(self) -> None:
        """There is nothing to close."""


@pytest.fixture
def port():
    return Port()


@pytest.fixture
def stops():
    return []


@pytest.fixture
def wire(port, stops):
    return Wire(port, lambda: bool(stops))


def test_requests_and_answers_are_recorded(wire, port):
    wire.write(REQUEST.encode())
    port.says = b"noise" + ANSWER.encode()
    wire.read(0.1)

    (exchange,) = wire.exchanges()
    assert (exchange.request, exchange.answer) == (REQUEST, ANSWER)
    wire.forget()
    assert wire.exchanges() == []


def test_repeats_and_beginnings_of_sessions_are_not_shown(wire, port):
    wire.write(Frame(1, 6, b"\x01").encode())
    wire.write(REQUEST.encode())
    wire.write(REQUEST.encode())

    assert [each.request for each in wire.exchanges()] == [REQUEST]


def test_a_version_that_was_asked_for_is_shown(wire):
    wire.write(Frame(1, 6, b"\x01").encode())

    assert [each.request.message for each in wire.exchanges()] == [b"\x01"]


def test_nothing_is_sent_while_a_stop_waits(wire, port, stops):
    stops.append("stop")

    with pytest.raises(Stopped):
        wire.write(REQUEST.encode())
    assert port.sent == b""


def test_the_stop_itself_is_sent(wire, port, stops):
    stops.append("stop")
    wire.yields = False

    wire.write(REQUEST.encode())
    assert wire.read(0.15) == b""
    assert port.sent == REQUEST.encode()


def test_a_stop_ends_the_wait_for_an_answer_that_is_overdue(wire, stops):
    wire.write(REQUEST.encode())
    stops.append("stop")

    started = time.monotonic()
    with pytest.raises(Stopped):
        wire.read(30)
    assert time.monotonic() - started < 15


def test_an_answer_that_comes_in_time_is_taken_though_a_stop_waits(wire, port, stops):
    wire.write(REQUEST.encode())
    stops.append("stop")
    port.says = ANSWER.encode()

    assert wire.read(30) == ANSWER.encode()
