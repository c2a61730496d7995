"""`sim`: runs programs on the simulated unit, in virtual time, and says what happened."""

from __future__ import annotations

import json
import os
import re
import sys
from argparse import Namespace
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools import host, sim_board
from rkm04_tools.check import Checked, check_source, show
from rkm04_tools.failure import DONE, NOT_SO, Failure, reading_failed, writing_failed
from rkm04_tools.plot import draw, require_format
from rkm04_tools.record import read_record
from rkm04_tools.report import Run, summary
from rkm04_tools.signals import signals
from rkm04_tools.source import read_source

MOTORS = range(1, 5)
SECONDS_MAX = 100_000_000
"""More than the longest move takes at 1 step/s."""

NUMBER = re.compile(r"\d{1,9}(\.\d{1,9})?")


@dataclass(frozen=True)
class Outputs:
    """Where the files that were asked for go."""

    steps: Path | None
    trace: Path | None
    vcd: Path | None
    plot: Path | None

    @property
    def wanted(self) -> list[Path]:
        """Those that are wanted."""
        return [p for p in (self.steps, self.trace, self.vcd, self.plot) if p]


def run(options: Namespace) -> int:
    """Check the programs, run them, and report."""
    outputs = Outputs(*(_path(options, name) for name in ("steps", "trace", "vcd", "plot")))
    programs = _programs(options)
    inputs = _path(options, "inputs")
    _require_seconds(options.seconds)
    _require_inputs(inputs)
    _require_outputs(outputs, [*programs.values(), *([inputs] if inputs else [])])
    if options.target == "stm32":
        _require_board_has(outputs)
    checked = {motor: check_source(read_source(path)) for motor, path in programs.items()}
    if not _all_good(checked.values()):
        return NOT_SO
    with TemporaryDirectory(prefix="rkm04-") as folder:
        if options.target == "stm32":
            files = sim_board.Files(inputs, outputs.steps, outputs.vcd)
            return _on_board(checked, files, options, Path(folder))
        answer = _simulate(checked, inputs, options.seconds, outputs, Path(folder))
    return _report(answer, checked, options)


def _path(options: Namespace, name: str) -> Path | None:
    value: str | None = getattr(options, name)
    return None if value is None else Path(value)


def _programs(options: Namespace) -> dict[int, Path]:
    """Which program each motor runs."""
    given = [f"1={options.file}"] if options.file is not None else []
    programs: dict[int, Path] = {}
    for text in [*given, *options.motor]:
        number, equals, name = text.partition("=")
        if not equals or not name or number not in map(str, MOTORS):
            raise Failure(f"--motor {text}: write --motor N=FILE with N from 1 to 4")
        if int(number) in programs:
            raise Failure(f"motor {number} has two programs; give it one (FILE is for motor 1)")
        programs[int(number)] = Path(name)
    if not programs:
        raise Failure("no program to run; name a FILE, or --motor N=FILE")
    return dict(sorted(programs.items()))


def _require_seconds(text: str) -> None:
    if not NUMBER.fullmatch(text) or not 0 < float(text) <= SECONDS_MAX:
        raise Failure(f"--for {text}: write seconds, more than 0, at most {SECONDS_MAX}")


def _require_inputs(path: Path | None) -> None:
    """Refuse an inputs file that is not there; what is in it is for the simulator to judge."""
    if path is None:
        return
    try:
        with path.open("rb"):
            pass
    except OSError as error:
        raise reading_failed(path, error) from None


def _is_stream(path: Path) -> bool:
    """Whether a path names an open stream: that of the simulator would be another one."""
    return str(path).startswith(("/dev/std", "/dev/fd", "/proc/"))


def _require_outputs(outputs: Outputs, read: Sequence[Path]) -> None:
    """Refuse what cannot be written before anything runs."""
    if outputs.plot:
        require_format(outputs.plot)
    known = {path.resolve(): "is read by this very command" for path in read}
    for path in outputs.wanted:
        if path.is_dir():
            raise Failure(f"{path}: is a directory; name a file in it")
        if _is_stream(path):
            raise Failure(f"{path}: is a stream; name a file")
        if not path.parent.is_dir():
            raise Failure(f"{path}: there is no folder {path.parent}; make it first")
        if not os.access(path if path.exists() else path.parent, os.W_OK):
            raise writing_failed(path, PermissionError("permission denied"))
        if path.resolve() in known:
            raise Failure(f"{path}: {known[path.resolve()]}; choose another name")
        known[path.resolve()] = "is named for two outputs"


def _require_board_has(outputs: Outputs) -> None:
    """Refuse what only the simulator can tell."""
    for name, path in (("trace", outputs.trace), ("plot", outputs.plot)):
        if path:
            raise Failure(f"--{name}: not with --target stm32; leave one of the two away")


def _all_good(programs: Collection[Checked]) -> bool:
    """Show what there is to say about the programs on standard error."""
    for checked in {c.source.name: c for c in programs}.values():
        for diagnostic in checked.diagnostics:
            show(checked.source, diagnostic, sys.stderr)
    return all(checked.is_good for checked in programs)


def _simulate(
    programs: dict[int, Checked],
    inputs: Path | None,
    seconds: str,
    outputs: Outputs,
    folder: Path,
) -> dict[str, Any]:
    """Run the programs and write the files; return the simulator's summary."""
    steps, trace = outputs.steps, outputs.trace
    if outputs.plot:
        steps, trace = steps or folder / "steps.csv", trace or folder / "trace.csv"
    arguments = ["--for", seconds]
    for motor, checked in programs.items():
        program = folder / f"{motor}.rks"
        program.write_bytes(checked.source.message)
        arguments += ["--motor", f"{motor}={program}"]
    named = {"inputs": inputs, "steps": steps, "trace": trace, "vcd": outputs.vcd}
    for name, path in named.items():
        arguments += [f"--{name}", str(path)] if path else []
    try:
        answer = host.simulate(arguments)
    except BaseException:
        _remove_parts([path for path in (steps, trace, outputs.vcd) if path])
        raise
    if outputs.plot and steps and trace:
        record = read_record(steps, trace, inputs, answer["seconds"])
        commands = [c for checked in programs.values() for c in checked.parsed.commands]
        draw(record, _title(programs), signals(record, commands), outputs.plot)
    return answer


def _remove_parts(outputs: Sequence[Path]) -> None:
    """Remove what an interrupted simulator leaves of files that it had not finished."""
    for path in outputs:
        path.with_name(f"{path.name}.part").unlink(missing_ok=True)


def _title(programs: dict[int, Checked]) -> str:
    names = {motor: Path(checked.source.name).name for motor, checked in programs.items()}
    if list(names) == [1]:
        return names[1]
    return ", ".join(f"motor {motor}: {name}" for motor, name in names.items())


def _on_board(
    programs: dict[int, Checked], files: sim_board.Files, options: Namespace, folder: Path
) -> int:
    """Run the programs on the virtual board, and report."""
    simulated, answer = sim_board.simulate(programs, options.seconds, files, folder)
    runs = _runs(simulated, programs)
    if options.json:
        print(sim_board.as_json(simulated, answer, runs))
    else:
        print(sim_board.summary(answer, runs))
    return _status(runs)


def _report(answer: dict[str, Any], programs: dict[int, Checked], options: Namespace) -> int:
    """Show the summary; the exit status."""
    runs = _runs(answer, programs)
    if options.json:
        print(json.dumps({**answer, "motors": [each.as_json() for each in runs]}, indent=2))
    else:
        print(summary(answer, runs, options.seconds))
    return _status(runs)


def _runs(answer: dict[str, Any], programs: dict[int, Checked]) -> list[Run]:
    told = [motor for motor in answer["motors"] if motor["motor"] in programs]
    return [Run(motor, programs[motor["motor"]]) for motor in told]


def _status(runs: Sequence[Run]) -> int:
    """Show where a program has ended with an error; the exit status."""
    failed = [each for each in runs if each.error]
    for each in failed:
        each.show_error(sys.stderr)
    return NOT_SO if failed else DONE
