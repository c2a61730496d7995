"""Raw data of Saleae's Logic as CSV: `Time [s]` and a column for each channel.

Rows come where a channel changes, or (Logic 1) for each sample. Times are seconds, or dates and
times of ISO 8601. `X` is no data: before and after what was recorded, nowhere else.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Collection
from pathlib import Path
from typing import IO

import numpy as np

from rkm04_tools.compare.recording import Edges, Floats, Recording, names_of, parts
from rkm04_tools.failure import Failure

HEAD = re.compile(r"time\s*[\[(]s[\])]", re.IGNORECASE)
TABLE = {"name", "type", "start_time"}
"""Columns of Logic's data table, which has what analysers have decoded."""
ISO = re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?")
DECIMAL = re.compile(rb"[-+]?\d+(\.\d+)?")
LOOKED_AT = 50
"""Rows that tell how many digits times have."""
UNIT_SECONDS = 1e-12
SECONDS_MAX = 100 * 86_400
"""In that unit they fit 64 bits."""
NO_DATA = 2.0


class SaleaeReader:
    """A file whose first line was read."""

    kind = "a CSV of Saleae Logic"

    def __init__(self, path: Path, file: IO[bytes], head: bytes) -> None:
        self._path = path
        self._file = file
        line, _, self._given = head.partition(b"\n")
        columns = _cells(line.decode("utf-8-sig", "replace").strip())
        if set(columns) >= TABLE:
            raise Failure(f"{path}: is a data table of Saleae Logic; use its Export Raw Data, CSV")
        if len(columns) < 2 or not HEAD.fullmatch(columns[0]):
            raise Failure(
                f"{path}: is no capture: neither an .sr of sigrok nor a VCD, and not a CSV of "
                "Saleae Logic, whose first line is Time [s] and names, commas between; name "
                "another file"
            )
        self._columns = {name: at for at, name in reversed(list(enumerate(columns)))}
        self.names = names_of(columns[1:])

    def read(self, wanted: Collection[str]) -> Recording:
        """Read all rows, and keep the edges."""
        rows = _Rows(
            self._path, [self._columns[name] for name in wanted], Edges(self._path, wanted)
        )
        for part in parts(self._path, self._file, b"\n", self._given):
            rows.take(part)
        if rows.end is None or rows.begin is None:
            raise Failure(f"{self._path}: has no data in the channels that are compared")
        traces = rows.edges.traces(UNIT_SECONDS)
        return Recording(rows.begin, rows.end, 0.0, rows.digit_seconds, traces)


def _cells(line: str) -> list[str]:
    try:
        return [name.strip() for name in next(csv.reader([line]), [])]
    except csv.Error:
        return []


class _Rows:
    """Goes through the rows of a file."""

    def __init__(self, path: Path, columns: list[int], edges: Edges) -> None:
        self.edges = edges
        self.begin: float | None = None
        self.end: float | None = None
        self.digit_seconds = 0.0
        self._path = path
        self._columns = columns
        self._line = 2
        self._time = -np.inf
        self._iso_begin: np.datetime64 | None = None
        self._is_iso = False
        self._has_ended = False
        """The channels have no data any more."""

    def take(self, part: bytes) -> None:
        """Take some whole rows."""
        if self._line == 2:
            self._look_at(part)
        seconds, levels = self._numbers(part.replace(b"X", b"2"))
        if not len(seconds):
            return
        self._require_order(seconds)
        seconds, levels = self._with_data(seconds, levels)
        if len(seconds):
            self._add(seconds, levels)
        self._line += part.count(b"\n")
        self.edges.require_room()

    def _look_at(self, part: bytes) -> None:
        """See how the file writes its times."""
        cells = [line.partition(b",")[0].strip() for line in part.split(b"\n", LOOKED_AT)]
        self._is_iso = ISO.match(cells[0]) is not None
        found = filter(None, map((ISO if self._is_iso else DECIMAL).match, cells[:LOOKED_AT]))
        digits = max((len(match[1]) - 1 for match in found if match[1]), default=0)
        exact = not self._is_iso and any(b"e" in cell.lower() for cell in cells)
        self.digit_seconds = UNIT_SECONDS if exact else 10.0 ** -min(digits, 12)

    def _numbers(self, part: bytes) -> tuple[Floats, Floats]:
        """Times in seconds, and a row of levels for each."""
        lines = [line for line in part.splitlines() if line.strip()]
        times: Floats | None = None
        if self._is_iso:
            times = self._iso_seconds(lines)
            lines = [b"0," + line.partition(b",")[2] for line in lines]
        if not lines:
            return np.empty(0), np.empty((0, len(self._columns)))
        try:
            table = np.loadtxt(
                lines, delimiter=",", usecols=[0, *self._columns], ndmin=2, comments=None,
                encoding="latin-1",
            )  # fmt: skip
        except ValueError as error:
            raise self._wrong(lines, str(error)) from None
        levels = table[:, 1:]
        if not np.isin(levels, (0.0, 1.0, NO_DATA)).all():
            row = int(np.argmax(~np.isin(levels, (0.0, 1.0, NO_DATA)).all(axis=1)))
            raise Failure(f"{self._path}:{self._line + row}: a level is neither 0 nor 1: no logic")
        return (table[:, 0] if times is None else times), levels

    def _iso_seconds(self, lines: list[bytes]) -> Floats:
        """Dates and times as seconds from the first one."""
        cells = []
        for at, line in enumerate(lines):
            match = ISO.match(line)
            if not match:
                raise Failure(f"{self._path}:{self._line + at}: begins with no date and time")
            cells.append(match[0].decode())
        try:
            times = np.array(cells, dtype="datetime64[ns]")
        except ValueError as error:
            raise Failure(f"{self._path}: has a date that is none ({error})") from None
        if self._iso_begin is None:
            self._iso_begin = times[0]
        return np.asarray((times - self._iso_begin).astype(np.int64) * 1e-9, dtype=np.float64)

    def _wrong(self, lines: list[bytes], why: str) -> Failure:
        """The first row that cannot be read, by its line."""
        wanted = max([0, *self._columns])
        for at, line in enumerate(lines):
            cells = line.split(b",")
            try:
                good = len(cells) > wanted and [float(cells[c]) for c in (0, *self._columns)]
            except ValueError:
                good = False
            if not good:
                cut = "; the file may have been cut off" if len(cells) <= wanted else ""
                return Failure(f"{self._path}:{self._line + at}: is no row of numbers{cut}")
        return Failure(f"{self._path}: cannot be read: {why.partition(';')[0]}")

    def _require_order(self, seconds: Floats) -> None:
        is_wrong = ~(np.diff(seconds, prepend=self._time) >= 0) | ~np.isfinite(seconds)
        if is_wrong.any():
            line = self._line + int(np.argmax(is_wrong))
            raise Failure(f"{self._path}:{line}: the time is not after the one before it")
        if max(-seconds[0], seconds[-1]) > SECONDS_MAX:
            raise Failure(f"{self._path}: has times beyond 100 days; export it once more")
        if seconds[0] == seconds[-1] and len(seconds) > 1000:
            raise Failure(f"{self._path}:{self._line}: time stands still; export it once more")
        self._time = float(seconds[-1])

    def _with_data(self, seconds: Floats, levels: Floats) -> tuple[Floats, Floats]:
        """The rows with data, which must follow each other."""
        rows = np.flatnonzero(np.all(levels != NO_DATA, axis=1))
        if len(rows):
            whole = len(rows) == rows[-1] - rows[0] + 1
            if not whole or self._has_ended or (self.begin is not None and rows[0] > 0):
                raise Failure(f"{self._path}: has a gap without data; record its channels at once")
        self._has_ended = self.begin is not None or len(rows) > 0
        self._has_ended &= not len(rows) or rows[-1] < len(levels) - 1
        return seconds[rows], levels[rows]

    def _add(self, seconds: Floats, levels: Floats) -> None:
        """Add rows of levels."""
        if self.begin is None:
            self.begin = float(seconds[0])
            for at, name in enumerate(self.edges.levels):
                self.edges.begin(name, int(levels[0, at]))
        times = np.rint(seconds / UNIT_SECONDS).astype(np.int64)
        for at, name in enumerate(self.edges.levels):
            changed = np.diff(levels[:, at], prepend=self.edges.levels[name]) != 0
            self.edges.extend(name, times[changed])
        self.end = float(seconds[-1])
