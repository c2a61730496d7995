"""The summary of a simulation as a table, and where in its file each program has come to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TextIO

from rkm04_tools.check import Checked, Diagnostic, show
from rkm04_tools.host import Command, stored
from rkm04_tools.source import Place
from rkm04_tools.table import rounded, table, thousands

HEAD = ("motor", "program", "moves", "pulses", "position", "peak steps/s", "moving s", "at the end")
STATES = {
    "idle": "done",
    "held": "held, waits for ]",
    "stopped": "stopped by K",
    "ended": "stopped by X",
    "failed": "error",
}
"""States in which only a message makes the program go on, in words."""


@dataclass(frozen=True)
class Run:
    """What the simulator says of a motor, and the program it ran."""

    told: Mapping[str, Any]
    checked: Checked

    @property
    def error(self) -> str:
        """Why the program has ended with an error; empty if it has not."""
        return str(self.told["error"] or "")

    @cached_property
    def command(self) -> Command | None:
        """The command that is being run or was run last."""
        commands = stored(self.checked.parsed.commands)
        ordinal = int(self.told["place"])
        return commands[ordinal - 1] if 0 < ordinal <= len(commands) else None

    @property
    def place(self) -> Place | None:
        """Where it stands in the file."""
        return self.checked.source.place(self.command.offset) if self.command else None

    @property
    def state(self) -> str:
        """What the program does at the end of the simulation, in words."""
        state = str(self.told["state"])
        if state in STATES or not (self.command and self.place):
            return STATES.get(state, state)
        return f"at {self.command.text}, line {self.place.line}"

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        where = {"line": self.place.line, "column": self.place.column} if self.place else {}
        return {**self.told, "program": self.checked.source.name, **where}

    def show_error(self, stream: TextIO) -> None:
        """Print the error with its place."""
        what = f"motor {self.told['motor']}: {self.error}"
        diagnostic = Diagnostic(self.place or Place(1, 1), "error", "run", what)
        show(self.checked.source, diagnostic, stream)


def summary(answer: Mapping[str, Any], runs: Sequence[Run], limit: str) -> str:
    """The table of the motors, the times, and why the simulation ended."""
    notes = [
        f"motor {r.told['motor']}: program memory was full" for r in runs if r.told["overflow"]
    ]
    if answer["late_steps"]:
        notes.append(f"{thousands(answer['late_steps'])} pulses came too late")
    if answer["outputs"]:
        notes.append(f"outputs that are on: {', '.join(numbers_of(answer['outputs']))}")
    lines = [table([HEAD, *map(_row, runs)], "rlrrrrrl"), "", times(answer), _end(answer, limit)]
    return "\n".join([*lines, *notes])


def _row(run: Run) -> tuple[str, ...]:
    told = run.told
    return (
        str(told["motor"]),
        run.checked.source.name,
        thousands(told["moves"]),
        thousands(told["pulses"]),
        thousands(told["position"]),
        f"{told['peak_speed']:.1f}",
        f"{told['seconds_moving']:.3f}",
        run.state,
    )


def numbers_of(levels: int) -> list[str]:
    """The numbers of the outputs that are 1."""
    return [str(bit + 1) for bit in range(levels.bit_length()) if levels >> bit & 1]


def times(answer: Mapping[str, Any]) -> str:
    """Unit time and real time of a simulation."""
    unit, real = answer["seconds"], answer["real_seconds"]
    ratio = f": {rounded(answer['ratio'])} times faster than real time" if unit else ""
    return f"unit time {unit:.6f} s, real time {real:.6f} s{ratio}"


def _end(answer: Mapping[str, Any], limit: str) -> str:
    if answer["ended"] == "idle":
        return "ended because every program has come to rest"
    return f"ended at the limit of {limit} s; --for SECONDS sets another one"
