"""A vector file as what is sent of it, line by line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134.answers import canonical
from rkm04_tools.source import LINE_END, Source

COMMENT = ";"
HOST_MARK = ";@"
"""A line that begins so is a comment to the unit, and asks something of the host."""
LINE_OWN = ("%+", "%-", "@", ">")
"""What the line does by itself."""
TIMED = re.compile(r"@\d")


@dataclass(frozen=True)
class Command:
    """A command and the line of the file where it stands, from 1."""

    line: int
    text: str

    @property
    def letter(self) -> str:
        """Its first letter, of the interpolator's; the spindle's have none."""
        return "" if self.text.startswith("!7") else self.text[0]

    @property
    def is_vector(self) -> bool:
        """Whether it is L or C."""
        return self.letter in ("L", "C")

    @property
    def goes_in_packets(self) -> bool:
        """Whether it is C or B."""
        return self.letter in ("C", "B")


@dataclass(frozen=True)
class Job:
    """A file without errors. `left_out` names commands of it that are not sent."""

    source: Source
    commands: int
    vectors: int
    left_out: tuple[str, ...]

    def __iter__(self) -> Iterator[Command]:
        return (each for each in commands_of(self.source.text) if each.text not in LINE_OWN)


def job_of(source: Source) -> Job:
    """Look through a file that the unit's parser has passed."""
    commands = vectors = 0
    left_out: dict[str, None] = {}
    for command in commands_of(source.text):
        if command.text.startswith(HOST_MARK):
            raise Failure(
                f"{source.name}:{command.line}: {command.text} asks for what send does not do; "
                "nothing was sent",
                NOT_SO,
            )
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
    return Job(source, commands, vectors, tuple(left_out))


def commands_of(text: str) -> Iterator[Command]:
    """The commands of a text, in capital letters; those of the interpolator without address."""
    for number, line in enumerate(LINE_END.split(text), 1):
        if line.lstrip(" \t").startswith(HOST_MARK):
            yield Command(number, line.strip(" \t"))
            continue
        command = line.partition(COMMENT)[0].strip(" \t")
        if command:
            yield Command(number, canonical(command.removeprefix("!0")))
