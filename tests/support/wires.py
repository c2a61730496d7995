"""The wires of a board as the README beside its header tells them: what a machine is wired by.

Nothing here comes from board.h, so that a slip there, too, is seen at the pins.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass

from rkm04_tools import board, virtual_board
from rkm04_tools.board_header import Board, Pin

ROW = re.compile(r"^\| (\w+) \| P([A-K]\d+) \|(.*)\|$", re.MULTILINE)
LEVEL = re.compile(r"active (high|low)|(high|low) = ")
USART = re.compile(r"USART(\d)")
DRIVERS = re.compile(
    r"A pulse is at least ([\d.]+) µs high and ([\d.]+) µs low; "
    r"DIR stands ([\d.]+) µs before a rising edge and ([\d.]+) µs after it"
)
TIMES = ("width_min", "gap_min", "dir_setup_min", "dir_hold_min")
"""As the summary of the virtual board names what a motor has seen."""


@dataclass(frozen=True)
class Wire:
    """A row of the table."""

    signal: str
    pin: str
    note: str

    @property
    def kind(self) -> str:
        return self.signal.partition("_")[0]


def page(name: str) -> str:
    """The README of a board."""
    return (board.BOARDS / name / "README.md").read_text()


def wires(name: str) -> list[Wire]:
    """All rows of a board's table."""
    return [Wire(signal, pin, note.strip()) for signal, pin, note in ROW.findall(page(name))]


def times_us(name: str) -> dict[str, float]:
    """What the drivers of the motors can rely on."""
    (times,) = DRIVERS.findall(" ".join(page(name).split()))
    return dict(zip(TIMES, map(float, times), strict=True))


def levels(name: str) -> dict[str, str]:
    """The level that is 1, high or low, of each kind of wire, as its first row says it."""
    found: dict[str, str] = {}
    for wire in wires(name):
        if match := LEVEL.search(wire.note):
            found.setdefault(wire.kind, match[1] or match[2])
    return found


def pins_file(name: str, but: Collection[str] = (), unit: str = board.UNIT) -> str:
    """The wires for the virtual board with the image of a unit; kinds in `but` are left open."""
    level = {
        f"BOARD_{virtual_board.LEVELS.get(kind, kind)}_LEVEL": f"{one == 'high':d}U"
        for kind, one in levels(name).items()
    }
    (usart,) = {match[1] for wire in wires(name) if (match := USART.search(wire.note))}
    connected = [Pin(w.signal, w.pin, "") for w in wires(name) if w.kind not in but]
    return virtual_board.pins(Board(connected, {}, level | {"BOARD_USART": usart}), unit)
