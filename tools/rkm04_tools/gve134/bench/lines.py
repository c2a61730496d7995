"""Scripts for the line of the virtual board, and what the unit has answered to them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.gve134.answers import encoded
from rkm04_tools.transport import BITS_PER_BYTE

LOG = "log.txt"


@dataclass(frozen=True)
class Said:
    """An answer, and when its first byte began."""

    ms: float
    text: str


def said_in(folder: Path) -> list[Said]:
    """All that the unit has answered in a run."""
    found, begin, text = [], 0.0, ""
    for row in (folder / LOG).read_text().splitlines():
        ms, byte = row.split()
        begin = begin if text else float(ms)
        text += chr(int(byte[:2], 16))
        if text.endswith("\r"):
            found.append(Said(begin, text[:-1]))
            text = ""
    return found


def byte_ms(baud: int) -> float:
    """The time of a byte on the line."""
    return 1000 * BITS_PER_BYTE / baud


def packet(commands: list[str], sums: bool) -> bytes:
    """As the line has it."""
    return b"".join(encoded(each, sums) for each in ["*S", *commands, f"*E{len(commands)}"])


def row(ms: float, data: bytes) -> str:
    """A line of a script: bytes back to back."""
    return f"{ms:.6f} {data.hex()}\n"
