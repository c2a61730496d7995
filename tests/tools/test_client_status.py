"""Get Status: the shared answers become types, and the commands print what they say."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import pytest
import statuses
from fake_unit import FakeLine, FakeUnit
from rkm04_tools.line import open_line
from rkm04_tools.line_errors import UnitRefused, UnknownMessage, WrongAnswer
from rkm04_tools.status import CAUSES, ERRORS, LAYOUT, LINE_COUNTS, WAITS, parse_status

ROOT = Path(__file__).resolve().parents[2]
ANSWERS = json.loads(statuses.JSON_FILE.read_text())["answers"]
AT_WORK = next(each for each in statuses.VECTORS if each.name == "at work")
NODE = 3

TEXT = """\
motor            position  state
    1               5 000  moving
    2                  -5  waiting for input 5 to become 1, simulated
    3          16 000 000  stopped by K, moving, simulated
    4  -1 099 511 627 776  ended by X, simulated

inputs at 1:  1 3 6 8
outputs at 1: 3 4 5 6, simulated (T41)
started by:   power-on
late steps:   7
line:         100 good frames for this unit
              101 good frames for others, and answers
              102 bytes outside of frames
              103 bytes with a framing, noise or overrun error
              104 frames with a wrong FCS
              105 frames that were aborted
              106 frames with a byte escaped that must not be
              107 frames without a message
              108 frames that were too long
              109 frames with a gap
              110 requests that were not executed again
              111 answers not begun, as the line was not silent
memory:       refuses commands when full (T40)
"""
TROUBLED = """\
motor  position  state
    1         0  at rest
    2         0  failed: no motion without the crystal
    3         0  at rest
    4         0  at rest

inputs at 1:  none
outputs at 1: none
started by:   reset
late steps:   0
line:         nothing yet
crystal:      missing: no motion
stored:       no programs, the part is too small
"""


@pytest.fixture
def unit(monkeypatch):
    unit = FakeUnit(NODE, status=AT_WORK.whole, positions=[5000, -5, 0, 0])
    line = FakeLine(unit)
    monkeypatch.setenv("RKM04_PORT", line.port)
    monkeypatch.setenv("RKM04_NODE", str(NODE))
    yield unit
    line.close()


def header_texts(path: str, macro: str) -> list[tuple[str, str]]:
    """Names and texts of a list in the firmware."""
    text = (ROOT / "firmware" / path).read_text(encoding="utf-8")
    part = text[text.index(f"#define {macro}(X)") :].split("\n\n")[0]
    return re.findall(r'X\((\w+), "(.*?)"\)', part)


def levels(byte: int) -> list[int]:
    return [byte >> place & 1 for place in range(8)]


def motor_bits(motor: dict[str, Any]) -> int:
    names = ("moving", "running", "waiting", "stopped", "failed", "ended", "simulated")
    return sum(motor[name] << place for place, name in enumerate(names))


@pytest.mark.parametrize("vector", ANSWERS, ids=lambda vector: vector["name"])
def test_every_shared_answer_is_read_as_what_it_says(vector):
    status = parse_status(bytes.fromhex(vector["answer"])).as_json()

    switches = ("no_crystal", "not_started", "memory_locked", "simulating", "no_store", "untimed")
    assert status["inputs"] == levels(vector["inputs"])
    assert status["outputs"] == levels(vector["outputs"])
    assert CAUSES.index(status["cause"]) == vector["cause"]
    assert sum(status[name] << bit for bit, name in enumerate(switches)) == vector["switches"]
    assert [motor_bits(each) for each in status["motors"]] == vector["motors"]
    assert [ERRORS.index(each["error"]) for each in status["motors"]] == [
        error if state & 16 else 0
        for error, state in zip(vector["errors"], vector["motors"], strict=True)
    ]
    assert [each["position"] for each in status["motors"]] == vector["positions_steps"]
    assert status["late_steps"] == vector["late_steps"]
    assert list(status["line"].values()) == vector["line_counts"]


def test_errors_and_counters_are_those_of_the_firmware():
    errors = header_texts("rkm04/interpreter/interpreter.h", "INTERPRETER_ERRORS")
    counts = header_texts("rkm04/link/link_receiver.h", "LINK_COUNTS")

    assert tuple(text for _, text in errors) == ERRORS
    assert [(name.lower(), text) for name, text in counts] == list(LINE_COUNTS.items())


def test_a_later_layout_is_read_as_far_as_it_is_known():
    later = bytearray(AT_WORK.whole + b"more")
    later[1] = 3
    later[4], later[6], later[10] = 77, 0xF0, 200

    status = parse_status(bytes(later))

    assert (status.layout, status.cause) == (3, "cause 77")
    assert status.motors[0].error == "error 200"
    assert status.late_steps == AT_WORK.late_steps


@pytest.mark.parametrize(
    "answer",
    [
        b"\xc8",
        AT_WORK.oldest[:-1],
        AT_WORK.whole[:-1],
        b"\xc8\0" + AT_WORK.whole[2:],
        b"\x04" + AT_WORK.whole[1:],
    ],
)
def test_an_answer_of_other_bytes_is_a_typed_error(answer):
    with pytest.raises(WrongAnswer, match="Get Status"):
        parse_status(answer)


def test_what_motors_wait_for_is_told_in_words():
    vector = next(each for each in statuses.VECTORS if each.name == "every kind of wait")

    texts = [motor.text for motor in parse_status(vector.whole).motors]

    assert texts == [
        "waiting for input 8 to become 0",
        "waiting for variable 80 to become 1",
        "waiting for a time",
        "waiting for ]",
    ]


@pytest.mark.parametrize("code", [0, 9, 79, 98, 127, 128, 128 + 96])
def test_what_is_awaited_and_not_known_is_not_made_up(code):
    answer = statuses.Vector("", motors=[6, 6, 6, 6], waits=[code] * 4).whole

    assert {motor.text for motor in parse_status(answer).motors} == {"waiting"}


def test_a_unit_of_the_oldest_layout_does_not_tell_what_is_awaited():
    status = parse_status(AT_WORK.oldest)

    assert (status.layout, status.motors[1].text) == (1, "waiting, simulated")
    assert status.line["unsent"] == 111


def test_an_original_unit_refuses_it_in_its_own_way():
    with pytest.raises(UnknownMessage, match="does not know Get Status") as caught:
        parse_status(b"\xff\xc8\0\0")
    assert isinstance(caught.value, UnitRefused)


def test_the_answer_has_the_length_of_the_documents():
    assert (
        {len(bytes.fromhex(each["answer"])) for each in ANSWERS}
        == {LAYOUT.size + WAITS.size}
        == {102}
    )


def test_status_says_how_exact_steps_are_that_an_interrupt_makes(tool, unit):
    timed = tool("status").out
    unit.status = bytes([*AT_WORK.whole[:5], AT_WORK.whole[5] | 1 << 5, *AT_WORK.whole[6:]])

    assert "class 2" not in timed
    assert tool("status").out.splitlines()[-1] == (
        "steps:        by an interrupt (class 2): less than 4 us late, or counted as late"
    )


def test_a_script_gets_the_status(unit):
    with open_line(os.environ["RKM04_PORT"]) as line:
        status = line.unit(NODE).status()

    assert status.inputs == (True, False, True, False, False, True, False, True)
    assert status.motors[0].moving
    assert status.line["fcs"] == 104


def test_status_prints_what_the_unit_is_like(tool, unit):
    assert tool("status").out == TEXT


def test_status_names_what_is_wrong(tool, unit):
    unit.status = statuses.VECTORS[3].whole

    assert tool("status").out == TROUBLED


def test_status_as_json(tool, unit):
    answer = tool("status", "--json").json

    assert answer["node"] == NODE
    assert answer["inputs"] == [1, 0, 1, 0, 0, 1, 0, 1]
    assert answer["motors"][0] == {
        "motor": 1, "position": 5000, "moving": True, "running": True, "waiting": False,
        "stopped": False, "failed": False, "ended": False, "error": "", "awaited": None,
        "simulated": False,
    }  # fmt: skip
    assert answer["line"]["repeats"] == 110


def test_status_of_an_original_unit_says_why_there_is_none(tool, unit):
    unit.status = b""

    result = tool("status")

    assert result.status == 1
    assert "the unit does not know Get Status (message 200)" in result.complaint


def test_watch_shows_inputs_and_outputs(tool, unit):
    text = tool("watch", "--motor", "1", "--count", "1").out
    as_json = tool("watch", "--motor", "1", "--count", "1", "--json").json

    assert text == ("0.0 s  1: 5000 - steps/s, step 247 of -, command 3  BI 1 3 6 8  BO 3 4 5 6\n")
    assert (as_json["inputs"], as_json["outputs"]) == (levels(0xA5), levels(0x3C))


def test_watch_of_an_original_unit_shows_the_rest_and_says_so_once(tool, unit):
    unit.status = b""

    result = tool("watch", "--motor", "1", "--interval", "0.4", "--count", "3")

    assert result.status == 0
    assert result.err.count("\n") == 1
    assert "unit 3 does not know Get Status (message 200)" in result.err
    assert result.out.count("1: 5000 ") == 3
    assert "BI" not in result.out
    assert unit.done.count(b"\xc8") == 1
