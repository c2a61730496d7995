"""Answers become types, and an answer of any other bytes a typed error."""

from __future__ import annotations

import contextlib
import datetime
import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rkm04_tools import messages
from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import UnitRefused, WrongAnswer
from rkm04_tools.messages import BreakPoint, Progress

VECTORS = Path(__file__).resolve().parents[1] / "vectors" / "messages.json"
PARSERS = [
    messages.parse_set_command,
    messages.parse_store,
    messages.parse_positions,
    messages.parse_program,
    messages.parse_table,
    messages.parse_progress,
]


def talks(number: int) -> list[tuple[bytes, bytes]]:
    """Every request of a number that the vectors hold, with its answer."""
    loaded = json.loads(VECTORS.read_text())["conversations"]
    pairs = [
        (bytes.fromhex(each["request"]), bytes.fromhex(each["answer"]))
        for talk in loaded
        for each in talk["exchanges"]
    ]
    found = [(asked, answer) for asked, answer in pairs if asked[0] == number and len(asked) > 1]
    assert found != []
    return found


def test_version_has_number_and_date():
    version = messages.parse_version(b"\x01\x1001.02,06.03.2009")

    assert (version.number, version.date) == ("01.02", datetime.date(2009, 3, 6))


def test_positions_may_be_longer_than_their_field():
    answer = b"\x040\x0a         0\x0b-1234567890\x0a         5\x0a         0"

    assert messages.parse_positions(answer, 0) == [0, -1234567890, 5, 0]


def test_a_table_has_its_points():
    answer = b"\x062  3;[(1;100),(10;500),(2222;0)]"

    points = messages.parse_table(answer, 2)

    assert points == (BreakPoint(1, 100), BreakPoint(10, 500), BreakPoint(2222, 0))


def test_progress_has_steps_and_command():
    assert messages.parse_progress(b"\x074 45823; 5", 4) == Progress(45823, 5)


@pytest.mark.parametrize(
    ("number", "parse"),
    [
        (messages.GET_POSITION, messages.parse_positions),
        (messages.GET_COMMAND, messages.parse_program),
        (messages.GET_TABLE, messages.parse_table),
        (messages.GET_PROGRESS, messages.parse_progress),
    ],
)
def test_every_answer_of_the_documents_is_read_or_refused_as_what_it_is(number, parse):
    for asked, answer in talks(number):
        motor = asked[1] - ord("0")
        if answer[0] == messages.UNKNOWN:
            with pytest.raises(UnitRefused, match="does not know"):
                parse(answer, motor)
        elif b"ERROR COMMAND" not in answer:
            assert parse(answer, motor) is not None


def test_every_flag_of_the_documents_is_read_or_refused_as_what_it_is():
    for asked, answer in talks(messages.SET_COMMAND):
        motor = asked[1] - ord("0")
        if answer[2] == 0:
            assert messages.parse_set_command(answer, motor) is False
        else:
            with pytest.raises(UnitRefused) as refused:
                messages.parse_set_command(answer, motor)
            assert refused.value.flag == answer[2]
            assert refused.value.character == chr(answer[3])


def test_flag_3_is_no_error():
    assert messages.parse_set_command(b"\x021\x03\x00", 1) is True


@pytest.mark.parametrize(("error", "words"), [(1, "memory reports"), (2, "too long"), (9, "9")])
def test_an_error_of_store_flash_is_told(error, words):
    with pytest.raises(UnitRefused, match=words):
        messages.parse_store(b"\x031" + bytes([error]), 1)


@pytest.mark.parametrize(
    "answer",
    [
        b"\x01\x0f01.02,06.03.2009",
        b"\x01\x1001.02,31.02.2009",
        b"\x01\x1001.02;06.03.2009",
        b"\x01",
        b"",
        b"\x02\x1001.02,06.03.2009",
    ],
)
def test_a_version_that_is_none_is_a_wrong_answer(answer):
    with pytest.raises(WrongAnswer, match="Version"):
        messages.parse_version(answer)


@pytest.mark.parametrize(
    ("parse", "answer"),
    [
        (messages.parse_positions, b"\x041\x0a         "),
        (messages.parse_positions, b"\x041\x0a         x"),
        (messages.parse_positions, b"\x042\x0a         0"),
        (messages.parse_positions, b"\x041\x00"),
        (messages.parse_positions, b"\x041"),
        (messages.parse_positions, b"\x041\x0a         0\x0a         0"),
        (messages.parse_table, b"\x061  2;[(1;100)]"),
        (messages.parse_table, b"\x061  1;[(1;100),]"),
        (messages.parse_progress, b"\x071     0;"),
        (messages.parse_program, b"\x051C100\xff"),
        (messages.parse_program, b"\x051C100\x1b[2J"),
        (messages.parse_store, b"\x031"),
        (messages.parse_set_command, b"\x021\x00"),
        (messages.parse_set_command, b"\x021\x07\x00"),
    ],
)
def test_an_answer_of_another_form_is_a_wrong_answer(parse, answer):
    with pytest.raises(WrongAnswer):
        parse(answer, 1)


@pytest.mark.parametrize("parse", PARSERS)
@given(content=st.binary(max_size=40) | st.text("0123456789 ;[](),-", max_size=40).map(str.encode))
def test_any_bytes_are_an_answer_or_a_typed_error(parse, content):
    for start in (b"", bytes([PARSERS.index(parse) + 2]) + b"1"):
        with contextlib.suppress(UnitRefused, WrongAnswer):
            parse(start + content, 1)


@given(content=st.binary(max_size=40))
def test_any_bytes_are_a_version_or_a_typed_error(content):
    for answer in (content, bytes([1, len(content)]) + content):
        with pytest.raises(Failure):
            messages.parse_version(answer)
