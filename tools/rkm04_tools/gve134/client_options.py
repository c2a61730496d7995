"""The commands that talk to a unit: their arguments. What they do is in `client`.

That module is loaded only when one of them runs: the others need no ports.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from textwrap import fill
from typing import Any

from rkm04_tools.failure import NO_CONNECTION
from rkm04_tools.gve134.gcode.options import add_turning
from rkm04_tools.gve134.sums import Sums
from rkm04_tools.stopper import ENDED_BEFORE, shout

PORT_HELP = "a serial device, socket://HOST:PORT or a pty (or GVE134_PORT)"
BAUDS = (38_400, 57_600, 115_200, 230_400, 460_800, 921_600)
BAUD_DEFAULT = 115_200
POLL_SECONDS_DEFAULT = 1.0
HELP_COLUMNS = 95
OUTPUTS = ("spindle", "brake", "cooling", "blow", "lock", "release", "cover")
"""Bits 0 to 6 of port 0."""

STOPS = (
    "Ctrl-C halts the axes down their ramps (H) and tells where they stand. A second one, or a "
    "unit that does not answer, ends with STOP NOT CONFIRMED: use the emergency stop then. Exit "
    "status 130: stopped and confirmed; 3: not confirmed."
)
CHANGES_NOTHING = (
    "position", "status", "watch", "halt", "memory get", "memory backup", "memory diff",
)  # fmt: skip
"""What may run beside another program must not take its checksums away."""
NO_SUMS = "switch checksums off and speak without them: what is damaged on the line may be executed"
NO_SUMS_READING = "leave checksums as they are in the unit; else they are switched on"
MOVES = ("send", "home", "jog")
"""A signal while one of them moves axes halts them; one before that is told to be another end."""
PLACES = (
    "Places of the memory with a meaning: 01 function of the relay; 05 polarity of STEP (bits 0-3) "
    "and DIR (bits 4-7) of X, Y, Z, A; 0C axis that A is coupled with (01, 02, 03; else none); "
    "F8-FB day, month, year, piece; FD release of the brake in 0.1 s. They act at once."
)


@dataclass(frozen=True)
class CommandRow:
    """A command of the client; `examples` and `notes` are paragraphs of its help."""

    name: str
    title: str
    examples: tuple[str, ...]
    notes: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The help after the arguments."""
        paragraphs = "\n".join(fill(each, HELP_COLUMNS) for each in self.notes)
        example = "\n  ".join(f"gve134 {each}" for each in self.examples)
        return f"{example}\n\n{paragraphs}" if paragraphs else example


COMMANDS = (
    CommandRow(
        "send",
        "check a vector file and send it to the unit, which runs it at once",
        ("send part.gve --port /dev/ttyUSB0", "send - < part.gve"),
        (
            "Nothing is sent of a file with errors, nor to a unit that moves, unless the file "
            "begins with H or J. Vectors go in packets; what is lost or damaged "
            "on the line is repeated, and never executed twice. At the end it waits until the axes "
            "stand. %+, %-, @ and > are left out: the line uses them by itself. G-code is turned "
            "as by gve134 gcode: position 0 of the program is where the axes stand when it begins, "
            "unless its G28 or G92 says otherwise. After a halt bring them back to where "
            "it began before it is sent again.",
            "On a terminal keys act while it runs: + and - change the speed by a sixteenth (XU, "
            "XD), 0 goes back to about that at the start, space halts, g goes on.",
            STOPS,
        ),
    ),
    CommandRow(
        "console",
        "send commands that are typed, one in a line, and show the answers in words",
        ("console --port COM5", "console < commands.txt"),
        (
            "Commands are written as in vector files: P4, SR6, V1000, !7V300; Tab completes them. "
            "Ctrl-D ends; Ctrl-C halts the axes (H), whether they move or not; where that is not "
            "confirmed, the exit status is 3. With --json each "
            "answer is an object in a line of its own.",
        ),
    ),
    CommandRow(
        "position",
        "ask for the positions of X, Y, Z, A",
        ("position --port socket://127.0.0.1:5000 --json", "position --latched"),
    ),
    CommandRow(
        "status",
        "tell what the unit does, what has stopped it, and its inputs",
        ("status --port COM5 --json",),
    ),
    CommandRow(
        "watch",
        "show positions, state and inputs until Ctrl-C",
        ("watch --port COM5 --interval 0.2",),
    ),
    CommandRow(
        "halt",
        "stop the axes down their ramps, and make sure that they stand (H)",
        ("halt --port COM5",),
        (
            "A unit at rest counts as stopped after it, too: gve134 delete ends that. The spindle "
            "goes on as it was: gve134 spindle 0 stops it. Exit status 3 and STOP NOT CONFIRMED: "
            "nobody knows whether the axes stand.",
        ),
    ),
    CommandRow(
        "go",
        "go on where a halt or an interrupt has stopped (G)",
        ("go --port COM5",),
        ("It does not wait for the end; gve134 watch shows the motion.",),
    ),
    CommandRow(
        "delete",
        "delete the vectors that wait, and what is told of the last stop (D)",
        ("delete --port COM5",),
        ("Positions stay.",),
    ),
    CommandRow(
        "home",
        "find the reference switch of an axis (W), and stand where it lets go",
        ("home X -20000 1000 2000 500 --port COM5",),
        (
            "AXIS goes at most WAY pulses (its sign is the direction) at SPEED pulses/s until the "
            "switch is hit, then at most BACK pulses away at SPEED2, and stands at the pulse where "
            "the switch let go. Which level is active is bit 0-3 of ST2. Positions count on: "
            "NX0 in the console makes this place 0. Exit status 1: the switch was not found, or "
            "something interrupted.",
            STOPS,
        ),
    ),
    CommandRow(
        "override",
        "change the speed of all vectors in the queue while they move (X)",
        ("override 80 --port COM5", "override up"),
        (
            "A number is the per cent of the last V (1 to 1000); up and down change by a "
            "sixteenth; last is 100 %. It stays for vectors that come later, those of a jog, too. "
            "While gve134 send runs its keys do this: it has the line.",
        ),
    ),
    CommandRow(
        "jog",
        "move axes by so many pulses, after saying from where to where",
        ("jog X1000 Y-200 --speed 500 --port COM5", "jog X50000 --hold"),
        (
            "--hold moves until Enter is pressed, or input ends, and at most so far: that is the "
            "bound even if the line breaks. --speed sets V, which stays for vectors that come "
            "later. What is left of a jog that was stopped, by whatever it was, is deleted; where "
            "that cannot be, it is said that it waits.",
            STOPS,
        ),
    ),
    CommandRow(
        "output",
        "switch an output of port 0 on or off (O0)",
        ("output cooling on --port COM5", "output blow on --keep cooling spindle"),
        (
            "The port is written as a whole and cannot be read: ALL OUTPUTS THAT ARE NOT NAMED ARE "
            "SWITCHED OFF, as nobody knows how they are. --keep names those that are to be on "
            "besides. lock, release and cover act only through the relay, if its function says so.",
        ),
    ),
    CommandRow(
        "spindle",
        "set the speed of the spindle, 0 to 100.0 per cent",
        ("spindle 30.5 --port COM5",),
        ("0 also switches the output spindle off, others switch it on.",),
    ),
)

MEMORY = (
    CommandRow(
        "get",
        "read bytes, words or numbers with a fraction",
        ("memory get 05 --port COM5", "memory get 10 --as float --count 2"),
        (PLACES,),
    ),
    CommandRow(
        "set",
        "write a byte, a word or a number with a fraction, and read it back",
        ("memory set 0C 03 --port COM5", "memory set 10 1.5 --as float"),
        (PLACES,),
    ),
    CommandRow(
        "backup", "write all 256 bytes to a text file", ("memory backup unit.mem --port COM5",)
    ),
    CommandRow(
        "restore",
        "write the bytes of such a file, and read each back",
        ("memory restore unit.mem --port COM5",),
        (
            "Only bytes that differ are written; places that the file does not have stay. A line "
            "is a place, a colon and bytes, all of two hexadecimal digits (10: FF 0A); ; begins a "
            "comment.",
        ),
    ),
    CommandRow(
        "diff", "compare such a file with the memory", ("memory diff unit.mem --port COM5",)
    ),
)

AddTo = Callable[..., argparse.ArgumentParser]


def add_client_commands(commands: Any, add: AddTo) -> None:
    """Add all of them; `add` takes where to, name, what to run, title and example."""
    for row in COMMANDS:
        _add_own(row.name, _add(commands, add, row, row.name))
    title = "get, set, back up, restore and compare the memory that is kept without power"
    memory = commands.add_parser("memory", help=title, description=title, allow_abbrev=False)
    actions = memory.add_subparsers(metavar="ACTION", required=True)
    for row in MEMORY:
        _add_of_memory(row.name, _add(actions, add, row, f"memory {row.name}"))


def _add(commands: Any, add: AddTo, row: CommandRow, runs: str) -> argparse.ArgumentParser:
    command = add(commands, row.name, _runner(runs), row.title, row.text)
    command.add_argument("--port", metavar="PORT", help=PORT_HELP)
    command.add_argument(
        "--baud", type=int, choices=BAUDS, default=BAUD_DEFAULT, metavar="BD",
        help=f"rate of a serial device; the image of the unit fixes it (default: {BAUD_DEFAULT})",
    )  # fmt: skip
    reads = runs in CHANGES_NOTHING
    command.add_argument(
        "--no-sums", dest="sums", action="store_const", default=Sums.ON,
        const=Sums.KEPT if reads else Sums.NONE, help=NO_SUMS_READING if reads else NO_SUMS,
    )  # fmt: skip
    return command


def _add_own(name: str, command: argparse.ArgumentParser) -> None:
    """Add the arguments that only one command has."""
    if name == "send":
        command.add_argument(
            "file", metavar="FILE", help="a vector file, or one of G-code (.nc); -: standard input"
        )
        command.add_argument(
            "--machine", metavar="FILE.rkm",
            help="the machine for G-code (default: that of GVE134_MACHINE)",
        )  # fmt: skip
        add_turning(command)
        command.add_argument(
            "--no-wait", dest="wait", action="store_false", help="do not wait for the axes"
        )
    elif name == "position":
        command.add_argument(
            "--latched", action="store_true", help="those at the last interrupt (PL)"
        )
    elif name == "watch":
        _add_watch(command)
    elif name == "home":
        command.add_argument("axis", metavar="AXIS", help="X, Y, Z or A")
        for argument in ("way", "speed", "back", "speed2"):
            command.add_argument(argument, metavar=argument.upper())
    elif name == "override":
        command.add_argument("percent", metavar="PERCENT", help="1 to 1000, up, down or last")
    elif name == "jog":
        command.add_argument("ways", metavar="WAY", nargs="+", help="axis and pulses, as in X-1000")
        command.add_argument("--speed", metavar="V", help="pulses/s, 10 to 200000")
        command.add_argument("--hold", action="store_true", help="only until Enter is pressed")
    elif name == "output":
        command.add_argument("output", metavar="NAME", choices=OUTPUTS, help=", ".join(OUTPUTS))
        command.add_argument("level", metavar="on|off", choices=("on", "off"))
        command.add_argument(
            "--keep", metavar="NAME", nargs="+", choices=OUTPUTS, default=[],
            help="outputs that are to be on besides",
        )  # fmt: skip
    elif name == "spindle":
        command.add_argument("percent", metavar="PERCENT", help="0 to 100.0")


def _add_watch(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--interval", metavar="SECONDS", type=float, default=POLL_SECONDS_DEFAULT,
        help="time from one look to the next (default: 1)",
    )  # fmt: skip
    command.add_argument(
        "--count", metavar="N", type=int, help="end after N looks (default: at Ctrl-C)"
    )


def _add_of_memory(name: str, command: argparse.ArgumentParser) -> None:
    if name in ("get", "set"):
        command.add_argument("place", metavar="PLACE", help="hexadecimal, 00 to FF")
        command.add_argument(
            "--as", dest="kind", choices=("byte", "word", "float"), default="byte",
            help="one byte, or four: the low one first, or a number with a fraction",
        )  # fmt: skip
    if name == "get":
        command.add_argument(
            "--count", metavar="N", type=int, default=1, help="how many of them (default: 1)"
        )
    elif name == "set":
        command.add_argument("value", metavar="VALUE", help="hexadecimal; of a float decimal")
    else:
        stream = "standard output" if name == "backup" else "standard input"
        command.add_argument("file", metavar="FILE", help=f"a text file; -: {stream}")


def _runner(name: str) -> Callable[[argparse.Namespace], int]:
    def run(options: argparse.Namespace) -> int:
        try:
            status: int = import_module("rkm04_tools.gve134.client").RUNS[name](options)
        except KeyboardInterrupt:
            if name in MOVES:
                text = f"{name} was ended while it moved nothing: no halt was sent"
                print(f"gve134: {text}", file=sys.stderr)
            if name == "halt":
                shout(ENDED_BEFORE)
                return NO_CONNECTION
            raise
        return status

    return run
