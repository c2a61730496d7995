"""The command line of `tools/gve134`."""

from __future__ import annotations

import argparse
import re

from rkm04_tools import completion, sim_target
from rkm04_tools.cli import (
    Commands,
    Parser,
    add_board,
    add_command,
    add_page_options,
    add_static_option,
    write_static,
)
from rkm04_tools.gve134 import check, serve
from rkm04_tools.gve134.client_options import (
    BAUD_DEFAULT,
    BAUDS,
    PORT_HELP,
    add_client_commands,
)  # fmt: skip
from rkm04_tools.gve134.gcode import options as gcode_options
from rkm04_tools.tree import ROOT, require_checkout

CHECK_NOTES = """\
A vector file has a command in each line, as the unit's line has it, without ! and address for the
interpolator and with them for the spindle (!7V300). ; begins a comment. A line that begins with @
and a time in ms (@250.5 H) goes beside the others. Lines between *S and *E are a packet.
Lines ;@wait 2.5, ;@pause TEXT and ;@probe are for the host; gcode --help tells of them.
"""
SIM_NOTES = """\
The lines of FILE go to the unit one after the other: each waits for the answer to the one before,
is sent again after 1 ms where the answer is 1 (no room), and a packet (*S to *E) goes as a whole. A
line @250.5 H goes at that time, in ms from the start, beside the others, as soon as the line is
free; J at any time leaves what has not been answered without an answer, and nothing is sent for
100 ms after it. While checksums are on (%+ in FILE) every line gets its own.

What gcode writes for a host is done: ;@wait and ;@probe; ;@pause goes on at once.
Answers with values are shown, and each that is neither 0 nor 1; then the exit status is 1.
INPUTS has lines ms,input,level such as 350.5,3,0: input 3 is closed to ground at 350.5 ms. The
lines may come in any order; of two at the same time the later one acts last. Inputs are 1 to 4
(RefX, RefY, RefZ, RefA), 7 and 8 (button and plate of the tool sensor), open (1) at the start.
Bytes take no time on the line, unless --baud says a rate.

The simulation ends when all lines have been answered and the axes stand, or at the limit of time.
Steps, trace and waveforms are those of rkm04 sim, with motors 1 to 4 for X, Y, Z, A.

--target stm32 plays FILE to the image of a board on the virtual board (modelled, not measured) and
tells its load and its late steps. Bytes take their time there, at 115200 Bd unless --baud says
another rate that images have. There is no --trace, --plot, --xy, and no ;@probe. Times in FILE and
INPUTS count from its first line, those in the files that are written from power-on. Pulses there
are rises of the pins, also where FILE turns their polarity (EW05). What comes as a packet has the
ticks of the simulator, counted from the first pulse; other vectors come when the line brings them.
"""
SERVICE_NOTES = """\
Without --port and GVE134_PORT it connects to a virtual unit of its own. Connecting moves nothing.
The page is for this machine only: its address has a token, and 127.0.0.1 is not to be reached from
others. Ctrl-C ends it, and the virtual unit with it; a unit on a line is left as it is.
"""
BENCH_NOTES = """\
--target stm32 runs the image of the reference board on the virtual board (modelled, not measured):
load and late pulses at 4 x 200 000 pulses/s with the line saturated, the queue while gve134 send
streams over slow converters, the time to an answer, power-on to ready, stack, flash and RAM, each
with two cycle models. hal/stm32/bench/README.md tells what each figure means. About two minutes.
"""
SIM_OPTIONS = [
    ("--inputs", "INPUTS", "what the inputs do over time; all are 1 (open) at the start"),
    ("--steps", "OUT.csv", "write the tick of every pulse"),
    ("--trace", "OUT.csv", "write paths, stops and outputs"),
    ("--vcd", "OUT.vcd", "write the waveforms for a viewer such as GTKWave"),
    ("--plot", "OUT", "draw speeds, positions and signals: a name ending in .svg or .png"),
    ("--xy", "OUT", "draw the path in X and Y, coloured by its speed: .svg or .png"),
]
TABLE = ROOT / "firmware/gve134/command/gve_commands.def"


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
    _add_sim(commands)
    title = "a unit without hardware: it runs in real time and speaks the line"
    serve.add_arguments(add_command(commands, "serve", serve.run, title, serve.EXAMPLE))
    gcode_options.add_arguments(commands)
    _add_service(commands)
    _add_bench(commands)
    add_board(commands, "gve134")
    add_client_commands(commands, add_command)
    completion.add_command(commands, "gve134", add_command)
    return parser


def _sim(options: argparse.Namespace) -> int:
    """Import the drawing of pictures only when it may be needed: it takes long."""
    from rkm04_tools.gve134 import sim

    return sim.run(options)


def _service(options: argparse.Namespace) -> int:
    """Import the server only when it is needed: others have not even installed it."""
    from rkm04_tools.gve134.service import command

    if options.static is None:
        return command.run(options)
    return write_static(options, options.port, options.machine, shown="gve134.html")


def _add_service(commands: Commands) -> None:
    title = "a page in the browser: the path planned and made, start, halt, all that the unit tells"
    example = "gve134 service\n  gve134 service --port COM5 --machine mill.rkm --no-browser"
    example += "\n  gve134 service --static build/page"
    command = add_command(
        commands, "service", _service, title, f"{example}\n\n{SERVICE_NOTES.rstrip()}"
    )
    command.add_argument("--port", metavar="PORT", help=f"connect there first; {PORT_HELP}")
    command.add_argument(
        "--baud", metavar="N", type=int, choices=BAUDS, default=BAUD_DEFAULT,
        help=f"the rate of the line (default: {BAUD_DEFAULT})",
    )  # fmt: skip
    command.add_argument(
        "--machine", metavar="FILE.rkm", help="the machine (default: that of GVE134_MACHINE)"
    )
    add_page_options(command, 8405)
    add_static_option(command)


def _bench(options: argparse.Namespace) -> int:
    """Import what measures only when it is asked for."""
    if options.target == "host":
        from rkm04_tools.gve134.bench import host_figures

        return host_figures.run(options)
    require_checkout("bench --target stm32")
    from rkm04_tools.gve134.bench import target

    return target.run(options)


def _add_bench(commands: Commands) -> None:
    title = "measure speed and load, and compare them with their goals"
    example = f"gve134 bench --json\n  gve134 bench --target stm32\n\n{BENCH_NOTES.rstrip()}"
    command = add_command(commands, "bench", _bench, title, example)
    command.add_argument(
        "--target", choices=["host", "stm32"], default="host",
        help="what is measured: the tools here, or the image of a board (default: host)",
    )  # fmt: skip


def _add_check(commands: Commands) -> None:
    title = "find every command in vector files that the unit would refuse"
    example = f"gve134 check part.gve\n\n{CHECK_NOTES.rstrip()}"
    command = add_command(commands, "check", check.run, title, example)
    command.add_argument(
        "files", nargs="+", metavar="FILE", help="a vector file; -: standard input"
    )


def _add_sim(commands: Commands) -> None:
    title = "play a vector file to the simulated unit, in virtual time"
    example = (
        "gve134 sim part.gve --xy part.svg\n"
        "  gve134 sim part.gve --inputs inputs.csv --baud 115200 --for 10 --vcd part.vcd\n"
        "  gve134 sim part.gve --target stm32 --steps board.csv"
    )
    command = add_command(commands, "sim", _sim, title, f"{example}\n\n{SIM_NOTES.rstrip()}")
    command.add_argument("file", metavar="FILE", help="a vector file (.gve); -: standard input")
    command.add_argument(
        "--for", metavar="SECONDS", dest="seconds", default="60",
        help="end at this unit time at the latest (default: 60)",
    )  # fmt: skip
    command.add_argument(
        "--baud", metavar="N", help="bytes take their time at this rate, 38400 to 921600"
    )
    for flag, metavar, text in SIM_OPTIONS:
        command.add_argument(flag, metavar=metavar, help=text)
    sim_target.add_arguments(command, "gve134")
