"""Vector files: from bytes on the disk to text."""

from __future__ import annotations

from pathlib import Path

from rkm04_tools.failure import Failure
from rkm04_tools.source import Source, read_text

GCODE_SUFFIXES = (".nc", ".ngc", ".gcode", ".tap")

FILE_BYTES_MAX = 100_000_000
"""Four million vectors; a larger file is none of vectors."""
TOO_LARGE = "cut it into several files"


def read_source(name: str) -> Source:
    """Read a vector file, or standard input for `-`."""
    if is_gcode(name):
        raise Failure(f"{name}: is G-code; gve134 gcode {name} -o OUT.gve makes vectors of it")
    return read_text(name, FILE_BYTES_MAX, TOO_LARGE, "a vector file (.gve)")


def is_gcode(name: str) -> bool:
    """Whether a file has G-code, as its name tells."""
    return Path(name).suffix.lower() in GCODE_SUFFIXES
