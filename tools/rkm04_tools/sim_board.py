"""`sim --target stm32`: runs programs on the image of the reference board, on the virtual board.

The programs come by the line, as on a real board: each is held by `[` until all have come, then `]`
releases them. The simulator has run them before, which tells how long that takes, whether a
program is wrong, and how many pulses there should be.
"""

from __future__ import annotations

import codecs
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rkm04_tools import board, host, virtual_board
from rkm04_tools.check import Checked
from rkm04_tools.failure import Failure
from rkm04_tools.frame import Frame
from rkm04_tools.report import Run
from rkm04_tools.table import rounded, table, thousands

NODE = 1
READY_MS = 50.0
"""The unit listens by then."""
BYTE_MS = 10 / 19.2
ANSWER_MS = 40.0
"""Time for an answer to Set Command, and for the silence around it."""
AFTER_SECONDS = 0.1
"""How much longer than on the simulator the board runs."""
MESSAGE_BYTES_MAX = 8192
SET_COMMAND = b"\x02"
LATE = "stm32_late_steps"

CHANGE = re.compile(rb"\s*(\d+(?:\.\d+)?)\s*(,.*)", re.DOTALL)
HEAD = ("motor", "program", "pulses", "on the simulator", "forward less backward")


@dataclass(frozen=True)
class Files:
    """What is read and written."""

    inputs: Path | None
    steps: Path | None
    vcd: Path | None


def message(checked: Checked, alone: bool) -> bytes:
    """The text of a program; one that is not alone is held after its last reset."""
    text = checked.source.message
    resets = [c.offset for c in checked.parsed.commands if c.opcode == "RESET"]
    at = resets[-1] + 1 if resets else 0
    held = text if alone else text[:at] + b"[" + text[at:]
    if len(held) + 2 > MESSAGE_BYTES_MAX:
        raise Failure(f"{checked.source.name}: too long for one message to the board")
    return held


def line_script(programs: Mapping[int, Checked]) -> tuple[str, float]:
    """What the line sends, and the time in ms at which all of it has come."""
    alone = len(programs) == 1
    texts = [(motor, message(checked, alone)) for motor, checked in programs.items()]
    at, come, lines = READY_MS, 0.0, ""
    for motor, text in texts if alone else [*texts, (0, b"]")]:
        data = Frame(NODE, 0, SET_COMMAND + b"%d" % motor + text).encode()
        lines += f"{at:.3f} {data.hex()}\n"
        come = at + len(data) * BYTE_MS
        at = come + ANSWER_MS
    return lines, come


def later(inputs: bytes, by_ms: float) -> bytes:
    """An inputs file whose changes come later; those at 0 stay, being what the inputs are at."""
    lines = []
    inputs = inputs.removeprefix(codecs.BOM_UTF8)
    for line in inputs.splitlines(keepends=True):
        change = CHANGE.match(line)
        if change and float(change[1]) > 0:
            line = b"%.6f" % (float(change[1]) + by_ms) + change[2]
        lines.append(line)
    return b"".join(lines)


def simulate(
    programs: Mapping[int, Checked], seconds: str, files: Files, folder: Path
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Run the programs; what the simulator says of them, and what the virtual board does."""
    arguments = ["--for", seconds]
    for motor, checked in programs.items():
        program = folder / f"{motor}.rks"
        program.write_bytes(checked.source.message)
        arguments += ["--motor", f"{motor}={program}"]
    arguments += ["--inputs", str(files.inputs)] if files.inputs else []
    simulated = host.simulate(arguments)
    lines, begin_ms = line_script(programs)
    length = min(float(seconds), simulated["seconds"] + AFTER_SECONDS) + begin_ms / 1000
    answer = _run(lines, begin_ms, length, files, folder)
    return simulated, {**answer, "began_ms": begin_ms}


def _run(lines: str, begin_ms: float, length: float, files: Files, folder: Path) -> dict[str, Any]:
    program = virtual_board.program_path()
    image = board.build(board.DEFAULT_BOARD)
    pins, script, inputs = (folder / name for name in ("pins", "line", "inputs"))
    pins.write_text(virtual_board.board_pins(image.board))
    script.write_text(lines)
    arguments = ["--elf", str(image.file("elf")), "--pins", str(pins), "--for", f"{length:.6f}"]
    arguments += ["--line-script", str(script), "--watch", LATE]
    if files.inputs:
        inputs.write_bytes(later(files.inputs.read_bytes(), begin_ms))
        arguments += ["--inputs", str(inputs)]
    named = {"steps": files.steps, "vcd": files.vcd}
    for name, path in named.items():
        arguments += [f"--{name}", str(path)] if path else []
    return virtual_board.run(program, arguments)


def as_json(simulated: Mapping[str, Any], answer: Mapping[str, Any], runs: Sequence[Run]) -> str:
    """For scripts."""
    told = {run.told["motor"]: run for run in runs}
    motors = [
        {
            "motor": motor["motor"],
            "program": told[motor["motor"]].checked.source.name,
            "pulses": motor["pulses"],
            "pulses_simulated": told[motor["motor"]].told["pulses"],
            "position": motor["position"],
            "error": told[motor["motor"]].error,
        }
        for motor in answer["motors"]
        if motor["motor"] in told
    ]
    facts = {
        "target": "stm32",
        "board": board.DEFAULT_BOARD,
        "model": answer["model"],
        "began_ms": answer["began_ms"],
        "seconds": answer["microseconds"] / 1e6,
        "seconds_simulated": simulated["seconds"],
        "load": answer["load"],
        "late_steps": answer["watch"][LATE],
        "step_interrupt": step_interrupt(answer),
    }
    return json.dumps({**facts, "motors": motors}, indent=2)


def step_interrupt(answer: Mapping[str, Any]) -> dict[str, int]:
    """How often it ran, and its cycles."""
    vectors = [v for v in answer["vectors"] if v["name"] == "TIM2"]
    wanted = ("count", "min", "median", "max")
    return {name: vectors[0][name] if vectors else 0 for name in wanted}


def summary(answer: Mapping[str, Any], runs: Sequence[Run]) -> str:
    """The table of the motors, and what the board had to do for it."""
    board_motors = {motor["motor"]: motor for motor in answer["motors"]}
    rows = []
    for run in runs:
        motor = board_motors[run.told["motor"]]
        counts = (motor["pulses"], run.told["pulses"], motor["position"])
        rows.append((str(motor["motor"]), run.checked.source.name, *map(thousands, counts)))
    return "\n".join(
        [
            table([HEAD, *rows], "rlrrr"),
            "",
            f"the programs had come {answer['began_ms']:.3f} ms after power-on",
            *cost(answer),
        ]
    )


def cost(answer: Mapping[str, Any]) -> list[str]:
    """What the board had to do for it."""
    cycles = step_interrupt(answer)
    late = answer["watch"][LATE]
    return [
        f"load {rounded(100 * answer['load'])} %, late steps: {thousands(late)}",
        f"step interrupt: {thousands(cycles['count'])} times, cycles {cycles['min']} at least, "
        f"median {cycles['median']}, {cycles['max']} at most",
        virtual_board.MODEL,
    ]
