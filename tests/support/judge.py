"""The judge of a simulated run: what must hold of every edge log, whatever ran.

In: the pulses of a run (`read_steps`) and its events (`read_trace`). Out: a list of
violations, each a sentence; an empty one for a lawful run. The judge itself is the
program rkm04-judge (judge/judge.h), here by its files. From them it knows no program
and no plan, so it can say only what holds for all of them:

- pulses lie inside moves, each move makes as many as its `done` says, in its
  direction, and the position follows them one by one;
- a move that was not stopped reaches its target;
- no two pulses of a motor stand closer than the top speed allows, none further apart
  inside a move than the lowest speed does;
- a move begins and ends at no more than the greatest start/stop speed, and between
  the speed changes no faster than the greatest acceleration lets it.

Whether each pulse stands at its exact tick is for the exact reference to say.
"""

from __future__ import annotations

import csv
import os
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Ticks = NDArray[np.int64]

STEPS_HEADER = "tick,motor,position"
TRACE_HEADER = "tick,motor,event,value"
RATE_PREFIX = "# tick_hz="
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Steps:
    """The pulses of a run, sorted by tick.

    `tick` counts from the start of the simulation at `tick_hz` per second, `motor` is
    1 to 4, `position` the absolute position after the pulse. One entry per pulse.
    """

    tick_hz: int
    tick: Ticks
    motor: Ticks
    position: Ticks


@dataclass(frozen=True)
class Event:
    """One line of the trace; `value` is kept as text. Motor 0 is the whole unit."""

    tick: int
    motor: int
    event: str
    value: str


@dataclass(frozen=True)
class Limits:
    """The greatest values a run may use; as they stand, those of the language.

    Speeds in steps/s, `accel` in steps/s². `slack` is the rounding, in ticks, allowed
    to an interval: one tick for the pulse at each end.
    """

    slowest: int = 1
    start_speed: int = 2_000
    speed: int = 16_000
    accel: int = 60_000
    slack: int = 2


def read_steps(path: Path | str) -> Steps:
    """Read a steps file: rate, header, then tick, motor and position of each pulse."""
    with Path(path).open(encoding="utf-8") as lines:
        rate = lines.readline().rstrip("\n")
        header = lines.readline().rstrip("\n")
        if not rate.startswith(RATE_PREFIX) or header != STEPS_HEADER:
            raise ValueError(f"{path}: not a steps file: {rate!r}, {header!r}")
        rows = [[int(cell) for cell in row] for row in csv.reader(lines)]
    table = np.array(rows, dtype=np.int64).reshape(-1, 3)
    columns = (np.ascontiguousarray(table[:, column]) for column in range(3))
    return Steps(int(rate.removeprefix(RATE_PREFIX)), *columns)


def read_trace(path: Path | str) -> list[Event]:
    """Read a trace file: header, then tick, motor, event and value of each event."""
    with Path(path).open(encoding="utf-8", newline="") as lines:
        rows = csv.reader(lines)
        header = ",".join(next(rows, []))
        if header != TRACE_HEADER:
            raise ValueError(f"{path}: not a trace file: {header!r}")
        return [Event(int(t), int(m), event, value) for t, m, event, value in rows]


def judge(
    steps: Steps,
    trace: Sequence[Event],
    limits: Limits | None = None,
    *,
    counter_set: bool = False,
) -> list[str]:
    """Return what a run violates, as sentences; none for a lawful run.

    `counter_set` says that the program writes the position counter, so that the
    position may jump between moves and need not start at 0.
    """
    with tempfile.TemporaryDirectory() as folder:
        steps_file, trace_file = Path(folder) / "steps.csv", Path(folder) / "trace.csv"
        _write_steps(steps_file, steps)
        _write_trace(trace_file, trace)
        return judge_files(steps_file, trace_file, limits, counter_set=counter_set)


def judge_files(
    steps: Path,
    trace: Path | None = None,
    limits: Limits | None = None,
    *,
    counter_set: bool = False,
) -> list[str]:
    """Do the same with files; without a trace only what holds for pulses of any kind is judged."""
    limits = limits or Limits()
    options = {"--start-speed": limits.start_speed, "--speed": limits.speed}
    options |= {"--accel": limits.accel, "--slowest": limits.slowest, "--slack": limits.slack}
    command = [str(_program()), str(steps), *([str(trace)] if trace else [])]
    command += [str(cell) for pair in options.items() for cell in pair]
    command += ["--counter-set"] if counter_set else []
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    if done.returncode not in (0, 1):
        raise ValueError(done.stderr)
    return done.stdout.splitlines()


def _program() -> Path:
    build = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
    return build / "bin" / "rkm04-judge"


def _write_steps(path: Path, steps: Steps) -> None:
    table = np.column_stack((steps.tick, steps.motor, steps.position))
    header = f"{RATE_PREFIX}{steps.tick_hz}\n{STEPS_HEADER}"
    np.savetxt(path, table, fmt="%d", delimiter=",", header=header, comments="")


def _write_trace(path: Path, trace: Sequence[Event]) -> None:
    lines = [f"{e.tick},{e.motor},{e.event},{e.value}" for e in trace]
    path.write_text("\n".join([TRACE_HEADER, *lines, ""]), encoding="utf-8")
