"""Requests on a line with faults: executed once at most, and every call ends in time."""

from __future__ import annotations

import contextlib
import itertools
import resource
import threading
import time

import fake_unit
import pytest
from fake_unit import FakeLine, FakeUnit
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rkm04_tools.failure import Failure
from rkm04_tools.frame import Frame
from rkm04_tools.line import ATTEMPTS, Line, Motor, Wait, open_line
from rkm04_tools.line_errors import (
    GarbledAnswer,
    NoAnswer,
    PortLost,
    UnitRefused,
    UnitRestarted,
    WrongAnswer,
)
from rkm04_tools.messages import BreakPoint, Progress

NODE = 3
VERSION = b"\x01"


@pytest.fixture
def unit():
    return FakeUnit(NODE, positions=[0, -5, 123, 16_000_000])


@pytest.fixture(params=[False, True], ids=["tcp", "pty"])
def fake(request, unit):
    line = FakeLine(unit, on_pty=request.param)
    yield line
    line.close()


@pytest.fixture
def line(fake):
    with open_line(fake.port) as opened:
        yield opened


@pytest.fixture
def motor(line):
    return line.unit(NODE).motor(2)


def commands(unit: FakeUnit) -> list[bytes]:
    """What was executed, without the versions that begin sessions."""
    return [message for message in unit.done if message != VERSION]


def test_a_motor_is_asked_and_told(motor, unit):
    unit.programs[2] = b"S100R"
    unit.tables[2] = b"  2;[(1;100),(50;0)]"

    assert motor.position() == -5
    assert motor.program() == "S100R"
    assert motor.table() == (BreakPoint(1, 100), BreakPoint(50, 0))
    assert motor.progress() == Progress(247, 3)
    assert motor.unit.version().number == "01.02"
    assert motor.unit.positions() == [0, -5, 123, 16_000_000]


def test_acts_are_the_messages_of_the_manual(motor, unit):
    motor.stop()
    motor.resume()
    motor.reset()
    motor.set_speed(500)
    motor.store()

    assert commands(unit) == [b"\x022K", b"\x022C75", b"\x022\\", b"\x022V500", b"\x032"]


def test_a_session_begins_with_two_versions_and_counts_on(motor, fake):
    motor.position()
    motor.position()
    motor.position()

    numbers = [number for _, number, _ in fake.requests]
    assert [message for _, _, message in fake.requests] == [VERSION] * 2 + [b"\x042"] * 3
    assert 0 not in numbers
    assert [(b - a) % 255 for a, b in itertools.pairwise(numbers)] == [1, 1, 1, 1]


def test_stop_goes_at_once_and_without_a_number(motor, fake):
    motor.stop()

    assert fake.requests == [(NODE, 0, b"\x022K")]


def test_a_lost_request_is_repeated_with_its_number(motor, fake, unit):
    motor.position()
    fake.lost_requests = 2

    motor.command("F100R")

    assert commands(unit)[-1:] == [b"\x022F100R"]
    assert len({number for _, number, _ in fake.requests[3:]}) == 1
    assert len(fake.requests) == 6


@pytest.mark.parametrize("fake", [False], indirect=True)
@pytest.mark.parametrize(
    "fault", [fake_unit.lost, fake_unit.damaged, fake_unit.cut_off, fake_unit.mixed]
)
def test_a_request_whose_answer_is_lost_is_executed_once(motor, fake, unit, fault):
    motor.position()
    fake.faults += [fault] * 2

    motor.command("F100R")

    assert commands(unit).count(b"\x022F100R") == 1
    assert unit.programs[2] == b"F100R"


def test_an_answer_amid_noise_is_found(motor, fake):
    fake.faults += [fake_unit.noisy] * 3

    assert (motor.position(), motor.position()) == (-5, -5)
    assert len(fake.requests) <= 5


def test_an_adapter_that_echoes_is_tolerated_and_known(motor, fake, line):
    fake.echo = True

    assert motor.position() == -5
    assert line.echoes
    assert motor.send("\\S100F100R").commands == 3


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_nobody_is_an_error_that_says_what_to_do_in_time(line):
    started = time.monotonic()

    with pytest.raises(NoAnswer, match=r"unit 9 does not answer; check power, wiring .*rkm04 scan"):
        line.unit(9).motor(1).position()

    assert time.monotonic() - started < 1.5


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_an_echo_alone_is_named(fake, line):
    fake.echo = True

    with pytest.raises(NoAnswer, match="only the adapter's echo comes back"):
        line.unit(9).version()


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_two_units_that_talk_at_once_are_named_as_a_cause(motor, fake):
    fake.faults += [fake_unit.mixed] * 8

    with pytest.raises(GarbledAnswer, match="two units have this address"):
        motor.position()


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_a_request_is_not_repeated_by_a_restart_after_its_execution(motor, fake, unit):
    def lost_by_restart(answer: bytes) -> bytes:
        unit.restart()
        return b""

    motor.position()
    fake.faults.append(lost_by_restart)

    with pytest.raises(UnitRestarted, match="executed before that or not at all; look") as caught:
        motor.command("F100R")

    assert caught.value.repeated
    assert commands(unit).count(b"\x022F100R") == 1


def test_a_unit_that_has_restarted_executes_nothing_that_changes_something(motor, unit):
    motor.position()
    unit.restart()

    with pytest.raises(UnitRestarted, match="the request was not executed; look") as caught:
        motor.command("F100R")
    assert not caught.value.repeated
    assert commands(unit) == [b"\x042"]

    motor.command("F100R")
    assert commands(unit) == [b"\x042", b"\x022F100R"]


@pytest.mark.parametrize("act", [Motor.reset, Motor.resume, Motor.store])
def test_nor_any_other_of_the_acts(motor, unit, act):
    motor.position()
    unit.restart()

    with pytest.raises(UnitRestarted):
        act(motor)

    assert commands(unit) == [b"\x042"]


def test_a_unit_that_has_restarted_is_asked_in_a_new_session(motor, fake, unit):
    motor.position()
    unit.restart()
    unit.positions[1] = 0

    assert motor.position() == 0
    assert [message for _, _, message in fake.requests[-4:]] == [b"\x042", *[VERSION] * 2, b"\x042"]


def test_a_unit_that_has_restarted_is_stopped(motor, unit):
    motor.position()
    unit.restart()

    motor.stop()

    assert commands(unit)[-1:] == [b"\x022K"]


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_after_an_error_the_next_request_begins_a_session(motor, fake, unit):
    motor.position()
    fake.faults += [fake_unit.lost] * ATTEMPTS
    with pytest.raises(NoAnswer):
        motor.command("F1")

    motor.command("F1")

    begins = [VERSION] * 2
    assert unit.done == [*begins, b"\x042", b"\x022F1", *begins, b"\x022F1"]


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_after_a_wait_that_was_ended_the_next_request_begins_a_session(
    motor, line, unit, monkeypatch
):
    def ended(seconds: float) -> bytes:
        raise KeyboardInterrupt

    motor.position()
    with monkeypatch.context() as patch:
        patch.setattr(line.transport, "read", ended)
        with pytest.raises(KeyboardInterrupt):
            motor.position()

    motor.command("F1")

    begins = [VERSION] * 2
    assert [message for message in unit.done if message != b"\x042"] == [*begins * 2, b"\x022F1"]
    assert line.sessions[NODE] == 2


def test_an_answer_that_comes_too_late_is_not_taken_for_the_next_one(line, fake, unit):
    line.unit(NODE).version()
    fake.delay_seconds = 0.25
    assert line.unit(NODE).motor(2).position() == -5
    fake.delay_seconds = 0.0
    unit.positions[1] = 77

    assert line.unit(NODE).motor(2).position() == 77


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_an_answer_that_comes_too_late_does_not_confirm_the_next_stop(motor, fake):
    fake.delay_seconds = 0.25
    motor.stop()
    time.sleep(0.3)
    fake.lost_requests = 1000

    with pytest.raises(NoAnswer):
        motor.stop()


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_a_store_does_not_wait_long_for_a_unit_that_is_not_there(line):
    started = time.monotonic()

    with pytest.raises(NoAnswer):
        line.unit(9).motor(1).store()

    assert time.monotonic() - started < 1.5


@pytest.mark.parametrize("fake", [False], indirect=True)
def test_a_flood_of_garbage_ends_in_an_error(fake, line):
    fake.flood = b"\x55\x55\x7e\x83\x7d\x7e\x7e" * 9
    started = time.monotonic()

    with pytest.raises((GarbledAnswer, NoAnswer)):
        line.unit(NODE).motor(1).stop()

    assert time.monotonic() - started < 4


def test_a_broadcast_is_executed_by_all_and_awaited_by_nobody(fake, line, unit):
    started = time.monotonic()
    everybody = line.unit(0).motor(0)

    everybody.stop()
    assert everybody.command("]") is False
    everybody.store()

    assert time.monotonic() - started < 0.1
    deadline = time.monotonic() + 2
    while len(unit.done) < 5 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert unit.done == [b"\x020K", b"\x020K", b"\x020K", b"\x020]", b"\x030"]


def test_nobody_can_be_asked_by_broadcast(line):
    with pytest.raises(Failure, match="none of them answers"):
        line.unit(0).version()


@pytest.mark.parametrize("node", [-1, 17, 128])
def test_an_address_that_there_is_not_is_refused(line, node):
    with pytest.raises(Failure, match="1 to 16"):
        line.unit(node)


@pytest.mark.parametrize("number", [-1, 5])
def test_a_motor_that_there_is_not_is_refused(line, number):
    with pytest.raises(Failure, match="1 to 4"):
        line.unit(1).motor(number)


def test_what_one_motor_only_can_tell_is_not_asked_of_all(line):
    with pytest.raises(Failure, match="name one, 1 to 4"):
        line.unit(NODE).motor(0).program()


def test_a_unit_that_knows_no_such_message_refuses(motor, unit):
    unit.answers[b"\x072"] = b"\xff\x07\x00\x00"

    with pytest.raises(UnitRefused, match="does not know Get Pozic Run"):
        motor.progress()


def test_an_answer_of_wrong_content_is_a_wrong_answer(motor, unit):
    unit.answers[b"\x042"] = b"\x042\x0ahello"

    with pytest.raises(WrongAnswer, match="Get Position"):
        motor.position()


def test_a_port_that_goes_away_is_an_error(fake, line):
    line.unit(NODE).version()
    fake.close()

    with pytest.raises((PortLost, NoAnswer)):
        line.unit(NODE).version()


def test_scan_finds_who_is_there_and_who_is_there_twice(unit):
    fake = FakeLine(FakeUnit(1), unit, FakeUnit(16))
    fake.faults += [bytes] * 2 + [fake_unit.twice] * 2
    try:
        with open_line(fake.port) as line:
            found = line.scan([1, 2, 3, 16])
    finally:
        fake.close()

    assert [(each.node, bool(each.version)) for each in found] == [(1, True), (3, True), (16, True)]
    assert [each.remark for each in found] == [
        "",
        "answers twice: two units with this address?",
        "",
    ]


def test_scan_tells_of_damaged_answers(unit):
    fake = FakeLine(unit)
    fake.faults += [fake_unit.mixed] * 4
    try:
        with open_line(fake.port) as line:
            (found,) = line.scan([2, 3])
    finally:
        fake.close()

    assert (found.node, found.version) == (3, None)
    assert "two units" in found.remark


def test_scan_of_a_silent_line_takes_less_than_two_seconds():
    fake = FakeLine()
    try:
        with open_line(fake.port) as line:
            started = time.monotonic()
            assert line.scan() == []
            assert time.monotonic() - started < 2
    finally:
        fake.close()


def test_threads_take_turns(line):
    motors = [line.unit(NODE).motor(number) for number in (1, 2, 3, 4)]
    got: dict[int, set[int]] = {number: set() for number in range(4)}

    def ask(index: int) -> None:
        for _ in range(10):
            got[index].add(motors[index].position())

    threads = [threading.Thread(target=ask, args=[index]) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    assert got == {0: {0}, 1: {-5}, 2: {123}, 3: {16_000_000}}


class Script:
    """A port that gives what it is told to, and then nothing; its time passes at once."""

    name = "script"

    def __init__(self, answers: list[bytes]) -> None:
        self._answers = answers
        self.sent: list[bytes] = []
        self.now_ns = 0

    def read(self, seconds: float) -> bytes:
        if self.sent and self._answers:
            return self._answers.pop(0)
        self.now_ns += round(seconds * 1e9) + 1
        return b""

    def write(self, data: bytes) -> None:
        self.sent.append(data)

    def close(self) -> None:
        pass


def scripted(script: Script) -> Line:
    return Line(script, clock=lambda: script.now_ns)


@pytest.mark.parametrize("length", [0, 8193])
def test_a_message_that_no_unit_takes_is_not_sent(length):
    script = Script([])

    with scripted(script) as line, pytest.raises(Failure, match="a message has 1 to 8192"):
        line.request(3, bytes(length))

    assert script.sent == []


def test_the_longest_message_is_sent():
    script = Script([])

    with scripted(script) as line, pytest.raises(NoAnswer):
        line.request_at_once(3, b"\x022" + bytes(8190), Wait(0.01, 1))

    assert script.sent == [Frame(3, 0, b"\x022" + bytes(8190)).encode()]


@given(
    noise=st.lists(st.binary(min_size=1, max_size=60), max_size=4), content=st.binary(max_size=9)
)
@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_bytes_on_the_line_end_in_an_answer_or_a_typed_error(noise, content):
    answer = Frame(0x83, 0, b"\x02" + content).encode()
    with scripted(Script([*noise, answer])) as line, contextlib.suppress(GarbledAnswer, NoAnswer):
        assert line.request_at_once(3, b"\x023K", Wait(0.004, 2)) == b"\x02" + content


def test_a_line_that_has_gone_leaves_no_memory_behind():
    def open_many() -> int:
        for _ in range(300):
            scripted(Script([])).close()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    first = open_many()

    assert open_many() - first < 300 * 20  # kB; a line has 46
