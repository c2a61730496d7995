"""The arguments of `bringup`, apart from what it needs to run."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError

from rkm04_tools import board
from rkm04_tools.client_options import PORT_HELP

TITLE = "try a new board: a walk, step by step, and a report of what was seen"
EXAMPLE = "rkm04 bringup --board weact-f405 --port /dev/ttyUSB0 --report board-1.txt"
NOTES = """\
The board has the bring-up image: rkm04 board flash --board NAME --image bringup. A jumper wire is
wanted, from each STEP pin to CAPTURE (rkm04 board pins), to measure pulses. Nothing is sent
before you have said that the motors are unpowered, nothing is switched before you have confirmed
its step; what you type before a question is shown does not count. What was left out, or not come
to, stands in the report as such. The report is printed at the end; with --json as one JSON object,
and the walk goes to standard error. The file of --report must not be there yet, and is not made if
nothing was done. Status 0: all was done and is good."""
PATIENCE_SECONDS = 20.0


def add_arguments(command: ArgumentParser) -> None:
    command.add_argument("--board", metavar="NAME", default=board.DEFAULT_BOARD,
                         help=f"one of {', '.join(board.names())}")  # fmt: skip
    command.add_argument("--port", metavar="PORT", help=PORT_HELP)
    command.add_argument("--report", metavar="FILE", help="write the report to a new file as well")
    command.add_argument("--patience", metavar="SECONDS", type=_seconds, default=PATIENCE_SECONDS,
                         help="how long to wait for your hands at the inputs, with nothing new "
                              "(default: 20)")  # fmt: skip


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0 < seconds <= 3600:
        raise ArgumentTypeError(f"{text}: write seconds, more than 0, at most 3600")
    return seconds
