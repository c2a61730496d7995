"""Plays sessions to the positioning unit, simulated on the host."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from pos_model import Done
from pos_session import Act, Sample, Session, Setting
from pos_words import AXES, MS

ROOT = Path(__file__).resolve().parents[2]
NAMES = {
    "status": "STATUS",
    "error": "ERROR",
    "flags": "FLAGS",
    "captures": "CAPTURES",
    "position_um": "POSITION",
    "way_left_um": "WAY_LEFT",
    "speed": "SPEED",
    "position_steps": "POSITION_STEPS",
    "captured_steps": "CAPTURED_STEPS",
}
"""What the simulator calls the registers."""


def program() -> Path:
    """The simulator."""
    return Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host") / "bin/positioning-host"


def run_session(session: Session, *, epoch: int = 0) -> tuple[Session, Done]:
    """What the unit does in a session; each instruction is at the tick when the unit has taken it.

    So that this is known, registers are read after every instruction.
    """
    reads = {(each.tick, each.axis) for each in session.script}
    session = replace(session, reads=tuple(sorted({*session.reads, *reads})))
    with tempfile.TemporaryDirectory() as folder:
        script, inputs, steps = (Path(folder) / name for name in ("script", "inputs", "steps"))
        script.write_text(session.csv, encoding="utf-8")
        inputs.write_text(session.inputs_csv, encoding="utf-8")
        command = [str(program()), "sim", str(script), "--inputs", str(inputs)]
        command += ["--steps", str(steps), "--for", f"{session.end / MS / 1000:.6f}"]
        command += ["--epoch", str(epoch)]
        result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        if result.returncode:
            raise AssertionError(result.stderr)
        done = Done()
        _read_steps(done, steps)
        return _read_told(done, session, json.loads(result.stdout)["told"]), done


def _read_steps(done: Done, path: Path) -> None:
    places = dict.fromkeys(AXES, 0)
    for row in path.read_text(encoding="utf-8").splitlines()[2:]:
        tick, motor, place = map(int, row.split(","))
        train = done.trains[motor - 1]
        train.ticks.append(tick)
        train.signs.append(place - places[motor])
        places[motor] = place


def _read_told(done: Done, session: Session, told: list[dict[str, Any]]) -> Session:
    lines = session.lines
    at: dict[tuple[int, int], int] = {}
    results: dict[tuple[int, int], int] = {}
    for each in told:
        line = lines[each["line"] - 1]
        if isinstance(line, tuple):
            at[line] = each["tick"]
            values = {register: each[name] for name, register in NAMES.items()}
            done.samples.append(Sample(each["tick"], each["axis"], values))
        else:
            results[each["line"] - 1, line.tick] = each["result"]
    script: list[Act | Setting] = []
    for index, line in enumerate(lines):
        if isinstance(line, tuple):
            continue
        if isinstance(line, Act):
            done.results[len(script)] = results.get((index, line.tick), 0)
        script.append(replace(line, tick=at.get((line.tick, line.axis), line.tick)))
    return replace(session, script=tuple(script))
