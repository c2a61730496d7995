"""The commands that talk to a unit: their arguments. What they do is in `client`.

That module is loaded only when one of them runs: the others need no ports and no Modbus.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from textwrap import fill
from typing import Any

PORT_HELP = "a serial device, socket://HOST:PORT, modbus://HOST:PORT or a pty (POSITIONING_PORT)"
RATES = (9600, 19_200, 38_400, 57_600, 115_200)
FORMATS = ("8E1", "8O1", "8N1", "8N2")
RATE, FORMAT = 19_200, "8E1"
"""What is taken if nothing else is said."""
HELP_COLUMNS = 95
STOPS = (
    "Ctrl-C holds the axis (MP = 0): it brakes, and what is left of the measure is kept for "
    "positioning go. A second one, a unit that does not answer, or a PLC that gives the permission "
    "again, ends with STOP NOT CONFIRMED: use the emergency stop then."
)


@dataclass(frozen=True)
class CommandRow:
    """A command of the client; `arguments` are its own, of `ARGUMENTS`."""

    name: str
    title: str
    example: str
    arguments: tuple[str, ...] = ()
    notes: str = ""
    has_axis: bool = True

    @property
    def text(self) -> str:
        """The help after the arguments."""
        notes = f"\n\n{fill(self.notes, HELP_COLUMNS)}" if self.notes else ""
        return f"positioning {self.example}{notes}"


QUIET = (
    "It ends when it is answered, and nobody asks the unit after that: a WATCHDOG shorter than the "
    "time until the next command is a fault (error 8). Use reset and then move, or a script, there."
)
ASKS = (
    "It asks the unit every 50 ms, and what line and PC need; a WATCHDOG must be longer than that. "
)

COMMANDS = (
    CommandRow("scan", "ask addresses 1 to 16 who is there", "scan --port COM5", has_axis=False),
    CommandRow(
        "status", "tell what the unit and its axes do", "status --port socket://127.0.0.1:5000",
        has_axis=False,
    ),
    CommandRow(
        "watch", "show positions and states until Ctrl-C", "watch --interval 0.2",
        ("interval", "count"), has_axis=False,
    ),
    CommandRow("init", "take an axis (POS_INIT)", "init --axis 2", ("space",),
               "What moves stops on its ramp; an error is over. " + QUIET),
    CommandRow("mode", "give a measure (POS_MODE)", "mode 12.5 --accel 500", ("mm", "accel", "abs"),
               "It moves when feed gives it a speed. MM is a way, with --abs a position. " + QUIET),
    CommandRow("feed", "set the wanted feed in mm/min (POS_CONTROL)", "feed 1000", ("feed_value",),
               "It acts at once, in motion too. Permission (MP) stays as it is."),
    CommandRow("hold", "take the permission away (MP = 0), and see the axis stand", "hold --axis 1",
               (), "What is left of the measure is kept: positioning go goes on. STOP NOT "
               "CONFIRMED tells a unit that does not answer (status 3), or an axis that is not "
               "held, as another master gives the permission again (status 1): use the emergency "
               "stop then; positioning init ends the measure, whatever MP is."),
    CommandRow("go", "give the permission (MP = 1), and go on", "go --axis 1"),
    CommandRow("reset", "end the work of an axis and give it back (POS_RESET)", "reset --axis 1"),
    CommandRow(
        "move", "move an axis by so many mm, and wait until it is there", "move 10 --feed 1000",
        ("mm", "feed", "accel", "abs"),
        "An axis that is not taken is taken first; after a fault, init comes first. MM is a way, "
        "with --abs a position. " + ASKS + STOPS,
    ),
    CommandRow(
        "home", "find the reference of an axis (POS_HOME), and wait for it",
        "home --method 21 --feed 1200", ("method", "position", "feed", "accel"),
        "Method 19 goes in positive direction to the switch, 21 in negative; 37 moves nothing: the "
        "axis is at POSITION now. Feeds above HOME_FEED and HOME_SLOW count as these. "
        + ASKS + STOPS,
    ),
)  # fmt: skip
SETTINGS = (
    CommandRow("get", "print settings", "settings get STEPS --axis 1", ("names",),
               "Without NAME all of them."),
    CommandRow("set", "write settings and read them back", "settings set STEPS=400 BACKLASH=20",
               ("values", "store"), "A value counts at once. It is lost without --store. Nothing "
               "is written while an axis that one of them concerns is taken or moves."),
    CommandRow("backup", "write all settings to a file", "settings backup unit.json", ("file",),
               has_axis=False),
    CommandRow("restore", "write the settings of such a file, and read each back",
               "settings restore unit.json --store", ("file", "store"),
               "Of a damaged file, or one of another kind of unit, nothing is written; nor while "
               "an axis is taken or moves.", has_axis=False),
    CommandRow("diff", "compare such a file with the unit", "settings diff unit.json", ("file",),
               has_axis=False),
)  # fmt: skip
ARGUMENTS: dict[str, tuple[tuple[str, ...], dict[str, Any]]] = {
    "interval": (("--interval",), {"metavar": "SECONDS", "type": float, "default": 1.0,
                                   "help": "time from one look to the next (default: 1)"}),
    "count": (("--count",), {"metavar": "N", "type": int,
                             "help": "end after N looks (default: at Ctrl-C)"}),
    "space": (("--space",), {"type": int, "default": 0, "metavar": "N",
                             "help": "0 to 6 (default: 0)"}),
    "mm": (("mm",), {"metavar": "MM", "type": float,
                     "help": "millimetres, as in -12.5; to 0.001, the nearest counts"}),
    "accel": (("--accel",), {"metavar": "A", "type": int, "default": 500,
                             "help": "of all ramps, mm/s2 (default: 500)"}),
    "abs": (("--abs",), {"action": "store_true", "help": "MM is a position"}),
    "feed_value": (("feed",), {"metavar": "FEED", "type": float,
                               "help": "mm/min; a fraction counts, to 1/65536"}),
    "feed": (("--feed",), {"metavar": "F", "type": float, "default": 600.0,
                           "help": "mm/min, as in 0.5 (default: 600)"}),
    "method": (("--method",), {"type": int, "default": 21, "choices": (19, 21, 37),
                               "help": "19, 21 or 37 (default: 21)"}),
    "position": (("--position",), {"metavar": "MM", "type": float, "default": 0.0,
                                   "help": "of the reference (default: 0)"}),
    "names": (("names",), {"metavar": "NAME", "nargs": "*"}),
    "values": (("values",), {"metavar": "NAME=VALUE", "nargs": "+"}),
    "store": (("--store",), {"action": "store_true",
                                        "help": "then keep all settings of the unit without power, "
                                        "those written before, too"}),
    "file": (("file",), {"metavar": "FILE", "help": "a file of settings (.json)"}),
}  # fmt: skip

AddTo = Callable[..., argparse.ArgumentParser]


def add_client_commands(commands: Any, add: AddTo) -> None:
    """Add all of them; `add` takes where to, name, what to run, title and example."""
    for row in COMMANDS:
        _add(commands, add, row, row.name)
    title = "get, set, back up, restore and compare the settings"
    settings = commands.add_parser("settings", help=title, description=title, allow_abbrev=False)
    actions = settings.add_subparsers(metavar="ACTION", required=True)
    for row in SETTINGS:
        _add(actions, add, row, f"settings {row.name}")


def _add(commands: Any, add: AddTo, row: CommandRow, runs: str) -> None:
    command = add(commands, row.name, _runner(runs), row.title, row.text)
    for name in row.arguments:
        flags, how = ARGUMENTS[name]
        command.add_argument(*flags, **how)
    if row.has_axis:
        command.add_argument("--axis", type=int, default=1, help="1 to 4 (default: 1)")
    add_line_options(command, has_node=row.name != "scan")


def add_line_options(command: argparse.ArgumentParser, has_node: bool = True) -> None:
    """The options that name a line and the unit on it."""
    command.add_argument("--port", metavar="PORT", help=PORT_HELP)
    if has_node:
        command.add_argument(
            "--node", metavar="N", help="address of the unit, 1 to 16 (POSITIONING_NODE, or 1)"
        )
    command.add_argument("--baud", type=int, choices=RATES, default=RATE, metavar="BD",
                         help="rate of a serial device (default: 19200)")  # fmt: skip
    command.add_argument("--format", dest="form", choices=FORMATS, default=FORMAT,
                         help="format of a serial device (default: 8E1)")  # fmt: skip


def _runner(name: str) -> Callable[[argparse.Namespace], int]:
    def run(options: argparse.Namespace) -> int:
        status: int = import_module("rkm04_tools.positioning.client").RUNS[name](options)
        return status

    return run
