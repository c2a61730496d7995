"""The masters of lines, which tools and page have in common: C, in the shared library rkm04-lines.

A function of tools/lines is called by its name, its arguments are numbers and handles; what it
returns has to be stated with `declared` before the first call.
"""

from __future__ import annotations

import ctypes
import sys
import weakref
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.host import program_path

HEARD_BYTES = 4096
"""LINES_RKM04_HEARD_BYTES, LINES_GVE134_HEARD_BYTES and LINES_POSITIONING_HEARD_BYTES."""
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")


@cache
def library() -> ctypes.CDLL:
    """The library, loaded."""
    path = program_path().with_name(f"rkm04-lines{SUFFIX}")
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise Failure(f"{path}: cannot be loaded ({error})") from error


def declared(prefix: str, functions: Mapping[str, tuple[Any, ...]]) -> dict[str, Any]:
    """Functions by what follows `prefix` in their names: for each result, then arguments."""
    found = {}
    for name, (result, *arguments) in functions.items():
        function = getattr(library(), prefix + name)
        function.restype, function.argtypes = result, arguments
        found[name] = function
    return found


def owned(owner: object, handle: int | None, end: Callable[[int], None]) -> int:
    """A handle that has been begun, which ends with its owner."""
    if not handle:
        raise MemoryError
    # A thread that is left at the exit of Python may use it still.
    weakref.finalize(owner, end, handle).atexit = False
    return handle


class Handle:
    """A line of one of the masters, with its functions; it ends with this."""

    def __init__(self, functions: Mapping[str, Any], *arguments: int) -> None:
        self._functions = functions
        self._line = owned(self, functions["begin"](*arguments), functions["end"])

    def take(self, came: bytes, now_ns: int) -> None:
        """Hand in what has come."""
        for at in range(0, len(came), HEARD_BYTES):
            part = came[at : at + HEARD_BYTES]
            ctypes.memmove(self._call("heard"), part, len(part))
            self._call("take", len(part), now_ns)

    def _put(self, request: bytes) -> None:
        ctypes.memmove(self._call("request"), request, len(request))

    def _bytes(self, name: str, length: int) -> bytes:
        return ctypes.string_at(self._call(name), length)

    def _call(self, name: str, *arguments: int) -> Any:
        return self._functions[name](self._line, *arguments)
