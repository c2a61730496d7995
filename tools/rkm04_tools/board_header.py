"""What a board header says (hal/stm32/boards/NAME/board.h): its pins and its values.

They are read as the compiler reads them as long as the header has the form that `board_form` wants.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

COMMENT = re.compile(r'("(?:\\.|[^"\\\n])*")|/\*.*?\*/|//(?:\\\n|[^\n])*', re.DOTALL)
PIN = re.compile(r"\bX\(\s*(\w+)\s*,\s*(\w+)\s*,\s*(\w+)\s*,\s*(\w+)\s*\)")
TAKEN = re.compile(r'\bX\(\s*(\w+)\s*,\s*(\w+)\s*,\s*"([^"]+)"\s*\)')
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


def without_comments(text: str) -> str:
    """A header with a space for each comment, as the compiler sees it; strings stay."""
    return COMMENT.sub(lambda found: found[1] or " ", text)


def read_board(text: str) -> Board:
    code = without_comments(text)
    pins = [Pin(m[1], m[2] + m[3], m[4]) for m in PIN.finditer(code)]
    taken = {m[1] + m[2]: m[3] for m in TAKEN.finditer(code)}
    return Board(pins, taken, dict(DEFINE.findall(code)))
