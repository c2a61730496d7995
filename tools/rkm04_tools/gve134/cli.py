"""The command line of `tools/gve134`."""

from __future__ import annotations

import re
from pathlib import Path

from rkm04_tools import completion
from rkm04_tools.cli import Commands, Parser, add_board, add_command
from rkm04_tools.gve134 import check
from rkm04_tools.gve134.client_options import add_client_commands
from rkm04_tools.gve134.gcode import options as gcode_options

CHECK_NOTES = """\
A vector file has a command in each line, as the unit's line has it, without ! and address for the
interpolator and with them for the spindle (!7V300). ; begins a comment. A line that begins with @
and a time in ms (@250.5 H) goes beside the others. Lines between *S and *E are a packet.
"""
TABLE = Path(__file__).resolve().parents[3] / "firmware/gve134/command/gve_commands.def"


def version() -> str:
    """What the unit answers to ?."""
    match = re.search(r'"\?", "0,(.*)"\)', TABLE.read_text(encoding="utf-8"))
    return match[1] if match else "unknown"


def make_parser() -> Parser:
    """The parser of the whole command line."""
    parser = Parser(
        prog="gve134",
        description="Tools for the GVE134 unit, which moves four axes along vectors.",
        epilog="gve134 COMMAND --help shows an example of each command.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action="version", version=f"gve134, with the firmware {version()}",
        help="show the version and end",
    )  # fmt: skip
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_check(commands)
    gcode_options.add_arguments(commands)
    add_board(commands, "gve134")
    add_client_commands(commands, add_command)
    completion.add_command(commands, "gve134", add_command)
    return parser


def _add_check(commands: Commands) -> None:
    title = "find every command in vector files that the unit would refuse"
    example = f"gve134 check part.gve\n\n{CHECK_NOTES.rstrip()}"
    command = add_command(commands, "check", check.run, title, example)
    command.add_argument(
        "files", nargs="+", metavar="FILE", help="a vector file; -: standard input"
    )
