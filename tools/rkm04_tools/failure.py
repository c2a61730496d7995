"""Exit statuses, and the one exception that ends a command with a line for the user."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

DONE = 0
NOT_SO = 1
"""What was asked about is not so: a program has errors, or ended with one."""
WRONG_USAGE = 2
NO_CONNECTION = 3
INTERRUPTED = 130
"""Ctrl-C, as a shell reports it."""


class Failure(Exception):
    """Ends a command. The message is one line: what is wrong and what to do."""

    def __init__(self, message: str, status: int = WRONG_USAGE) -> None:
        super().__init__(message)
        self.status = status


def reading_failed(path: Path, error: OSError) -> Failure:
    """Say why a file cannot be read."""
    if isinstance(error, FileNotFoundError):
        return Failure(f"{path}: no such file; check the name and the folder")
    if isinstance(error, IsADirectoryError):
        return Failure(f"{path}: is a directory; name a file in it")
    return Failure(f"{path}: cannot be read: {_reason(error)}")


def writing_failed(path: Path, error: OSError) -> Failure:
    """Say why a file cannot be written."""
    return Failure(f"{path}: cannot be written: {_reason(error)}; choose another place")


@contextmanager
def finished_or_absent(path: Path) -> Iterator[Path]:
    """What to write instead of a file: it gets the name when it is whole, or is removed.

    What is no plain file, as a pipe, is written as it is.
    """
    if path.exists() and not path.is_file():
        yield path
        return
    part = path.with_name(f"{path.name}.part")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()
