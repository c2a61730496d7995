"""Requests on the line of the virtual board, and what the image answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.positioning import board_line
from rkm04_tools.positioning.frames import GAP_MS_MIN, byte_ms, exchange, gap_ms, sealed, write
from rkm04_tools.target_run import Ran, Rig

BAUD = 115_200
CYCLE_MS = 15.0
AXES = range(1, 5)
FULL_OUT, FAST_OUT, FAST_IN, FAST_IN_WORDS = 600, 500, 520, 16
TAKE, MODE = 1, 2
LOG = "log.txt"


def cycle(feeds: Sequence[int], permitted: int = 1) -> bytes:
    """Function 23 with the fast image: a feed for each axis."""
    words = [word for feed in feeds for word in (permitted, feed >> 16, feed & 0xFFFF)]
    return exchange(FAST_OUT, words, FAST_IN, FAST_IN_WORDS)


def measures(ways: Sequence[int], accel: int, feeds: Sequence[int]) -> list[bytes]:
    """Take all axes, and begin a measure of each, on one tick."""
    found = []
    for code in (TAKE, MODE):
        words: list[int] = []
        for way, feed in zip(ways, feeds, strict=True):
            high, low = divmod(way & 0xFFFFFFFF, 1 << 16)
            words += [256 + code, 0, high, low, accel, 1, feed >> 16, feed & 0xFFFF]
        found.append(write(FULL_OUT, words))
    return found


@dataclass(frozen=True)
class Asked:
    """A request, and when its first byte begins."""

    ms: float
    data: bytes
    baud: int = BAUD

    @property
    def end_ms(self) -> float:
        """When its last byte is over."""
        return self.ms + len(self.data) * byte_ms(self.baud)

    @property
    def come_ms(self) -> float:
        """When it has come, as the contract says."""
        return self.end_ms + gap_ms(self.baud)


@dataclass(frozen=True)
class Said:
    """An answer, and when its first byte begins."""

    ms: float
    data: bytes


def play(
    rig: Rig, asked: Sequence[Asked], seconds: float, *options: str, inputs: str = ""
) -> tuple[Ran, list[Said]]:
    """Send requests, all at one rate; what was answered."""
    baud = asked[0].baud
    line = "".join(f"{each.ms:.6f} {each.data.hex()}\n" for each in asked)
    log = rig.folder / LOG
    told = [*board_line.options(rig, baud), "--line-log", str(log), *options]
    ran = rig.run(seconds, line, inputs, *told, steps=True)
    return ran, said_in(log)


def said_in(log: Path) -> list[Said]:
    """The answers in a log: a pause ends one."""
    found: list[Said] = []
    last = float("-inf")
    for row in log.read_text().splitlines():
        text, byte = row.split()
        if byte.endswith("*"):
            raise Failure("the image has sent a byte that nobody could read", NOT_SO)
        ms, data = float(text), bytes.fromhex(byte)
        if found and ms - last < GAP_MS_MIN:
            found[-1] = Said(found[-1].ms, found[-1].data + data)
        else:
            found.append(Said(ms, data))
        last = ms
    return found


def unanswered(asked: Sequence[Asked], said: Sequence[Said]) -> int:
    """Requests that have no good answer before the next one begins."""
    ends = [*(each.ms for each in asked[1:]), float("inf")]
    missing = 0
    for each, until in zip(asked, ends, strict=True):
        answers = [s for s in said if each.end_ms < s.ms < until]
        good = len(answers) == 1 and answers[0].data[:2] == each.data[:2]
        missing += not (good and answers[0].data == sealed(answers[0].data[1:-2]))
    return missing


def longest_ms(asked: Sequence[Asked], said: Sequence[Said]) -> float:
    """The longest time from the last byte of a request to the first one of its answer."""
    times = [
        next((s.ms for s in said if s.ms > each.end_ms), float("inf")) - each.end_ms
        for each in asked
    ]
    return max(times)
