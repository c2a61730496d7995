"""The paths that a program can take from command to command.

A command is named by its index. A call steps to the command behind it if its subroutine can come to
an end; what a subroutine does in between belongs to the flow that starts at its label.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from rkm04_tools.host import Command

JUMPS = frozenset({"JUMP", "JUMP_IF_HIGH", "JUMP_IF_LOW"})
RUNS = frozenset({"RUN_FORWARD", "RUN_BACKWARD"})
GUARDS = frozenset({"GUARD_HIGH", "GUARD_LOW"})
WAITS = RUNS | {
    "MOVE",
    "GO_TO",
    "GO_HOME",
    "LIMIT_FORWARD",
    "LIMIT_BACKWARD",
    "WAIT",
    "WAIT_INPUT_HIGH",
    "WAIT_INPUT_LOW",
    "WAIT_VARIABLE_HIGH",
    "WAIT_VARIABLE_LOW",
}
"""Commands that take time, so that a loop with one of them is not busy."""

Successors = Callable[[int], Iterable[int]]


@dataclass(frozen=True)
class Flow:
    """The flow of the commands behind the last reset."""

    commands: Sequence[Command]

    @cached_property
    def labels(self) -> dict[int, int]:
        """Where each label stands; of several the last one counts."""
        return {c.value: i for i, c in enumerate(self.commands) if c.opcode == "LABEL"}

    @cached_property
    def calls(self) -> dict[int, list[int]]:
        """For each label that is called and exists, the calls."""
        found: dict[int, list[int]] = {}
        for i, command in enumerate(self.commands):
            if command.opcode == "CALL" and command.value in self.labels:
                found.setdefault(command.value, []).append(i)
        return found

    @cached_property
    def main(self) -> set[int]:
        """Commands that run outside any subroutine."""
        return self.reached([0] if self.commands else [])

    @cached_property
    def subroutines(self) -> dict[int, set[int]]:
        """For each subroutine that can be called, its label and the commands of its own flow."""
        found: dict[int, set[int]] = {}
        open_flows = [self.main]
        while open_flows:
            flow = open_flows.pop()
            for label in {self.commands[i].value for i in flow if i in self._call_indices}:
                if label not in found:
                    found[label] = self.reached([self.labels[label]])
                    open_flows.append(found[label])
        return found

    @cached_property
    def run(self) -> set[int]:
        """All commands that can ever run."""
        return self.main.union(*self.subroutines.values())

    def reached(self, starts: Iterable[int]) -> set[int]:
        """Everything on the paths from these commands, themselves included."""
        return _closure(starts, self.next)

    def next(self, index: int) -> Iterable[int]:
        """The commands that may run directly behind one, subroutines skipped."""
        command = self.commands[index]
        if command.opcode == "CALL" and command.value not in self._ending:
            return
        if command.opcode in JUMPS and command.value in self.labels:
            yield self.labels[command.value]
        if not self._ends_here(command) and index + 1 < len(self.commands):
            yield index + 1

    def next_inside(self, index: int) -> Iterable[int]:
        """The same, and a call leads into its subroutine too."""
        command = self.commands[index]
        if command.opcode == "CALL" and command.value in self.labels:
            yield self.labels[command.value]
        yield from self.next(index)

    def next_at_once(self, index: int) -> Iterable[int]:
        """The commands that may run behind one before any time has gone by."""
        command = self.commands[index]
        if command.opcode in WAITS:
            return
        if command.opcode != "CALL" or command.value in self._ending_at_once:
            yield from self.next(index)

    def _ends_here(self, command: Command) -> bool:
        """Whether the flow never goes on behind a command."""
        return command.opcode in ("JUMP", "RETURN") or (
            command.opcode in RUNS and not self._has_guards
        )

    @cached_property
    def _has_guards(self) -> bool:
        """Whether there is anything that ends a run without end and lets the program go on."""
        return any(command.opcode in GUARDS for command in self.commands)

    @cached_property
    def _call_indices(self) -> set[int]:
        return {i for calls in self.calls.values() for i in calls}

    @cached_property
    def _ending(self) -> set[int]:
        """Labels of subroutines from which some path leads to their end."""
        return self._labels_that_end(lambda command: True)

    @cached_property
    def _ending_at_once(self) -> set[int]:
        """Those from which such a path takes no time."""
        return self._labels_that_end(lambda command: command.opcode not in WAITS)

    def _labels_that_end(self, passes: Callable[[Command], bool]) -> set[int]:
        """Labels from which a path over commands that pass leads to the end of a subroutine.

        Found backward from the ends: whenever a subroutine turns out to end, its calls pass too.
        """
        before = self._predecessors(passes)
        ending: set[int] = set()
        seen: set[int] = set()
        todo = [i for i, c in enumerate(self.commands) if c.opcode == "RETURN"]
        while todo:
            index = todo.pop()
            if index in seen:
                continue
            seen.add(index)
            todo += [i for i in before[index] if self._call_passes(i, ending)]
            command = self.commands[index]
            if command.opcode == "LABEL" and self.labels[command.value] == index:
                ending.add(command.value)
                calls = self.calls.get(command.value, [])
                todo += [i for i in calls if i + 1 in seen]
        return ending

    def _call_passes(self, index: int, ending: set[int]) -> bool:
        command = self.commands[index]
        return command.opcode != "CALL" or command.value in ending

    def _predecessors(self, passes: Callable[[Command], bool]) -> list[list[int]]:
        """For each command, those that pass and may run directly before it; calls pass here."""
        before: list[list[int]] = [[] for _ in range(len(self.commands) + 1)]
        for i, command in enumerate(self.commands):
            if not passes(command):
                continue
            if command.opcode in JUMPS and command.value in self.labels:
                before[self.labels[command.value]].append(i)
            if not self._ends_here(command):
                before[i + 1].append(i)
        return before


def _closure(starts: Iterable[int], following: Successors) -> set[int]:
    seen: set[int] = set()
    todo = list(starts)
    while todo:
        index = todo.pop()
        if index not in seen:
            seen.add(index)
            todo += following(index)
    return seen
