"""`bench`: the figures of the project against their goals, each measured here and now."""

from __future__ import annotations

import json
import subprocess
import sys
from argparse import Namespace
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any

from rkm04_tools import child, host
from rkm04_tools.bar import Bar
from rkm04_tools.failure import DONE
from rkm04_tools.table import rounded, table
from rkm04_tools.tree import ROOT

SCRIPTS = ROOT / "tests" / "support"
HEAD = ("figure", "measured", "goal", "unit", "met")


@dataclass(frozen=True)
class Row:
    """A figure; `measured` is None where it could not be measured, and `note` says why."""

    figure: str
    unit: str
    goal: float
    at_most: bool
    measured: float | None = None
    note: str = ""

    @property
    def met(self) -> bool | None:
        """Whether the goal is met; None where nothing was measured."""
        if self.measured is None:
            return None
        return self.measured <= self.goal if self.at_most else self.measured >= self.goal

    def cells(self) -> tuple[str, ...]:
        """For the table."""
        sign = "at most" if self.at_most else "at least"
        goal = f"{sign} {rounded(self.goal)}"
        if self.measured is None:
            return self.figure, "not measured", goal, self.unit, "-"
        met = "yes" if self.met else "no"
        return self.figure, rounded(self.measured), goal, self.unit, met


def run(options: Namespace) -> int:
    """Measure everything and print it."""
    rows: list[Row] = []
    parts: list[Callable[[], list[Row]]] = [_accuracy, _generator_and_simulation, _instructions]
    with Bar("measuring") as bar:
        for done, measured in enumerate(parts):
            bar.show(done, len(parts))
            rows += measured()
    if options.json:
        print(json.dumps({"figures": [{**asdict(row), "met": row.met} for row in rows]}, indent=2))
        return DONE
    print(table([HEAD, *(row.cells() for row in rows)], "lrrll"))
    for row in rows:
        if row.note:
            print(f"not measured: {row.figure}: {row.note}")
    return DONE


def _generator_and_simulation() -> list[Row]:
    told = host.measure()
    rows = []
    for move in told["generator"]:
        name = f"step generator here, {move['move']}"
        measured = move["pulses_per_second"] / 1e6
        rows.append(Row(name, "million pulses/s", 20, at_most=False, measured=measured))
    name = f"simulation, 4 motors, {told['simulation']['program']}"
    measured = told["simulation"]["ratio"]
    return [*rows, Row(name, "times real time", 100, at_most=False, measured=measured)]


def _accuracy() -> list[Row]:
    row = Row("worst deviation of a pulse", "ticks", 1, at_most=True)
    return [_from_script(row, "accuracy.py", lambda told: told["worst_ticks"])]


def _instructions() -> list[Row]:
    row = Row("next tick of a pulse on Cortex-M4", "instructions", 60, at_most=True)
    return [_from_script(row, "arm_count.py", lambda told: told["generator_worst_mean"])]


def _from_script(row: Row, name: str, figure: Callable[[dict[str, Any]], float]) -> Row:
    """Fill in a row by a script of tests/support, which may lack what it needs."""
    script = SCRIPTS / name
    if not script.is_file():
        return replace(row, note=f"{script} is not there")
    command = [sys.executable, str(script), "--json"]
    done = subprocess.run(
        command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
        preexec_fn=child.binder(),
    )  # fmt: skip
    try:
        if done.returncode == 0:
            return replace(row, measured=float(figure(json.loads(done.stdout))))
        note = done.stderr.strip().rpartition("\n")[2] or f"{name} failed"
    except (ValueError, KeyError, TypeError):
        note = f"{name} gave no figure"
    return replace(row, note=note)
