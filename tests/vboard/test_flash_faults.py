"""What the image of the board does when its flash fails, or does not hold any more what it was."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest
from board_talk import Answer, ask, heard
from stored import AREA_FIRST, area, flash, record
from virtual_board import Modelled, VirtualBoard

OLD, NEW, OTHER = b"S2000V2000F5R", b"S2000V2000B7R", b"S2000V2000B2R"
OLD_STEPS, OTHER_STEPS = 5, -2
HEAD_BYTES = 20
RECORDS = [record(2, 2, OTHER), record(1, 3, OLD)]
STORED = flash(area(1, RECORDS))
MINE = AREA_FIRST + len(record(1, 0, b"")) + len(RECORDS[0])
"""Where the record of motor 1 is."""
OPERATIONS = 15
"""Words of a store: two heads of 5, a text of 4, the whole-mark."""
FAILURES = ["wrp", "pga", "pgp", "pgs", "op", "silent", "bit"]
FAILED = b"\x031\x01"
SEED = 20261121
FLIPS = 24


def message(unit: VirtualBoard, number: int) -> list[Answer]:
    return [answer for answer in heard(unit.folder) if answer.message[0] == number]


def store_twice(unit: VirtualBoard, content: bytes, failure: str) -> Modelled:
    """Set and store a program, ask what is stored after a power cut; and all of it again."""
    path = unit.folder / "flash"
    path.write_bytes(content)
    script = ask(30, b"\x021\\" + NEW) + ask(60, b"\x031") + ask(110, b"\x051")
    script += ask(145, b"\x021\\" + NEW) + ask(175, b"\x031") + ask(225, b"\x051")
    options = ["--flash", str(path), "--flash-erase", "0.5", "--flash-fail", failure]
    options += ["--fault", "80:power", "--fault", "195:power"]
    return unit.run(script, 0.255, "", *options)


@pytest.mark.parametrize("operation", [1, 8, 13, OPERATIONS])
@pytest.mark.parametrize("failure", FAILURES)
def test_a_word_that_fails_is_told_and_the_old_program_stays(unit, failure, operation):
    store_twice(unit, STORED, f"{operation}:{failure}")

    assert [answer.message for answer in message(unit, 3)] == [FAILED, b"\x031\0"]
    assert [answer.message for answer in message(unit, 5)] == [b"\x051" + OLD, b"\x051" + NEW]


@pytest.mark.parametrize("failure", ["wrp", "op", "silent"])
def test_an_erase_that_fails_is_told_and_the_old_program_stays(unit, failure):
    content = flash(
        b"\0" * 4096, area(1, RECORDS)[:-4] + b"\0\0\0\0"
    )  # full: the other area is next

    store_twice(unit, content, f"1:{failure}")

    assert [answer.message for answer in message(unit, 3)] == [FAILED, b"\x031\0"]
    assert [answer.message for answer in message(unit, 5)] == [b"\x051" + OLD, b"\x051" + NEW]


def start_with(unit: VirtualBoard, flipped: int, seconds: float = 0.08) -> Modelled:
    """Start with one bit of the record of motor 1 changed."""
    content = bytearray(STORED)
    content[MINE + flipped // 8] ^= 1 << flipped % 8
    path = unit.folder / "flash"
    path.write_bytes(content)
    return unit.run(ask(50, b"\x051"), seconds, "", "--flash", str(path))


@pytest.mark.parametrize("part", ["first head", "second head", "text", "whole-mark"])
def test_a_bit_that_has_changed_never_starts_another_program(unit, part):
    begin, count = {
        "first head": (0, HEAD_BYTES),
        "second head": (HEAD_BYTES, HEAD_BYTES),
        "text": (2 * HEAD_BYTES, len(OLD)),
        "whole-mark": (2 * HEAD_BYTES + 16, 4),
    }[part]
    rng = random.Random(SEED)

    for bit in rng.sample(range(8 * begin, 8 * (begin + count)), FLIPS // 4):
        modelled = start_with(unit, bit)
        motors = modelled.summary["motors"]
        (answer,) = message(unit, 5)
        damaged = motors[0]["led"] == 1
        assert damaged == (part == "text"), f"bit {bit}"
        assert motors[0]["position"] == (0 if damaged else OLD_STEPS)
        assert answer.message == b"\x051" + (b"" if damaged else OLD)
        assert motors[1]["position"] == OTHER_STEPS


def test_a_damaged_program_blinks_until_it_is_replaced(unit):
    content = bytearray(STORED)
    content[MINE + 2 * HEAD_BYTES] ^= 1
    path = unit.folder / "flash"
    path.write_bytes(content)
    script = ask(1300, b"\x021\\" + NEW) + ask(1340, b"\x031") + ask(1380, b"\x051")

    modelled = unit.run(script, 1.45, "", "--flash", str(path), "--flash-erase", "0.5")

    blinks = [ms for ms, level in modelled.edges("m1_led") if ms < 1300]
    assert [round(b - a) for a, b in pairwise(blinks)] == [500, 500]
    assert modelled.summary["motors"][0]["led"] == 0
    assert message(unit, 3)[0].message == b"\x031\0"
    assert modelled.summary["motors"][0]["position"] == -7
