"""Value change dumps (IEEE 1364): those of sigrok, of other analysers' programs, and of simulators.

Only wires of one bit are taken; a value that is neither 0 nor 1 changes nothing. A wire whose level
is not told at the begin has the other one until it is. Sigrok writes names with spaces as they are.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import IO

from rkm04_tools.compare.recording import PART_BYTES, Edges, Names, Recording, hertz, parts
from rkm04_tools.failure import Failure

HEAD_BYTES_MAX = 1 << 20
END_OF_HEAD = b"$enddefinitions"
SECTION = re.compile(r"\$(\w+)\s(.*?)\$end\b", re.DOTALL)
TIMESCALE = re.compile(r"(10{0,2})\s*(s|ms|us|ns|ps|fs)")
UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "ps": 1e-12, "fs": 1e-15}
NO_WIRES = ("real", "realtime", "event", "string", "parameter", "integer", "time")
SIGROK_RATE = re.compile(r"Acquisition with \S+ channels at ([\d.]+ ?[kMG]?Hz)")
OWN = re.compile(r"\s*rkm04-")
"""What the simulator and the virtual board write is exact to the digit, and on nobody's samples."""
TIME, SECTION_MARK = ord("#"), ord("$")
WITH_CODE = frozenset(b"rRbBsS")
"""How a value begins that has the code of its signal as a word of its own."""


class VcdReader:
    """A dump whose head was read."""

    kind = "a VCD"

    def __init__(self, path: Path, file: IO[bytes], head: bytes) -> None:
        self._path = path
        self._file = file
        while END_OF_HEAD not in head and len(head) < HEAD_BYTES_MAX:
            data = file.read(PART_BYTES)
            if not data:
                break
            head += data
        text, mark, self._given = head.partition(END_OF_HEAD)
        if not mark:
            raise Failure(f"{path}: is no VCD: its head has no $enddefinitions; name another file")
        self._given = self._given.partition(b"$end")[2]
        sections = SECTION.findall(text.decode("utf-8", "replace"))
        self._unit_seconds = self._timescale(sections)
        rate = SIGROK_RATE.search(" ".join(text for kind, text in sections if kind == "comment"))
        self._sample_hz = hertz(rate[1]) if rate else 0.0
        if any(kind == "version" and OWN.match(text) for kind, text in sections):
            self._sample_hz = 1 / self._unit_seconds
        self._codes, self.names = _wires(text for kind, text in sections if kind == "var")
        if not self._codes:
            raise Failure(f"{path}: has no wires of one bit; export digital channels")

    def read(self, wanted: Collection[str]) -> Recording:
        """Read all changes, and keep those of the wires."""
        changes = _Changes(self._path, {name: self._codes[name] for name in wanted})
        for part in parts(self._path, self._file, b"\n", self._given):
            changes.take(part)
        unit = self._unit_seconds
        traces = changes.edges.traces(unit)
        begin = changes.first if changes.first is not None else 0
        return Recording(begin * unit, changes.now * unit, self._sample_hz, unit, traces)

    def _timescale(self, sections: list[tuple[str, str]]) -> float:
        texts = [text.strip() for kind, text in sections if kind == "timescale"]
        match = TIMESCALE.fullmatch(texts[0]) if texts else None
        if not match:
            raise Failure(f"{self._path}: has no $timescale as 1 ns; export it once more")
        return float(match[1]) * UNITS[match[2]]


class _Changes:
    """Goes through the words of a dump."""

    def __init__(self, path: Path, codes: dict[str, str]) -> None:
        self.edges = Edges(path, codes)
        self.first: int | None = None
        self.now = 0
        self._path = path
        self._values = {
            f"{level}{code}".encode(): (name, level)
            for name, code in codes.items()
            for level in (0, 1)
        }
        self._skips = 0
        """Words to leave out, the code of a value; -1: all up to $end."""

    def take(self, part: bytes) -> None:
        """Take a part of the file that ends with a word."""
        before = self.now
        words = iter(part.split())
        values, levels, times = self._values, self.edges.levels, self.edges.times
        for word in words:
            value = values.get(word)
            if value is not None and not self._skips:
                name, level = value
                if levels[name] == level:
                    continue
                if levels[name] < 0:
                    begins = self.now == (self.first or 0)
                    self.edges.begin(name, level if begins else 1 - level)
                    if begins:
                        continue
                levels[name] = level
                times[name].append(self.now)
            elif word[0] == TIME and not self._skips:
                self._set_time(word)
            elif self._skips or word[0] in WITH_CODE or word[0] == SECTION_MARK:
                self._pass_by(word)
        if self.now == before and len(part) > PART_BYTES // 2:
            raise Failure(f"{self._path}: time stands still at #{self.now}; record it once more")
        self.edges.require_room()

    def _set_time(self, word: bytes) -> None:
        digits = word[1:].partition(b".")[0]
        if not digits.isdigit() or len(digits) > 18 or (now := int(digits)) < self.now:
            shown = word[:20].decode("ascii", "replace")
            raise Failure(f"{self._path}: the time {shown} after #{self.now}: is no whole VCD")
        self.first = now if self.first is None else self.first
        self.now = now

    def _pass_by(self, word: bytes) -> None:
        if self._skips > 0:
            self._skips -= 1
        elif self._skips < 0:
            self._skips = 0 if word == b"$end" else -1
        elif word == b"$comment":
            self._skips = -1
        elif word[0] in WITH_CODE:
            self._skips = 1


def _wires(texts: Iterable[str]) -> tuple[dict[str, str], Names]:
    """Codes of the wires of one bit, by name; a wire may stand in two scopes, with one code."""
    codes: dict[str, str] = {}
    twice, wide = set(), set()
    for text in texts:
        words = text.split()
        if len(words) < 4 or words[0] in NO_WIRES:
            continue
        _, size, code = words[:3]
        name = " ".join(word for word in words[3:] if word[0] != "[")
        if size != "1":
            wide.add(name)
        elif codes.setdefault(name, code) != code:
            twice.add(name)
    return codes, Names(list(codes), twice, wide - set(codes))
