"""The commands that talk to a unit: their arguments. What they do is in `client`.

That module is loaded only when one of them runs: the others need no ports.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

PORT_HELP = "a serial device, socket://HOST:PORT or a pty (or RKM04_PORT)"
NODE_HELP = "address of the unit, 1 to 16; 0: all units, none answers (or RKM04_NODE; default: 1)"
POLL_SECONDS_DEFAULT = 1.0

READS, ACTS, LINE = "reads", "acts", "line"
"""What a command is for: it asks units, it makes them do something, it asks a whole line."""


@dataclass(frozen=True)
class CommandRow:
    """A command of the client; `motor` is the one that it means if none is named."""

    name: str
    title: str
    example: str
    kind: str
    motor: int | None


COMMANDS = (
    CommandRow("version", "ask a unit for version and date of its software",
               "rkm04 version --port COM5 --node 3", READS, None),
    CommandRow("send", "check a program and send it to a motor, which runs it at once",
               "rkm04 send tools/examples/4-loop.rks --port /dev/ttyUSB0 --motor 2", ACTS, 1),
    CommandRow("store", "keep the program of a motor without power, and read it back",
               "rkm04 store tools/examples/4-loop.rks --port COM5", ACTS, 1),
    CommandRow("position", "ask for absolute positions",
               "rkm04 position --port socket://127.0.0.1:5000 --json", READS, 0),
    CommandRow("program", "ask for the programs in the memory",
               "rkm04 program --port COM5 --motor 1", READS, 0),
    CommandRow("table", "ask for the break points of the moves in progress",
               "rkm04 table --port COM5 --motor 1", READS, 0),
    CommandRow("progress", "ask for the steps made and the command being run",
               "rkm04 progress --port COM5", READS, 0),
    CommandRow("status", "ask for inputs, outputs, states of motors and counters of the line",
               "rkm04 status --port COM5 --json", READS, None),
    CommandRow("stop", "stop motors down their ramps, and their programs (K)",
               "rkm04 stop --port COM5", ACTS, 0),
    CommandRow("resume", "go on where stop has stopped (C75)",
               "rkm04 resume --port COM5 --motor 2", ACTS, 0),
    CommandRow("reset", "stop a motor and forget its program (\\)",
               "rkm04 reset --port COM5 --motor 2", ACTS, 1),
    CommandRow("speed", "change the speed of moves in progress (V); motors that stand get nothing",
               "rkm04 speed 500 --port COM5", ACTS, 1),
    CommandRow("scan", "ask addresses 1 to 16 who is there",
               "rkm04 scan --port COM5", LINE, None),
    CommandRow("diff", "compare a program file with what a motor has in its memory",
               "rkm04 diff tools/examples/4-loop.rks --port COM5 --motor 2", READS, 1),
    CommandRow("backup", "write the programs of all units of a line to a folder",
               "rkm04 backup programs --port COM5", LINE, None),
    CommandRow("restore", "load and store the programs that backup has written; their motors stop",
               "rkm04 restore programs --port COM5", LINE, None),
    CommandRow("watch", "show positions, programs, inputs and outputs until Ctrl-C",
               "rkm04 watch --port COM5 --interval 0.5", READS, 0),
)  # fmt: skip

Add = Callable[..., Any]


def add_client_commands(add: Add) -> None:
    """Add all of them; `add` takes name, what to run, title and example, and returns a parser."""
    for row in COMMANDS:
        command = add(row.name, _runner(row.name), row.title, row.example)
        command.add_argument("--port", metavar="PORT", help=PORT_HELP)
        if row.kind != LINE:
            command.add_argument("--node", metavar="N", help=NODE_HELP)
        if row.motor is not None:
            which = "all of them" if row.motor == 0 else str(row.motor)
            command.add_argument(
                "--motor", metavar="N", type=int, choices=range(5), default=row.motor,
                help=f"1 to 4, or 0 for all of them (default: {which})",
            )  # fmt: skip
        _add_own(row.name, command)


def _add_own(name: str, command: argparse.ArgumentParser) -> None:
    """Add the arguments that only one command has."""
    if name in ("send", "diff"):
        command.add_argument("file", metavar="FILE", help="a program file; -: standard input")
    if name == "send":
        command.add_argument(
            "--stream", action="store_true",
            help="feed a program of any length, which begins with \\, as memory gets free; Ctrl-C "
            "stops the motor",
        )  # fmt: skip
    elif name == "store":
        command.add_argument(
            "file", metavar="FILE", nargs="?", help="store only if this program is in the memory"
        )
    elif name in ("backup", "restore"):
        command.add_argument("folder", metavar="FOLDER", help="has a file for each motor")
    elif name == "speed":
        command.add_argument("speed", metavar="V", type=int, help="steps/s, 1 to 16000")
    elif name == "watch":
        command.add_argument(
            "--interval", metavar="SECONDS", type=float, default=POLL_SECONDS_DEFAULT,
            help="time from one look to the next (default: 1); what the line cannot keep is told",
        )  # fmt: skip
        command.add_argument(
            "--count", metavar="N", type=int, help="end after N looks (default: at Ctrl-C)"
        )


def _runner(name: str) -> Callable[[argparse.Namespace], int]:
    def run(options: argparse.Namespace) -> int:
        status: int = import_module("rkm04_tools.client").RUNS[name](options)
        return status

    return run
