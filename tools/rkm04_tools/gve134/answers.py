"""Commands and answers of the unit as they stand on the line, with a checksum or without."""

from __future__ import annotations

import re
from dataclasses import dataclass

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
INTERPOLATOR, SPINDLE = "0", "7"

NO_VALUES = re.compile("")
ANY_VALUES = re.compile(".*")
ONE_NUMBER = re.compile(r"\d{1,3}")
BYTE = re.compile("[0-9A-F]{2}")
"""What the values of an answer look like: what looks otherwise is the answer to something else."""

FORMS = {
    "?": re.compile(".+"),
    "Q": re.compile("[0-9A-F]{8}"),
    "P": re.compile(r"-?\d+,-?\d+"),
    "PF": re.compile(r"-?\d+(,-?\d+){2}"),
    "P4": re.compile(r"-?\d+(,-?\d+){3}"),
    "PL": re.compile(r"-?\d+(,-?\d+){3}"),
    "SR": BYTE,
    "F": BYTE,
    "I1": BYTE,
    "I2": BYTE,
    "ER": BYTE,
    "EUR": re.compile("[0-9A-F]{8}"),
    "EFR": re.compile(r"-?(\d+(\.\d+)?(E[-+]\d+)?|INF)|NAN"),
    "@": ONE_NUMBER,
    ">": ANY_VALUES,
    "*E": ONE_NUMBER,
}
WITH_SUM = re.compile(r"(([0-9A-F])(?:,(.+))?,)([0-9A-F]{2})")
WITHOUT_SUM = re.compile(r"([0-9A-F])(?:,(.+))?")
PARTS = re.compile(r"([LC])(-?\d+)((?:,-?\d+){0,3})")


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


def sum_of(text: str) -> str:
    """The checksum of all characters from the first to the comma before the sum."""
    return f"{sum(text.encode('latin-1')) % 256:02X}"


def addressed(command: str) -> str:
    """A command as files have it, with its address before it: H becomes 0H, !7V300 7V300."""
    return command[1:] if command.startswith("!") else INTERPOLATOR + command


def encoded(command: str, sums: bool) -> bytes:
    """A command as files have it, as the line has it.

    All four numbers of a vector are sent: a checksum is then never taken for one of them.
    """
    text = f"!{addressed(canonical(command))}"
    if sums:
        text += ","
        text += sum_of(text)
    return f"{text}\r".encode("latin-1")


def canonical(command: str) -> str:
    """A command in capital letters, vectors with all their four numbers."""
    command = command.upper()
    if match := PARTS.fullmatch(command):
        parts = [match[2], *match[3].split(",")[1:]]
        command = match[1] + ",".join(parts + ["0"] * (4 - len(parts)))
    return command


def form_of(command: str) -> re.Pattern[str]:
    """What the values of the answer to a command look like where its code is 0."""
    text = addressed(command)[1:].upper()
    if text.startswith("V"):
        return NO_VALUES
    names = (name for name in FORMS if text.startswith(name))
    name = max(names, key=len, default=None)
    return FORMS[name] if name else NO_VALUES


def parsed(line: str, sums: bool) -> Answer | None:
    """Read an answer without its CR; None: it is none, or its checksum is wrong."""
    if sums:
        match = WITH_SUM.fullmatch(line)
        if not match or sum_of(match[1]) != match[4]:
            return None
        digit, values = int(match[2], 16), match[3] or ""
    else:
        match = WITHOUT_SUM.fullmatch(line)
        if not match:
            return None
        digit, values = int(match[1], 16), match[2] or ""
    return Answer(digit % INTA_BIT, digit >= INTA_BIT, values)


def fits(answer: Answer, form: re.Pattern[str]) -> bool:
    """Whether an answer can be one to a command; what was refused has no values, but packets."""
    if answer.code != DONE and not answer.values:
        return True
    return form.fullmatch(answer.values) is not None
