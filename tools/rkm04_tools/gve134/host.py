"""The C program `gve134-host`: the firmware on the host backend, asked by command line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from rkm04_tools import host
from rkm04_tools.failure import Failure

PROGRAM = f"gve134-host{host.SUFFIX}"


@dataclass(frozen=True)
class Error:
    """What the unit would refuse, or a host should not send, and the code that it would answer.

    Line and column count from 1.
    """

    line: int
    column: int
    code: int
    message: str


@dataclass(frozen=True)
class Parsed:
    """How many commands a text has, and what is wrong with them; `more` errors are not listed."""

    commands: int
    errors: list[Error]
    more: int


@dataclass(frozen=True)
class Command:
    """A row of gve_commands.def. `address`: 1 interpolator, 2 spindle, 3 both."""

    name: str
    text: str
    address: int
    packet: int
    states: str
    least: int
    example: str
    answer: str
    parameters: list[dict[str, Any]]


def program_path() -> Path:
    """Where the program was built."""
    path = host.program_path().with_name(PROGRAM)
    if not path.is_file():
        raise Failure(f"{path}: not built; start the command as tools/gve134, which builds it")
    return path


def check(text: str) -> Parsed:
    """Parse a text as the unit does."""
    answer = _answer("check", "-", given=text.encode("utf-8", "surrogatepass"))
    errors = [Error(**each) for each in answer["errors"]]
    return Parsed(answer["commands"], errors, answer["more"])


@cache
def commands() -> list[Command]:
    """The table of all commands."""
    return [Command(**row) for row in _answer("commands")["commands"]]


def simulate(arguments: Sequence[str], pipes: Sequence[int] = ()) -> dict[str, Any]:
    """Play a vector file to the unit; the answer is the summary."""
    return host.simulate(arguments, pipes, program_path())


def _answer(*arguments: str, given: bytes = b"") -> dict[str, Any]:
    """Run the program to its end and return what it answers."""
    return host.ask(program_path(), arguments, given)
