"""Vector files: from bytes on the disk to text."""

from __future__ import annotations

import sys

from rkm04_tools.failure import Failure, reading_failed
from rkm04_tools.source import Source, decode, is_standard_input, named, why_no_text

FILE_BYTES_MAX = 100_000_000
"""Four million vectors; a larger file is none of vectors."""


def read_source(name: str) -> Source:
    """Read a vector file, or standard input for `-`."""
    path = named(name)
    try:
        with sys.stdin.buffer if is_standard_input(path) else path.open("rb") as file:
            content = file.read(FILE_BYTES_MAX + 1)
    except OSError as error:
        raise reading_failed(path, error) from None
    if len(content) > FILE_BYTES_MAX:
        raise Failure(f"{path}: larger than {FILE_BYTES_MAX} bytes; cut it into several files")
    if wrong := why_no_text(content):
        raise Failure(f"{path}: {wrong.replace('a program (.rks)', 'a vector file (.gve)')}")
    return Source(str(path), decode(content))
