"""Messages over the line of the virtual board at set times, and the answers that came."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from frames import FLAG, fcs16, frame, unescape

ANSWER = 0x80
GOOD_FCS = 0xF0B8 ^ 0xFFFF


@dataclass(frozen=True)
class Answer:
    """A whole answer, and when its first byte began."""

    ms: float
    node: int
    number: int
    message: bytes


def ask(ms: float, message: bytes, node: int = 1, number: int = 0) -> str:
    """A line of a script for the line: one request."""
    return f"{ms:.3f} {frame(node, number, message).hex()}\n"


def answers(rows: Iterable[str]) -> list[Answer]:
    """The answers in a log of the line. Bytes that nobody could read are left out."""
    found = []
    content = bytearray()
    begun = 0.0
    for ms, byte in (row.split() for row in rows if not row.rstrip().endswith("*")):
        value = int(byte, 16)
        if value != FLAG:
            content.append(value)
            continue
        plain = unescape(bytes(content))
        if len(plain) > 4 and fcs16(plain) == GOOD_FCS and plain[0] & ANSWER:
            found.append(Answer(begun, plain[0] & ~ANSWER, plain[1], plain[2:-2]))
        content.clear()
        begun = float(ms)
    return found


def heard(folder: Path) -> list[Answer]:
    """The answers in the log of a run of the board."""
    return answers((folder / "log.txt").read_text().splitlines())
