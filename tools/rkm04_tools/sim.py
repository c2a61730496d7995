"""`sim`: runs programs on the simulated unit, in virtual time, and says what happened."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools import host, sim_board
from rkm04_tools.check import Checked, check_source, show_all
from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.machine.simulation import Simulated, is_machine, read_simulated
from rkm04_tools.plot import draw
from rkm04_tools.record import read_record
from rkm04_tools.report import Run, summary
from rkm04_tools.signals import signals
from rkm04_tools.sim_files import (
    Outputs,
    path_of,
    pipes,
    plain,
    remove_parts,
    require_inputs,
    require_outputs,
    require_plain,
    require_seconds,
)
from rkm04_tools.source import is_standard_input, named, read_source
from rkm04_tools.tree import require_checkout

MOTORS = range(1, 5)


def run(options: Namespace) -> int:
    """Check the programs, run them, and report."""
    outputs = Outputs(*(path_of(options, name) for name in ("steps", "trace", "vcd", "plot")))
    is_of_machine = is_machine(options.file)
    programs = {} if is_of_machine else _programs(options)
    inputs = path_of(options, "inputs")
    require_seconds(options.seconds)
    require_inputs(inputs)
    read = [named(options.file)] if is_of_machine else [*programs.values()]
    require_outputs(outputs, [*read, *([inputs] if inputs else [])])
    if options.target == "stm32":
        require_checkout("--target stm32")
        _require_board_has(outputs)
    if is_of_machine:
        machine = read_simulated(options)
        return _run_machine(machine, inputs, outputs, options) if machine else NOT_SO
    checked = {motor: check_source(read_source(path)) for motor, path in programs.items()}
    if not _all_good(checked.values()):
        return NOT_SO
    with TemporaryDirectory(prefix="rkm04-") as folder:
        return _run(checked, inputs, outputs, options, Path(folder))


def _run_machine(
    machine: Simulated, inputs: Path | None, outputs: Outputs, options: Namespace
) -> int:
    """Run the programs of a machine with its inputs, unless others are named; see its limits."""
    with TemporaryDirectory(prefix="rkm04-") as name:
        folder = Path(name)
        inputs = inputs or machine.inputs(folder)
        if not machine.has_limits:
            return _run(machine.programs, inputs, outputs, options, folder)
        steps = outputs.steps or folder / "limits.csv"
        require_plain(steps, "the limits of the machine are looked for in it")
        status = _run(machine.programs, inputs, replace(outputs, steps=steps), options, folder)
        return max(status, machine.judge(steps))


def _run(
    checked: dict[int, Checked],
    inputs: Path | None,
    outputs: Outputs,
    options: Namespace,
    folder: Path,
) -> int:
    """Run programs without errors, and report."""
    inputs = plain(inputs, folder)
    if options.target == "stm32":
        files = sim_board.Files(inputs, outputs.steps, outputs.vcd)
        return _on_board(checked, files, options, folder)
    answer = _simulate(checked, inputs, options.seconds, outputs, folder)
    return _report(answer, checked, options)


def _programs(options: Namespace) -> dict[int, Path]:
    """Which program each motor runs."""
    given = [f"1={named(options.file)}"] if options.file is not None else []
    programs: dict[int, Path] = {}
    for text in [*given, *options.motor]:
        number, equals, name = text.partition("=")
        if not equals or not name or number not in map(str, MOTORS):
            raise Failure(f"--motor {text}: write --motor N=FILE with N from 1 to 4")
        if int(number) in programs:
            raise Failure(f"motor {number} has two programs; give it one (FILE is for motor 1)")
        programs[int(number)] = named(name)
    if not programs:
        raise Failure("no program to run; name a FILE, or --motor N=FILE")
    if sum(map(is_standard_input, programs.values())) > 1:
        raise Failure("- is for one motor only: standard input is one program")
    return dict(sorted(programs.items()))


def _require_board_has(outputs: Outputs) -> None:
    """Refuse what only the simulator can tell."""
    for name, path in (("trace", outputs.trace), ("plot", outputs.plot)):
        if path:
            raise Failure(f"--{name}: not with --target stm32; leave one of the two away")


def _all_good(programs: Collection[Checked]) -> bool:
    """Show what there is to say about the programs on standard error."""
    for checked in {c.source.name: c for c in programs}.values():
        show_all(checked, sys.stderr)
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
        answer = host.simulate(arguments, pipes(outputs))
    except BaseException:
        remove_parts([path for path in (steps, trace, outputs.vcd) if path])
        raise
    if outputs.plot and steps and trace:
        record = read_record(steps, trace, inputs, answer["seconds"])
        commands = [c for checked in programs.values() for c in checked.parsed.commands]
        draw(record, _title(programs), signals(record, commands), outputs.plot)
    return answer


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
