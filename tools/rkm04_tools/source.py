"""Program files: from bytes on the disk to the bytes of a message, and back to line and column.

The firmware reads bytes, people count characters. So every character of a file becomes exactly one
byte, and an offset that the firmware reports is the index of a character.
"""

from __future__ import annotations

import codecs
import re
import sys
import unicodedata
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rkm04_tools.failure import Failure, reading_failed

PROGRAM = "a program (.rks)"
MACHINE_SUFFIX = ".rkm"
FILE_BYTES_MAX = 4_000_000
"""Far more than 700 commands with comments; a larger file is no program."""

CALL_FORMS = "\N{ACUTE ACCENT}\N{RIGHT SINGLE QUOTATION MARK}\N{DOUBLE LOW-9 QUOTATION MARK}"
"""What the manual prints for the call character; the unit's own is the apostrophe."""

FOREIGN = 0xFF
"""The byte of every other character outside ASCII: the unit knows no such command."""

STANDARD_INPUT = "-"
DOS_END = re.compile(r"\x1a[\x1a\s]*\Z")
"""The end of a file as DOS editors write it; what blanks follow it is nothing."""
TEXT_CONTROLS = b"\t\n\v\f\r\x1a\x1b"
CONTROLS_PER_BYTES, CONTROLS_MIN = 20, 3
"""A file of more control characters than one in so many, and than so many, is no text."""

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


def read_source(name: str | Path) -> Source:
    """Read a program file, or standard input for `-`."""
    return read_text(name, FILE_BYTES_MAX, "so it is not a program", PROGRAM)


def read_text(name: str | Path, bytes_max: int, too_large: str, kind: str) -> Source:
    """Read a file of a kind, or standard input for `-`: UTF-8, or else Windows-1250, as the
    manual's own programs are."""
    path = named(str(name))
    if kind == PROGRAM and path.suffix == MACHINE_SUFFIX:
        raise Failure(f"{path}: is a machine file; rkm04 machine --help tells what is done with it")
    try:
        with sys.stdin.buffer if is_standard_input(path) else path.open("rb") as file:
            content = file.read(bytes_max + 1)
    except OSError as error:
        raise reading_failed(path, error) from None
    if len(content) > bytes_max:
        raise Failure(f"{path}: larger than {bytes_max} bytes, {too_large}")
    if wrong := why_no_text(content, kind):
        raise Failure(f"{path}: {wrong}")
    return Source(str(path), decode(content))


def named(name: str) -> Path:
    """The file of a name, which must be one."""
    if not name:
        raise Failure("a file name is empty; name a file")
    return Path(name)


def is_standard_input(path: Path) -> bool:
    """Whether a program comes from standard input."""
    return str(path) == STANDARD_INPUT


def why_no_text(content: bytes, kind: str = PROGRAM) -> str:
    """What a file is that is no text of 8-bit characters; empty for one that is."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "this is UTF-16; save it as UTF-8 or ANSI"
    even, odd = content[::2].count(0), content[1::2].count(0)
    if min(even, odd) == 0 and 3 * max(even, odd) > len(content):
        return "this is UTF-16 without a mark; save it as UTF-8 or ANSI"
    controls = len(content.translate(None, bytes(range(32, 256)) + TEXT_CONTROLS))
    if even or odd or controls > max(CONTROLS_MIN, len(content) // CONTROLS_PER_BYTES):
        return f"is not a text file; name {kind}"
    return ""


def decode(content: bytes) -> str:
    """Text of a program file; any bytes are one."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1250", errors="replace")
    return DOS_END.sub("", text)


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
