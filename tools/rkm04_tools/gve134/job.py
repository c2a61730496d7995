"""A vector file as what is sent of it, line by line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134.answers import canonical
from rkm04_tools.gve134.gcode.directives import MARK, Pause, Probe, Wait, directive_of
from rkm04_tools.source import LINE_END, Source

COMMENT = ";"
BLANKS = " \t"
LINE_OWN = ("%+", "%-", "@", ">")
"""What the line does by itself."""
TIMED = re.compile(r"@\d")

Asked = Wait | Pause | Probe


@dataclass(frozen=True)
class Command:
    """What stands in a line of the file, from 1: a command, or something asked of the host."""

    line: int
    text: str
    asked_of_host: Asked | None = None

    @property
    def letter(self) -> str:
        """Its first letter, of the interpolator's; others have none."""
        return "" if self.text.startswith(("!7", MARK)) else self.text[0]

    @property
    def is_vector(self) -> bool:
        """Whether it is L or C."""
        return self.letter in ("L", "C")

    @property
    def goes_in_packets(self) -> bool:
        """Whether it is C or B."""
        return self.letter in ("C", "B")

    @property
    def steps(self) -> tuple[int, ...]:
        """What a vector has on each axis."""
        return tuple(map(int, self.text[1:].split(",")))


@dataclass(frozen=True)
class Job:
    """A file without errors. `left_out` names commands of it that are not sent.

    `pauses`: whether it waits for a person.
    """

    source: Source
    commands: int
    vectors: int
    left_out: tuple[str, ...]
    pauses: bool

    def __iter__(self) -> Iterator[Command]:
        return (each for each in commands_of(self.source) if each.text not in LINE_OWN)


def job_of(source: Source) -> Job:
    """Look through a file that the unit's parser has passed."""
    commands = vectors = 0
    pauses = False
    left_out: dict[str, None] = {}
    for command in commands_of(source):
        if command.asked_of_host is not None:
            pauses = pauses or isinstance(command.asked_of_host, Pause)
            continue
        if TIMED.match(command.text):
            raise Failure(
                f"{source.name}:{command.line}: a command at a time (@) is for gve134 sim; "
                "nothing was sent",
                NOT_SO,
            )
        if command.text in LINE_OWN:
            left_out[command.text] = None
            continue
        commands += 1
        vectors += command.is_vector
    return Job(source, commands, vectors, tuple(left_out), pauses)


def commands_of(source: Source) -> Iterator[Command]:
    """The commands of a file, in capital letters; those of the interpolator without address."""
    for number, line in enumerate(_lines(source.text), 1):
        if line.lstrip(BLANKS).startswith(MARK):
            yield _of_host(source, number, line)
            continue
        command = line.partition(COMMENT)[0].strip(BLANKS)
        if command:
            yield Command(number, canonical(command.removeprefix("!0")))


def _lines(text: str) -> Iterator[str]:
    """One after the other: a file may have millions of them."""
    start = 0
    for end in LINE_END.finditer(text):
        yield text[start : end.start()]
        start = end.end()
    yield text[start:]


def _of_host(source: Source, number: int, line: str) -> Command:
    try:
        return Command(number, line.strip(BLANKS), directive_of(line))
    except ValueError as error:
        raise Failure(f"{source.name}:{number}: {error}; nothing was sent", NOT_SO) from None
