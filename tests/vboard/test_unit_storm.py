"""Four motors at full speed while inputs and the line are as busy as they can be."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle

import numpy as np
import pytest
from board_talk import ask, heard
from frames import frame
from rkm04_tools import board
from stored import area, flash, record
from virtual_board import BYTE_MS, TICKS_PER_MS, Modelled, VirtualBoard, first_tick, of_motor

VERSION = b"\x01"
TOLD_VERSION = b"\x01\x10" + board.version().encode()
PROGRAM = b"S500V16000A60000M08F3000RB3000R"
"""Input 8 would stop it; it stays quiet."""
MOTORS = range(1, 5)
FLOOD_MS, FLOOD_END_MS, END_MS = 30.0, 1100.0, 1200.0
STORM_KHZ = 100
CHARACTER_US = 1000 * BYTE_MS
"""Until then the unit lets the line go, firmware/rkm04/docs/line.md."""
REQUESTS = [b"\x040", b"\x051", b"\x062", b"\x073", b"\x040"]


def run(
    unit: VirtualBoard, storm: str = "", flood: str = "", options: Sequence[str] = ()
) -> Modelled:
    path = unit.folder / "flash"
    path.write_bytes(flash(area(1, [record(m, 1 + m, PROGRAM) for m in MOTORS])))
    script = flood + ask(FLOOD_END_MS + 60, VERSION)
    return unit.run(script, END_MS / 1000, storm, "--flash", str(path), *options)


def storm() -> str:
    """Inputs 1 to 7 taking turns, so that all of them together change 100 000 times a second."""
    count = int((FLOOD_END_MS - FLOOD_MS) * STORM_KHZ)
    level = [0] * 8
    lines = []
    for i, number in zip(range(count), cycle(range(1, 8)), strict=False):
        level[number] ^= 1
        lines.append(f"{FLOOD_MS + i / STORM_KHZ:.6f},{number},{level[number]}\n")
    return "".join(lines)


def flood() -> str:
    """Requests to this unit with nothing between them."""
    data = bytearray()
    for request in cycle(REQUESTS):
        if len(data) * BYTE_MS > FLOOD_END_MS - FLOOD_MS:
            break
        data += frame(1, 0, request)
    return f"{FLOOD_MS} {data.hex()}\n"


@pytest.mark.parametrize(
    ("inputs", "line"),
    [(storm(), ""), ("", flood()), (storm(), flood())],
    ids=["inputs", "line", "both"],
)
def test_a_storm_on_inputs_and_line_moves_no_pulse_and_the_unit_answers(unit, inputs, line):
    quiet = run(unit)

    busy = run(unit, inputs, line)

    for motor in MOTORS:
        ticks, positions = of_motor(quiet.steps, motor)
        stormy, places = of_motor(busy.steps, motor)
        assert len(ticks) == 6000
        assert np.array_equal(ticks[:3000], stormy[:3000])
        assert np.array_equal(positions, places)
        # The second move begins when main gets to it.
        second, again = ticks[3000:] - ticks[3000], stormy[3000:] - stormy[3000]
        assert np.array_equal(second, again)
    assert quiet.late_steps == busy.late_steps == 0
    assert (first_tick(quiet.steps) - first_tick(busy.steps)) / TICKS_PER_MS == pytest.approx(0)
    assert heard(unit.folder)[-1].message == TOLD_VERSION
    assert 0 < busy.summary["line"]["release_max"] < CHARACTER_US
    assert busy.summary["warnings"] == 0  # no handler returns while its last write is on its way
    assert busy.summary["resets"] == {"power": 1, "software": 0, "watchdog": 0}
    print(f"load {quiet.summary['load']} quiet, {busy.summary['load']} busy")


@pytest.mark.parametrize(
    "options",
    [
        ["--match-equal"],
        ["--pwm-at-once"],
        ["--exti-mask-first"],
        ["--shared-bus"],
        ["--match-equal", "--pwm-at-once"],
        ["--timer-start", str(2**32 - 30 * TICKS_PER_MS)],
        ["--timer-start", str(2**32 - 200 * TICKS_PER_MS), "--match-equal", "--pwm-at-once"],
        ["--timer-start", str(2**31 - 100 * TICKS_PER_MS)],
    ],
    ids=["equal", "pwm", "edges", "bus", "both", "turns before", "turns in a move", "half-way"],
)
def test_what_the_manual_leaves_open_and_the_count_of_the_timer_change_no_pulse(unit, options):
    plain = run(unit)

    other = run(unit, options=options)

    assert len(plain.steps.tick) == 4 * 6000
    for motor in MOTORS:
        assert np.array_equal(of_motor(plain.steps, motor), of_motor(other.steps, motor))
    assert other.late_steps == 0


def test_the_image_of_the_second_board_runs_a_program(program, tmp_path, monkeypatch, unit):
    second = VirtualBoard(program, board.build("f407-discovery"), tmp_path)
    script = ask(60, VERSION) + ask(100, b"\x021\\T01S2000V2000F7R")

    modelled = second.run(script, 0.2)

    answers = [answer.message for answer in heard(tmp_path)]
    assert answers == [TOLD_VERSION, b"\x021\0\0"]
    assert modelled.summary["motors"][0]["position"] == 7
    assert modelled.summary["outputs"] == 1
    assert modelled.late_steps == 0
