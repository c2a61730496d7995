"""`serve`: units in real time. The C program does it; a gateway in Python adds Modbus TCP."""

from __future__ import annotations

import argparse

from rkm04_tools import serve
from rkm04_tools.positioning import host

EXAMPLE = """\
positioning serve --flash unit.flash             # RTU over TCP, for the other commands
  positioning serve --pty /tmp/unit --node 1 --node 2
  positioning serve --modbus-tcp 1502            # for an HMI or a PLC runtime
  positioning serve --noise 500 --loss 500       # one byte of a thousand comes to harm

Others then connect, from a second terminal:
  positioning status --port socket://127.0.0.1:5000
  positioning status --port modbus://127.0.0.1:1502

Lines on standard input, and on the control port, act while it runs:
  3=1      input 3 becomes 1 (all are 0 at the start)
  2.3=1    input 3 of unit 2, if there are several
  ?        prints the state of each unit as a line of JSON
Ctrl-C ends it. Without --flash the settings end with it; with it, starting it again is like
switching the units on again. The rate and format of the line are those of the stored settings.

With --modbus-tcp the line of RTU belongs to the gateway, as a line has one master. The unit
identifier is the address of the unit. Clients may be several; their requests go out one after the
other, and every function and exception comes back as it is. Where the unit does not answer, the
answer is exception 0Bh. 0 is the broadcast, which none answers."""

PASSED_ON: serve.Passed = [
    ("--node", "N", "a unit of this address, 1 to 16; may be repeated (default: 1)"),
    ("--flash", "FILE", "keep stored settings in it; with several units in FILE.nodeN"),
    ("--speed", "X", "times real time, 0.001 to 1000; 0: as fast as possible (default: 1)"),
    ("--control", "PORT", "take the lines of standard input by TCP too (0: any free port)"),
    ("--address", "ADDRESS", "listen there (default: 127.0.0.1, for this machine only)"),
    ("--noise", "N", "a bad line: N bytes of a million are changed, each way (default: 0)"),
    ("--loss", "N", "N bytes of a million are lost, each way (default: 0)"),
    ("--seed", "N", "with another seed other bytes are changed and lost (default: 0)"),
]


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    place = serve.add_arguments(command, PASSED_ON)
    place.add_argument(
        "--modbus-tcp", metavar="PORT", help="speak Modbus TCP there (0: any free port)"
    )


def run(options: argparse.Namespace) -> int:
    """Become the C program, or be its gateway."""
    if options.modbus_tcp is None:
        serve.become(host.program_path(), "positioning", options, PASSED_ON)
    from rkm04_tools.positioning import gateway

    return gateway.run(options, PASSED_ON)
