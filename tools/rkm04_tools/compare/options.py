"""The arguments of `compare`: apart, as help and completion come without numpy."""

from __future__ import annotations

from argparse import ArgumentParser

TITLE = "hold a logic analyser's capture against the simulator's steps"
EXAMPLE = (
    "rkm04 sim tools/examples/4-loop.rks --steps loop.csv\n"
    "  rkm04 compare capture.sr loop.csv --channels STEP1=D0,DIR1=D1"
)
NOTES = """\
CAPTURE is a session of sigrok or PulseView (.sr), a VCD, or raw data of Saleae Logic 2 as CSV;
STEPS is what sim writes by --steps or by --vcd. The two are aligned by the pulses themselves: an
offset, and a rate, since no two crystals agree; the rate may change by 0.1 ppm in a second, as of
crystals that warm up: more is not the same. A pulse is off by what is left then, and nothing below
a sample can be told.

Channels are found by their names (STEP1, DIR_2, m3_step, X STEP); --channels says it otherwise. A !
before a name is for a wire that an inverter follows. DIR is high for backward.

The same (status 0) is: every pulse there and no other, each within the limit, DIR right at each,
and with --part at one place of the simulation only: what repeats may be of another one.
STEP and DIR of each motor that moves in STEPS must have been captured. With --channels, what it
does not name is left out on purpose; the result tells that, and of which motors it speaks.
tools/rkm04_tools/compare/README.md tells how to capture and what the figures mean.\
"""
LIMIT_NS_MAX = 1e6


def add_arguments(command: ArgumentParser) -> None:
    """Add the arguments of the command."""
    command.add_argument("capture", metavar="CAPTURE", help="what the analyser has recorded")
    command.add_argument("steps", metavar="STEPS", help="what the simulator has written")
    options = [
        ("--channels", "MAP", "as STEP1=D0,DIR1=D1,STEP2=!D2: which channel is which wire"),
        ("--limit", "NS", "how far a pulse may be off (default: a sample and a tick)"),
        (
            "--sample-rate",
            "RATE",
            "as 24MHz: where the file does not tell it; no other than it tells",
        ),
    ]
    for flag, metavar, about in options:
        command.add_argument(flag, metavar=metavar, help=about)
    command.add_argument(
        "--part", action="store_true", help="the capture holds only a part of the simulation"
    )
    command.add_argument(
        "--no-rate", dest="rate", action="store_false",
        help="both have the same clock, as the virtual board and the simulator: fit an offset only",
    )  # fmt: skip
