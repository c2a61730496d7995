"""The table of `bench --target stm32`, of the tools of every unit: figures beside their goals.

Every figure is made twice on the virtual board: with three cycles to refill the pipeline (P = 3),
which goals and budgets are held against, and with two, which is nearer to published figures.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rkm04_tools import board_size
from rkm04_tools.board import UNIT
from rkm04_tools.table import rounded, table
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_run import BESIDE, GATE, Model

NOTE = "modelled on the virtual board, flash with 5 wait states; nothing was measured on hardware"
HEAD = ("figure", GATE.name, BESIDE.name, "goal", "unit", "met")
STACK = "stack_used"


@dataclass(frozen=True)
class Goal:
    """A figure that is told: its key, what it is, and what it should be."""

    key: str
    title: str
    unit: str
    goal: float | None = None
    at_most: bool = True
    budget: str = ""
    """Its name in hal/stm32/budgets.json; tools/test holds it there."""


SIZES = [
    Goal("stack", "stack that is proved to be enough", "bytes", budget="stack_bytes"),
    Goal("flash", "flash", "bytes", budget="flash_bytes"),
    Goal("ram", "RAM, the stack included", "bytes", budget="ram_bytes"),
]


@dataclass(frozen=True)
class Row:
    """A figure with both models; `beside` is None where the model plays no part."""

    key: str
    figure: str
    unit: str
    measured: float
    beside: float | None
    goal: float | None
    at_most: bool
    budget: float | None

    @property
    def met(self) -> bool | None:
        """Whether goal and budget are met; None where there is neither."""
        if self.goal is None and self.budget is None:
            return None
        limits = [limit for limit in (self.goal, self.budget) if limit is not None]
        if self.at_most:
            return all(self.measured <= limit for limit in limits)
        return all(self.measured >= limit for limit in limits)

    def cells(self) -> tuple[str, ...]:
        """For the table."""
        sign = "at most" if self.at_most else "at least"
        limit = self.goal if self.goal is not None else self.budget
        goal = "" if limit is None else f"{sign} {rounded(limit)}"
        beside = "" if self.beside is None else rounded(self.beside)
        return self.figure, rounded(self.measured), beside, goal, self.unit, yes_no(self.met)


def yes_no(met: bool | None) -> str:
    """For a table; nothing where there is no goal."""
    return "" if met is None else "yes" if met else "no"


def budgets(unit: str = UNIT) -> dict[str, float]:
    """The budgets of hal/stm32/budgets.json by their names."""
    found = json.loads(board_size.BUDGETS.read_text())
    found |= found.get(unit, {})
    return {name: float(value) for name, value in found.items() if not isinstance(value, dict)}


def rows_of(
    goals: Sequence[Goal],
    figures: Mapping[Model, Figures],
    sizes: Mapping[str, int],
    unit: str = UNIT,
) -> list[Row]:
    """All figures in the order of the table."""
    limits = budgets(unit)

    def row(goal: Goal, measured: float, beside: float | None) -> Row:
        budget = limits[goal.budget] if goal.budget else None
        ends = (goal.goal, goal.at_most, budget)
        return Row(goal.key, goal.title, goal.unit, measured, beside, *ends)

    made = [row(goal, figures[GATE][goal.key], figures[BESIDE][goal.key]) for goal in goals]
    return made + [row(goal, sizes[goal.key], None) for goal in SIZES]


def rows_table(rows: Sequence[Row]) -> str:
    """For people."""
    return table([HEAD, *(row.cells() for row in rows)], "lrrrll")


def merge(figures: Figures, more: Figures) -> None:
    """Take in more figures; of the stacks the deepest counts."""
    deepest = max(figures.get(STACK, 0), more.get(STACK, 0))
    figures.update(more)
    figures[STACK] = deepest
