"""A program of any length: fed to a motor as its memory gets free.

The memory is a ring, and what has run may be overwritten. So the unit is asked again and again
which command it runs, and gets no more than fits in front of that. What a loop comes back to, and
what waits for a `]` further on, is kept until it is after. Jumps and calls are refused: a label
that has been overwritten, or has not come yet, would end the program.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from rkm04_tools.check import Checked
from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.host import Command, stored
from rkm04_tools.line import Motor
from rkm04_tools.line_errors import UnitRefused, UnknownMessage
from rkm04_tools.messages import ALL_MOTORS
from rkm04_tools.sending import COMMANDS_MAX, Plan, Sent, Tell, placed
from rkm04_tools.source import Source
from rkm04_tools.status import MotorStatus

PART_BYTES_MAX = 200
"""A tenth of a second on the line: a K need not wait for longer."""
PART_COMMANDS_MAX = PART_BYTES_MAX
"""Of a letter each."""
SPAN_MAX = 600
"""Commands from the beginning to the end of a loop: the rest of the memory feeds on."""
POLL_SECONDS = 0.05
LOCK = 40
"""The function with which a full memory ignores what comes."""
JUMPS = frozenset({"JUMP", "JUMP_IF_HIGH", "JUMP_IF_LOW"})

Say = Callable[[str], None]


def stream_program(motor: Motor, checked: Checked, tell: Tell, say: Say) -> Sent:
    """Feed a program without errors; return when all of it is in the memory.

    `tell` is told how many commands are sent, `say` what a person should know meanwhile.
    """
    if motor.number == ALL_MOTORS or motor.unit.node == BROADCAST:
        raise Failure("--stream feeds one motor of one unit; name them with --motor and --node")
    commands = stored(checked.parsed.commands)
    source = checked.source
    if not any(command.opcode == "RESET" for command in checked.parsed.commands):
        raise Failure(
            f"{source.name}: --stream begins with an empty memory; begin it with \\", NOT_SO
        )
    feeder = Feeder(motor, Plan(checked, commands, notes=()), _spans(source, commands), say)
    with motor.unit.line.one_session(motor.unit.node):
        return feeder.feed(tell)


def _spans(source: Source, commands: Sequence[Command]) -> list[tuple[int, int]]:
    """First and last ordinal of what must be in the memory together, from 1."""
    spans: list[tuple[int, int]] = []
    loops: list[int] = []
    holds: list[int] = []
    for ordinal, command in enumerate(commands, 1):
        if command.opcode in JUMPS or command.opcode == "CALL":
            raise _refused(source, command, "jumps and calls need their label in the memory")
        if command.opcode == "FUNCTION_ON" and command.value == LOCK:
            raise _refused(source, command, "with it a full memory ignores what comes")
        if command.opcode == "LOOP":
            loops.append(ordinal)
        elif command.opcode == "LOOP_END" and loops:
            spans.append((loops.pop(), ordinal))
        elif command.opcode == "HOLD":
            holds.append(ordinal)
        elif command.opcode == "RELEASE":
            spans += [(hold, ordinal) for hold in holds]
            holds.clear()
    for first, last in spans:
        if last - first >= SPAN_MAX:
            text = f"it has more than {SPAN_MAX} commands up to its end"
            raise _refused(source, commands[first - 1], text)
    return spans


def _refused(source: Source, command: Command, why: str) -> Failure:
    place = source.place(command.offset)
    where = f"{source.name}:{place.line}:{place.column}"
    return Failure(f"{where}: {command.text} cannot be streamed: {why}; nothing was sent", NOT_SO)


class Feeder:
    """Feeds one motor. `sent` counts the commands that it has got."""

    def __init__(
        self, motor: Motor, plan: Plan, spans: Sequence[tuple[int, int]], say: Say
    ) -> None:
        self._motor = motor
        self._plan = plan
        self._spans = spans
        self._say = say
        self._stopped = False
        self.sent = 0

    def feed(self, tell: Tell) -> Sent:
        """Feed all."""
        total, messages = len(self._plan.commands), 0
        self._require_unlocked()
        while self.sent < total or not messages:
            tell(self.sent, total)
            room = self._room() if messages else COMMANDS_MAX
            if not room:
                time.sleep(POLL_SECONDS)
                continue
            self._send(self._part(room), is_first=not messages)
            messages += 1
        tell(total, total)
        return Sent(total, messages, overflow=False, notes=())

    def _part(self, room: int) -> list[Command]:
        """The next commands that fit."""
        part: list[Command] = []
        size = 0
        for command in self._plan.commands[self.sent : self.sent + room]:
            size += len(command.text)
            if size > PART_BYTES_MAX:
                break
            part.append(command)
        return part

    def _send(self, part: Sequence[Command], is_first: bool) -> None:
        text = ("\\" if is_first else "") + "".join(command.text for command in part)
        if [command.opcode for command in part] == ["SPEED"]:
            text = f"K{text}"  # V alone would act at once; K inside a message does nothing
        try:
            self._motor.command(text)
        except UnitRefused as refusal:
            raise placed(refusal, self._plan) from None
        self.sent += len(part)

    def _room(self) -> int:
        """How many commands may be written now."""
        place = self._motor.progress().command
        state = self._state()
        if state and state.at_rest:
            return COMMANDS_MAX
        place = max(place, 1)
        needed = min([first for first, last in self._spans if first <= place <= last] + [place])
        return max(0, COMMANDS_MAX - (self.sent - needed + 1))

    def _state(self) -> MotorStatus | None:
        """What the motor does, None if the unit cannot tell; the end of its program is raised."""
        try:
            state = self._motor.unit.status().motors[self._motor.number - 1]
        except UnknownMessage:
            return None
        if state.failed or state.ended:
            raise Failure(f"motor {state.motor} {state.text}", NOT_SO)
        if state.stopped and not self._stopped:
            self._say(f"motor {state.motor} is stopped by K and goes on at rkm04 resume")
        self._stopped = state.stopped
        return state

    def _require_unlocked(self) -> None:
        try:
            if not self._motor.unit.status().memory_locked:
                return
        except UnknownMessage:
            return
        raise Failure("T40 is on: a full memory ignores what comes; send C40 first", NOT_SO)
