"""The page reads answers of units as the tools do: what is told and refused, and what a stop is.

A page without a service has this in TypeScript, where it cannot ask the tools.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from page_source import ROOT, ask_source
from rkm04_tools import messages
from rkm04_tools.line_errors import UnknownMessage, WrongAnswer
from rkm04_tools.messages import (
    ALL_MOTORS,
    GET_POSITION,
    GET_PROGRESS,
    GET_TABLE,
    MOTORS,
)
from rkm04_tools.service.stopping import is_stopped
from rkm04_tools.status import CAUSES, ERRORS, LINE_COUNTS, Status, parse_status
from statuses import VECTORS, Vector

STATES = range(1 << 7)
"""All that the byte of a motor's state can say."""


def ask(asked: Sequence[Sequence[Any]]) -> list[Any]:
    """What the page's functions return; bytes go as hex."""
    names = {"causes": CAUSES, "errors": ERRORS, "line": list(LINE_COUNTS)}
    return ask_source("unit_messages.ts", asked, names)


def as_page(status: Status) -> dict[str, Any]:
    """What the tools read, as the page has it: with numbers of a browser, and apart from speeds."""
    told = status.as_json()
    del told["layout"]
    motors = [{**each, "position": float(each["position"])} for each in told.pop("motors")]
    for motor in motors:
        del motor["motor"]
    return {"inputs": told.pop("inputs"), "outputs": told.pop("outputs"), "motors": motors,
            "unit": told}  # fmt: skip


def of_page(told: dict[str, Any]) -> dict[str, Any]:
    motors = [{**each, "position": float(each["position"])} for each in told["motors"]]
    for motor in motors:
        assert motor.pop("speed") is None
    return {**told, "motors": motors}


def test_every_vector_of_get_status_says_the_same():
    answers = [answer for each in VECTORS for answer in (each.whole, each.oldest)]
    answers += [answer + b"\xff\1" for answer in answers[::2]]  # as a later layout may have

    told = ask([("status", answer) for answer in answers])

    for answer, one in zip(answers, told, strict=True):
        assert of_page(one) == as_page(parse_status(answer)), answer.hex()


def test_the_vectors_in_the_file_are_those():
    file = json.loads((ROOT / "tests" / "vectors" / "status.json").read_text(encoding="ascii"))

    assert [each["answer"] for each in file["answers"]] == [each.whole.hex() for each in VECTORS]


def test_every_state_is_a_stop_and_a_rest_where_it_is_one_for_the_tools():
    statuses = [parse_status(Vector("", motors=[state] * 4).whole) for state in STATES]
    motors = [asdict(status.motors[0]) for status in statuses]

    stopped = ask([("isStopped", motor) for motor in motors])
    at_rest = ask([("isAtRest", motor) for motor in motors])

    assert stopped == [is_stopped(status.motors[0]) for status in statuses]
    assert at_rest == [status.motors[0].at_rest for status in statuses]
    assert 0 < sum(stopped) < len(STATES)


def test_every_wait_is_read_as_the_tools_read_it():
    vectors = [Vector("", motors=[7] * 4, waits=[code] * 4) for code in range(256)]

    told = ask([("status", each.whole) for each in vectors])

    for each, one in zip(vectors, told, strict=True):
        assert of_page(one) == as_page(parse_status(each.whole)), each.waits


def refusal_of(answer: bytes) -> str | None:
    try:
        parse_status(answer)
    except (UnknownMessage, WrongAnswer) as error:
        return type(error).__name__
    return None


def test_what_is_no_answer_to_get_status_is_refused_as_the_tools_refuse_it():
    whole = VECTORS[0].whole
    answers = [whole[:length] for length in range(1, len(whole))]
    answers += [b"\xff\xc8\0\0", b"\xc8\0" + whole[2:], b"\x04" + whole[1:]]

    told = ask([("status", answer) for answer in answers])

    assert [one.get("refused") for one in told] == [refusal_of(answer) for answer in answers]
    assert all(one.get("refused") for one in told)


def test_the_other_answers_are_read_and_refused_as_the_tools_do_it():
    at = messages.request
    good: list[tuple[Any, ...]] = [
        ("version", b"\x01\x1001.02,06.03.2009"),
        ("positions", at(GET_POSITION, 2, b"\x04 -12"), 2),
        ("positions", at(GET_POSITION, ALL_MOTORS, b"\x011\x02-2\x02 3\x014"), 0),
        ("table", at(GET_TABLE, 1, b"    3;[(0;100),(248;1000),(500;100)]"), 1),
        ("table", at(GET_TABLE, 1, b"0;[]"), 1),
        ("progress", at(GET_PROGRESS, 4, b"  17;   3"), 4),
    ]
    bad: list[tuple[Any, ...]] = [
        ("version", b"\x01\x1101.02,06.03.2009"),
        ("version", b"\x01\x04zero"),
        ("positions", at(GET_POSITION, 3, b"\x0212"), 2),
        ("positions", at(GET_POSITION, 2, b"\x02x2"), 2),
        ("positions", at(GET_POSITION, 2, b"\x0212\x013"), 2),
        ("positions", at(GET_POSITION, ALL_MOTORS, b"\x011\x012"), 0),
        ("table", at(GET_TABLE, 1, b"2;[(0;100)]"), 1),
        ("progress", at(GET_PROGRESS, 4, b"17"), 4),
    ]
    told = ask([*good, *bad])

    version = messages.parse_version(good[0][1])
    (lone,) = messages.parse_positions(good[1][1], 2)
    table = messages.parse_table(good[3][1], 1)
    progress = messages.parse_progress(good[5][1], 4)
    every = messages.parse_positions(good[2][1], ALL_MOTORS)
    assert told[: len(good)] == [
        {"version": version.number, "date": version.date.isoformat()},
        {"2": lone},
        {str(motor): position for motor, position in zip(MOTORS, every, strict=True)},
        [[point.step, point.speed] for point in table],
        [],
        {"steps": progress.steps, "command": progress.command},
    ]
    assert [one["refused"] for one in told[len(good) :]] == ["WrongAnswer"] * len(bad)
