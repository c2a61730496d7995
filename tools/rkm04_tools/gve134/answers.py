"""Commands and answers of the unit as they stand on the line, with a checksum or without."""

from __future__ import annotations

from dataclasses import dataclass

from rkm04_tools.gve134 import master

INTA_BIT = 8
DONE, NO_ROOM, DAMAGED, UNKNOWN, SYNTAX, BOUNDS, NOTHING_TO_GO_ON, NOT_WHILE_MOVING = range(8)
CODE_WORDS = (
    "done",
    "no room for the vector",
    "the command was damaged",
    "unknown command",
    "wrong syntax",
    "a parameter is out of bounds",
    "nothing to go on with",
    "not while a vector runs",
)
NOT_AFTER_STOP = "not after a stop or a fault: D comes first"
"""What the code NOT_WHILE_MOVING says with INTA."""
SWITCH_NOT_FOUND = "its switch was not found, or not let go, within the ways that were given"
"""What BOUNDS with INTA says of W, whose parameters have been checked."""
TEXT_CHARACTERS_MAX = 80
"""Between ! and CR."""
COMMAS = 3
"""Between the four numbers of a vector."""
INTERPOLATOR, SPINDLE = "0", "7"


@dataclass(frozen=True)
class Answer:
    """An answer: its code, 0 to 7, whether INTA is set, and its values without the first comma."""

    code: int
    inta: bool
    values: str = ""

    @property
    def text(self) -> str:
        """The answer as the line has it, without a checksum."""
        digit = f"{self.code + INTA_BIT * self.inta:X}"
        return f"{digit},{self.values}" if self.values else digit

    @property
    def words(self) -> str:
        """What the digit says."""
        is_stopped = self.inta and self.code == NOT_WHILE_MOVING
        words = NOT_AFTER_STOP if is_stopped else CODE_WORDS[self.code]
        return f"{words}{', INTA is set' if self.inta else ''}"

    @property
    def numbers(self) -> tuple[int, ...]:
        """The values, which are decimal numbers."""
        return tuple(int(value) for value in self.values.split(","))


def answer_of(digit: int, values: str) -> Answer:
    """An answer by its digit."""
    return Answer(digit % INTA_BIT, digit >= INTA_BIT, values)


def addressed(command: str) -> str:
    """A command as files have it, with its address before it: H becomes 0H, !7V300 7V300."""
    return command[1:] if command.startswith("!") else INTERPOLATOR + command


def encoded(command: str, sums: bool) -> bytes:
    """A command as files have it, as the line has it."""
    return master.encode(command, sums)


def canonical(command: str) -> str:
    """A command in capital letters, vectors with all their four numbers."""
    command = command.upper()
    if not command.startswith(("L", "C")) or command.count(",") >= COMMAS or not command.isascii():
        return command
    return master.encode(command, sums=False).decode("ascii")[2:-1]


def parsed(line: str, sums: bool) -> Answer | None:
    """Read an answer without its CR; None: it is none, or its checksum is wrong."""
    read = master.read(line, sums)
    return None if read is None else answer_of(*read)
