"""A bring-up image on the virtual board, in virtual time, and somebody who stands before it."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest
from rkm04_tools import board, virtual_board
from rkm04_tools.board_header import read_board
from rkm04_tools.bringup import clock, command, talk, wires
from rkm04_tools.bringup.part import name_of_image
from rkm04_tools.bringup.plan import STEPS

INNER = {"address switch": 1, "outputs": 8, "LEDs": 4, "directions": 4}
"""Questions inside of a step; of those that depend on the board none."""
PRESSED_MS, APART_MS, ROUNDS = 60, 20, 90
SECONDS = 300
START_SECONDS = 0.2
"""Until the image has said that it is there."""

Typed = str | tuple[str, Callable[[], None]]
"""A line, and what the person does before typing it."""


def pressing() -> str:
    """Somebody who presses one input after the other, again and again."""
    lines = []
    for i in range(8 * ROUNDS):
        at = 100 + i * (PRESSED_MS + APART_MS)
        lines += [f"{at},{i % 8 + 1},1", f"{at + PRESSED_MS},{i % 8 + 1},0"]
    return "\n".join([*lines, ""])


class Hands:
    """Standard input: types the lines one after the other, and is gone then."""

    def __init__(self, lines: Sequence[Typed]) -> None:
        self._lines = list(lines)

    def readline(self) -> str:
        if not self._lines:
            return ""
        line = self._lines.pop(0)
        if not isinstance(line, str):
            line[1]()
            line = line[0]
        return f"{line}\n"


class FakeLine:
    """A line that answers each command with the next of some texts, in pieces."""

    name = "fake"

    def __init__(self, *texts: bytes) -> None:
        self.texts = list(texts)
        self.sent: list[bytes] = []
        self._there = b""

    def read(self, seconds: float) -> bytes:
        piece, self._there = self._there[:7], self._there[7:]
        return piece

    def write(self, data: bytes) -> None:
        self.sent.append(data)
        self._there += self.texts.pop(0) if self.texts else b""

    def close(self) -> None:
        pass


def whole(text: bytes, letter: bytes) -> bytes:
    return text + b"end %s %08x\n" % (letter, zlib.crc32(text))


NAME = whole(f"ready {name_of_image('f405')}\n".encode(), b"h")
"""What the image of that board says when it is asked who it is."""


class VirtualLine:
    """A transport whose reading lets virtual time go by."""

    name = "virtual"

    def __init__(self, unit: virtual_board.Talk) -> None:
        self._unit = unit
        self._kept = b""

    def read(self, seconds: float) -> bytes:
        kept, self._kept = self._kept, b""
        return kept or self._unit.until(self._unit.ms + 1000 * seconds)

    def sleep(self, seconds: float) -> None:
        """What comes meanwhile waits, as in a port."""
        end = self._unit.ms + 1000 * seconds
        while self._unit.ms < end:
            self._kept += self._unit.until(end)

    def write(self, data: bytes) -> None:
        self._unit.say(data)

    def close(self) -> None:
        pass


class VirtualTime:
    """What stands for the module `time`."""

    def __init__(self, unit: virtual_board.Talk, line: VirtualLine) -> None:
        self._unit = unit
        self.sleep = line.sleep

    def monotonic(self) -> float:
        return self._unit.ms / 1000


class Bench:
    """A board with power, and the pins of its header by name."""

    def __init__(self, unit: virtual_board.Talk, name: str) -> None:
        self._unit = unit
        header = read_board((board.BOARDS / name / "board.h").read_text())
        self.pins = {pin.signal: f"P{pin.pin}" for pin in header.pins}

    def wire(self, start: str, end: str = "CAPTURE", fault: str = "") -> Callable[[], None]:
        """Somebody who leads a wire from one signal to another, or takes it off."""
        text = f"{self.pins.get(start, start)}={self.pins[end]}{fault}"
        return lambda: self._unit.wire(text)

    def measured(self, fault: str = "") -> list[Typed]:
        """What is typed in the step of the pulses by somebody who leads the wire each time."""
        lines: list[Typed] = [""]
        for motor in range(1, 5):
            lines += [("", self.wire(f"STEP_{motor}", fault=fault)), ""]
        return [*lines, ""]

    def walked(self) -> list[Typed]:
        """All steps, each thing being so."""
        lines: list[Typed] = ["y"]
        inner = INNER | {"enables": sum(signal.startswith("EN_") for signal in self.pins)}
        for step in STEPS:
            if step.name == "pulses":
                lines += self.measured()
            else:
                lines += ["", *["y"] * inner.get(step.name, 0), ""]
        return lines

    def only(self, name: str, inner: Sequence[Typed]) -> list[Typed]:
        """One step, and all others left out."""
        lines: list[Typed] = ["y"]
        for step in STEPS:
            lines += inner if step.name == name else ["s"]
        return lines


@contextmanager
def powered(
    folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, *options: str, pressed: bool = False
) -> Iterator[Bench]:
    """A virtual board with its bring-up image; `bringup` talks to that."""
    elf = board.build(name, what=board.BRINGUP).file("elf")
    (folder / "pins").write_text(virtual_board.board_pins(name))
    (folder / "inputs").write_text(pressing() if pressed else "")
    arguments = ["--elf", str(elf), "--pins", str(folder / "pins"), "--lockstep"]
    arguments += ["--inputs", str(folder / "inputs"), "--for", str(SECONDS), *options]
    with virtual_board.Talk(virtual_board.program_path(), arguments) as unit:
        line = VirtualLine(unit)
        monkeypatch.setattr(command, "open_transport", lambda _: line)
        for module in (clock, talk, wires):
            monkeypatch.setattr(module, "time", VirtualTime(unit, line))
        line.sleep(START_SECONDS)
        yield Bench(unit, name)
