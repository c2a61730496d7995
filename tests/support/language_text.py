"""The text of programs, read independently of the firmware: commands, flags, canonical form.

Written from the language's description. In: bytes of program text. Out: commands, or the flag and
the character with which the unit refuses the text.
"""

from __future__ import annotations

from dataclasses import dataclass

WRONG_VALUE = 1
UNKNOWN = 2

BLANKS = b" \t\r\n"
CALLS = b"'\"`\xb4"
PLAIN = "\\DEHKRUY.[]"
"""Commands without a number."""

RANGES: dict[str, tuple[tuple[int, int], ...]] = {
    "@": ((1, 80),),
    "A": ((1, 60_000),),
    "B": ((1, 16_000_000),),
    "C": ((1, 8), (40, 58), (75, 75), (80, 95), (100, 100)),
    "F": ((1, 16_000_000),),
    "G": ((1, 2_000_000_000),),
    "J": ((1, 80),),
    "L": ((1, 255),),
    "M": ((1, 8),),
    "N": ((1, 8),),
    "O": ((1, 8), (80, 95)),
    "S": ((1, 2_000),),
    "T": ((1, 8), (40, 58), (80, 95)),
    "V": ((1, 16_000),),
    "W": ((1, 16_000_000),),
    "X": ((1, 8),),
    "Z": ((1, 8), (80, 95)),
    ")": ((1, 8),),
    "(": ((1, 8),),
    "=": ((-2_000_000_000, 2_000_000_000),),
    "'": ((1, 80),),
}
TWO_DIGITS = "CTMNOXZ()"
CONDITION = ((1, 8), (80, 95))
LABEL = ((1, 80),)


@dataclass(frozen=True)
class Command:
    """One command: its letter, its number, and what else its kind has.

    `letter` is "G+" and "G-" for the runs without end, "IH" and "IL" for conditional jumps, whose
    `number` is the input or variable and whose `label` is the target.
    """

    letter: str
    number: int = 0
    label: int = 0

    @property
    def listing(self) -> str:
        """The canonical form."""
        if self.letter in ("IH", "IL"):
            return f"I{self.number:02}{self.letter[1]}{self.label}"
        if self.letter in PLAIN or self.letter in ("G+", "G-"):
            return self.letter
        if self.letter in TWO_DIGITS:
            return f"{self.letter}{self.number:02}"
        return f"{self.letter}{self.number}"


class Refused(Exception):
    """The text has an error: the flag and the character of the answer."""

    def __init__(self, flag: int, char: int) -> None:
        super().__init__(flag, char)
        self.flag = flag
        self.char = char


class _Reader:
    """A place in a text."""

    def __init__(self, text: bytes) -> None:
        self.text = text
        self.at = 0

    def peek(self) -> str:
        """The next character, empty at the end."""
        return self.text[self.at : self.at + 1].decode("latin-1")

    def skip_gaps(self) -> None:
        """Pass over blanks and comments."""
        while self.at < len(self.text):
            if self.text[self.at] in BLANKS:
                self.at += 1
            elif self.peek() == "{":
                end = self.text.find(b"}", self.at)
                if end < 0:
                    raise Refused(UNKNOWN, ord("{"))
                self.at = end + 1
            else:
                return

    def number(self) -> int | None:
        """Read digits; None if there is none."""
        begin = self.at
        while self.peek() and self.peek() in "0123456789":
            self.at += 1
        digits = self.text[begin : self.at].lstrip(b"0")[:12]
        return int(digits or b"0") if self.at > begin else None


def parse(text: bytes) -> list[Command]:
    """Return the commands of a text; raises `Refused` at its first error."""
    reader = _Reader(text)
    commands = []
    reader.skip_gaps()
    while reader.at < len(text):
        commands.append(_command(reader))
        reader.skip_gaps()
    return commands


def listing(commands: list[Command]) -> bytes:
    """Return the canonical form of commands."""
    return "".join(command.listing for command in commands).encode("ascii")


def _command(reader: _Reader) -> Command:
    byte = reader.text[reader.at]
    letter = "'" if byte in CALLS else chr(byte)
    reader.at += 1
    if letter in PLAIN:
        return Command(letter)
    if letter == "I":
        return _condition(reader)
    if letter not in RANGES:
        raise Refused(UNKNOWN, byte)
    if letter == "G" and reader.peek() in ("+", "-"):
        reader.at += 1
        return Command(letter + chr(reader.text[reader.at - 1]))
    return Command(letter, _value(reader, letter, RANGES[letter], byte))


def _condition(reader: _Reader) -> Command:
    source = _value(reader, "I", CONDITION, ord("I"))
    level = reader.peek()
    if level not in ("H", "L"):
        raise Refused(WRONG_VALUE, ord("I"))
    reader.at += 1
    return Command("I" + level, source, _value(reader, "I", LABEL, ord("I")))


def _value(reader: _Reader, letter: str, ranges: tuple[tuple[int, int], ...], told: int) -> int:
    sign = 1
    if letter == "=" and reader.peek() == "-":
        sign = -1
        reader.at += 1
    number = reader.number()
    if number is None or not any(low <= sign * number <= high for low, high in ranges):
        raise Refused(WRONG_VALUE, told)
    return sign * number
