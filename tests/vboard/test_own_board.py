"""A board of one's own whose drivers are as slow as a header may say."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from own_board import built
from rkm04_tools import board, virtual_board
from rkm04_tools.board_header import read_board
from virtual_board import TICKS_PER_MS, Message, VirtualBoard, of_motor, script

MOTORS = range(1, 5)
TURNS = b"\\C100\nS2000 V2000 A60000\nW500\nL50\nF3 R D R\nE\n"
SECTIONS = b"\\C100\nS2000 V16000 A60000\nW500\nL20\nF30 Y V8000 F30 R B30 Y V16000 B30 R\nE\n"
EXACT_US = {"f405": 0.0, "skr-pro-1.2": 4.0}
"""How late an edge may be: of class 1, and of class 2."""

pytestmark = pytest.mark.skipif(
    not shutil.which(board.COMPILER), reason=f"{board.COMPILER} is not installed"
)


def with_times(like: str, hold_ns: int, setup_ns: int) -> str:
    """The header of a board, with what its drivers need of DIR."""
    text = (board.BOARDS / like / "board.h").read_text()
    for name, value in (("HOLD", hold_ns), ("SETUP", setup_ns)):
        text = re.sub(rf"(BOARD_DIR_{name}_NS) .*", rf"\1 {value}U", text)
    return text


@pytest.mark.parametrize("like", EXACT_US)
@pytest.mark.parametrize(("hold_ns", "setup_ns"), [(1, 29_999), (24_000, 24_000), (120_000, 0)])
def test_four_motors_that_turn_together_keep_their_ticks_with_the_slowest_drivers(
    program: Path, tmp_path: Path, like: str, hold_ns: int, setup_ns: int
) -> None:
    header = with_times(like, hold_ns, setup_ns)
    wires = virtual_board.pins(read_board(header))
    unit = VirtualBoard(program, built(tmp_path, header), tmp_path, wires)

    for text in (TURNS, SECTIONS):
        sent = script([Message(0, text)])
        simulated = unit.simulate(dict.fromkeys(MOTORS, text), 10)
        end = sent.come_ms[-1] / 1000 + simulated.summary["seconds"] + 0.1
        modelled = unit.run(sent.lines, end)

        assert modelled.late_steps == 0
        for motor in MOTORS:
            wanted, made = (of_motor(run.steps, motor)[0] for run in (simulated, modelled))
            late_us = (made - wanted) / TICKS_PER_MS * 1000
            assert np.all(abs(late_us) <= EXACT_US[like])
