"""The image of the reference board tells its status as the simulated unit does."""

from __future__ import annotations

from pathlib import Path

import pytest
from frames import FLAG, frame, unescape
from rkm04_tools import board
from rkm04_tools.status import parse_status
from virtual_board import NODE, Message, VirtualBoard, script

ASKED_MS = 400.0
SECONDS = 0.6
GET_STATUS = b"\xc8"


def last_answer(folder: Path) -> bytes:
    """The message of the last frame that the board has sent."""
    lines = (folder / "log.txt").read_text().splitlines()
    sent = b"".join(bytes.fromhex(line.split()[1]) for line in lines)
    return unescape(sent.rstrip(bytes([FLAG])).rpartition(bytes([FLAG]))[2])[2:-2]


@pytest.fixture
def unit(program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> VirtualBoard:
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    return VirtualBoard(program, board.build(board.DEFAULT_BOARD), tmp_path)


def test_the_image_tells_inputs_outputs_states_and_counters(unit: VirtualBoard) -> None:
    damaged = bytearray(frame(NODE, 0, GET_STATUS))
    damaged[3] ^= 1
    sent = script([Message(1, b"T4T7 B5 R O1"), Message(2, b"J9")]).lines
    sent += f"{ASKED_MS - 20} {damaged.hex()}\n{ASKED_MS} {frame(NODE, 0, GET_STATUS).hex()}\n"

    unit.run(sent, SECONDS, "300,3,1\n")

    status = parse_status(last_answer(unit.folder))
    assert status.inputs == (False, False, True) + (False,) * 5
    assert status.outputs == (False, False, False, True, False, False, True, False)
    assert (status.cause, status.no_crystal, status.not_started) == ("power-on", False, False)
    assert [motor.text for motor in status.motors] == [
        "waiting for input 1 to become 1", "failed: label not found", "at rest", "at rest",
    ]  # fmt: skip
    assert [motor.position for motor in status.motors] == [-5, 0, 0, 0]
    assert status.late_steps == 0
    assert {name: count for name, count in status.line.items() if count} == {"frames": 3, "fcs": 1}
