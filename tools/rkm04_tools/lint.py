"""Warnings: what the unit accepts and runs, but what is surely not meant.

Each rule looks at the commands behind the last reset and yields what it finds. What depends on the
course of the program is judged by its flow; what a rule cannot know for sure it leaves alone.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass, field

from rkm04_tools.flow import JUMPS, WAITS, Flow
from rkm04_tools.host import Command

LOOPS_MAX = 8
CALLS_MAX = 6
SECTIONS_MAX = 10
COMMANDS_MAX = 700
STEPS = ("STEPS_FORWARD", "STEPS_BACKWARD")
ALONE = ("HALT", "RESUME")
TAKES_TIME = WAITS | {"HOLD"}
MARKS = range(51, 59)
"""Functions that set an output when the last section of a compound move begins."""
SIMULATION = 41


@dataclass(frozen=True)
class Remark:
    """Something suspicious at the character `offset` of the text; `rule` is its short name."""

    offset: int
    rule: str
    message: str


def lint(commands: Sequence[Command]) -> list[Remark]:
    """Return all warnings about a program that has no errors, in the order of the text."""
    if not commands:
        return [Remark(0, "empty", "there is no command in this file")]
    start = _start(commands)
    found = list(_lost(commands, start))
    flow = Flow(commands[start:])
    for rule in RULES:
        found += rule(flow)
    return sorted(found, key=lambda remark: remark.offset)


def stored(commands: Sequence[Command]) -> list[Command]:
    """The commands that program memory keeps of a text, in the order of their ordinals from 1."""
    return [c for c in commands[_start(commands) :] if c.opcode not in ALONE]


def _start(commands: Sequence[Command]) -> int:
    """Index of the command behind the last reset."""
    resets = (i for i, c in enumerate(commands) if c.opcode == "RESET")
    return max(resets, default=-1) + 1


def _lost(commands: Sequence[Command], start: int) -> Iterator[Remark]:
    if start > 1 and any(c.opcode != "RESET" for c in commands[: start - 1]):
        offset = commands[start - 1].offset
        yield Remark(offset, "lost", "\\ clears all that stands before it; nothing of it runs")


def _labels(flow: Flow) -> Iterator[Remark]:
    seen: set[int] = set()
    for command in flow.commands:
        if command.opcode == "LABEL":
            if command.value in seen:
                text = f"label {command.value} is defined again; only its last place counts"
                yield Remark(command.offset, "duplicate-label", text)
            seen.add(command.value)
        elif (command.opcode in JUMPS or command.opcode == "CALL") and (
            command.value not in flow.labels
        ):
            text = f"there is no label {command.value} (@{command.value}) in this file"
            yield Remark(command.offset, "missing-label", text)


def _loops(flow: Flow) -> Iterator[Remark]:
    opened: list[Command] = []
    for command in flow.commands:
        if command.opcode == "LOOP":
            opened.append(command)
            if len(opened) == LOOPS_MAX + 1:
                text = f"this loop is nested too deeply; at most {LOOPS_MAX} can be open"
                yield Remark(command.offset, "loop-depth", text)
        elif command.opcode == "LOOP_END":
            if not opened:
                yield Remark(command.offset, "loop-end", "E without an L before it")
            else:
                opened.pop()
    for command in opened:
        yield Remark(command.offset, "loop-open", f"{command.text} without an E behind it")


def _returned_loops(flow: Flow) -> Iterator[Remark]:
    """Find loops of subroutines that only a `.` ends."""
    for index in sorted(flow.run - flow.main):
        command = flow.commands[index]
        if command.opcode == "LOOP":
            after = {flow.commands[i].opcode for i in flow.reached(flow.next_inside(index))}
            if "RETURN" in after and "LOOP_END" not in after:
                text = f"the . after it closes {command.text}; an E after the call is not its own"
                yield Remark(command.offset, "loop-returned", text)


def _calls(flow: Flow) -> Iterator[Remark]:
    """Find calls that can be more than six deep, recursion among them."""
    depths = dict.fromkeys(flow.subroutines, 0)
    level = _called(flow, flow.main)
    for depth in range(1, CALLS_MAX + 2):
        depths.update(dict.fromkeys(level, depth))
        level = set[int]().union(*(_called(flow, flow.subroutines[label]) for label in level))
    too_deep = [label for label, depth in depths.items() if depth > CALLS_MAX]
    if too_deep:
        first = min(flow.calls[label][0] for label in too_deep)
        text = f"calls can become more than {CALLS_MAX} deep here"
        yield Remark(flow.commands[first].offset, "call-depth", text)


def _called(flow: Flow, indices: set[int]) -> set[int]:
    """Labels that are called by these commands."""
    return {label for label, calls in flow.calls.items() if not indices.isdisjoint(calls)}


def _returns(flow: Flow) -> Iterator[Remark]:
    for index in sorted(flow.main):
        command = flow.commands[index]
        if command.opcode == "RETURN":
            text = "the program comes to this . without a call"
            yield Remark(command.offset, "return", text)


def _unreachable(flow: Flow) -> Iterator[Remark]:
    """Find stretches that never run. A ] releases without being run."""
    dead_before = False
    for index, command in enumerate(flow.commands):
        dead = index not in flow.run and command.opcode != "RELEASE"
        if dead and not dead_before:
            text = f"{command.text} is never reached"
            yield Remark(command.offset, "unreachable", text)
        dead_before = dead


def _busy_loops(flow: Flow) -> Iterator[Remark]:
    reported: set[int] = set()
    for label, start in sorted(flow.labels.items(), key=lambda item: item[1]):
        cycle = _cycle_at_once(flow, start) if start in flow.run else []
        if not cycle or not reported.isdisjoint(cycle):
            continue
        reported.update(cycle)
        back = flow.commands[cycle[-1]]
        text = f"the loop from here back to label {label} never waits, the program is busy"
        polls = any(flow.commands[i].opcode in JUMPS - {"JUMP"} for i in cycle)
        advice = "wait for an input with O or Z, or pause with W" if polls else "pause with W"
        yield Remark(back.offset, "busy-loop", f"{text}; {advice}")


def _cycle_at_once(flow: Flow, start: int) -> list[int]:
    """A shortest way from a command back to itself that takes no time; empty if there is none."""
    came_from: dict[int, int] = {}
    todo = deque([start])
    while todo:
        index = todo.popleft()
        for following in flow.next_at_once(index):
            if following == start:
                return _way(came_from, index, start)
            if following not in came_from:
                came_from[following] = index
                todo.append(following)
    return []


def _way(came_from: dict[int, int], index: int, start: int) -> list[int]:
    way = [index]
    while way[-1] != start:
        way.append(came_from[way[-1]])
    return way[::-1]


def _speeds(flow: Flow) -> Iterator[Remark]:
    """Find a maximum speed below the start/stop speed when a move, or the end, comes."""
    speeds: dict[str, Command] = {}
    reported: set[tuple[int, int]] = set()
    moves = ("MOVE", "APPEND_SECTION", "GO_TO", "GO_HOME", "RUN_FORWARD", "RUN_BACKWARD")
    for command in [*flow.commands, None]:
        if command and command.opcode in ("SPEED", "START_SPEED"):
            speeds[command.opcode] = command
        elif (command is None or command.opcode in moves) and len(speeds) == 2:
            slow, start = speeds["SPEED"], speeds["START_SPEED"]
            pair = (slow.offset, start.offset)
            if slow.value < start.value and pair not in reported:
                reported.add(pair)
                text = f"{slow.text} is below {start.text}; the move runs at {slow.text} throughout"
                yield Remark(max(pair), "speed", text)


def _no_steps(flow: Flow) -> Iterator[Remark]:
    """Find the first R and Y to which no way leads from any F or B."""
    reached = _with_steps(flow, [i for i, c in enumerate(flow.commands) if c.opcode in STEPS])
    effects = {"MOVE": "R before any F or B does nothing", "APPEND_SECTION": "Y before any F or B"}
    for index in sorted(flow.run - reached):
        command = flow.commands[index]
        if command.opcode in effects:
            yield Remark(command.offset, "no-steps", effects.pop(command.opcode))


def _with_steps(flow: Flow, sources: list[int]) -> set[int]:
    """Commands that can run behind one of the sources, in and behind subroutines too."""
    reached: set[int] = set()
    todo = list(sources)
    while todo:
        index = todo.pop()
        if index in reached:
            continue
        reached.add(index)
        todo += flow.next_inside(index)
        if flow.commands[index].opcode == "RETURN":
            todo += _behind_calls(flow, index)
    return reached


def _behind_calls(flow: Flow, end: int) -> Iterator[int]:
    """Where the end of a subroutine may lead."""
    for label, own in flow.subroutines.items():
        if end in own:
            yield from (i + 1 for i in flow.calls[label] if i + 1 < len(flow.commands))


def _total_stops(flow: Flow) -> Iterator[Remark]:
    """Find an X after which the program only comes to rest."""
    if not any(command.opcode in TAKES_TIME for command in flow.commands):
        return
    for index, command in enumerate(flow.commands):
        if command.opcode == "TOTAL_STOP" and index in flow.run:
            after = {flow.commands[i].opcode for i in _with_steps(flow, [index])}
            if after.isdisjoint(TAKES_TIME):
                text = f"{command.text} does nothing while the motor rests; put it before the moves"
                yield Remark(command.offset, "total-stop", text)


def _simulation(flow: Flow) -> Iterator[Remark]:
    switches = [c for c in flow.commands if _is_switch(c, [SIMULATION])]
    if len(switches) == len(flow.commands):
        return
    for command in switches:
        text = (
            f"{command.text} inside a program switches the outputs at once, "
            "and every motor of the unit where it next stands"
        )
        yield Remark(command.offset, "simulation", text)


def _is_switch(command: Command, functions: Container[int]) -> bool:
    return command.opcode.startswith("FUNCTION_") and command.value in functions


def _ignored(flow: Flow) -> Iterator[Remark]:
    if len(flow.commands) == 1:
        return
    for command in flow.commands:
        if command.opcode in ALONE:
            text = f"{command.text} inside a program is ignored; it must be sent alone"
            yield Remark(command.offset, "ignored", text)


def _too_many(flow: Flow) -> Iterator[Remark]:
    kept = stored(flow.commands)
    if len(kept) > COMMANDS_MAX:
        text = (
            f"program memory holds {COMMANDS_MAX} commands; from here on the oldest ones are lost"
        )
        yield Remark(kept[COMMANDS_MAX].offset, "too-many", text)


@dataclass
class _Compound:
    """What a reader of the text knows of the compound move that is being set up."""

    backward: bool = False
    sections: int = 0
    done: bool = False
    direction: bool = False
    on: set[int] = field(default_factory=set)
    off: dict[int, Command] = field(default_factory=dict)
    """Functions that are on; and those that were on at the first Y and are not any more."""

    def append(self) -> None:
        """Do a Y."""
        if self.done or self.sections == 0:
            self.sections, self.done, self.direction = 0, False, self.backward
            self.off = {}
        self.sections += 1

    def switch(self, command: Command) -> None:
        """Do a T51 to T58 or C51 to C58."""
        if command.opcode == "FUNCTION_ON":
            self.on.add(command.value)
            self.off.pop(command.value, None)
        elif command.value in self.on:
            self.on.discard(command.value)
            if self.sections > 0:
                self.off[command.value] = command

    def run(self) -> Iterator[Command]:
        """Do an R; what was switched off before it."""
        self.done = self.sections > 0
        if self.done:
            yield from self.off.values()
            self.off = {}

    def forget_if_done(self) -> None:
        """Do an F or B."""
        if self.done:
            self.sections, self.done = 0, False


def _compounds(flow: Flow) -> Iterator[Remark]:
    state = _Compound()
    for command in flow.commands:
        if command.opcode in STEPS:
            state.backward = command.opcode == "STEPS_BACKWARD"
            state.forget_if_done()
        elif command.opcode == "REVERSE":
            state.backward = not state.backward
        elif command.opcode == "MOVE":
            for off in state.run():
                text = f"{off.text} stands before an R of this compound move; its output is not set"
                yield Remark(off.offset, "mark-off", text)
        elif command.opcode == "APPEND_SECTION":
            state.append()
            yield from _section(command, state)
        elif _is_switch(command, MARKS):
            if _is_late_mark(command, state):
                text = (
                    f"{command.text} does not act on this compound move; put it before the first Y"
                )
                yield Remark(command.offset, "mark", text)
            state.switch(command)


def _is_late_mark(command: Command, state: _Compound) -> bool:
    is_on = command.opcode == "FUNCTION_ON" and command.value not in state.off
    return is_on and state.sections > 0 and not state.done


def _section(command: Command, state: _Compound) -> Iterator[Remark]:
    if state.backward != state.direction:
        text = "the direction changes inside a compound move"
        yield Remark(command.offset, "direction", text)
    if state.sections == SECTIONS_MAX + 1:
        text = f"a compound move has at most {SECTIONS_MAX} sections"
        yield Remark(command.offset, "sections", text)


RULES = (
    _labels,
    _loops,
    _returned_loops,
    _calls,
    _returns,
    _unreachable,
    _busy_loops,
    _speeds,
    _no_steps,
    _total_stops,
    _simulation,
    _ignored,
    _too_many,
    _compounds,
)
