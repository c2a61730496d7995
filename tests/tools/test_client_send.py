"""How a program is cut into messages, and what keeps it from running too early."""

from __future__ import annotations

import re
import time
from types import SimpleNamespace

import pytest
from fake_unit import MOVING, RUNNING, STOPPED, FakeLine, FakeUnit
from hypothesis import given, settings
from hypothesis import strategies as st
from rkm04_tools import sending
from rkm04_tools.failure import Failure
from rkm04_tools.frame import Frame
from rkm04_tools.line import open_line
from rkm04_tools.line_errors import UnitRefused, UnitRestarted
from rkm04_tools.sending import (
    TEXT_BYTES_MAX,
    Hold,
    check_program,
    plan_program,
    without_hold,
)
from rkm04_tools.service.together import send_all
from statuses import Vector

LONG = "\\S100" + "F16000000R" * 120


def plan(text: str) -> sending.Plan:
    return plan_program(check_program(text))


@pytest.fixture
def unit():
    return FakeUnit(1)


@pytest.fixture
def fake(unit):
    line = FakeLine(unit)
    yield line
    line.close()


@pytest.fixture
def motor(fake):
    with open_line(fake.port) as line:
        yield line.unit(1).motor(1)


def sent_texts(unit: FakeUnit) -> list[str]:
    return [message[2:].decode() for message in unit.done if message[0] == 2]


def test_a_short_program_goes_in_one_message_in_canonical_form():
    assert plan("\\ S0100 {slow}\n M5 F5 R").texts == ["\\S100M05F5R"]


def test_a_program_that_just_fits_is_not_cut():
    fits = "F1R" * (TEXT_BYTES_MAX // 3) + "R" * (TEXT_BYTES_MAX % 3)

    assert plan(fits).texts == [fits]
    assert len(plan(fits + "R").texts) == 2


def test_a_long_program_is_held_by_brackets_and_cut_between_commands():
    plan_ = plan(LONG)

    assert plan_.hold is Hold.BRACKETS
    assert plan_.texts[0].startswith("\\[S100F16000000R")
    assert plan_.texts[-1].endswith("R]")
    assert "".join(plan_.texts) == LONG.replace("\\", "\\[") + "]"
    assert all(re.fullmatch(r"[\\\[A-Z].*[0-9R\]]", text) for text in plan_.texts)


def test_parts_are_as_long_as_they_can_be():
    assert [len(text) for text in plan("F1" * 345 + "B9" * 345).texts] == [TEXT_BYTES_MAX, 369]


def test_no_frame_is_longer_than_1024_bytes(motor, fake):
    motor.send(LONG)

    assert len(fake.frame_bytes) == 4
    assert max(fake.frame_bytes) <= 1024


def test_the_longest_text_leaves_room_for_every_escape():
    frames = (Frame(16, 0x7E, b"\x020" + b"R" * (TEXT_BYTES_MAX - n)).encode() for n in range(300))

    assert max(map(len, frames)) <= 1024


def test_the_unit_holds_the_long_program(motor, unit):
    sent = motor.send(LONG)

    assert unit.programs[1].decode() == "[" + LONG[1:] + "]"
    assert (sent.commands, sent.messages, sent.overflow) == (241, 2, False)


def test_what_is_left_of_a_program_that_was_cut_short_is_not_released_by_the_next(motor, unit):
    unit.programs[1] = b"[S100F5R"
    unit.states[0] = RUNNING

    with pytest.raises(Failure, match=r"motor 1 waits at \[ in another program .* begin it with"):
        motor.send(LONG[1:])

    assert sent_texts(unit) == []
    motor.send("F6R")
    motor.send(LONG)
    assert unit.programs[1].decode() == "[" + LONG[1:] + "]"


def test_a_long_program_without_a_reset_is_held_too():
    assert plan(LONG[1:]).texts[0].startswith("[S100")


@pytest.mark.parametrize("own", ["[", "]"])
def test_a_long_program_with_brackets_of_its_own_is_held_by_a_stop(motor, unit, own):
    motor.send(LONG + own)

    texts = sent_texts(unit)
    assert texts[:2] == ["\\[", "K"]
    assert texts[-1] == "C75"
    assert "".join(texts[2:-1]) == "]" + LONG[1:] + own


@pytest.mark.parametrize(
    ("count", "hold"),
    [(698, Hold.BRACKETS), (699, Hold.STOP), (700, Hold.STOP)],
)
def test_brackets_never_push_a_program_out_of_the_memory(count, hold):
    assert plan("\\" + "W100" * count).hold is hold


def test_a_stop_waits_until_the_motor_stands(motor, unit, monkeypatch):
    monkeypatch.setattr(sending, "STAND_SECONDS", 0.2)
    unit.tables[1] = b"  2;[(1;100),(50;0)]"

    with pytest.raises(Failure, match="send again when it stands"):
        motor.send(LONG + "[")

    assert sent_texts(unit) == ["\\[", "\\"]


@pytest.mark.parametrize("text", ["\\" + "R" * 701, "R" * 1500])
def test_more_than_the_memory_holds_is_refused_before_anything_is_sent(motor, unit, text):
    count = text.count("R")

    with pytest.raises(Failure, match=f"has {count} commands, and the memory holds 700; nothing"):
        motor.send(text)

    assert unit.done == []


def test_what_has_not_run_is_not_overwritten(motor, unit):
    unit.programs[1] = b"R" * 695
    unit.states[0] = RUNNING | MOVING

    with pytest.raises(Failure, match="has 6 commands, and the memory of motor 1 has room for 5"):
        motor.send("R" * 6)

    assert sent_texts(unit) == []
    motor.send("R" * 5)
    assert sent_texts(unit) == ["RRRRR"]


def test_what_has_run_is_overwritten(motor, unit):
    unit.programs[1] = b"R" * 700

    motor.send("F5R")

    assert sent_texts(unit) == ["F5R"]


def test_a_motor_that_ignores_what_does_not_fit_gets_no_more(motor, unit):
    unit.programs[1] = b"R" * 700
    unit.status = Vector("T40", switches=4).whole

    with pytest.raises(Failure, match="room for 0 more"):
        motor.send("F5R")


def test_one_of_all_motors_without_room_is_enough(motor, unit):
    unit.programs[3] = b"R" * 700
    unit.states[2] = STOPPED

    with pytest.raises(Failure, match="memory of motor 3"):
        motor.unit.motor(0).send("F5R")

    assert sent_texts(unit) == []


def test_a_motor_that_is_not_held_gets_no_program_that_must_be(motor, unit):
    unit.answers[b"\x021K"] = b"\x021\x00\x00"

    with pytest.raises(Failure, match="could not be held by K; nothing more was sent"):
        motor.send(LONG + "]")

    assert sent_texts(unit) == ["\\[", "K", "\\"]


@pytest.mark.parametrize("text", [LONG[1:] + "[", "W100" * 700])
def test_what_cannot_be_held_is_refused_before_anything_is_sent(motor, unit, text):
    with pytest.raises(Failure, match=r"begin it with \\ to send it") as refused:
        motor.send(text)

    assert refused.value.status == 1
    assert unit.done == []


def test_what_needs_a_stop_is_not_sent_to_all_units(motor):
    with pytest.raises(Failure, match="send it to each unit"):
        motor.unit.line.unit(0).motor(1).send(LONG + "[")


@pytest.mark.parametrize(("text", "sent"), [("F1 R K W5 C75", "F1RW5"), ("\\K", "\\")])
def test_k_and_c75_are_kept_out_and_told(text, sent):
    plan_ = plan(text)

    assert plan_.texts == [sent]
    assert "K in line 1, column" in plan_.notes[0]
    assert "rkm04 stop" in plan_.notes[0]


def test_a_speed_does_not_become_one_that_acts_at_once():
    assert plan("V500 K").texts == ["KV500"]


def test_what_stands_before_the_last_reset_is_not_sent():
    plan_ = plan("F1 R \\ F2 R \\ F3 R")

    assert plan_.texts == ["\\F3R"]
    assert plan_.notes == ["4 of its commands stand before \\ and would never run: not sent"]


@pytest.mark.parametrize("text", ["K", " {stop}\n K ", "C75", "V500"])
def test_what_acts_alone_is_sent_as_it_is(motor, unit, text):
    motor.send(text)

    assert sent_texts(unit) == [text.split()[-1]]


@pytest.mark.parametrize("text", ["", " {nothing} ", "C75 K", "K K"])
def test_nothing_is_not_sent(text):
    with pytest.raises(Failure, match="nothing in it to be sent"):
        plan(text)


def test_errors_are_found_before_anything_is_sent(motor, unit):
    with pytest.raises(Failure, match=r"the program:2:4: V .*found 0; nothing was sent") as refused:
        motor.send("S100\nF1 V0")

    assert refused.value.status == 1
    assert unit.done == []


def test_a_refusal_of_the_unit_is_given_its_place(motor, unit):
    unit.flag = b"\x01V"

    with pytest.raises(UnitRefused, match=r"the program:2:4: the unit refuses the value after V"):
        motor.send("F100\nR  V500")


def test_a_refusal_of_what_the_program_has_not_is_told_without_a_place(motor, unit):
    unit.flag = b"\x02?"

    with pytest.raises(UnitRefused, match=r"the program: the unit refuses the command \?"):
        motor.send("F100R")


def test_a_full_memory_is_reported(motor, unit):
    unit.flag = b"\x03\x00"

    assert motor.send("F100R").overflow


def test_a_memory_that_was_full_for_one_part_only_is_reported(motor, unit, monkeypatch):
    def execute(unit: FakeUnit, message: bytes) -> bytes:
        answer = original(unit, message)
        return answer[:2] + b"\x03\0" if message.startswith(b"\x021\\") else answer

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)

    sent = motor.send(LONG)

    assert (sent.messages, sent.overflow) == (2, True)


def test_the_rest_of_a_program_does_not_go_to_a_unit_that_has_restarted(motor, unit):
    with pytest.raises(UnitRestarted):
        motor.send(LONG, lambda done, total: unit.restart() if done == 1 else None)

    assert len(sent_texts(unit)) == 1


def test_nor_if_somebody_has_asked_it_in_between(motor, unit):
    def tell(done: int, total: int) -> None:
        if done == 1:
            unit.restart()
            motor.position()

    with pytest.raises(UnitRestarted):
        motor.send(LONG, tell)

    assert len(sent_texts(unit)) == 1


def test_nor_if_it_has_restarted_while_it_was_waited_for(motor, unit, monkeypatch):
    unit.tables[1] = b"  2;[(1;100),(50;0)]"

    def restart(seconds: float) -> None:
        unit.restart()
        unit.tables.clear()

    clock = SimpleNamespace(monotonic=time.monotonic, sleep=restart)
    monkeypatch.setattr(sending, "time", clock)
    with pytest.raises(UnitRestarted):
        motor.send(LONG + "[")

    assert sent_texts(unit) == ["\\["]


def test_what_needs_several_messages_does_not_go_to_all_units_at_once(fake, unit):
    with open_line(fake.port) as line, pytest.raises(Failure, match="cannot go to all units"):
        line.unit(0).motor(1).send(LONG)

    assert unit.done == []


@pytest.mark.parametrize("motors", [1, 2])
def test_nothing_is_started_in_a_unit_that_has_restarted_since_it_got_its_programs(
    fake, unit, motors
):
    def restart(answer: bytes) -> bytes:
        if sent_texts(unit)[-1:] == [f"\\[F{motors}R"]:
            unit.restart()
        return answer

    fake.faults += [restart] * 1000
    programs = {number: f"\\ F{number} R" for number in range(1, motors + 1)}

    with open_line(fake.port) as line, pytest.raises(Failure, match="has restarted"):
        send_all(line.unit(1), programs, True, sending.silent)

    assert "]" not in sent_texts(unit)


def test_progress_is_told(motor):
    told: list[tuple[int, int]] = []

    motor.send(LONG, lambda done, total: told.append((done, total)))

    assert told == [(0, 2), (1, 2), (2, 2)]


@pytest.mark.parametrize(
    ("held", "program"),
    [
        ("[ F5 R ]", "F5 R"),
        ("[ ] F5 R", "F5 R"),
        ("] F5 R", "F5 R"),
        ("[ ] [ F5 R ]", "[ F5 R ]"),
        ("F5 R", "F5 R"),
        ("[ F5 [ R ]", "[ F5 [ R ]"),
        ("[ F5 R", "[ F5 R"),
        ("[ F5 ] R ]", "[ F5 ] R ]"),
        ("[", "["),
        ("", ""),
    ],
)
def test_what_sending_adds_is_no_part_of_the_program(held, program):
    assert without_hold(held.split()) == program.split()


PIECES = [
    "S100",
    "V16000",
    "F16000000",
    "R",
    "W5",
    "I05H10",
    "@1",
    "=-2000000000",
    "L3",
    "E",
    "T02",
]


@given(pieces=st.lists(st.sampled_from(PIECES), min_size=1, max_size=690), reset=st.booleans())
@settings(max_examples=25, deadline=None)
def test_the_parts_are_the_program(pieces, reset):
    text = "".join(pieces)
    plan_ = plan(("\\" if reset else "") + text)

    joined = "".join(plan_.texts).removeprefix("\\")
    assert joined == (text if len(plan_.texts) == 1 else f"[{text}]")
    assert all(0 < len(part) <= TEXT_BYTES_MAX for part in plan_.texts)
