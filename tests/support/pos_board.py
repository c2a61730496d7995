"""The positioning unit's image on the virtual board: frames to it, and what a run has made."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from judge import Steps, read_steps
from rkm04_tools import board, virtual_board

UNIT = "positioning"


def sealed(text: bytes) -> bytes:
    """A frame with its CRC, bit by bit."""
    rest = 0xFFFF
    for byte in text:
        rest ^= byte
        for _ in range(8):
            rest = (rest >> 1) ^ 0xA001 if rest & 1 else rest >> 1
    return text + struct.pack("<H", rest)


def write(first: int, words: list[int]) -> bytes:
    head = struct.pack(">BBHHB", 1, 16, first, len(words), 2 * len(words))
    return sealed(head + struct.pack(f">{len(words)}H", *words))


def read(first: int, count: int) -> bytes:
    return sealed(struct.pack(">BBHH", 1, 3, first, count))


@dataclass(frozen=True)
class Made:
    """What a run on the board has made."""

    summary: dict[str, Any]
    steps: Steps
    said: bytes


def run_image(
    program: Path, folder: Path, line: str, for_ms: float, *more: str, line_format: str = "8E1"
) -> Made:
    """Run the image with what comes on the line, a line of text for each frame: ms, bytes."""
    image = board.build(board.DEFAULT_BOARD, what=UNIT)
    for name, text in (("line", line), ("pins", virtual_board.board_pins(image.board, UNIT))):
        (folder / name).write_text(text)
    options = ["--elf", str(image.file("elf")), "--pins", str(folder / "pins")]
    options += ["--line-script", str(folder / "line"), "--format", line_format]
    options += ["--line-log", str(folder / "log.txt"), "--steps", str(folder / "steps")]
    options += ["--watch", "stm32_late_steps", "--stack-limit", "stm32_stack_bottom"]
    options += ["--step-timer", "TIM5", "--for", f"{for_ms / 1000:.6f}", *more]
    summary = virtual_board.run(program, options)
    rows = (folder / "log.txt").read_text().split()[1::2]
    said = bytes(int(byte, 16) for byte in rows if not byte.endswith("*"))
    return Made(summary, read_steps(folder / "steps"), said)
