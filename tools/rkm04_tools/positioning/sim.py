"""`sim`: plays a script to the simulated unit, in virtual time, and says what happened."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.plot import draw
from rkm04_tools.positioning import host
from rkm04_tools.positioning.check import checked
from rkm04_tools.positioning.report import has_failed, is_refused, line_text, summary
from rkm04_tools.positioning.source import read_source
from rkm04_tools.record import read_record
from rkm04_tools.signals import signals
from rkm04_tools.sim_files import (
    Outputs,
    path_of,
    pipes,
    plain,
    remove_parts,
    require_inputs,
    require_outputs,
    require_seconds,
)
from rkm04_tools.sim_target import TARGET, is_board, require_no
from rkm04_tools.source import Source, named

SHOWN_MAX = 50
AXES = {number: f"axis {number}" for number in range(1, 5)}


def run(options: Namespace) -> int:
    """Read the script, play it, and report."""
    outputs = Outputs(*(path_of(options, name) for name in ("steps", "trace", "vcd", "plot")))
    file, inputs = named(options.file), path_of(options, "inputs")
    require_seconds(options.seconds)
    require_inputs(inputs)
    require_outputs(outputs, [file, *([inputs] if inputs else [])])
    on_board = _is_on_board(options, outputs)
    host.program_path()
    source = read_source(options.file)
    with TemporaryDirectory(prefix="positioning-") as folder:
        script, _ = checked(source, Path(folder))
        inputs = plain(inputs, Path(folder))
        if on_board:
            return _on_board(source, script, inputs, outputs, options)
        answer = _play(source, script, inputs, outputs, options.seconds)
    return _report(source.name, answer, options)


def _is_on_board(options: Namespace, outputs: Outputs) -> bool:
    """Whether the image of a board is meant; refuse what goes with one of the two only."""
    if is_board(options):
        require_no({"trace": outputs.trace, "plot": outputs.plot})
        return True
    if options.baud is not None:
        raise Failure(f"--baud needs {TARGET}")
    return False


def _on_board(
    source: Source, script: Path, inputs: Path | None, outputs: Outputs, options: Namespace
) -> int:
    """Play the script to the image of a board, and report."""
    from rkm04_tools.positioning import sim_board

    simulated, played = sim_board.simulate(source, script, inputs, outputs, options)
    told = sim_board.course(simulated, played)
    if options.json:
        print(sim_board.as_json(source.name, simulated, played, options))
    else:
        _show_lines(source.name, told)
        print(sim_board.summary(simulated, played, options.seconds))
    return NOT_SO if has_failed(told) else DONE


def _play(
    source: Source, script: Path, inputs: Path | None, outputs: Outputs, seconds: str
) -> dict[str, Any]:
    """Play the script and write what was asked for; return the summary."""
    steps, trace = outputs.steps, outputs.trace
    if outputs.plot:
        steps = steps or script.with_name("steps.csv")
        trace = trace or script.with_name("trace.csv")
    arguments = [str(script), "--for", seconds]
    files = {"inputs": inputs, "steps": steps, "trace": trace, "vcd": outputs.vcd}
    for name, path in files.items():
        arguments += [f"--{name}", str(path)] if path else []
    try:
        answer = host.simulate(arguments, pipes(outputs))
    except BaseException:
        remove_parts([path for path in (steps, trace, outputs.vcd) if path])
        raise
    if steps and trace and outputs.plot:
        record = read_record(steps, trace, inputs, answer["seconds"], turns=True)
        draw(record, Path(source.name).name, signals(record, []), outputs.plot, AXES)
    return answer


def _report(name: str, answer: dict[str, Any], options: Namespace) -> int:
    """Show what was refused and read, and the summary; the exit status."""
    if options.json:
        print(json.dumps({"file": name, **answer}, indent=2))
    else:
        _show_lines(name, answer)
        print(summary(answer, options.seconds))
    return NOT_SO if has_failed(answer) else DONE


def _show_lines(name: str, answer: dict[str, Any]) -> None:
    """What READ has found on standard output, refusals on standard error."""
    for each in answer["told"][:SHOWN_MAX]:
        stream = sys.stderr if is_refused(each) else sys.stdout
        print(f"{name}:{each['line']}: {line_text(each)}", file=stream)
    if (more := len(answer["told"]) - SHOWN_MAX) > 0:
        print(f"{name}: and {more} more; --json has them")
