"""Files of G-code: from bytes on the disk to lines, whatever the size of the file."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import BinaryIO

from rkm04_tools.failure import Failure, reading_failed
from rkm04_tools.source import is_standard_input, why_no_text

KIND = "a program of G-code (.nc)"
CHUNK_BYTES = 1 << 20
LINE_BYTES_MAX = 1 << 16
"""Of a longer line the rest is dropped: it is an error however it goes on."""

ENDS = b"\r\n\x1a"

Show = Callable[[int, int], None]


def lines_of(path: Path, show: Show) -> Iterator[bytes]:
    """The lines of a file or, for `-`, of standard input; tells bytes read, of how many."""
    total = 0 if is_standard_input(path) else _size(path)
    try:
        with _opened(path) as file:
            yield from _lines(file, path, lambda done: show(done, total))
    except OSError as error:
        raise reading_failed(path, error) from None


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError as error:
        raise reading_failed(path, error) from None


def _opened(path: Path) -> AbstractContextManager[BinaryIO]:
    return nullcontext(sys.stdin.buffer) if is_standard_input(path) else path.open("rb")


def _lines(file: BinaryIO, path: Path, show: Callable[[int], None]) -> Iterator[bytes]:
    rest, done = b"", 0
    while chunk := file.read(CHUNK_BYTES):
        if done == 0 and (wrong := why_no_text(chunk, KIND)):
            raise Failure(f"{path}: {wrong}")
        done += len(chunk)
        show(done)
        lines = (rest + chunk).splitlines(keepends=True)
        rest = b"" if chunk.endswith(b"\n") else lines.pop()[:LINE_BYTES_MAX]
        for line in lines:
            yield line.rstrip(ENDS)
    for line in rest.splitlines():
        yield line.rstrip(ENDS)
