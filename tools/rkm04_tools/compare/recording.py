"""What a recording of levels holds, whatever file it came from, and how a file is opened.

A file is read once and in parts; what is kept of it are the edges of the wires that were asked for.
"""

from __future__ import annotations

import re
from array import array
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Protocol

import numpy as np
from numpy.typing import NDArray

from rkm04_tools.bar import Bar
from rkm04_tools.failure import Failure

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

PART_BYTES = 1 << 22
"""What is read at a time; no line of a text is longer."""
EDGES_MAX = 50_000_000
"""Of all wires together: 400 MB."""
RATE = re.compile(r"\s*(\d+(?:\.\d+)?)\s*([kKMG]?)(?:Hz)?\s*")
FACTORS = {"": 1.0, "k": 1e3, "K": 1e3, "M": 1e6, "G": 1e9}


@dataclass(frozen=True)
class Trace:
    """A wire: its level at the start, and the times of its edges in seconds, which only grow."""

    level: int
    edges: Floats

    @property
    def rises(self) -> Floats:
        """The times at which it goes to 1."""
        return self.edges[self.level :: 2]

    @property
    def falls(self) -> Floats:
        """The times at which it goes to 0."""
        return self.edges[1 - self.level :: 2]

    def levels(self, seconds: Floats) -> Ints:
        """Its levels at these times, an edge at the very time included."""
        edges_before = np.searchsorted(self.edges, seconds, side="right")
        return (self.level + edges_before) & 1

    def inverted(self) -> Trace:
        """The wire after an inverter."""
        return Trace(1 - self.level, self.edges)


@dataclass(frozen=True)
class Recording:
    """The wires that were asked for, from `begin` to `end` in seconds.

    `sample_hz` is 0 where the file does not tell it; `digit_seconds` is the last digit of its
    times, 0 where they are samples. Where a file does not tell its end, that is its last edge.
    """

    begin: float
    end: float
    sample_hz: float
    digit_seconds: float
    traces: Mapping[str, Trace]


@dataclass(frozen=True)
class Names:
    """What a file calls its wires."""

    wires: Sequence[str]
    """In its order."""
    twice: Collection[str] = ()
    """Names that two of them have, so that they tell neither."""
    wide: Collection[str] = ()
    """Names of what has more than one bit, and is no wire."""


class Reader(Protocol):
    """A file that was opened, and what it is."""

    kind: str
    names: Names

    def read(self, wanted: Collection[str]) -> Recording:
        """Read all of it, once."""


class Edges:
    """Collects the edges of some wires, as whole numbers of the file's own unit of time."""

    def __init__(self, path: Path, names: Collection[str]) -> None:
        self.path = path
        self.levels = dict.fromkeys(names, -1)
        """The level of each wire now; -1 before the first one."""
        self._first: dict[str, int] = {}
        self.times = {name: array("q") for name in names}

    def begin(self, name: str, level: int) -> None:
        """Tell the level of a wire at the start."""
        self._first[name] = self.levels[name] = level

    def extend(self, name: str, times: Ints) -> None:
        """Add edges of a wire, each of which toggles it."""
        self.times[name].frombytes(np.ascontiguousarray(times, dtype=np.int64).tobytes())
        self.levels[name] ^= len(times) & 1

    def require_room(self) -> None:
        """Refuse what does not fit into memory; to be called after each part of a file."""
        if sum(map(len, self.times.values())) > EDGES_MAX:
            raise Failure(
                f"{self.path}: has more than {EDGES_MAX // 1_000_000} million edges in the "
                "channels that are compared; record less, or compare one motor at a time"
            )

    def traces(self, unit_seconds: float) -> dict[str, Trace]:
        """What was collected."""
        return {
            name: Trace(max(self._first.get(name, 0), 0), np.asarray(times) * unit_seconds)
            for name, times in self.times.items()
        }


def names_of(wires: Iterable[str]) -> Names:
    """Names of the columns or channels of a file, as they come."""
    counts = Counter(wires)
    return Names(list(counts), {name for name, count in counts.items() if count > 1})


def hertz(text: str) -> float:
    """A rate such as `24 MHz`, `24M` or `24000000`; 0 if it is none."""
    match = RATE.fullmatch(text)
    return float(match[1]) * FACTORS[match[2]] if match else 0.0


def parts(path: Path, file: IO[bytes], end: bytes, given: bytes = b"") -> Iterator[bytes]:
    """What is left of a text file, in parts that end with the byte `end`, but for the last one.

    `given` was read already. A bar is shown where the size is known.
    """
    size = path.stat().st_size if path.is_file() else 0
    done, rest = len(given), given
    with Bar("reading") as bar:
        while True:
            data = file.read(PART_BYTES)
            done += len(data)
            bar.show(done // 1_000_000, size // 1_000_000)
            if not data:
                break
            whole, found, begun = (rest + data).rpartition(end)
            if found:
                yield whole + found
            elif len(begun) > PART_BYTES:
                raise Failure(f"{path}: has a line of more than {PART_BYTES >> 20} MB: is no text")
            rest = begun
    if rest.strip():
        yield rest
