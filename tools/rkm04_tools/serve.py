"""`serve`: units on a line in real time. The C program takes the place of this one and does it."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn, TypeAlias

from rkm04_tools import host

EXAMPLE = """\
rkm04 serve --node 1 --node 2 --flash units.flash
  rkm04 serve --pty /tmp/unit --speed 10

Others then connect, from a second terminal:
  rkm04 version --port socket://127.0.0.1:5000 --node 2

Lines on standard input, and on the control port, act while it runs:
  3=1      input 3 becomes 1
  2.3=1    input 3 of unit 2, if there are several
  ?        prints the state of each unit as a line of JSON
Ctrl-C ends it. Without --flash stored programs end with it; with it, starting it again is like
switching the units on again: stored programs run at once."""

Place: TypeAlias = "argparse._MutuallyExclusiveGroup"
Passed = Sequence[tuple[str, str, str]]
"""Options with a value, its name and its help; the C program judges it."""

PASSED_ON: Passed = [
    ("--node", "N", "a unit of this address, 1 to 16; may be repeated (default: 1)"),
    ("--flash", "FILE", "keep stored programs in it; with several units in FILE.nodeN"),
    ("--speed", "X", "times real time, 0.001 to 1000; 0: as fast as possible (default: 1)"),
    ("--control", "PORT", "take the lines of standard input by TCP too (0: any free port)"),
    ("--address", "ADDRESS", "listen there (default: 127.0.0.1, for this machine only)"),
    ("--noise", "N", "a bad line: N bytes of a million are changed, each way (default: 0)"),
    ("--loss", "N", "N bytes of a million are lost, each way (default: 0)"),
    ("--seed", "N", "with another seed other bytes are changed and lost (default: 0)"),
]


def add_arguments(command: argparse.ArgumentParser, passed_on: Passed = PASSED_ON) -> Place:
    """Add the arguments of the command; what is returned takes more places to listen at."""
    place = command.add_mutually_exclusive_group()
    place.add_argument(
        "--tcp", metavar="PORT", help="listen there (default: 5000; 0: any free port)"
    )
    place.add_argument("--pty", metavar="PATH", help="make a pty, and a link to it of this name")
    for flag, metavar, text in passed_on:
        command.add_argument(flag, metavar=metavar, help=text, action="append", default=[])
    command.add_argument(
        "--unpaced", action="store_true", help="bytes take no time on the line, for tests"
    )
    return place


def run(options: argparse.Namespace) -> NoReturn:
    """Become the C program: signals then reach it without a detour."""
    become(host.program_path(), "rkm04", options, PASSED_ON)


def become(program: Path, tool: str, options: argparse.Namespace, passed_on: Passed) -> NoReturn:
    """Become the C program of a tool."""
    sys.stdout.flush()
    sys.stderr.flush()
    arguments = ["serve", *arguments_of(options, passed_on)]
    if os.name == "nt":  # which has no exec: it would end this one at once
        sys.exit(subprocess.call([program, *arguments]))
    os.execv(program, [tool, *arguments])


def arguments_of(options: argparse.Namespace, passed_on: Passed) -> list[str]:
    """What the C program is given of a command line."""
    values = [(flag, value) for flag, *_ in passed_on for value in getattr(options, flag[2:])]
    values += [(flag, getattr(options, flag[2:])) for flag in ("--tcp", "--pty")]
    given = [part for flag, value in values if value is not None for part in (flag, value)]
    switches = [flag for flag in ("--unpaced", "--json") if getattr(options, flag[2:])]
    return [*given, *switches]
