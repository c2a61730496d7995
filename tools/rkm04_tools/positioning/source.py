"""Scripts: from bytes on the disk to text."""

from __future__ import annotations

from rkm04_tools.source import Source, read_text

FILE_BYTES_MAX = 100_000_000


def read_source(name: str) -> Source:
    """Read a script, or standard input for `-`."""
    return read_text(name, FILE_BYTES_MAX, "cut it into several files", "a script (.csv)")
