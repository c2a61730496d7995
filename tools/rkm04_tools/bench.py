"""`bench`: the figures of the project against their goals, each measured here and now."""

from __future__ import annotations

import json
import subprocess
import sys
from argparse import Namespace
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
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
    if options.target == "page":
        parts = [_page]
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


PAGE = {
    "gzipped_kb": Row("the largest page, gzipped", "kB", 400, at_most=True),
    "first_curve_seconds": Row("from opening to the first curve", "s", 1.5, at_most=True),
    "check_ms": Row("check of 700 commands while typing", "ms", 50, at_most=True),
    "simulation_ms": Row("4 motors x 60 s at 16 000 steps/s, curves", "ms", 300, at_most=True),
    "real_time": Row(
        "unit in the page, 4 x 16 000 steps/s", "times real time", 0.99, at_most=False
    ),
    "late_steps": Row("... late steps", "steps", 0, at_most=True),
    "load_percent": Row("... load of a core", "%", 50, at_most=True),
    "wheel_mb": Row("the largest wheel of build/wheels", "MB", 15, at_most=True),
}


def _page() -> list[Row]:
    """The pages that need no service, all by one script; without wheels one figure is missing."""
    script = SCRIPTS / "page_figures.py"
    if not script.is_file():
        return [replace(row, note=f"{script} is not there") for row in PAGE.values()]
    told, note = _told(script)
    rows = []
    for name, row in PAGE.items():
        if isinstance(told, dict) and isinstance(told.get(name), int | float):
            rows.append(replace(row, measured=float(told[name])))
        else:
            missing = "tools/wheels builds it" if name == "wheel_mb" else f"{script.name} gave none"
            rows.append(replace(row, note=note or missing))
    return rows


def _told(script: Path) -> tuple[Any, str]:
    """What a script has measured, or why it has not."""
    command = [sys.executable, str(script), "--json"]
    done = subprocess.run(
        command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
        preexec_fn=child.binder(),
    )  # fmt: skip
    if done.returncode != 0:
        return None, done.stderr.strip().rpartition("\n")[2] or f"{script.name} failed"
    try:
        return json.loads(done.stdout), ""
    except ValueError:
        return None, f"{script.name} gave no figure"


def _from_script(row: Row, name: str, figure: Callable[[dict[str, Any]], float]) -> Row:
    """Fill in a row by a script of tests/support, which may lack what it needs."""
    script = SCRIPTS / name
    if not script.is_file():
        return replace(row, note=f"{script} is not there")
    told, note = _told(script)
    if note:
        return replace(row, note=note)
    try:
        return replace(row, measured=float(figure(told)))
    except (ValueError, KeyError, TypeError):
        return replace(row, note=f"{name} gave no figure")
