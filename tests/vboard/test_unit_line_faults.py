"""Bytes that come damaged or are overrun: they never become a command, and are counted."""

from __future__ import annotations

import random

from board_talk import ask, heard
from debug_info import offset
from frames import frame
from rkm04_tools import board
from virtual_board import BYTE_MS, Modelled, VirtualBoard

VERSION = b"\x01"
TOLD_VERSION = b"\x01\x10" + board.version().encode()
MOVE = frame(1, 0, b"\x021\\S2000V2000F7R")
FRAMING, NOISE = "*", "~"
COUNTS = ("FRAMES", "FOREIGN", "STRAY", "BROKEN", "FCS", "ABORT", "ESCAPE", "SHORT", "LONG", "GAP")
"""Of the receiver, in the order in which it keeps them."""
READY_MS = 30.0
BETWEEN_MS = 2.0
USART1 = 53
SEED = 20261121


def run(unit: VirtualBoard, script: str, end_ms: float, *options: str) -> Modelled:
    """Run, and ask for the version at the end."""
    script += ask(end_ms, VERSION)
    return unit.run(script, (end_ms + 40) / 1000, "", "--watch", "unit.0", *options)


def counts(unit: VirtualBoard, modelled: Modelled) -> dict[str, int]:
    at = offset(unit.image.file("elf"), "rkm04", ("line", "link", "receiver", "counts"))
    words = modelled.summary["watch"]["unit.0"][at // 4 :]
    return dict(zip(COUNTS, words[: len(COUNTS)], strict=True))


def damaged(at: int, damage: str) -> str:
    """The frame of a move with one byte damaged on its way."""
    return "".join(f"{byte:02x}{damage if i == at else ''}" for i, byte in enumerate(MOVE))


def test_a_frame_with_any_one_byte_damaged_is_never_executed_and_counted(unit):
    script = ""
    ms = READY_MS
    for damage in (FRAMING, NOISE, FRAMING + NOISE):
        for at in range(len(MOVE)):
            script += f"{ms:.3f} {damaged(at, damage)}\n"
            ms += len(MOVE) * BYTE_MS + BETWEEN_MS

    modelled = run(unit, script, ms)

    assert modelled.summary["motors"][0]["pulses"] == 0
    assert [answer.message for answer in heard(unit.folder)] == [TOLD_VERSION]
    assert counts(unit, modelled)["BROKEN"] == 3 * len(MOVE)
    assert counts(unit, modelled)["FRAMES"] == 1


def test_the_frame_without_damage_is_executed(unit):
    modelled = run(unit, f"{READY_MS} {MOVE.hex()}\n", READY_MS + 60)

    assert modelled.summary["motors"][0]["pulses"] == 7
    assert counts(unit, modelled) == dict.fromkeys(COUNTS, 0) | {"FRAMES": 2}


def test_a_frame_in_which_bytes_were_overrun_is_never_executed_and_counted(unit):
    script = ""
    options = []
    ms = READY_MS
    for at in range(0, len(MOVE) - 3, 2):
        script += f"{ms:.3f} {MOVE.hex()}\n"
        options += ["--fault", f"{ms + (at + 1) * BYTE_MS:.3f}:lose={USART1},1.6"]
        ms += len(MOVE) * BYTE_MS + 60

    modelled = run(unit, script, ms, *options)

    frames = len(options) // 2
    assert modelled.summary["line"]["overruns"] >= 2 * frames
    assert modelled.summary["motors"][0]["pulses"] == 0
    assert [answer.message for answer in heard(unit.folder)] == [TOLD_VERSION]
    assert counts(unit, modelled)["BROKEN"] >= frames
    assert counts(unit, modelled)["FRAMES"] == 1


def test_random_bytes_on_the_line_are_never_executed(unit):
    rng = random.Random(SEED)
    print(f"seed {SEED}")
    noise = " ".join(
        f"{rng.randrange(256):02x}{rng.choice(['', '', FRAMING, NOISE])}" for _ in range(600)
    )

    modelled = run(unit, f"{READY_MS} {noise}\n", READY_MS + 600 * BYTE_MS + 60)

    assert modelled.summary["motors"][0]["pulses"] == 0
    assert [answer.message for answer in heard(unit.folder)] == [TOLD_VERSION]
    assert counts(unit, modelled)["FRAMES"] == 1
    assert counts(unit, modelled)["BROKEN"] > 100


def test_an_answer_that_nobody_continues_lets_the_line_go(unit):
    request = frame(1, 0, VERSION)
    stuck_ms = READY_MS + len(request) * BYTE_MS + 4  # in the middle of the answer
    faults = [f"{stuck_ms:.3f}:lose={USART1}", f"{stuck_ms:.3f}:hold=rkm04_poll"]
    options = [word for fault in faults for word in ("--fault", fault)]

    modelled = unit.run(f"{READY_MS} {request.hex()}\n", 0.1, "", *options)

    ms, level = modelled.edges("de")[-1]
    assert level == 0
    assert stuck_ms + 9 <= ms <= stuck_ms + 12
