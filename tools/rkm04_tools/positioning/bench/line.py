"""Requests on the line of the virtual board, and what the image answers."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.target_run import Ran, Rig

BAUD, DELIVERED_BAUD = 115_200, 19_200
BYTE_BITS = 11
PAUSE_MS = 1.75
"""Ends an answer, and above 19 200 Bd a request."""
FORMAT = ("--format", "8E1")
CYCLE_MS = 15.0
AXES = range(1, 5)
RATE, STORE, FULL_OUT, FAST_OUT, FAST_IN, FAST_IN_WORDS = 31, 40, 600, 500, 520, 16
STORE_MS = 3000.0
TAKE, MODE = 1, 2
LOG, FLASH = "log.txt", "flash.bin"


def sealed(text: bytes) -> bytes:
    """A frame of unit 1 with its CRC."""
    frame = bytes([1]) + text
    rest = 0xFFFF
    for byte in frame:
        rest ^= byte
        for _ in range(8):
            rest = (rest >> 1) ^ 0xA001 if rest & 1 else rest >> 1
    return frame + struct.pack("<H", rest)


def words_of(words: Sequence[int]) -> bytes:
    """Their number of bytes, and they."""
    return struct.pack(f">B{len(words)}H", 2 * len(words), *words)


def write(first: int, words: Sequence[int]) -> bytes:
    """Function 16."""
    return sealed(struct.pack(">BHH", 16, first, len(words)) + words_of(words))


def read(first: int, count: int) -> bytes:
    """Function 3."""
    return sealed(struct.pack(">BHH", 3, first, count))


def cycle(feeds: Sequence[int], permitted: int = 1) -> bytes:
    """Function 23 with the fast image: a feed for each axis."""
    words = [word for feed in feeds for word in (permitted, feed >> 16, feed & 0xFFFF)]
    head = struct.pack(">BHHHH", 23, FAST_IN, FAST_IN_WORDS, FAST_OUT, len(words))
    return sealed(head + words_of(words))


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
    def byte_ms(self) -> float:
        """How long a byte takes."""
        return 1000 * BYTE_BITS / self.baud

    @property
    def end_ms(self) -> float:
        """When its last byte is over."""
        return self.ms + len(self.data) * self.byte_ms

    @property
    def come_ms(self) -> float:
        """When it has come, as the contract says."""
        return self.end_ms + max(PAUSE_MS, 3.5 * self.byte_ms)


@dataclass(frozen=True)
class Said:
    """An answer, and when its first byte begins."""

    ms: float
    data: bytes


def stored(rig: Rig) -> Path:
    """A flash in which the line has its highest rate; the image does not know it from elsewhere."""
    path = rig.folder / FLASH
    if not path.exists():
        asks = [(50.0, write(RATE, [BAUD // 100])), (120.0, write(STORE, [1]))]
        line = "".join(f"{ms:.6f} {data.hex()}\n" for ms, data in asks)
        rig.run((asks[-1][0] + STORE_MS) / 1000, line, "", *FORMAT, flash=path)
    return path


def play(
    rig: Rig, asked: Sequence[Asked], seconds: float, *options: str, inputs: str = ""
) -> tuple[Ran, list[Said]]:
    """Send requests, all at one rate; what was answered."""
    baud = asked[0].baud
    line = "".join(f"{each.ms:.6f} {each.data.hex()}\n" for each in asked)
    log = rig.folder / LOG
    options = ("--baud", str(baud), *FORMAT, "--line-log", str(log), *options)
    flash = None if baud == DELIVERED_BAUD else stored(rig)
    ran = rig.run(seconds, line, inputs, *options, steps=True, flash=flash)
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
        if found and ms - last < PAUSE_MS:
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
