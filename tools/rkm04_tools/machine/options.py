"""`machine`: its actions and their arguments. What they do is in `command`."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from importlib import import_module
from typing import Any

from rkm04_tools.client_options import NODE_HELP, PORT_HELP

TITLE = "a whole machine in one file (.rkm): its programs, names, units, limits and notes"
NOTES = """\
tools/rkm04_tools/machine/README.md tells what such a file holds. rkm04 sim FILE.rkm runs it on the
simulated unit, with its inputs, and tells where a motor would leave its limits.
"""
FILE_HELP = "a machine file (.rkm)"

ACTIONS = (
    ("check", "find what is wrong with machine files, their programs and limits",
     "rkm04 machine check feeder.rkm"),
    ("show", "print what a machine file says: names, units, limits, notes",
     "rkm04 machine show feeder.rkm"),
    ("new", "make a machine file of program files without errors",
     "rkm04 machine new feeder.rkm --name Feeder --motor 1=feed.rks --inputs feed.csv"),
    ("unpack", "write the programs and inputs of a machine file to a new folder",
     "rkm04 machine unpack feeder.rkm feeder"),
    ("diff", "compare a machine file with another one, or with what the four motors of a unit hold",
     "rkm04 machine diff feeder.rkm old.rkm\n  rkm04 machine diff feeder.rkm --port COM5"),
    ("send", "check all programs, then send each to its motor, which runs it at once",
     "rkm04 machine send feeder.rkm --port COM5 --together"),
    ("store", "keep the programs without power, if they are those of the file",
     "rkm04 machine store feeder.rkm --port COM5"),
)  # fmt: skip
OF_UNITS = ("diff", "send", "store")


def add_arguments(commands: Any, add: Callable[..., argparse.ArgumentParser]) -> None:
    """Add the command; `add` adds an action with its example."""
    command = commands.add_parser(
        "machine", help=TITLE, description=f"{TITLE[0].upper()}{TITLE[1:]}.",
        epilog=f"example:\n  rkm04 machine check feeder.rkm\n\n{NOTES}",
        formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False,
    )  # fmt: skip
    actions = command.add_subparsers(metavar="ACTION", required=True)
    for name, title, example in ACTIONS:
        action = add(actions, name, _runner(name), title, example)
        if name == "check":
            action.add_argument("files", metavar="FILE", nargs="+", help=FILE_HELP)
        else:
            action.add_argument("file", metavar="FILE", help=FILE_HELP)
        _add_own(name, action)


def _add_own(name: str, action: argparse.ArgumentParser) -> None:
    """Add the arguments that only some actions have."""
    if name == "diff":
        action.add_argument("other", metavar="OTHER", nargs="?", help="another machine file")
    elif name == "unpack":
        action.add_argument("folder", metavar="FOLDER", help="must not be there yet")
    elif name == "new":
        action.add_argument("--name", metavar="NAME", help="of the machine (default: of the file)")
        action.add_argument("--motor", metavar="N=FILE", action="append", default=[],
                            help="the program of motor N (1 to 4); may be repeated")  # fmt: skip
        action.add_argument("--inputs", metavar="INPUTS", help="what the inputs do in simulations")
    elif name == "send":
        action.add_argument("--together", action="store_true",
                            help="let them start on the same tick; motors without a program in "
                                 "the file must be empty, as ] goes to all four")  # fmt: skip
    if name in OF_UNITS:
        action.add_argument("--port", metavar="PORT", help=PORT_HELP)
        action.add_argument("--node", metavar="N", help=NODE_HELP)


def _runner(name: str) -> Callable[[argparse.Namespace], int]:
    def run(options: argparse.Namespace) -> int:
        status: int = import_module("rkm04_tools.machine.command").RUNS[name](options)
        return status

    return run
