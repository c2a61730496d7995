"""`board pins`: which signal is on which pin of a board, and what the hardware makes of it."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import asdict, dataclass

from rkm04_tools import board
from rkm04_tools.board_header import Board, Pin, inputs_without_edges
from rkm04_tools.failure import DONE
from rkm04_tools.table import table

HEAD = ("signal", "pin", "1 is", "what")
STEP_CLASSES = {
    "1": "class 1, each edge on its tick",
    "2": "class 2, each edge less than 4 us late, mostly less than 1 us, or counted",
}
AT_ONCE = "an edge acts at once"
EVERY_MS = "looked at every millisecond, as {} has its line for edges"
MORE = {"PWM", *(f"LED_{number}" for number in range(5, 9))}
"""What units on RS-485 do not have, and what they have that those of full duplex do not."""
FEWER = {"CAPTURE", *(f"S1_{number}" for number in range(1, 5))}
LEVELS = {"EN": "ENABLE", "LINE": ""}
"""As a header names the level of a kind, where not as the kind; empty: it has none."""


@dataclass(frozen=True)
class Wire:
    """A signal of a board."""

    signal: str
    pin: str
    one: str  # the level that is 1, or empty
    what: str


def _input(pins: list[Pin], pin: Pin) -> str:
    if pin.signal not in inputs_without_edges(pins):
        return AT_ONCE
    inputs = (each for each in pins if each.signal.startswith("BI_"))
    return EVERY_MS.format(next(each.signal for each in inputs if each.pin[1:] == pin.pin[1:]))


def _enable(header: Board) -> str:
    idle = int(header.values["BOARD_ENABLE_IDLE_MS"].rstrip("U")) / 1000
    off = f"off {idle:g} s after the last motion" if idle else "never off after the first motion"
    which = header.values["BOARD_ENABLE_READY_US"].rstrip("U")
    return f"on {which} us before a motion's first pulse, {off}"


def _what(header: Board, pin: Pin) -> str:
    kind = pin.signal.partition("_")[0]
    steps = header.values.get("BOARD_STEP_CLASS", "1")
    if kind == "STEP":
        return f"{pin.use.replace('_CH', ' channel ')}, {STEP_CLASSES[steps]}"
    if kind == "BI":
        return _input(header.pins, pin)
    if kind == "EN":
        return _enable(header)
    if kind == "PWM":
        return f"{pin.use.replace('_CH', ' channel ')}, 1 kHz"
    if kind == "CAPTURE":
        return f"{pin.use.replace('_CH', ' channel ')}, for the bring-up image"
    return pin.use if pin.signal in ("LINE_TX", "LINE_RX") else ""


def wires(header: Board, unit: str = board.UNIT) -> Iterator[Wire]:
    """The signals of a unit, in the order of the header."""
    for pin in header.pins:
        kind = pin.signal.partition("_")[0]
        if pin.signal in (FEWER if board.is_full_duplex(unit) else MORE):
            continue
        level = header.values.get(f"BOARD_{LEVELS.get(kind, kind)}_LEVEL", "")
        one = {"1U": "high", "0U": "low"}.get(level, "")
        yield Wire(pin.signal, f"P{pin.pin}", one, _what(header, pin))


def run(options: Namespace) -> int:
    """`board pins`."""
    name = board.image_of(options.board, options.image).board
    shown = list(wires(board.header_of(name), options.image))
    if options.json:
        print(json.dumps({"board": name, "pins": [asdict(wire) for wire in shown]}))
    else:
        rows = [(wire.signal, wire.pin, wire.one, wire.what) for wire in shown]
        print(table([HEAD, *rows], "llll"))
    return DONE
