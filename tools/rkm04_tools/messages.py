"""The messages of firmware/rkm04/docs/messages.md: requests as bytes, answers as types."""

from __future__ import annotations

import datetime
import re
from dataclasses import dataclass

from rkm04_tools.line_errors import UnitRefused, UnknownMessage, WrongAnswer

VERSION, SET_COMMAND, STORE_FLASH, GET_POSITION, GET_COMMAND, GET_TABLE, GET_PROGRESS = range(1, 8)
GET_STATUS = 200
UNKNOWN = 255
NAMES = {
    VERSION: "Version",
    SET_COMMAND: "Set Command",
    STORE_FLASH: "Store Flash",
    GET_POSITION: "Get Position",
    GET_COMMAND: "Get Command",
    GET_TABLE: "Get Tabul Run",
    GET_PROGRESS: "Get Pozic Run",
    GET_STATUS: "Get Status",
}

ALL_MOTORS = 0
MOTORS = range(1, 5)
FLAG_VALUE, FLAG_UNKNOWN, FLAG_OVERFLOW = 1, 2, 3
STORE_ERRORS = {
    1: "the memory reports an error; the old program stays",
    2: "the program is too long for the memory",
}

VERSION_TEXT = re.compile(r"(\d\d\.\d\d),(\d\d)\.(\d\d)\.(\d{4})")
NUMBER = re.compile(rb" *-?\d+")
TABLE = re.compile(r" *(\d+);\[(?:\(\d+;\d+\)(?:,\(\d+;\d+\))*)?\]")
POINT = re.compile(r"\((\d+);(\d+)\)")
PROGRESS = re.compile(r" *(\d+); *(\d+)")


@dataclass(frozen=True)
class Version:
    """Version and date of a unit's software; `text` is what the unit said."""

    text: str
    number: str
    date: datetime.date


@dataclass(frozen=True)
class BreakPoint:
    """A corner of the speed curve of a move: the step, and the speed in steps/s there."""

    step: int
    speed: int


@dataclass(frozen=True)
class Progress:
    """Steps made in the move in progress, and the ordinal of the command being run, from 1."""

    steps: int
    command: int


def request(message: int, motor: int, text: bytes = b"") -> bytes:
    """A request that names its motor."""
    return bytes([message, ord("0") + motor]) + text


def parse_version(answer: bytes) -> Version:
    """Read an answer to Version."""
    require_known(VERSION, answer)
    text = answer[2:].decode("ascii", "replace")
    match = VERSION_TEXT.fullmatch(text)
    if not match or answer[0] != VERSION or answer[1] != len(text):
        raise WrongAnswer(NAMES[VERSION], answer)
    try:
        date = datetime.date(int(match[4]), int(match[3]), int(match[2]))
    except ValueError:
        raise WrongAnswer(NAMES[VERSION], answer) from None
    return Version(text, match[1], date)


def parse_set_command(answer: bytes, motor: int) -> bool:
    """Read an answer to Set Command; true: the program memory has overflowed."""
    content = _content(SET_COMMAND, answer, motor)
    if len(content) != 2 or content[0] > FLAG_OVERFLOW:
        raise WrongAnswer(NAMES[SET_COMMAND], answer)
    flag, character = content[0], content[1:].decode("ascii", "backslashreplace")
    if flag in (FLAG_VALUE, FLAG_UNKNOWN):
        what = "the value after" if flag == FLAG_VALUE else "the command"
        shown = character if character.isprintable() else f"code {content[1]}"
        raise UnitRefused(
            f"the unit refuses {what} {shown} (flag {flag}); nothing of it was stored or run",
            flag,
            character,
        )
    return flag == FLAG_OVERFLOW


def parse_store(answer: bytes, motor: int) -> None:
    """Read an answer to Store Flash."""
    content = _content(STORE_FLASH, answer, motor)
    if len(content) != 1:
        raise WrongAnswer(NAMES[STORE_FLASH], answer)
    if content[0]:
        reason = STORE_ERRORS.get(content[0], "an error that this tool does not know")
        raise UnitRefused(f"the unit could not store the program (error {content[0]}): {reason}")


def parse_positions(answer: bytes, motor: int) -> list[int]:
    """Read an answer to Get Position: one position, or those of all motors."""
    content = _content(GET_POSITION, answer, motor)
    positions = []
    while content:
        text, content = content[1 : 1 + content[0]], content[1 + content[0] :]
        if not NUMBER.fullmatch(text):
            raise WrongAnswer(NAMES[GET_POSITION], answer)
        positions.append(int(text))
    if len(positions) != (len(MOTORS) if motor == ALL_MOTORS else 1):
        raise WrongAnswer(NAMES[GET_POSITION], answer)
    return positions


def parse_program(answer: bytes, motor: int) -> str:
    """Read an answer to Get Command."""
    content = _content(GET_COMMAND, answer, motor)
    if not content.isascii() or any(byte < ord(" ") for byte in content):
        raise WrongAnswer(NAMES[GET_COMMAND], answer)
    return content.decode("ascii")


def parse_table(answer: bytes, motor: int) -> tuple[BreakPoint, ...]:
    """Read an answer to Get Tabul Run."""
    text = _content(GET_TABLE, answer, motor).decode("ascii", "replace")
    points = tuple(BreakPoint(int(step), int(speed)) for step, speed in POINT.findall(text))
    match = TABLE.fullmatch(text)
    if not match or int(match[1]) != len(points):
        raise WrongAnswer(NAMES[GET_TABLE], answer)
    return points


def parse_progress(answer: bytes, motor: int) -> Progress:
    """Read an answer to Get Pozic Run."""
    text = _content(GET_PROGRESS, answer, motor).decode("ascii", "replace")
    match = PROGRESS.fullmatch(text)
    if not match:
        raise WrongAnswer(NAMES[GET_PROGRESS], answer)
    return Progress(int(match[1]), int(match[2]))


def require_known(message: int, answer: bytes) -> None:
    """Raise UnknownMessage if the answer is that the unit does not know the request."""
    if answer[:1] == bytes([UNKNOWN]):
        raise UnknownMessage(
            f"the unit does not know {NAMES[message]} (message {message}); it has other software"
        )


def _content(message: int, answer: bytes, motor: int) -> bytes:
    """What follows number and motor."""
    require_known(message, answer)
    if answer[:2] != request(message, motor):
        raise WrongAnswer(NAMES[message], answer)
    return answer[2:]
