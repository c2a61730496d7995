"""Inputs, outputs and internal variables of a simulation as logic traces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rkm04_tools.host import Command
from rkm04_tools.record import Record

MARK_FIRST = 51
"""The function that sets output 1; that of output 8 follows seven later."""

OF_INPUTS = frozenset(
    {
        "WAIT_INPUT_HIGH",
        "WAIT_INPUT_LOW",
        "GUARD_HIGH",
        "GUARD_LOW",
        "TOTAL_STOP",
        "LIMIT_FORWARD",
        "LIMIT_BACKWARD",
    }
)
OF_OUTPUTS = frozenset({"SET_OUTPUT", "CLEAR_OUTPUT"})
OF_VARIABLES = frozenset(
    {"SET_VARIABLE", "CLEAR_VARIABLE", "WAIT_VARIABLE_HIGH", "WAIT_VARIABLE_LOW"}
)
CONDITIONAL = frozenset({"JUMP_IF_HIGH", "JUMP_IF_LOW"})
VARIABLE_FIRST = 80


@dataclass(frozen=True)
class Signal:
    """A logic trace: its name, its changes, seconds and level, and its level at the start."""

    name: str
    changes: list[tuple[float, int]]
    start: int = 0

    def corners(self, end: float) -> tuple[Sequence[float], Sequence[int]]:
        """Times and levels up to the end; each level holds until the next time."""
        shown = [change for change in self.changes if change[0] <= end]
        times, levels = zip((0.0, self.start), *shown, strict=True)
        return [*times, end], [*levels, levels[-1]]


def signals(record: Record, commands: Iterable[Command], inputs_at_start: int = 0) -> list[Signal]:
    """What changed in a simulation or is named by the commands, in the order of the numbers."""
    changes: dict[tuple[str, int], list[tuple[float, int]]] = {}
    for name in filter(None, map(_named, commands)):
        changes.setdefault(name, [])
    for ms, number, level in record.inputs:
        changes.setdefault(("BI", number), []).append((ms / 1000, level))
    for event in record.events:
        if event.name in ("out", "var"):
            value = int(event.value)
            name = ("BO" if event.name == "out" else "var", abs(value))
            changes.setdefault(name, []).append((event.tick / record.tick_hz, int(value > 0)))
    return [
        Signal(f"{kind} {number}", found, inputs_at_start if kind == "BI" else 0)
        for (kind, number), found in sorted(changes.items())
    ]


def _named(command: Command) -> tuple[str, int] | None:
    """The input, output or variable that a command names."""
    if command.opcode in CONDITIONAL:
        return ("var" if command.io >= VARIABLE_FIRST else "BI"), command.io
    if command.opcode in OF_INPUTS:
        return "BI", command.value
    if command.opcode in OF_OUTPUTS:
        return "BO", command.value
    if command.opcode in OF_VARIABLES:
        return "var", command.value
    if command.opcode == "FUNCTION_ON" and command.value >= MARK_FIRST:
        return "BO", command.value - MARK_FIRST + 1
    return None
