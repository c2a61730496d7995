"""The command line: arguments, and what becomes of errors."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from functools import partial
from typing import Any, NoReturn, TypeAlias

from rkm04_tools import bench, board, board_options, board_wiring, check, completion, serve
from rkm04_tools.bringup import options as bringup_options
from rkm04_tools.client_options import NODE_HELP, PORT_HELP, add_client_commands
from rkm04_tools.compare import options as compare_options
from rkm04_tools.failure import DONE, INTERRUPTED, Failure
from rkm04_tools.machine import options as machine_options
from rkm04_tools.output import with_streams
from rkm04_tools.source import named
from rkm04_tools.starting import take_interrupts
from rkm04_tools.tree import require_checkout

SIM_NOTES = """\
INPUTS has lines ms,input,level such as 350.5,3,1: BI3 becomes 1 at 350.5 ms. The lines may come
in any order; of two at the same time the later one acts last.
The simulation ends when all programs have come to rest, or at the limit of time.

--target stm32 runs the image of the reference board on the virtual board (modelled, not measured)
and tells its load and its late steps; it has no --trace and no --plot. Its programs come by the
line; INPUTS count from then, the files that are written from power-on.
"""
BENCH_NOTES = """\
--target stm32 runs the image of the reference board, and a bench image with moves beyond the limits
of the language, on the virtual board (modelled, not measured): cycles of a step, highest rates,
load, late steps, reaction to inputs, start-up, stack, flash and RAM, each with two cycle models.
hal/stm32/bench/README.md tells what each figure means. About two minutes.
--target page opens the pages of service --static in Debian's headless Chromium (tools/setup test).
"""
SERVICE_NOTES = """\
Without --port and RKM04_PORT it connects to a virtual unit of its own. Nothing moves on connecting.
The page is for this machine only: its address has a token, and 127.0.0.1 is not to be reached from
others. Ctrl-C ends it, and the virtual unit with it; a unit on a line is left as it is.\
"""
STATUSES = """\
exit status: 0 done; 1 what was asked about is not so (a program has errors, a unit refuses);
  2 wrong usage, or a file or standard output that cannot be read or written; 3 no connection;
  130 ended before it was done, by Ctrl-C or a signal handled like it; 143 by SIGTERM otherwise
"""

Run = Callable[[argparse.Namespace], int]


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line, as all errors of the tools."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Tell of an option that there is not where a command is missing, too."""
        first = next(iter(args or ()), "")
        known = self._option_string_actions
        if self._subparsers and first.startswith("-") and first.partition("=")[0] not in known:
            meant = _meant(first.partition("=")[0], known)
            self.error(f"unrecognized arguments: {first}{meant}")
        return super().parse_known_args(args, namespace)

    def error(self, message: str) -> NoReturn:
        """End the command."""
        raise Failure(f"{message}; {self.prog} --help shows how it is used")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Say which choice may have been meant."""
        if action.choices is not None and value not in action.choices:
            meant = _meant(str(value), map(str, action.choices))
            if meant:
                name = action.metavar or "/".join(action.option_strings) or action.dest
                raise argparse.ArgumentError(None, f"{name} {value} is none{meant}")
        super()._check_value(action, value)


def read(parser: Parser, arguments: Sequence[str]) -> argparse.Namespace:
    """Read a command line; of options that there are not, say which may have been meant."""
    options: argparse.Namespace
    options, unknown = parser.parse_known_args(arguments)
    if unknown:
        command = next((c for c in _named(parser, arguments)), parser)
        meant = _meant(unknown[0].partition("=")[0], command._option_string_actions)
        command.error(f"unrecognized arguments: {' '.join(unknown)}{meant}")
    return options


def _named(parser: Parser, arguments: Sequence[str]) -> list[argparse.ArgumentParser]:
    """The innermost command that a command line names first."""
    found: list[argparse.ArgumentParser] = []
    known = dict(completion.commands_of(parser))
    for word in arguments:
        if not word.startswith("-") and word in known:
            found.insert(0, known[word])
    return found[:1]


def _meant(word: str, known: Iterable[str]) -> str:
    """A question for what may have been meant; empty if nothing is near."""
    found = get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f"; did you mean {found[0]}?" if found else ""


Commands: TypeAlias = "argparse._SubParsersAction[Parser]"


def main(arguments: Sequence[str]) -> int:
    """Run a command and return its exit status."""
    return run_tool(make_parser(), arguments)


def run_tool(parser: Parser, arguments: Sequence[str]) -> int:
    """Run a command of one of the tools and return its exit status."""
    return with_streams(parser.prog, partial(_run, parser, arguments))


def _run(parser: Parser, arguments: Sequence[str]) -> int:
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        take_interrupts()
        if list(arguments[:2]) == ["completion", completion.WORDS]:
            print("\n".join(completion.offered(parser, arguments[2:])))
            return DONE
        options = read(parser, arguments)
        run: Run = options.run
        return run(options)
    except Failure as failure:
        print(f"{parser.prog}: {failure}", file=sys.stderr)
        return failure.status
    except KeyboardInterrupt:
        return INTERRUPTED


def _sim(options: argparse.Namespace) -> int:
    """Import the drawing of plots only when it may be needed: it takes long."""
    from rkm04_tools import sim

    return sim.run(options)


def _bench(options: argparse.Namespace) -> int:
    """Import what measures the image only when it is asked for."""
    require_checkout("bench")
    if options.target != "stm32":
        if options.profile:
            raise Failure("--profile needs --target stm32")
        return bench.run(options)
    from rkm04_tools import bench_target

    return bench_target.run(options)


def _bringup(options: argparse.Namespace) -> int:
    """Import what speaks to ports only when it is needed."""
    from rkm04_tools.bringup import command

    return command.run(options)


def _compare(options: argparse.Namespace) -> int:
    """Import numpy only when it is needed."""
    from rkm04_tools.compare import command

    return command.run(options)


def _service(options: argparse.Namespace) -> int:
    """Import the server only when it is needed: others have not even installed it."""
    if options.static is not None:
        return write_static(options, options.port, options.node)
    from rkm04_tools.service import command

    return command.run(options)


def write_static(options: argparse.Namespace, *others: object, shown: str = "index.html") -> int:
    """Write the pages that need no service; `others` are options of one that is served.

    `shown` is the page that is to be opened.
    """
    if any(each is not None for each in (options.listen, *others)):
        raise Failure("--static writes pages without a service; leave out the other options")
    from rkm04_tools import static_pages

    return static_pages.write(named(options.static), shown)


def make_parser() -> Parser:
    """The parser of the whole command line."""
    parser = Parser(
        prog="rkm04",
        description="Tools for the RKM04 unit, which runs the programs of four stepper motors.",
        epilog="rkm04 COMMAND --help shows an example of each command.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--version", action="version", version=f"rkm04, with the firmware {board.version()}",
        help="show the version and end",
    )  # fmt: skip
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_check(commands)
    _add_sim(commands)
    machine_options.add_arguments(commands, add_command)
    _add_compare(commands)
    _add_bench(commands)
    add_board(commands)
    _add_bringup(commands)
    _add_serve(commands)
    _add_service(commands)
    add_client_commands(partial(_add, commands))
    completion.add_command(commands, "rkm04", add_command)
    return parser


def add_command(
    commands: Commands,
    name: str,
    run: Run,
    title: str,
    example: str,
    *,
    has_json: bool = True,
) -> Parser:
    """Add a command with its example and the option that all with an answer have."""
    command = commands.add_parser(
        name,
        help=title,
        description=title[0].upper() + title[1:] + ".",
        epilog=f"example:\n  {example}\n\n{STATUSES}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    if has_json:
        command.add_argument("--json", action="store_true", help="print one JSON object")
    command.set_defaults(run=run)
    return command


_add = add_command


def _add_check(commands: Commands) -> None:
    title = "find every error in program files, and what is surely not meant"
    command = _add(commands, "check", check.run, title, "rkm04 check tools/examples/*.rks")
    command.add_argument(
        "files", nargs="+", metavar="FILE", help="a program file; -: standard input"
    )


def _add_sim(commands: Commands) -> None:
    title = "run programs on the simulated unit, in virtual time"
    example = (
        "rkm04 sim tools/examples/4-loop.rks --plot loop.svg\n"
        "  rkm04 sim --motor 1=a.rks --motor 2=b.rks --inputs inputs.csv --for 10"
    )
    command = _add(commands, "sim", _sim, title, f"{example}\n\n{SIM_NOTES.rstrip()}")
    command.add_argument(
        "file",
        nargs="?",
        metavar="FILE",
        help="the program of motor 1, or a machine file (.rkm); -: standard input",
    )
    options = [
        ("--motor", "N=FILE", "the program of motor N (1 to 4); may be repeated"),
        ("--inputs", "INPUTS", "what the inputs do over time; all are 0 at the start"),
        ("--for", "SECONDS", "end at this unit time at the latest (default: 60)"),
        ("--steps", "OUT.csv", "write the tick of every pulse"),
        ("--trace", "OUT.csv", "write moves, stops, outputs, waits and errors"),
        ("--vcd", "OUT.vcd", "write the waveforms for a viewer such as GTKWave"),
        ("--plot", "OUT", "draw speeds, positions and signals: a name ending in .svg or .png"),
    ]
    for flag, metavar, text in options:
        if flag == "--motor":
            command.add_argument(flag, metavar=metavar, help=text, action="append", default=[])
        elif flag == "--for":
            command.add_argument(flag, metavar=metavar, help=text, dest="seconds", default="60")
        else:
            command.add_argument(flag, metavar=metavar, help=text)
    command.add_argument(
        "--target",
        choices=["host", "stm32"],
        default="host",
        help="what runs the programs: the simulator, or the image of a board (default: host)",
    )


def _add_compare(commands: Commands) -> None:
    example = f"{compare_options.EXAMPLE}\n\n{compare_options.NOTES}"
    command = _add(commands, "compare", _compare, compare_options.TITLE, example)
    compare_options.add_arguments(command)


def _add_bringup(commands: Commands) -> None:
    example = f"{bringup_options.EXAMPLE}\n\n{bringup_options.NOTES}"
    command = _add(commands, "bringup", _bringup, bringup_options.TITLE, example)
    bringup_options.add_arguments(command)


def _add_serve(commands: Commands) -> None:
    title = "units without hardware: they run in real time and speak the line"
    serve.add_arguments(_add(commands, "serve", serve.run, title, serve.EXAMPLE))


def _add_service(commands: Commands) -> None:
    title = "the service program: a page in the browser to write, see and run programs"
    example = "rkm04 service\n  rkm04 service --port COM5 --node 3 --no-browser"
    example += "\n  rkm04 service --static build/page"
    command = _add(commands, "service", _service, title, f"{example}\n\n{SERVICE_NOTES}")
    command.add_argument("--port", metavar="PORT", help=f"connect there first; {PORT_HELP}")
    command.add_argument("--node", metavar="N", help=NODE_HELP)
    add_page_options(command, 8404)
    add_static_option(command)


def add_static_option(command: argparse.ArgumentParser) -> None:
    """The option of a service that writes pages instead."""
    command.add_argument(
        "--static", metavar="DIR",
        help="write the pages of all units into a folder instead, each as one file that needs no "
        "service: it checks, has a virtual unit, and reaches real ones where the browser can",
    )  # fmt: skip


def add_page_options(command: argparse.ArgumentParser, port: int) -> None:
    """The options of a service that concern its page."""
    command.add_argument(
        "--listen", metavar="N", type=int,
        help=f"the port of the page (default: {port}, or a free one if that is taken)",
    )  # fmt: skip
    command.add_argument(
        "--no-browser", dest="browser", action="store_false", help="only print the address"
    )


def _add_bench(commands: Commands) -> None:
    title = "measure accuracy and speed, and compare them with their goals"
    example = "rkm04 bench --json\n  rkm04 bench --target stm32 --profile listing.txt"
    command = _add(commands, "bench", _bench, title, f"{example}\n\n{BENCH_NOTES.rstrip()}")
    command.add_argument(
        "--target",
        choices=["host", "page", "stm32"],
        default="host",
        help="what is measured: the host build, the pages that need no service, or the image of a "
        "board (default: host)",
    )
    command.add_argument(
        "--profile",
        metavar="OUT",
        help="with --target stm32: only show where the cycles of a step interrupt go; OUT gets "
        "every instruction",
    )


BOOT0 = """\
dfu-util and stm32flash speak to the loader in the chip: reset the board with BOOT0 high, and take
that away afterwards. dfu-util often ends with 74 as the board leaves the loader; that counts as
done when the whole image had been written before. The size of the part's flash is read first;
stm32flash does not tell it. A board that one of the two cannot serve refuses it."""


def add_board(commands: Commands, unit: str = board.UNIT) -> None:
    """`board` of the tools of a unit."""
    title = "build, measure and flash the firmware of a board"
    other = board.names(unit)[-1]
    command = commands.add_parser(
        "board", help=title, description=f"{title[0].upper()}{title[1:]}.",
        epilog=f"example:\n  {unit} board build --board {other}\n"
        f"  {unit} board flash --dry-run\n\n"
        f"{unit} board ACTION --help shows an example of each action.",
        formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False,
    )  # fmt: skip
    actions = command.add_subparsers(metavar="ACTION", required=True)
    build = "build the image: .elf, .hex and .bin"
    parts = [
        _add(actions, "build", board.run_build, build, f"{unit} board build --board {other}"),
        _add(actions, "size", board.run_size, "flash, RAM and stack beside their budgets",
             f"{unit} board size --json"),
        _add(actions, "flash", board.run_flash, "build the image and write it into the board",
             f"{unit} board flash --tool dfu-util --dry-run"),
        _add(actions, "options", board_options.run,
             "show the option bytes of the part, and set its brown-out reset",
             f"{unit} board options --board {other}"),
        _add(actions, "pins", board_wiring.run, "which signal is on which pin, and how exact it is",
             f"{unit} board pins --board {other}"),
    ]  # fmt: skip
    for part in parts:
        part.add_argument("--board", metavar="NAME", default=board.DEFAULT_BOARD,
                          help=f"one of {', '.join(board.names(unit))}")  # fmt: skip
        part.set_defaults(image=unit, baud=None)
    for part in (parts[0], parts[2]):
        part.add_argument("--half-period", action="store_true",
                          help="STEP pulses of half a period, at most 10 us, where the next one is "
                               "known in time")  # fmt: skip
        if unit == board.UNIT:
            part.add_argument("--image", choices=board.IMAGES, default=board.UNIT,
                              help="that of the unit, or the one a new board is tried with "
                                   f"(default: {board.UNIT})")  # fmt: skip
        elif board.is_full_duplex(unit):
            part.add_argument("--baud", type=int, choices=board.RATES, default=board.line_bd(unit),
                              help="the rate of the line "
                                   f"(default: {board.line_bd(unit)})")  # fmt: skip
    board_options.add_arguments(parts[3])
    flash = parts[2]
    flash.epilog = f"{BOOT0}\n\n{flash.epilog}"
    flash.add_argument("--small", action="store_true",
                       help="a part of less than 1 MB will do: no stored programs")  # fmt: skip
    flash.add_argument("--tool", choices=sorted(board.FLASHERS), default="openocd")
    flash.add_argument("--probe", metavar="NAME", default="stlink",
                       help="openocd: its interface script")  # fmt: skip
    flash.add_argument("--port", metavar="DEVICE", help="stm32flash: the serial device")
    flash.add_argument("--dry-run", action="store_true", help="build, and show the command only")
