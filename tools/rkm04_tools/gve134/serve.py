"""`serve`: a unit in real time. The C program takes the place of this one and does it."""

from __future__ import annotations

import argparse
from typing import NoReturn

from rkm04_tools import serve
from rkm04_tools.gve134 import host

EXAMPLE = """\
gve134 serve --flash unit.flash
  gve134 serve --pty /tmp/unit --speed 10
  gve134 serve --noise 500 --loss 500      # one byte of a thousand comes to harm

Others then connect, from a second terminal:
  gve134 status --port socket://127.0.0.1:5000
By TCP several can; each hears the answers to what it has sent. A request goes to the unit when it
is whole, and is forgotten where it is not, a second after its last byte.

Lines on standard input, and on the control port, act while it runs:
  3=0      input 3 (RefZ) is closed to ground; 3=1: it is open, as all are at the start
  ?        prints the state of the unit as a line of JSON
Each is answered by a line of JSON: {"ok": true}, {"error": "..."} or the state; an
empty one by nothing.
Inputs are 1 to 4 (the reference switches), 7 and 8 (button and plate of the tool sensor). Ctrl-C
ends it. Without --flash the EEPROM ends with it."""

PASSED_ON: serve.Passed = [
    ("--flash", "FILE", "keep the EEPROM in it"),
    ("--speed", "X", "times real time, 0.001 to 1000; 0: as fast as possible (default: 1)"),
    ("--baud", "N", "the rate of the line, 38400 to 921600 (default: 115200)"),
    ("--control", "PORT", "take the lines of standard input by TCP too (0: any free port)"),
    ("--address", "ADDRESS", "listen there (default: 127.0.0.1, for this machine only)"),
    ("--noise", "N", "a bad line: N bytes of a million are changed, each way (default: 0)"),
    ("--loss", "N", "N bytes of a million are lost, each way (default: 0)"),
    ("--seed", "N", "with another seed other bytes are changed and lost (default: 0)"),
]


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    serve.add_arguments(command, PASSED_ON)


def run(options: argparse.Namespace) -> NoReturn:
    """Become the C program: signals then reach it without a detour."""
    serve.become(host.program_path(), "gve134", options, PASSED_ON)
