"""Lines of a script, as they go to the image of a board: the requests of a master.

The simulator has read the script before and found nothing wrong with it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rkm04_tools.positioning.modbus import (
    exchange_request,
    read_request,
    write_one_request,
    write_request,
)
from rkm04_tools.positioning.state import FEED_PER_MM_MIN, IN_FIRST, IN_NUMBERS
from rkm04_tools.positioning.table import (
    AXIS_STEP,
    WORD_BITS,
    WORD_MAX,
    images,
    instructions,
    register_at,
    registers,
)

CONTROL, READ, SETTING = "POS_CONTROL", "READ", "SETTING"
WITH_SPACE = ("POS_INIT", "POS_HOME")
"""Instructions whose first value goes to SPACE."""
WHOLE_FEED = "mm/min"
NUMBERS = 256
"""The upper part of an instruction word counts up, so that none is the same as the one before."""
WORDS = range(-(1 << WORD_BITS - 1), WORD_MAX + 1)
"""What one register can be given, with or without sign."""


@dataclass(frozen=True)
class Line:
    """A line of a script; `ms` from the start, `number` in the file from 1."""

    number: int
    ms: float
    axis: int
    word: str
    values: tuple[int, ...]


@dataclass(frozen=True)
class Request:
    """What goes onto the line at once for a line, or for several of the same time. `asked` empty:
    no request can say it. `instruction`: the word that DONE shows then, 0 for what has none."""

    lines: tuple[Line, ...]
    asked: bytes
    instruction: int = 0

    @property
    def line(self) -> Line:
        """The first one."""
        return self.lines[0]


def lines_of(text: str) -> Iterator[Line]:
    """The lines of a script that are not blank."""
    for number, row in enumerate(text.split("\n"), 1):
        if row := row.partition("#")[0].strip():
            ms, axis, word, *values = (field.strip() for field in row.split(","))
            yield Line(number, float(ms), int(axis), word, tuple(map(_value, values)))


def _value(text: str) -> int:
    whole = text.removesuffix(WHOLE_FEED)
    return int(whole) * (1 if whole == text else FEED_PER_MM_MIN)


def requests_of(lines: Sequence[Line]) -> Iterator[Request]:
    """What a master sends for them, in their order."""
    counts = Counter[int]()
    for group in _groups(lines):
        line = group[0]
        if line.word == CONTROL:
            yield Request(group, _control(group))
        elif line.word == READ:
            first = AXIS_STEP * line.axis + IN_FIRST
            yield Request(group, read_request(first, len(IN_NUMBERS)))
        elif line.word == SETTING:
            yield Request(group, _setting(*line.values))
        else:
            counts[line.axis] += 1
            number = counts[line.axis] % NUMBERS
            yield _instruction(line, number * NUMBERS | instructions()[line.word])


def _groups(lines: Sequence[Line]) -> Iterator[tuple[Line, ...]]:
    """Each line alone, but POS_CONTROL of the same time whose registers stand side by side."""
    group: list[Line] = []
    for line in lines:
        if group and not _goes_on(group[-1], line):
            yield tuple(group)
            group.clear()
        group.append(line)
    if group:
        yield tuple(group)


def _goes_on(before: Line, line: Line) -> bool:
    is_control = before.word == line.word == CONTROL
    has_mp = len(line.values) > 1
    return is_control and before.ms == line.ms and line.axis == before.axis + 1 and has_mp


def _control(group: Sequence[Line]) -> bytes:
    """CONTROL and FEED of axes side by side; the first one may have the feed alone."""
    image = images()["FAST_OUT"]
    first = image.first + len(image.numbers) * (group[0].axis - 1)
    words = [word for line in group for word in [*line.values[1:], *_two(line.values[0])]]
    return write_request(first if len(group[0].values) > 1 else first + 1, words)


def _setting(number: int, value: int) -> bytes:
    row = register_at(number)
    if row and row.words == 2:
        return write_request(number, _two(value))
    return write_one_request(number, value & WORD_MAX) if value in WORDS else b""


def _instruction(line: Line, word: int) -> Request:
    """INSTRUCTION and its parameters SPACE, LEN and ACCEL; DONE and RESULT are asked for."""
    space = list(line.values[:1]) if line.word in WITH_SPACE else []
    parameters = space or [0]
    if measure := line.values[len(space) :]:
        way, accel = measure
        parameters += [*_two(way), accel]
    base = AXIS_STEP * line.axis
    done = base + registers()["DONE"].number
    return Request((line,), exchange_request(base, [word, *parameters], done, 2), word)


def _two(value: int) -> list[int]:
    """Two registers of a number of 32 bits."""
    return [value >> WORD_BITS & WORD_MAX, value & WORD_MAX]
