"""Turns G-code in tests, and reads the vector file that comes of it as the contract has it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rkm04_tools.gve134.gcode.axes import Mill, mill_of
from rkm04_tools.gve134.gcode.turning import TOLERANCE_MM, Start, Turned, turn_file
from rkm04_tools.machine.machine import Machine

MACHINE = Path(__file__).resolve().parents[2] / "tools" / "examples" / "gve" / "mill.rkm"

Vector = tuple[int, int, int, int]


@dataclass(frozen=True)
class Entered:
    """A vector with what held when it was entered."""

    steps: Vector
    line: int
    """Of the program."""
    speed: int
    accel: int
    corrected: bool
    joins: bool

    @property
    def seconds(self) -> float:
        """How long it takes at the speed that was ordered, without limits."""
        length = max(map(abs, self.steps))
        way = math.sqrt(sum(each * each for each in self.steps[:3]))
        return (way if self.corrected and way else length) / self.speed


@dataclass
class Played:
    """The lines of a vector file, and what a unit would make of them."""

    turned: Turned
    lines: list[str] = field(default_factory=list)
    vectors: list[Entered] = field(default_factory=list)
    steps: list[int] = field(default_factory=lambda: [0, 0, 0, 0])

    @property
    def errors(self) -> list[tuple[int, int, str]]:
        """Line, column and message."""
        return [(each.line, each.column, each.message) for each in self.turned.problems]

    @property
    def warnings(self) -> list[tuple[int, str]]:
        """Line and message."""
        return [(each.line, each.message) for each in self.turned.warnings]

    def ends(self) -> dict[int, Vector]:
        """Where the axes are after each line of the program that has a vector, in pulses."""
        at = [0, 0, 0, 0]
        found: dict[int, Vector] = {}
        for vector in self.vectors:
            at = [a + b for a, b in zip(at, vector.steps, strict=True)]
            found[vector.line] = (at[0], at[1], at[2], at[3])
        return found

    def play(self) -> None:
        """Follow the modal commands and the vectors."""
        speed, accel, corrected, line = 1000, 20, False, 0
        for text in self.lines:
            command, _, comment = text.partition(" ; line ")
            line = int(comment) if comment else line
            if command.startswith(("C", "L")) and command != "L0,0,0,0":
                x, y, z, a = map(int, command[1:].split(","))
                entered = Entered((x, y, z, a), line, speed, accel, corrected, command[0] == "C")
                self.vectors.append(entered)
            elif command in ("VK", "VN"):
                corrected = command == "VK"
            elif command[0] == "V" and command[1].isdigit():
                speed = int(command[1:])
            elif command[0] == "A":
                accel = int(command[1:])


def content() -> dict[str, Any]:
    """The machine file of the examples."""
    told: dict[str, Any] = json.loads(MACHINE.read_text(encoding="utf-8"))
    return told


def mill(told: dict[str, Any] | None = None) -> Mill:
    """A machine; that of the examples if none is told."""
    return mill_of(Machine("mill.rkm", content() if told is None else told))


def play(
    program: str | Iterable[str], machine: Mill | None = None, tolerance: float = TOLERANCE_MM,
    start: Start = (0.0, 0.0, 0.0, 0.0),
) -> Played:  # fmt: skip
    """Turn a program, and read what comes of it."""
    lines = program.split("\n") if isinstance(program, str) else program
    pieces: list[str] = []
    source = (line.encode() for line in lines)
    turned = turn_file(source, "a.nc", machine or mill(), pieces.append, tolerance, start)
    played = Played(turned, "".join(pieces).splitlines())
    played.play()
    return played


def good(program: str | Iterable[str], machine: Mill | None = None, **more: Any) -> Played:
    """The same of a program in which nothing is wrong."""
    played = play(program, machine, **more)
    assert played.errors == []
    return played


def body(program: str, machine: Mill | None = None) -> list[str]:
    """The lines after those that hold for the whole file, without blanks at their ends."""
    lines = good(program, machine).lines
    begin = next(index for index, line in enumerate(lines) if line.startswith("VJ"))
    return lines[begin + 1 :]
