"""The inputs file of a simulation."""

from __future__ import annotations

from pathlib import Path

from rkm04_tools.source import decode

COMMENT = "#"


def read_inputs(path: Path) -> list[tuple[float, int, int]]:
    """Read an inputs file that the simulator has accepted."""
    lines = decode(path.read_bytes()).splitlines()
    cells = (line.partition(COMMENT)[0].split(",") for line in lines)
    rows = [(float(c[0]), int(c[1]), int(c[2])) for c in cells if len(c) == 3]
    return sorted(rows, key=lambda row: row[0])
