"""`sim`: plays a vector file to the simulated unit, in virtual time, and says what happened."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools.failure import DONE, NOT_SO
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.check import Checked, check_source
from rkm04_tools.gve134.report import AXES, Answer, summary
from rkm04_tools.gve134.source import read_source
from rkm04_tools.gve134.xy import draw_path
from rkm04_tools.plot import draw
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
from rkm04_tools.sim_target import is_board
from rkm04_tools.source import Source, named

SHOWN_MAX = 50
OPEN = 1
"""The level of all inputs at the start."""


def run(options: Namespace) -> int:
    """Check the file, play it, and report."""
    outputs = Outputs(*(path_of(options, name) for name in ("steps", "trace", "vcd", "plot", "xy")))
    file, inputs = named(options.file), path_of(options, "inputs")
    require_seconds(options.seconds)
    require_inputs(inputs)
    require_outputs(outputs, [file, *([inputs] if inputs else [])])
    on_board = is_board(options)
    host.program_path()
    checked = check_source(read_source(str(file)))
    if checked.parsed.errors:
        checked.report(sys.stderr)
        return NOT_SO
    with TemporaryDirectory(prefix="gve134-") as name:
        folder = Path(name)
        inputs = plain(inputs, folder)
        if on_board:
            return _on_board(checked.source, inputs, outputs, options, folder)
        answer = _play(checked, inputs, outputs, options, folder)
    return _report(checked, answer, options)


def _on_board(
    source: Source, inputs: Path | None, outputs: Outputs, options: Namespace, folder: Path
) -> int:
    """Play the file to the image of a board, and report."""
    from rkm04_tools.gve134 import sim_board

    sim_board.require_possible(options, outputs, source)
    simulated, played = sim_board.simulate(source, inputs, outputs, options, folder)
    told = sim_board.course(played)
    if options.json:
        print(sim_board.as_json(source.name, simulated, played, options))
    else:
        _show_answers(source.name, told)
        print(sim_board.summary(simulated, played, options.seconds))
    return NOT_SO if told["refused"] else DONE


def _play(
    checked: Checked,
    inputs: Path | None,
    outputs: Outputs,
    options: Namespace,
    folder: Path,
) -> dict[str, Any]:
    """Play the file and write what was asked for; return the summary."""
    steps, trace = outputs.steps, outputs.trace
    if outputs.pictures:
        steps, trace = steps or folder / "steps.csv", trace or folder / "trace.csv"
    script = folder / "script.gve"
    script.write_text(checked.source.text, "utf-8", "surrogatepass", newline="")
    arguments = [str(script), "--for", options.seconds]
    arguments += ["--baud", options.baud] if options.baud is not None else []
    files = {"inputs": inputs, "steps": steps, "trace": trace, "vcd": outputs.vcd}
    for name, path in files.items():
        arguments += [f"--{name}", str(path)] if path else []
    try:
        answer = host.simulate(arguments, pipes(outputs))
    except BaseException:
        remove_parts([path for path in (steps, trace, outputs.vcd) if path])
        raise
    if steps and trace and outputs.pictures:
        _draw(checked.source, outputs, (steps, trace, inputs), answer["seconds"])
    return answer


def _draw(
    source: Source, outputs: Outputs, files: tuple[Path, Path, Path | None], seconds: float
) -> None:
    record = read_record(*files, seconds, turns=True)
    title = Path(source.name).name
    if outputs.plot:
        draw(record, title, signals(record, [], OPEN), outputs.plot, dict(enumerate(AXES, 1)))
    if outputs.xy:
        draw_path(record, title, outputs.xy)


def _report(checked: Checked, answer: dict[str, Any], options: Namespace) -> int:
    """Show what the unit has answered, and the summary; the exit status."""
    name = checked.source.name
    if options.json:
        print(json.dumps({"file": name, **answer}, indent=2))
    else:
        _show_answers(name, answer)
        print(summary(answer, options.seconds))
    return NOT_SO if answer["refused"] else DONE


def _show_answers(name: str, answer: dict[str, Any]) -> None:
    """Answers with values on standard output, refusals on standard error."""
    answers = [Answer(**each) for each in answer["answers"]]
    told = {stream: [a for a in answers if a.refused is (stream is sys.stderr)]
            for stream in (sys.stdout, sys.stderr)}  # fmt: skip
    for stream, own in told.items():
        for each in own[:SHOWN_MAX]:
            print(f"{name}:{each.line}: {each.text}", file=stream)
    more = sum(max(0, len(own) - SHOWN_MAX) for own in told.values()) + answer["answers_more"]
    if more:
        print(f"{name}: and {more} more answers; --json has them")
    if told[sys.stdout] or more:
        print()
