"""What the parser refused, in words for the person who wrote the program."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

from rkm04_tools.host import OpcodeRow, ParseError
from rkm04_tools.opcodes import CONDITIONAL, MEANINGS, rows_of, wants
from rkm04_tools.source import LINE_END

WRONG_VALUE = 1
SHOWN_MAX = 16
"""Characters of a wrong value that a message shows."""

NUMBER = re.compile(r"[+\-0-9]*")
CONDITION = re.compile(r"[+\-0-9]*(?:[A-Za-z][+\-0-9]*)?")
BLANK_BEFORE_NUMBER = re.compile(r"[ \t\r\n]+[+\-0-9]")
QUOTES = (
    "\N{LEFT SINGLE QUOTATION MARK}\N{LEFT DOUBLE QUOTATION MARK}\N{RIGHT DOUBLE QUOTATION MARK}"
)


FOREIGN_COMMENTS = (";", "//", "#", "--", "%")
"""What comments begin with elsewhere."""


def without_comments(text: str, errors: Sequence[ParseError]) -> list[ParseError]:
    """Leave out what follows from a comment of another language, up to the end of its line."""
    kept: list[ParseError] = []
    after = 0
    for error in errors:
        if error.offset < after:
            continue
        kept.append(error)
        if text.startswith(FOREIGN_COMMENTS, error.offset):
            end = LINE_END.search(text, error.offset)
            after = end.start() if end else len(text)
    return kept


def describe(text: str, error: ParseError, rows: Sequence[OpcodeRow]) -> str:
    """Say what is wrong at the place of an error, and what would be right."""
    if error.flag == WRONG_VALUE:
        return _wrong_value(text, error.offset, rows)
    for mark in FOREIGN_COMMENTS:
        if text.startswith(mark, error.offset):
            return f"{mark} begins no comment here; write comments in {{ }}"
    return _unknown(text[error.offset], rows)


def _wrong_value(text: str, offset: int, rows: Sequence[OpcodeRow]) -> str:
    letter = text[offset]
    own = rows_of(letter, rows) or rows_of("'", rows)
    name = f"{letter} ({MEANINGS[own[0].name]})" if len(own) == 1 else letter
    return f"{name} takes {wants(own)}, {_found(text, offset + 1, own)}"


def _found(text: str, start: int, own: Sequence[OpcodeRow]) -> str:
    """Say what stands behind the letter."""
    match = (CONDITION if own[0].form in CONDITIONAL else NUMBER).match(text, start)
    value = match[0] if match else ""
    if value:
        return f"found {_shortened(value)}"
    if BLANK_BEFORE_NUMBER.match(text, start):
        return "found a blank; nothing may stand between a command and its number"
    if start == len(text):
        return "found the end of the file"
    return "found no number"


def _shortened(value: str) -> str:
    if len(value) <= SHOWN_MAX:
        return value
    return f"{value[:SHOWN_MAX]}... ({len(value)} characters)"


def _unknown(character: str, rows: Sequence[OpcodeRow]) -> str:
    if character == "{":
        return "the comment that begins here has no end; close it with }"
    return f"unknown command {_name(character)}{_advice(character, rows)}"


def _advice(character: str, rows: Sequence[OpcodeRow]) -> str:
    """Say what may have been meant."""
    if character.isascii() and character.isdigit():
        return "; this number belongs to no command"
    if character.islower() and rows_of(character.upper(), rows):
        return f"; commands are upper case: {character.upper()}"
    if character == "\x1a":
        return "; the end of a DOS file stands here, with more after it"
    if character == "}":
        return "; no comment is open here"
    if character in QUOTES:
        return "; a subroutine is called with '"
    return ""


def _name(character: str) -> str:
    """Show a character, or name it where it cannot be shown."""
    if character.isprintable():
        return f'"{character}"'
    name = unicodedata.name(character, "control character")
    return f"({name.lower()}, code {ord(character)})"
