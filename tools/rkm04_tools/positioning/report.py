"""What was refused in a simulation and what READ has found, and the summary as a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from rkm04_tools.positioning.state import EXCEPTIONS, AxisState, error_text, feed_text, mm_text
from rkm04_tools.report import times
from rkm04_tools.table import table, thousands

HEAD = (
    "axis", "moves", "pulses", "position mm", "steps", "peak steps/s", "moving s", "at the end",
)  # fmt: skip
READ = "READ"
OF_STATE = {field.name for field in fields(AxisState)}


def state_of(told: Mapping[str, Any]) -> AxisState:
    """What the simulator tells of an axis."""
    return AxisState(**{name: value for name, value in told.items() if name in OF_STATE})


def is_refused(told: Mapping[str, Any]) -> bool:
    """Whether a line of the script was refused."""
    return bool(told["result"])


def has_failed(answer: Mapping[str, Any]) -> bool:
    """Whether an instruction was refused, or an axis has an error at the end."""
    return any(map(is_refused, answer["told"])) or any(axis["error"] for axis in answer["axes"])


def line_text(told: Mapping[str, Any]) -> str:
    """A line of the script, and what became of it."""
    if told["instruction"] == READ:
        state = state_of(told)
        speed = f" at {feed_text(state.speed)} mm/min" if state.moves else ""
        return f"axis {state.axis}: {mm_text(state.position_um)} mm{speed}, {state.words}"
    number = told["result"]
    if told["instruction"] == "SETTING":
        why = f"exception {number}: {EXCEPTIONS.get(number, 'not known')}"
        return f"error: SETTING was refused: {why}"
    return f"error: {told['instruction']} of axis {told['axis']} was refused: {error_text(number)}"


def summary(answer: Mapping[str, Any], limit: str) -> str:
    """The table of the axes, the times, and why the simulation ended."""
    rows = [_row(axis) for axis in answer["axes"]]
    lines = [table([HEAD, *rows], "rrrrrrrl"), "", times(answer), end_text(answer, limit)]
    if answer["late_steps"]:
        lines.append(f"{thousands(answer['late_steps'])} pulses came too late")
    return "\n".join([*lines, *lines_notes(answer)])


def _row(axis: Mapping[str, Any]) -> tuple[str, ...]:
    return (
        str(axis["axis"]),
        thousands(axis["moves"]),
        thousands(axis["pulses"]),
        mm_text(axis["position_um"]),
        thousands(axis["position_steps"]),
        f"{axis['peak_speed']:.1f}",
        f"{axis['seconds_moving']:.3f}",
        state_of(axis).words,
    )


def end_text(answer: Mapping[str, Any], limit: str) -> str:
    """Why it ended."""
    if answer["ended"] == "idle":
        return "ended because the script is over and the axes stand"
    return f"ended at the limit of {limit} s; --for SECONDS sets another one"


def lines_notes(answer: Mapping[str, Any]) -> list[str]:
    """What has become of lines that were not executed."""
    left = answer["lines"] - answer["executed"]
    if left <= 0:
        return []
    are = "line of the script was" if left == 1 else "lines of the script were"
    return [f"{thousands(left)} {are} not due"]
