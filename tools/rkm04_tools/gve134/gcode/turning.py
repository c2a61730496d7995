"""From a file of G-code to lines of a vector file: the door for other parts of the tools.

`turn_file` reads a program once, line by line, whatever its size, and holds no more of it than a
line. What it writes is of use only if `Turned.problems` is empty.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from rkm04_tools.gve134.gcode.axes import PARTS, Mill
from rkm04_tools.gve134.gcode.path import Path
from rkm04_tools.gve134.gcode.program import Program
from rkm04_tools.gve134.gcode.words import columns_of, read_line
from rkm04_tools.gve134.gcode.writer import Writer
from rkm04_tools.source import decode

TOLERANCE_MM = 0.01
PROBLEMS_MAX = 1000
"""So many are kept; the rest is counted."""


Start = tuple[float, float, float, float]
NO_START: Start = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Problem:
    """What is wrong in a line; line and column count from 1. `text` is the line."""

    line: int
    column: int
    message: str
    text: str


@dataclass(slots=True)
class Turned:
    """What has become of a program. A warning that comes again and again is told once."""

    lines: int = 0
    vectors: int = 0
    lengths: dict[str, float] = field(default_factory=dict)
    """mm by kind: rapid, feed, arc, probe."""
    degrees: float = 0.0
    """Of A, where it moves alone."""
    dwelt_s: float = 0.0
    problems: list[Problem] = field(default_factory=list)
    more_problems: int = 0
    warnings: list[Problem] = field(default_factory=list)

    @property
    def is_good(self) -> bool:
        """Whether the vectors may go to a unit."""
        return not self.problems


class Turning:
    """A program on its way."""

    def __init__(
        self, mill: Mill, put: Callable[[str], object], tolerance: float = TOLERANCE_MM,
        start: Start = NO_START,
    ) -> None:  # fmt: skip
        self.turned = Turned()
        self.writer = Writer(mill, put)
        begin = [round(each * PARTS) for each in start]
        self.path = Path(mill, self.writer, tolerance, begin)
        self.program = Program(self.path, self.writer, self._warn)
        self._text = ""
        self._slowed = self._slowed_arcs = 0
        self._first_slowed: Problem | None = None
        self._first_slowed_arc: Problem | None = None
        self._first_without_pulse: Problem | None = None

    def take(self, text: str) -> None:
        """Turn the next line."""
        turned = self.turned
        turned.lines += 1
        self._text = text
        if self.program.ended:
            self._mind_rest(text)
            return
        line = read_line(text)
        for trouble in line.troubles:
            self._refuse(trouble.column, trouble.message)
        if line.words:
            self.writer.line = turned.lines
            for index, message in self.program.take(line.words, line.comment):
                column = columns_of(text)[index] if index >= 0 else _first_column(text)
                self._refuse(column, message)
            self._mind_slow()

    def end(self) -> Turned:
        """There are no more lines."""
        self._text = ""
        if self.writer.line == 0 and self.turned.is_good:
            self.turned.warnings.append(Problem(1, 1, "there is no G-code in this file", ""))
        self.program.end()
        turned = self.turned
        turned.vectors = self.writer.vectors
        turned.lengths, turned.degrees = self.path.lengths, self.path.turned
        turned.dwelt_s = self.program.dwelt_s
        for first, count, words in (
            (self._first_slowed, self.writer.slowed, "go slower than F, at an axis' limit"),
            (self._first_slowed_arc, self.path.slowed_arcs,
             "of arcs go slower than F, so that the acceleration keeps them on their arc"),
        ):  # fmt: skip
            if first is not None:
                message = f"vectors {words}; there are {count}, the first one here"
                turned.warnings.append(Problem(first.line, first.column, message, first.text))
        if self._first_without_pulse and not turned.vectors:
            turned.warnings.append(self._first_without_pulse)
        turned.warnings.sort(key=lambda each: each.line)
        return turned

    def _refuse(self, column: int, message: str) -> None:
        if len(self.turned.problems) == PROBLEMS_MAX:
            self.turned.more_problems += 1
        else:
            self.turned.problems.append(self._problem(column, message))

    def _warn(self, message: str) -> None:
        if len(self.turned.warnings) < PROBLEMS_MAX:
            self.turned.warnings.append(self._problem(_first_column(self._text), message))

    def _problem(self, column: int, message: str) -> Problem:
        return Problem(self.turned.lines, column, message, self._text)

    def _mind_rest(self, text: str) -> None:
        """What follows the end is told once, if it is anything."""
        if text.strip(" \t%") and not any(
            "end of the program" in w.message for w in self.turned.warnings
        ):
            self._warn("what follows the end of the program is left out")

    def _mind_slow(self) -> None:
        if self.path.without_pulse and self._first_without_pulse is None:
            self._first_without_pulse = self._problem(
                _first_column(self._text),
                "all moves of this program are shorter than a pulse, so nothing moves; look at "
                "steps_per_mm and steps_per_degree of the machine file",
            )
        if self.writer.slowed and self._first_slowed is None:
            self._first_slowed = self._problem(_first_column(self._text), "")
        if self.path.slowed_arcs and self._first_slowed_arc is None:
            self._first_slowed_arc = self._problem(_first_column(self._text), "")


def turn_file(
    lines: Iterable[bytes], name: str, mill: Mill, put: Callable[[str], object],
    tolerance: float = TOLERANCE_MM, start: Start = NO_START,
) -> Turned:  # fmt: skip
    """Turn a program; `put` gets pieces of the vector file, of whole lines."""
    pieces: list[str] = []
    turning = Turning(mill, pieces.append, tolerance, start)
    turning.writer.begin(name)
    for line in lines:
        turning.take(line.decode("ascii") if line.isascii() else decode(line))
        put("".join(pieces))
        pieces.clear()
    turned = turning.end()
    put("".join(pieces))
    return turned


def _first_column(text: str) -> int:
    return len(text) - len(text.lstrip(" \t")) + 1
