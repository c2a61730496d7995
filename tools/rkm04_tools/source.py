"""Program files: from bytes on the disk to the bytes of a message, and back to line and column.

The firmware reads bytes, people count characters. So every character of a file becomes exactly one
byte, and an offset that the firmware reports is the index of a character.
"""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rkm04_tools.failure import Failure, reading_failed

FILE_BYTES_MAX = 4_000_000
"""Far more than 700 commands with comments; a larger file is no program."""

CALL_FORMS = "\N{ACUTE ACCENT}\N{RIGHT SINGLE QUOTATION MARK}\N{DOUBLE LOW-9 QUOTATION MARK}"
"""What the manual prints for the call character; the unit's own is the apostrophe."""

FOREIGN = 0xFF
"""The byte of every other character outside ASCII: the unit knows no such command."""

EXCERPT_COLUMNS = 100
LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class Place:
    """Line and column of a character, both from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class Source:
    """A program file as text. `name` is what the user called it."""

    name: str
    text: str

    @cached_property
    def message(self) -> bytes:
        """The text as the unit gets it, one byte for each character."""
        return bytes(map(_byte, self.text))

    @cached_property
    def _line_starts(self) -> list[int]:
        return [0, *(match.end() for match in LINE_END.finditer(self.text))]

    def place(self, offset: int) -> Place:
        """Line and column of the character at an offset."""
        line = bisect_right(self._line_starts, offset)
        return Place(line, offset - self._line_starts[line - 1] + 1)

    def line(self, number: int) -> str:
        """The text of a line, without its end."""
        start = self._line_starts[number - 1]
        end = LINE_END.search(self.text, start)
        return self.text[start : end.start() if end else len(self.text)]

    def excerpt(self, place: Place) -> str:
        """The line of a place, or the part of it around the place, with a caret below."""
        line, at = self.line(place.line), place.column - 1
        first = max(0, at - EXCERPT_COLUMNS // 2) if len(line) > EXCERPT_COLUMNS else 0
        shown = line[first : first + EXCERPT_COLUMNS]
        return f"{_printable(shown)}\n{_blanks(shown[: at - first])}^"


def read_source(path: Path) -> Source:
    """Read a program file: UTF-8, or else Windows-1250, as the manual's own programs are."""
    try:
        with path.open("rb") as file:
            content = file.read(FILE_BYTES_MAX + 1)
    except OSError as error:
        raise reading_failed(path, error) from None
    if len(content) > FILE_BYTES_MAX:
        raise Failure(f"{path}: larger than {FILE_BYTES_MAX} bytes, so it is not a program")
    return Source(str(path), decode(content))


def decode(content: bytes) -> str:
    """Text of a program file; any bytes are one."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1250", errors="replace")


def _byte(character: str) -> int:
    if character in CALL_FORMS:
        return ord("'")
    return ord(character) if character.isascii() else FOREIGN


def _printable(text: str) -> str:
    """Replace what a terminal would obey instead of showing."""
    return "".join(c if c == "\t" or c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def _blanks(text: str) -> str:
    """As wide as the text, tabs kept."""
    return "".join("\t" if c == "\t" else " " * _columns(c) for c in text)


def _columns(character: str) -> int:
    """Columns of a terminal that a character takes."""
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1
