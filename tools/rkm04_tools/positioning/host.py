"""The C program `positioning-host`: the firmware on the host backend, asked by command line."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rkm04_tools import host
from rkm04_tools.failure import NOT_SO, Failure

PROGRAM = f"positioning-host{host.SUFFIX}"


def program_path() -> Path:
    """Where the program was built."""
    path = host.program_path().with_name(PROGRAM)
    if not path.is_file():
        raise Failure(f"{path}: not built; start the command as tools/positioning, which builds it")
    return path


def check(path: Path) -> int:
    """How many lines a script has; one that cannot be read is a Failure with its place."""
    try:
        return int(host.ask(program_path(), ["check", str(path)])["lines"])
    except Failure as failure:
        raise Failure(str(failure), NOT_SO) from None


def simulate(arguments: Sequence[str], pipes: Sequence[int] = ()) -> dict[str, Any]:
    """Play a script to the unit; the answer is the summary."""
    return host.simulate(arguments, pipes, program_path())
