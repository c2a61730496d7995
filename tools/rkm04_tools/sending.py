"""How a program goes to a motor: which messages, in which order, so that none of it runs too early.

Programs go in canonical form, cut at borders of commands. What needs several messages must not run
before all of it has arrived. So `[` goes before it and `]` after. Where that would change the
program, because it has brackets of its own (one `]` releases every `[`) or leaves no room for two
more, the motor is reset, held by `[`, and stopped by K; `]` is the first command after that, and
C75 follows the last message. (K alone does nothing to a motor at rest.)

K, C75 and V that are the whole text go as they are: alone in a message each acts at once.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from enum import Enum
from itertools import takewhile
from typing import TYPE_CHECKING

from rkm04_tools.check import Checked, check_source
from rkm04_tools.doubt import undisturbed
from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.host import Command, check, stored
from rkm04_tools.line_errors import UnitRefused, UnitRestarted, UnknownMessage
from rkm04_tools.messages import ALL_MOTORS, MOTORS
from rkm04_tools.source import Source

if TYPE_CHECKING:
    from rkm04_tools.line import Motor, Unit

FRAME_BYTES_MAX = 1024
ENVELOPE_BYTES_MAX = 2 + 1 + 2 + 2 + 4
"""Flags, address, number, message number and motor, FCS; number and FCS may be escaped."""
TEXT_BYTES_MAX = FRAME_BYTES_MAX - ENVELOPE_BYTES_MAX
COMMANDS_MAX = 700
STAND_SECONDS = 30.0
POLL_SECONDS = 0.05

SENT_BY = {"HALT": "rkm04 stop", "RESUME": "rkm04 resume"}
"""What sends the commands that act only alone in a message."""
BRACKETS = ("HOLD", "RELEASE")

Tell = Callable[[int, int], None]
"""Is told how many of how many parts are done."""


def silent(done: int, total: int) -> None:
    """Tell nobody."""


class Hold(Enum):
    """What keeps the parts of a program from running before the last one."""

    NOTHING = "nothing"
    BRACKETS = "brackets"
    STOP = "stop"


@dataclass(frozen=True)
class Plan:
    """The messages of a program, and what is to be said about them."""

    checked: Checked
    commands: Sequence[Command]
    """What is stored, without what the plan adds."""
    hold: Hold = Hold.NOTHING
    texts: Sequence[str] = ()
    notes: Sequence[str] = ()
    resets: bool = False
    """Whether the memory is emptied first."""

    @property
    def plain(self) -> list[str]:
        """The commands in canonical form."""
        return [command.text for command in self.commands]

    def is_held(self, held: Sequence[str]) -> bool:
        """Whether these commands of a memory are the program, with or without added brackets."""
        return without_hold(held) == without_hold(self.plain)


@dataclass(frozen=True)
class Sent:
    """What has been sent. `overflow`: the program memory was full, and commands were lost."""

    commands: int
    messages: int
    overflow: bool
    notes: Sequence[str]


def check_program(text: str, name: str = "the program") -> Checked:
    """Check a text; the first error is raised with its place."""
    checked = check_source(Source(name, text))
    if not checked.is_good:
        first = checked.diagnostics[0]
        place = f"{name}:{first.place.line}:{first.place.column}"
        raise Failure(f"{place}: {first.message}; nothing was sent", NOT_SO)
    return checked


def without_hold(held: Sequence[str]) -> list[str]:
    """The commands of a memory without the brackets that sending has added."""
    leading = list(takewhile(lambda command: command in ("[", "]"), held))
    if "]" in leading:
        return list(held[len(leading) - leading[::-1].index("]") :])
    inside = held[1:-1]
    wrapped = held[:1] == ["["] and held[-1] == "]" and not {"[", "]"}.intersection(inside)
    return list(inside) if wrapped else list(held)


def plan_program(checked: Checked) -> Plan:
    """Choose the messages for a program without errors."""
    alone = checked.parsed.commands
    if len(alone) == 1 and alone[0].opcode in SENT_BY:
        return Plan(checked, [], Hold.NOTHING, [alone[0].text], [])
    before, reset, after = _at_last_reset(checked.parsed.commands)
    left_out = [command for command in after if command.opcode in SENT_BY]
    commands = stored(checked.parsed.commands)
    notes = [_left_out_note(checked.source, command) for command in left_out]
    if before:
        notes.append(f"{len(before)} of its commands stand before \\ and would never run: not sent")
    start = ["\\"] if reset else []
    tokens = [command.text for command in commands]
    if not start and not tokens:
        raise Failure(f"{checked.source.name}: there is nothing in it to be sent", NOT_SO)
    if len(tokens) > COMMANDS_MAX:
        raise Failure(
            f"{checked.source.name}: has {len(tokens)} commands, and the memory holds "
            f"{COMMANDS_MAX}; nothing was sent; rkm04 send --stream feeds them as memory gets free",
            NOT_SO,
        )
    if left_out and len(tokens) == 1 and not reset:
        start = ["K"]  # inside a message it does nothing, but V alone would be a change of speed
    if _length([*start, *tokens]) <= TEXT_BYTES_MAX:
        return Plan(checked, commands, Hold.NOTHING, ["".join([*start, *tokens])], notes, reset)
    hold = _hold(checked.source, commands, reset)
    tokens = [*start, "[", *tokens, "]"] if hold is Hold.BRACKETS else ["]", *tokens]
    return Plan(checked, commands, hold, pack(tokens), notes, reset)


def held_commands(motor: Motor) -> list[str]:
    """The commands in the memory of a motor, in canonical form."""
    parsed = check(motor.program())
    if not parsed.is_good:
        raise Failure(
            f"motor {motor.number} of unit {motor.unit.node} holds a program that this tool does "
            "not understand; does the unit have other software?",
            NOT_SO,
        )
    return [command.text for command in parsed.commands]


def send_program(motor: Motor, checked: Checked, tell: Tell = silent) -> Sent:
    """Send a program without errors, which runs when all of it has arrived."""
    with motor.unit.line.one_session(motor.unit.node):
        return _send_plan(motor, plan_program(checked), tell)


def _send_plan(motor: Motor, plan: Plan, tell: Tell) -> Sent:
    # A unit that misses the first of them, with its [, runs the others as they come.
    if motor.unit.node == BROADCAST and len(plan.texts) > 1:
        raise Failure(
            f"{plan.checked.source.name}: cannot go to all units at once, as it needs several "
            "messages and leaves no way to hold it; send it to each unit",
            NOT_SO,
        )
    require_room(motor, plan)
    if plan.hold is not Hold.STOP:
        return send_texts(motor, plan, tell)
    _require_holdable(motor, plan)
    tell(0, len(plan.texts))
    with _whole_or_forgotten(motor):
        _halt(motor)
        sent = send_texts(motor, plan, tell)
    motor.resume()
    return sent


def load_program(motor: Motor, checked: Checked) -> Sent:
    """Put a program without errors into the memory, in place of the one there, and run nothing.

    The motor is stopped as by K: `resume` makes it run.
    """
    plan = plan_program(checked)
    plan = replace(plan, hold=Hold.STOP, texts=pack(["]", *plan.plain]))
    _require_holdable(motor, plan)
    with motor.unit.line.one_session(motor.unit.node), _whole_or_forgotten(motor):
        _halt(motor)
        return send_texts(motor, plan, silent)


def send_texts(motor: Motor, plan: Plan, tell: Tell) -> Sent:
    """Send all texts, inside a one_session."""
    overflow = False
    for done, text in enumerate(plan.texts):
        tell(done, len(plan.texts))
        try:
            overflow = motor.command(text) or overflow
        except UnitRefused as refusal:
            raise placed(refusal, plan) from None
    tell(len(plan.texts), len(plan.texts))
    # What overwrites only the brackets of the hold loses nothing.
    overflow = overflow and plan.hold is not Hold.STOP
    return Sent(len(plan.commands), len(plan.texts), overflow, plan.notes)


def _at_last_reset(commands: Sequence[Command]) -> tuple[list[Command], bool, list[Command]]:
    """The commands before the last `\\`, whether there is one, and those after it."""
    resets = [index for index, command in enumerate(commands) if command.opcode == "RESET"]
    if not resets:
        return [], False, list(commands)
    before = [command for command in commands[: resets[-1]] if command.opcode != "RESET"]
    return before, True, list(commands[resets[-1] + 1 :])


def _left_out_note(source: Source, command: Command) -> str:
    place = source.place(command.offset)
    return (
        f"{command.text} in line {place.line}, column {place.column} was not sent: it acts only "
        f"alone in a message ({SENT_BY[command.opcode]})"
    )


def _length(tokens: Sequence[str]) -> int:
    return sum(map(len, tokens))


def _hold(source: Source, commands: Sequence[Command], reset: bool) -> Hold:
    own = any(command.opcode in BRACKETS for command in commands)
    full = len(commands) + len(BRACKETS) > COMMANDS_MAX
    if not own and not full:
        return Hold.BRACKETS
    if reset:
        return Hold.STOP
    what = "[ or ] of its own" if own else "no room in the memory for [ and ]"
    raise Failure(
        f"{source.name}: needs several messages and has {what}; begin it with \\ to send it", NOT_SO
    )


def pack(tokens: Sequence[str]) -> list[str]:
    """Join commands to as few texts as there can be."""
    texts = [""]
    for token in tokens:
        if len(texts[-1]) + len(token) > TEXT_BYTES_MAX:
            texts.append("")
        texts[-1] += token
    return texts


def _require_holdable(motor: Motor, plan: Plan) -> None:
    """Refuse, while nothing has been sent, what cannot wait for C75."""
    name = plan.checked.source.name
    if len(plan.commands) + len(BRACKETS) > COMMANDS_MAX and is_locked(motor.unit):
        raise Failure(f"{name}: has no room for [ and ] while T40 is on; send C40 first", NOT_SO)


@contextmanager
def _whole_or_forgotten(motor: Motor) -> Iterator[None]:
    """Leave no part of a program that K holds: C75, perhaps meant for other motors, would run it.

    What cuts the block short gets a note if that is confirmed. A unit that restarts has forgotten.
    """
    try:
        yield
    except UnitRestarted:
        raise
    except BaseException as error:
        with undisturbed(), suppress(Failure):
            motor.reset()
            which = f"motor {motor.number}" if motor.number != ALL_MOTORS else "all motors"
            error.add_note(
                f"what had come of it is forgotten again: the memory of {which} of unit "
                f"{motor.unit.node} is empty"
            )
        raise


def _halt(motor: Motor) -> None:
    """Reset and stop a motor, so that what is stored then waits for C75."""
    motor.command("\\[")
    end = time.monotonic() + STAND_SECONDS
    numbers = MOTORS if motor.number == ALL_MOTORS else [motor.number]
    # Until it stands it has not come to [, and K would do nothing.
    while any(motor.unit.motor(number).table() for number in numbers):
        if time.monotonic() > end:
            raise Failure("the motor is still slowing down; send again when it stands", NOT_SO)
        time.sleep(POLL_SECONDS)
    motor.stop()
    _require_stopped(motor, numbers)


def _require_stopped(motor: Motor, numbers: Collection[int]) -> None:
    """Refuse to go on where a program would run at once; an original unit does not tell."""
    try:
        status = motor.unit.status()
    except UnknownMessage:
        return
    if not all(status.motors[number - 1].stopped for number in numbers):
        raise Failure("the motor could not be held by K; nothing more was sent", NOT_SO)


def is_locked(unit: Unit) -> bool:
    """Whether T40 is on: a full memory ignores commands. An original unit does not tell."""
    try:
        return unit.status().memory_locked
    except UnknownMessage:
        return False


def require_room(motor: Motor, plan: Plan) -> None:
    """Refuse to overwrite what is in the memory and may not have run, or to release it."""
    if motor.unit.node == BROADCAST or not plan.commands or plan.resets:
        return
    if [command.opcode for command in plan.commands] == ["SPEED"]:
        return  # of a motor that moves it is not stored
    for number in MOTORS if motor.number == ALL_MOTORS else [motor.number]:
        each = motor.unit.motor(number)
        if _has_run_all(each):
            continue
        held = held_commands(each)
        room = COMMANDS_MAX - len(held)
        if plan.hold is Hold.BRACKETS:
            room -= len(BRACKETS)
        why = (
            f"has {len(plan.commands)} commands, and the memory of motor {number} has room for "
            f"{max(room, 0)} more"
        )
        if plan.hold is Hold.BRACKETS and waits_for_release(held):
            why = f"motor {number} waits at [ in another program and would start too"
        elif len(plan.commands) <= room:
            continue
        raise Failure(
            f"{plan.checked.source.name}: {why}; nothing was sent; begin it with \\, which stops "
            "the motor, or send it when the program there has run",
            NOT_SO,
        )


def waits_for_release(held: Sequence[str]) -> bool:
    """Whether what is held stops at a `[`, as a program does whose end has not come."""
    brackets = [command for command in held if command in ("[", "]")]
    return brackets[-1:] == ["["]


def _has_run_all(motor: Motor) -> bool:
    """Whether all that is stored has run, and may be overwritten."""
    try:
        status = motor.unit.status()
    except UnknownMessage:
        return False
    return status.motors[motor.number - 1].at_rest and not status.memory_locked


def placed(refusal: UnitRefused, plan: Plan) -> UnitRefused:
    """Say where the program has what the unit refuses; the unit tells the character only."""
    source = plan.checked.source
    for command in plan.commands:
        if refusal.character and command.text.startswith(refusal.character):
            place = source.place(command.offset)
            where = f"{source.name}:{place.line}:{place.column}: "
            return UnitRefused(f"{where}{refusal}", refusal.flag, refusal.character)
    return UnitRefused(f"{source.name}: {refusal}", refusal.flag, refusal.character)
