"""What a board header says (hal/stm32/boards/NAME/board.h): its pins and its values."""

from __future__ import annotations

import re
from dataclasses import dataclass

PIN = re.compile(r"\bX\((\w+), ([A-K]), (\d+), (\w+)\)")
TAKEN = re.compile(r'\bX\(([A-K]), (\d+), "([^"]+)"\)')
DEFINE = re.compile(r'^#define (BOARD_\w+) "?([\w.]+)"?$', re.MULTILINE)


@dataclass(frozen=True)
class Pin:
    """A row of BOARD_PINS; `pin` is as in A15."""

    signal: str
    pin: str
    use: str


@dataclass(frozen=True)
class Board:
    """What a board header says."""

    pins: list[Pin]
    taken: dict[str, str]
    values: dict[str, str]


def inputs_without_edges(pins: list[Pin]) -> list[str]:
    """Inputs whose line for edges another one has: pins with the same number on different ports
    share one (RM0090 section 12.2.5), and the first has it."""
    owners: dict[str, str] = {}
    inputs = [pin for pin in pins if pin.signal.startswith("BI_")]
    return [
        pin.signal for pin in inputs if owners.setdefault(pin.pin[1:], pin.signal) != pin.signal
    ]


def read_board(text: str) -> Board:
    pins = [Pin(m[1], m[2] + m[3], m[4]) for m in PIN.finditer(text)]
    taken = {m[1] + m[2]: m[3] for m in TAKEN.finditer(text)}
    return Board(pins, taken, dict(DEFINE.findall(text)))
