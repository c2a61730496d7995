"""`gcode`: its arguments. What it does is in `command`."""

from __future__ import annotations

import argparse

from rkm04_tools.cli import Commands, add_command

TOLERANCE_DEFAULT = 0.01
START_DEFAULT = (0.0,) * 4
TITLE = "turn G-code into vectors for the unit, and tell what the unit would make of them"
EXAMPLE = """\
gve134 gcode pocket.nc --machine mill.rkm
  gve134 gcode pocket.nc --machine mill.rkm -o pocket.gve --xy pocket.svg"""
NOTES = """\
G0-G4, G17-G21, G28, G38.2, G90-G94, F, S, T, M0-M9 and M30 are known; what is not is an error with
its place, and then nothing is written. The machine file (.rkm) has pulses per mm and the limits of
each axis; GVE134_MACHINE names it for all calls. Program positions count from where the axes stand
when it begins, unless --start, G28 or G92 says otherwise.

The unit can neither dwell for more than 24 ms nor wait for a person, and goes back to where the
tool sensor was touched only if it is told to. So G4, M0, M1, M6 and G38.2 become lines for the
host, ;@wait, ;@pause and ;@probe. To the unit they are comments: WITH A PROGRAM THAT DOES NOT KNOW
THEM A FILE MUST NOT BE SENT. tools/rkm04_tools/gve134/gcode/README.md has all of it.
"""


def add_arguments(commands: Commands) -> None:
    """Add the command."""
    command = add_command(commands, "gcode", _run, TITLE, f"{EXAMPLE}\n\n{NOTES.rstrip()}")
    command.add_argument("file", metavar="FILE", help="a program of G-code; -: standard input")
    command.add_argument("-o", "--output", metavar="OUT.gve", help="write the vectors")
    command.add_argument("--machine", metavar="FILE.rkm",
                         help="the machine (default: that of GVE134_MACHINE)")  # fmt: skip
    add_turning(command)
    command.add_argument("--xy", metavar="OUT",
                         help="draw the path in X and Y, coloured by speed: a name ending in .svg "
                              "or .png")  # fmt: skip
    command.add_argument("--check", action="store_true",
                         help="only find what is wrong: no preview, and nothing is written"
                         )  # fmt: skip


def add_turning(command: argparse.ArgumentParser) -> None:
    """What every command takes that turns programs."""
    command.add_argument("--tolerance", metavar="MM", type=_tolerance, default=TOLERANCE_DEFAULT,
                         help="how far a chord may be from its arc, 0.0001 to 1 (default: 0.01)"
                         )  # fmt: skip
    command.add_argument("--start", metavar="X,Y,Z,A", type=_start, default=START_DEFAULT,
                         help="where the axes stand at the beginning, in mm and degrees "
                              "(default: 0,0,0,0)")  # fmt: skip


def _tolerance(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0001 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text} is not from 0.0001 to 1 mm")
    return value


def _start(text: str) -> tuple[float, ...]:
    try:
        values = tuple(float(each) for each in text.split(","))
    except ValueError:
        values = ()
    if len(values) > 4 or not values or not all(abs(each) <= 1e6 for each in values):
        raise argparse.ArgumentTypeError(f"{text} is not one to four numbers with commas between")
    return (*values, 0.0, 0.0, 0.0)[:4]


def _run(options: argparse.Namespace) -> int:
    """Import what turns programs only when it is asked for."""
    from rkm04_tools.gve134.gcode import command

    return command.run(options)
