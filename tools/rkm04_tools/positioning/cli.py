"""The command line of `tools/positioning`."""

from __future__ import annotations

import argparse

from rkm04_tools import board, completion, sim_target
from rkm04_tools.cli import (
    Commands,
    Parser,
    add_board,
    add_command,
    add_page_options,
    add_static_option,
    write_static,
)
from rkm04_tools.positioning import check, listing, serve
from rkm04_tools.positioning.client_options import (
    FORMAT,
    RATE,
    RATES,
    add_client_commands,
    add_line_options,
)
from rkm04_tools.tree import require_checkout

NAME = "positioning"
SCRIPT_NOTES = """\
A script has an instruction in each line, with its time in ms from the start and its axis, 1 to 4:
  ms,axis,POS_INIT[,space]              ms,axis,POS_MODE_ABS,position,accel
  ms,axis,POS_MODE,len,accel            ms,axis,POS_HOME,method,position,accel
  ms,axis,POS_CONTROL,feed[,mp]         ms,axis,POS_CAPTURE
  ms,axis,POS_RESET                     ms,0,SETTING,register,value
  ms,axis,READ                          # begins a comment
Ways and positions are in um, accelerations in mm/s2, feeds in 1/65536 mm/min, or in whole
mm/min as 1000mm/min.
"""
SIM_NOTES = """\
What READ has found is shown, and each instruction that is refused; then, and where an axis has an
error at the end, the exit status is 1. So it is for a script that cannot be read, which check
tells as well; INPUTS is an option, and 2 tells that it cannot be read.
INPUTS has lines ms,input,level such as 350.5,3,1: BI3 becomes 1 at 350.5 ms. All begin at 0.
The lines may come in any order; of two at the same time the later one acts last.

The simulation ends when the script is over and the axes stand, or at the limit of time. Steps,
trace and waveforms are those of rkm04 sim, with motors 1 to 4 for axes 1 to 4.

--target stm32 plays FILE to the image of a board on the virtual board (modelled, not measured), as
a master over its line, and tells its load and its late steps. Each line of FILE is a request, which
goes out at its time, or later, when the one before it is answered; POS_CONTROL of the same time for
axes that follow each other is one for all of them. At 115200 Bd, which are stored before, a request
acts 3 to 5 ms after it begins, and takes the line for 8 ms at most; --baud 19200 is the line as it
is delivered. There is no --trace and --plot. Times in FILE and INPUTS count from 50 ms after
power-on, those in the files that are written from power-on. WATCHDOG counts from request to
request there, on the simulator from the start.
"""
BENCH_NOTES = """\
--target stm32 runs the image of the reference board on the virtual board (modelled, not measured):
load and late pulses at 4 x 100 000 steps/s with new feeds for all axes every 15 ms at 115 200 Bd,
requests not answered, the time from a request, or an edge at a limit input, to the first pulse that
it changes, stack, flash and RAM, each with two cycle models. hal/stm32/bench/README.md tells what
each figure means.
"""
SIM_OPTIONS = [
    ("--inputs", "INPUTS", "what the inputs do over time; all are 0 at the start"),
    ("--steps", "OUT.csv", "write the tick of every pulse"),
    ("--trace", "OUT.csv", "write moves and stops"),
    ("--vcd", "OUT.vcd", "write the waveforms for a viewer such as GTKWave"),
    ("--plot", "OUT", "draw speeds, positions and signals: a name ending in .svg or .png"),
]
SERVICE_NOTES = """\
Without --port and POSITIONING_PORT it connects to a virtual unit of its own. Connecting moves
nothing. The page is for this machine only: its address has a token, and 127.0.0.1 is not to be
reached from others. Ctrl-C ends it, and the virtual unit with it; a unit on a line is left as it
is: its axes go on, unless its WATCHDOG is set.
"""
FORMS = [
    ("--csv", "csv", "a row for each register of the line"),
    ("--md", "md", "tables in Markdown, as in the document"),
    ("--st", "st", "constants in Structured Text"),
    ("--json", "json", "one JSON object: registers, images, codes, bits"),
]


def make_parser() -> Parser:
    """The parser of the whole command line."""
    parser = Parser(
        prog=NAME,
        description="Tools for the positioning unit, whose four axes a PLC moves over Modbus.",
        epilog="positioning COMMAND --help shows an example of each command.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action="version",
        version=f"positioning, with the firmware {board.version(NAME)}",
        help="show the version and end",
    )  # fmt: skip
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_check(commands)
    _add_sim(commands)
    title = "a unit without hardware: it runs in real time and speaks Modbus, RTU or TCP"
    serve.add_arguments(add_command(commands, "serve", serve.run, title, serve.EXAMPLE))
    _add_service(commands)
    _add_registers(commands)
    add_board(commands, NAME)
    add_client_commands(commands, add_command)
    _add_bench(commands)
    completion.add_command(commands, NAME, add_command)
    return parser


def _sim(options: argparse.Namespace) -> int:
    """Import the drawing of pictures only when it may be needed: it takes long."""
    from rkm04_tools.positioning import sim

    return sim.run(options)


def _service(options: argparse.Namespace) -> int:
    """Import the server only when it is needed: others have not even installed it."""
    if options.static is not None:
        is_usual = (options.node, options.baud, options.form) == (None, RATE, FORMAT)
        others = (options.port, None if is_usual else options)
        return write_static(options, *others, shown="positioning.html")
    from rkm04_tools.positioning.service import command

    return command.run(options)


def _add_service(commands: Commands) -> None:
    title = "a page in the browser: all four axes, moved, held and stopped, homing and settings"
    example = (
        "positioning service\n"
        "  positioning service --port /dev/ttyUSB0 --node 2\n"
        "  positioning service --port modbus://192.168.1.5:502\n"
        "  positioning service --static build/page"
    )
    text = f"{example}\n\n{SERVICE_NOTES.rstrip()}"
    command = add_command(commands, "service", _service, title, text)
    add_line_options(command)
    add_page_options(command, 8406)
    add_static_option(command)


def _bench(options: argparse.Namespace) -> int:
    """Import what measures, and Modbus, only when it is asked for."""
    if options.target == "host":
        from rkm04_tools.positioning.bench import host_figures

        return host_figures.run(options)
    require_checkout("bench --target stm32")
    from rkm04_tools.positioning.bench import target

    return target.run(options)


def _add_bench(commands: Commands) -> None:
    title = "measure how fast the unit is on this machine, or the image of a board"
    example = (
        f"positioning bench --json\n  positioning bench --target stm32\n\n{BENCH_NOTES.rstrip()}"
    )
    command = add_command(commands, "bench", _bench, title, example)
    command.add_argument(
        "--target", choices=["host", "stm32"], default="host",
        help="what is measured: the tools here, or the image of a board (default: host)",
    )  # fmt: skip


def _add_check(commands: Commands) -> None:
    title = "find out whether scripts can be read"
    example = f"positioning check moves.csv\n\n{SCRIPT_NOTES.rstrip()}"
    command = add_command(commands, "check", check.run, title, example)
    command.add_argument("files", nargs="+", metavar="FILE", help="a script; -: standard input")


def _add_sim(commands: Commands) -> None:
    title = "play a script of instructions to the simulated unit, in virtual time"
    example = (
        "positioning sim moves.csv --plot moves.svg\n"
        "  positioning sim moves.csv --inputs inputs.csv --for 10 --vcd moves.vcd\n"
        "  positioning sim moves.csv --target stm32 --steps board.csv"
    )
    notes = f"{SCRIPT_NOTES}\n{SIM_NOTES.rstrip()}"
    command = add_command(commands, "sim", _sim, title, f"{example}\n\n{notes}")
    command.add_argument("file", metavar="FILE", help="a script (.csv); -: standard input")
    command.add_argument(
        "--for", metavar="SECONDS", dest="seconds", default="60",
        help="end at this unit time at the latest (default: 60)",
    )  # fmt: skip
    for flag, metavar, text in SIM_OPTIONS:
        command.add_argument(flag, metavar=metavar, help=text)
    sim_target.add_arguments(command, NAME)
    command.add_argument(
        "--baud", type=int, choices=RATES, metavar="BD",
        help=f"with {sim_target.TARGET}: the rate of the line (default: {RATES[-1]})",
    )  # fmt: skip


def _add_registers(commands: Commands) -> None:
    title = "print the table of all registers, of Modbus and of the settings"
    example = "positioning registers --csv > registers.csv"
    command = add_command(commands, "registers", listing.run, title, example, has_json=False)
    forms = command.add_mutually_exclusive_group(required=True)
    for flag, form, text in FORMS:
        forms.add_argument(flag, action="store_const", const=form, dest="form", help=text)
