"""The C program `rkm04-host`: the firmware on the host backend, asked by command line.

It parses, simulates and measures; this module starts it and turns its JSON into types. Its errors
are one line each on standard error and become a `Failure` here.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from rkm04_tools import child, tree
from rkm04_tools.failure import Failure

SUFFIX = ".exe" if os.name == "nt" else ""
PROGRAM = f"rkm04-host{SUFFIX}"
BUILD_VARIABLE = "RKM04_BUILD"
BUILT = tree.ROOT / "build" / "host"
"""Where the commands of a checkout build the programs, and a wheel brings them."""
PROGRESS_AFTER_SECONDS = 1.0
PROGRESS = re.compile(rb"^progress (\d+)\n", re.MULTILINE)


@dataclass(frozen=True)
class Command:
    """A command as the firmware's parser found it.

    `offset` is that of its letter; `opcode` the name of its row in program_opcodes.def; `io` the
    input or variable of a conditional jump, else 0; `value` its number, else 0; `text` its
    canonical form; `ordinal` its place in program memory, 0 if it is not stored; `line` and
    `column` those of its letter, from 1.
    """

    offset: int
    opcode: str
    io: int
    value: int
    text: str
    ordinal: int = 0
    line: int = 1
    column: int = 1


@dataclass(frozen=True)
class Problem:
    """An error or a warning about a command. Errors have the unit's flag, 1 or 2."""

    line: int
    column: int
    end_column: int
    severity: str
    rule: str
    flag: int
    message: str


@dataclass(frozen=True)
class Parsed:
    """All commands of a text, and its errors or else its warnings, in its order.

    `more` errors are not listed.
    """

    commands: list[Command]
    problems: list[Problem]
    more: int = 0

    @property
    def is_good(self) -> bool:
        """Whether the unit accepts it."""
        return not any(problem.flag for problem in self.problems)


@dataclass(frozen=True)
class OpcodeRow:
    """A row of program_opcodes.def."""

    name: str
    letter: str
    form: str
    min: int
    max: int
    meaning: str


def check(text: str) -> Parsed:
    """Parse a text as the unit does; what is wrong with it, in words."""
    answer = _answer(["check", "-"], text.encode("utf-8", "surrogatepass"))
    names = [field.name for field in fields(Command)]
    commands = [Command(*(told[name] for name in names)) for told in answer["commands"]]
    names = [field.name for field in fields(Problem)]
    problems = [Problem(*(told[name] for name in names)) for told in answer["problems"]]
    return Parsed(commands, problems, answer["more"])


def stored(commands: Sequence[Command]) -> list[Command]:
    """The commands that program memory keeps of a text, in the order of their ordinals from 1."""
    return [command for command in commands if command.ordinal]


@cache
def opcode_rows() -> list[OpcodeRow]:
    """The table of all commands."""
    rows = _answer(["opcodes"])["opcodes"]
    return [OpcodeRow(**row) for row in rows]


def simulate(
    arguments: Sequence[str], pipes: Sequence[int] = (), program: Path | None = None
) -> dict[str, Any]:
    """Run a simulation, which may write to these open pipes; the answer is the summary."""
    command = ["sim", *arguments]
    seconds = next((b for a, b in pairwise(arguments) if a == "--for"), "")
    if sys.stderr.isatty():
        command += ["--progress", str(PROGRESS_AFTER_SECONDS)]
    path = program or program_path()
    return ask(path, command, progress="simulating", pipes=pipes, of_seconds=float(seconds or 0))


def measure() -> dict[str, Any]:
    """Run the benchmarks of the host."""
    return _answer(["bench"], progress="measuring")


def program_path() -> Path:
    """Where the program was built."""
    path = Path(os.environ.get(BUILD_VARIABLE) or BUILT) / "bin" / PROGRAM
    if not path.is_file():
        raise Failure(f"{path}: not built; start the command as tools/rkm04, which builds it")
    return path


def _answer(arguments: Sequence[str], given: bytes = b"", progress: str = "") -> dict[str, Any]:
    return ask(program_path(), arguments, given, progress)


def ask(
    program: Path,
    arguments: Sequence[str],
    given: bytes = b"",
    progress: str = "",
    pipes: Sequence[int] = (),
    of_seconds: float = 0,
) -> dict[str, Any]:
    """Run a C program of ours to its end and return what it answers.

    On a terminal `progress` is shown, with per cent where the program tells its unit time.
    """
    command = [str(program), *arguments]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, stdin=pipe, stdout=pipe, stderr=pipe, env=child.bound(), pass_fds=pipes
    ) as process:
        try:
            out, complaint = _communicate(process, given, progress, of_seconds)
        except BaseException:
            process.kill()
            raise
    if process.returncode != 0:
        raise _failed(program.name, process.returncode, complaint.decode(errors="replace"))
    answer = json.loads(out)
    if not isinstance(answer, dict):
        raise Failure(f"{program.name} {arguments[0]} gave no object as its answer; build it again")
    return answer


def _communicate(
    process: subprocess.Popen[bytes], given: bytes, progress: str, of_seconds: float
) -> tuple[bytes, bytes]:
    """Wait for the end of the program; show the time on a terminal if it takes long."""
    if not progress or not sys.stderr.isatty():
        return process.communicate(given)
    started = time.monotonic()
    shown = False
    while True:
        try:
            answer = process.communicate(given, timeout=PROGRESS_AFTER_SECONDS)
            break
        except subprocess.TimeoutExpired as still:
            shown = True
            text = f"{progress} ... {time.monotonic() - started:.0f} s"
            if of_seconds and (told := PROGRESS.findall(still.stderr or b"")):
                text += f", {int(told[-1]) / of_seconds / 10:.0f} % of {of_seconds:g} s"
            print(f"\r{text}\x1b[K", end="", file=sys.stderr, flush=True)
    if shown:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)
    return answer


def _failed(program: str, status: int, complaint: str) -> Failure:
    """Pass on the program's own line, or say that it crashed."""
    line = (
        PROGRESS.sub(b"", complaint.encode())
        .decode()
        .strip()
        .rpartition("\n")[2]
        .removeprefix(f"{program}: ")
    )
    if status > 0 and line:
        return Failure(line)
    how = f"signal {-status}" if status < 0 else f"status {status}"
    return Failure(f"{program} ended with {how}: this is a fault of the tool")
