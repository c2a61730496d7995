"""What the unit has answered, and the summary of a simulation as a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rkm04_tools.gve134.answers import NOT_AFTER_STOP
from rkm04_tools.gve134.probing import WORDS
from rkm04_tools.report import numbers_of, times
from rkm04_tools.table import table, thousands

AXES = "XYZA"
HEAD = ("axis", "pulses", "position", "peak steps/s", "moving s")
INTA, CODE = 8, 7
MEANINGS = {
    2: "it did not come whole, or was damaged",
    3: "there is no such command",
    4: "wrong syntax",
    5: "a parameter is out of bounds",
    6: "there is nothing to go on with",
    7: "not while a vector runs",
    INTA + 7: NOT_AFTER_STOP,
}
NOT_FOUND = "the reference switch was not found, or not let go"
STUCK = {
    "no_answer": "has not been answered",
    "no_room": "was answered by 1 (no room) until the end",
    "time": "was not due",
}


@dataclass(frozen=True)
class Answer:
    """An answer that is told, and the command of the file; line 0: it was none to a command.

    `reason`: why a probing ends with it.
    """

    line: int
    address: int
    command: str
    ms: float
    answer: str
    refused: bool
    reason: str | None = None

    @property
    def text(self) -> str:
        """What was asked and answered, in words where it is a refusal."""
        if not self.refused:
            return f"{self.command}: {self.answer}"
        if self.reason is not None:
            return f"error: ;@probe: {WORDS[self.reason]}"
        code = self.answer[:1]
        digit = int(code, 16) if code and code in "0123456789ABCDEF" else -1
        why = (MEANINGS.get(digit) or MEANINGS.get(digit & CODE)) if digit >= 0 else None
        if self.command[:1] in "Ww" and digit == INTA + 5:
            why = NOT_FOUND
        return f"error: {self.command} was answered by {self.answer}: {why or 'no answer to it'}"


def summary(answer: Mapping[str, Any], limit: str) -> str:
    """The table of the axes, the times, and why the simulation ended."""
    rows = [_row(axis) for axis in answer["axes"]]
    counts, end = counts_text(answer), end_text(answer, limit)
    lines = [table([HEAD, *rows], "rrrrr"), "", counts, times(answer), end]
    return "\n".join([*lines, *lines_notes(answer), *_unit_notes(answer)])


def _row(axis: Mapping[str, Any]) -> Sequence[str]:
    return (
        axis["axis"],
        thousands(axis["pulses"]),
        thousands(axis["position"]),
        f"{axis['peak_speed']:.1f}",
        f"{axis['seconds_moving']:.3f}",
    )


def counts_text(answer: Mapping[str, Any]) -> str:
    """What the unit has taken."""
    text = f"{thousands(answer['commands'])} commands, {thousands(answer['vectors'])} vectors"
    if answer["repeats"]:
        text += f"; lines sent again until they were taken: {thousands(answer['repeats'])}"
    return text


def end_text(answer: Mapping[str, Any], limit: str) -> str:
    """Why it ended."""
    if answer["ended"] == "idle":
        return "ended because every line has been answered and the axes stand"
    return f"ended at the limit of {limit} s; --for SECONDS sets another one"


def lines_notes(answer: Mapping[str, Any]) -> list[str]:
    """What has become of lines that had no answer."""
    notes = []
    if stuck := answer["stuck"]:
        notes.append(f"line {stuck['line']}, {stuck['command']}, {STUCK[stuck['reason']]}")
    if answer["unanswered"]:
        notes.append(f"{thousands(answer['unanswered'])} commands had no answer because of J")
    return notes


def _unit_notes(answer: Mapping[str, Any]) -> list[str]:
    notes = []
    if answer["interrupted"] and answer["waiting"]:
        notes.append("the rest of the vectors waits for G")
    if answer["late_steps"]:
        notes.append(f"{thousands(answer['late_steps'])} pulses came too late")
    if answer["outputs"]:
        notes.append(f"outputs that are on: {', '.join(numbers_of(answer['outputs']))}")
    if answer["pwm"]:
        notes.append(f"spindle at {answer['pwm'] / 10:g} %")
    return notes
