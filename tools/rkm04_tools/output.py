"""Standard streams that are closed or full, or that nobody reads any more.

What was asked for is done all the same, and then it is told that its answer was lost. What is said
on standard error never ends a command: most of it is said while a motor is being stopped.
"""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import IO, TypeVar

from rkm04_tools.failure import NOT_SO, WRONG_USAGE

Stream = TypeVar("Stream", bound=io.TextIOWrapper)


def with_streams(tool: str, run: Callable[[], int]) -> int:
    """Run a command; its exit status, or another one if its answer was lost."""
    _open_closed()
    if _is_plain(sys.stdout, 1):
        sys.stdout = _instead(sys.stdout, _Remembering)
    if _is_plain(sys.stderr, 2):
        sys.stderr = _instead(sys.stderr, _Unfailing)
    status = 0
    try:
        try:
            status = run()
        finally:
            sys.stdout.flush()
    except SystemExit:  # help, of which argparse lets a part get lost
        if _error() is None:
            raise
    except BrokenPipeError:
        status = NOT_SO
    except OSError:
        if _error() is None:
            raise
    if error := _error():
        lost = _lost(tool, error)
        status = status or lost
        _give_up()
    return status


class _Remembering(io.TextIOWrapper):
    """A stream that remembers what went wrong, whoever passes over it."""

    error: OSError | None = None

    def write(self, text: str, /) -> int:
        with self._remembered():
            return super().write(text)

    def flush(self) -> None:
        with self._remembered():
            super().flush()

    @contextmanager
    def _remembered(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            self.error = error
            raise


class _Unfailing(io.TextIOWrapper):
    """A stream whose words may get lost."""

    def write(self, text: str, /) -> int:
        with suppress(OSError):
            super().write(text)
        return len(text)

    def flush(self) -> None:
        with suppress(OSError):
            super().flush()


def _open_closed() -> None:
    """Give what is closed its number back, so that no file or line gets it."""
    if sys.stdin is None:
        sys.stdin = open(_null(0, os.O_RDONLY), closefd=False)  # noqa: SIM115
    if sys.stdout is None:
        # Open for reading only, so that writing fails as to a full one.
        sys.stdout = open(_null(1, os.O_RDONLY), "w", closefd=False)  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(_null(2, os.O_WRONLY), "w", closefd=False)  # noqa: SIM115


def _null(number: int, how: int) -> int:
    """The null device at a number."""
    opened = os.open(os.devnull, how)
    if opened != number:
        os.dup2(opened, number)
        os.close(opened)
    return number


def _is_plain(stream: IO[str], number: int) -> bool:
    """Whether it is one that Python has opened, and not of a test."""
    return type(stream) is io.TextIOWrapper and stream.fileno() == number


def _instead(stream: IO[str], kind: type[Stream]) -> Stream:
    """The same stream of another kind."""
    assert isinstance(stream, io.TextIOWrapper)
    encoding, by_line, at_once = stream.encoding, stream.line_buffering, stream.write_through
    return kind(
        stream.detach(), encoding=encoding, line_buffering=by_line, write_through=at_once
    )  # fmt: skip


def _error() -> OSError | None:
    """What standard output has failed with."""
    return sys.stdout.error if isinstance(sys.stdout, _Remembering) else None


def _lost(tool: str, error: OSError) -> int:
    """Say it; the exit status."""
    if isinstance(error, BrokenPipeError):
        return NOT_SO  # nobody wants to read more
    why = f"cannot be written ({(error.strerror or str(error)).lower()})"
    if error.errno == errno.EBADF:
        why = "is closed"
    print(
        f"{tool}: standard output {why}: the answer is lost, though what was asked for may be done",
        file=sys.stderr,
    )
    return WRONG_USAGE


def _give_up() -> None:
    """Let Python write the rest to nowhere as it ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
