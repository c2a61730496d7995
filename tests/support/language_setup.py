"""What the settings of a program make of its moves, in the model of the language."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import accumulate

from language_text import Command
from reference import ENDLESS, Curve, Section, limit_run, plan

SECTIONS_MAX = 10
ERRORS = (
    "",
    "label not found",
    "E without L",
    "more than 8 nested loops",
    "more than 6 nested calls",
    ". without a call",
    "more than 10 sections",
    "change of direction inside a compound move",
    "Y without F or B",
)
"""By the numbers that the trace has for them."""


class Failed(Exception):
    """An error at run time, one of `ERRORS`."""


@dataclass(frozen=True)
class Order:
    """A move that is to be made: its sections, heading 1 or -1, and what ends it.

    `limit` is the input that ends a limit run, 0 in any other move; `marks` are the outputs that
    are set when the last section begins.
    """

    sections: tuple[Section, ...]
    start_speed: int
    heading: int
    limit: int = 0
    marks: tuple[int, ...] = ()

    @property
    def is_endless(self) -> bool:
        """Whether the move has no end of its own."""
        return self.sections[0].steps == ENDLESS

    @property
    def value(self) -> int:
        """What the trace tells of it when it begins."""
        steps = sum(section.steps for section in self.sections)
        return 0 if self.is_endless else self.heading * steps

    @property
    def curve(self) -> Curve:
        """The ideal curve."""
        if self.limit:
            return limit_run(self.start_speed)
        return plan(self.sections, self.start_speed)

    @property
    def last_begins(self) -> int:
        """The pulse at which the last section begins."""
        return sum(section.steps for section in self.sections[:-1])

    def rest(self, made: int) -> Order | None:
        """What is left when so many steps have been made; None: nothing.

        A last section that has begun does not set its outputs again.
        """
        if self.is_endless:
            return self
        ends = accumulate(section.steps for section in self.sections)
        left = [
            replace(section, steps=min(section.steps, end - made))
            for section, end in zip(self.sections, ends, strict=True)
            if end > made
        ]
        marks = self.marks if made <= self.last_begins else ()
        return replace(self, sections=tuple(left), marks=marks) if left else None


@dataclass
class Setup:
    """S, V, A, the steps that are set up, the compound move, T51 to T58; the start values."""

    start_speed: int = 100
    speed: int = 1000
    accel: int = 2000
    steps: int = 0
    heading: int = 1
    functions: set[int] = field(default_factory=set)
    table: list[Section] = field(default_factory=list)
    table_heading: int = 1
    table_marks: tuple[int, ...] = ()
    table_has_run: bool = False
    table_is_turned: bool = False

    def obey(self, command: Command) -> bool:
        """Take a command that only sets something up; whether it was one."""
        match command.letter:
            case "S":
                self.start_speed = command.number
            case "V":
                self.speed = command.number
            case "A":
                self.accel = command.number
            case "F" | "B":
                self._set_steps(command)
            case "D":
                self.heading = -self.heading
                self.table_is_turned = not self.table_is_turned
            case "Y":
                self._append()
            case "T" if 51 <= command.number <= 58:
                self.functions.add(command.number - 50)
            case "C" if 51 <= command.number <= 58:
                self.functions.discard(command.number - 50)
            case _:
                return False
        return True

    def order(self) -> Order | None:
        """The move that `R` makes; None: there is none."""
        if self.table:
            self.table_has_run = True
            heading = -self.table_heading if self.table_is_turned else self.table_heading
            marks = tuple(mark for mark in self.table_marks if mark in self.functions)
            return Order(tuple(self.table), self.start_speed, heading, 0, marks)
        return self.way(self.heading * self.steps)

    def way(self, steps: int) -> Order | None:
        """A single move of so many steps, negative ones backward."""
        if steps == 0:
            return None
        section = Section(abs(steps), self.speed, self.accel)
        return Order((section,), self.start_speed, 1 if steps > 0 else -1)

    def run(self, heading: int, limit: int = 0) -> Order:
        """A run without end, or up to an input."""
        section = Section(ENDLESS, self.speed, self.accel)
        return Order((section,), self.start_speed, heading, limit)

    def _set_steps(self, command: Command) -> None:
        self.steps = command.number
        self.heading = 1 if command.letter == "F" else -1
        if self.table_has_run:
            self.table, self.table_has_run = [], False

    def _append(self) -> None:
        if self.table_has_run:
            self.table, self.table_has_run = [], False
        if self.steps == 0:
            raise Failed("Y without F or B")
        if not self.table:
            self.table_heading, self.table_is_turned = self.heading, False
            self.table_marks = tuple(sorted(self.functions))
        elif self.table_is_turned or self.table_heading != self.heading:
            raise Failed("change of direction inside a compound move")
        if len(self.table) == SECTIONS_MAX:
            raise Failed("more than 10 sections")
        self.table.append(Section(self.steps, self.speed, self.accel))
