"""The commands that make motors do something: send, stop, resume, reset and speed."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from typing import Any

from rkm04_tools import acting
from rkm04_tools.acting import Told
from rkm04_tools.bar import Bar
from rkm04_tools.check import Checked
from rkm04_tools.client_base import (
    OVERWRITTEN,
    checked_file,
    count_of,
    name_of,
    node_of,
    port_of,
    tell,
    who,
)
from rkm04_tools.doubt import Doubt, in_doubt, undisturbed
from rkm04_tools.failure import DONE, INTERRUPTED, NOT_SO, Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.host import opcode_rows
from rkm04_tools.line import Motor, Unit, open_line
from rkm04_tools.sending import (
    COMMANDS_MAX,
    Hold,
    Plan,
    Sent,
    plan_program,
    send_program,
)
from rkm04_tools.speeding import send_speed
from rkm04_tools.streaming import PART_COMMANDS_MAX, stream_program

ENDS_IN_ITS_MIDDLE = (
    " (do not resume: what is there of the program ends in its middle; rkm04 reset forgets it)"
)

Act = Callable[[Unit, int, Doubt], list[Told]]


def run_stop(options: Namespace) -> int:
    """Stop motors, and tell which stand; one that goes on is status 1."""
    doubt = Doubt("K", acting.EMERGENCY)
    return _act(options, acting.stop, "K was sent", enough=all, doubt=doubt)


def run_resume(options: Namespace) -> int:
    """Let motors go on; status 1 if none does."""
    return _act(options, acting.resume, "C75 was sent", enough=any)


def run_reset(options: Namespace) -> int:
    """Reset motors."""
    return _act(options, acting.reset, "\\ was sent", enough=all)


def run_speed(options: Namespace) -> int:
    """Change the speed of moves; status 1 if none has it then."""
    (row,) = (row for row in opcode_rows() if row.name == "SPEED")
    if not row.min <= options.speed <= row.max:
        raise Failure(f"speed {options.speed}: write steps/s, {row.min} to {row.max}")

    def act(unit: Unit, number: int, doubt: Doubt) -> list[Told]:
        return acting.change_speed(
            unit, number, options.speed, lambda motor, speed: send_speed(motor, speed, doubt)
        )

    return _act(options, act, "", enough=any)


def run_send(options: Namespace) -> int:
    """Check a program, send it, and say what became of it."""
    node, port = node_of(options), port_of(options)
    checked = checked_file(options.file, but="too-many" if options.stream else "")
    if not checked.is_good:
        return NOT_SO
    if options.stream:
        return _stream(options, node, port, checked)
    plan = plan_program(checked)
    for note in plan.notes:
        _warn(options, note)
    act = {"K": acting.stop, "C75": acting.resume}.get("".join(plan.texts))
    with in_doubt(Doubt()) as doubt, open_line(port) as line, Bar("sending") as bar:
        motor = line.unit(node).motor(options.motor)
        if act:
            return _tell_act(options, motor, act(motor.unit, motor.number, doubt), "sent", all)

        def show(done: int, total: int) -> None:
            _note_sending(doubt, plan, done, total)
            bar.show(done, total)

        if node != BROADCAST:
            motor.unit.begin()
        doubt.done = acting.KEPT
        sent = send_program(motor, checked, show)
        return _tell_sent(options, motor, sent)


def _note_sending(doubt: Doubt, plan: Plan, done: int, total: int) -> None:
    """Note what is not known of a program while its next message is under way."""
    name, has_more = plan.checked.source.name, total > 1
    counts = f"{done} of {count_of(total, 'message')} taken" if has_more else ""
    if done == total:
        doubt.about(f"{name} was taken, but what the motor does", acting.MAY_MOVE)
    elif done == total - 1 and plan.hold is not Hold.STOP:
        what = f"whether {name} was taken{' whole' if has_more else ''}, and runs"
        doubt.about(what, acting.MAY_MOVE, counts)
    else:
        _note_part(doubt, plan, counts, is_first=not done)


def _note_part(doubt: Doubt, plan: Plan, counts: str, is_first: bool) -> None:
    """Note what is not known of a program of which there is a part."""
    what, advice = (
        "what there is of it waits for the rest",
        "rkm04 reset forgets it, or send it again",
    )
    if plan.hold is Hold.STOP:
        what, advice = "rkm04 resume would run what there is of it", f"do not resume: {advice}"
    # The \ is the first to go: without an answer nobody knows whether it was taken.
    gone = f"what was in the memory before {'may be' if is_first else 'is'} gone"
    if plan.resets and is_first:
        advice = f"{gone}; {advice}"
    elif plan.resets:
        counts = f"{counts}; {gone}"
    doubt.about(f"how much of {plan.checked.source.name} was taken: {what}", advice, counts)


def _stream(options: Namespace, node: int, port: str, checked: Checked) -> int:
    """Feed a program; an interruption stops the motor, and tells what it does then."""
    doubt = Doubt(advice=f"{acting.MAY_MOVE}; if it must stand, use the emergency stop")

    counts = ""

    def show(done: int, total: int) -> None:
        nonlocal counts
        counts = f"{done} of {total} commands"
        doubt.done = f"{counts} were sent"
        held = min(done + PART_COMMANDS_MAX, total, COMMANDS_MAX)
        doubt.what = (
            f"what the motor does: without more it runs on with up to {count_of(held, 'command')}"
        )
        bar.show(done, total)

    with in_doubt(doubt), open_line(port) as line, Bar("feeding") as bar:
        motor = line.unit(node).motor(options.motor)
        try:
            sent = stream_program(motor, checked, show, lambda text: _warn(options, text))
            return _tell_sent(options, motor, sent)
        except KeyboardInterrupt:
            if not doubt.what:
                raise
            with undisturbed():
                doubt.done = f"interrupted after {counts}"
                found = acting.stop(motor.unit, motor.number, doubt)
            for each in found:
                text = _line(motor, each).replace(acting.RESUMES, ENDS_IN_ITS_MIDDLE)
                print(f"rkm04: {doubt.done}; {text}", file=sys.stderr)
            return INTERRUPTED


def _tell_sent(options: Namespace, motor: Motor, sent: Sent) -> int:
    """Print what was sent, and what the motors do after it."""
    if sent.overflow:
        _warn(
            options,
            f"warning: the program memory was full, {OVERWRITTEN}",
        )
    states = acting.states_since(motor.unit, motor.number)
    counts = f"{count_of(sent.commands, 'command')} in {count_of(sent.messages, 'message')}"
    is_answered = motor.unit.node != BROADCAST
    note = "" if is_answered else f"; {acting.BROADCAST_NOTE}"
    lines = [f"{options.file}: {counts} sent to {name_of(motor)}{note}"]
    for state in states or []:
        waits = ": what was sent waits for rkm04 resume" if state.stopped else ""
        lines.append(f"motor {state.motor}: {state.text}{waits}")
    answer = {
        "file": options.file,
        **who(motor),
        "confirmed": is_answered,
        "commands": sent.commands,
        "messages": sent.messages,
        "overflow": sent.overflow,
        "notes": list(sent.notes),
        "motors": [
            {"motor": state.motor, "state": state.text, "error": state.error or None}
            for state in states or []
        ],
    }
    tell(options, answer, "\n".join(lines))
    dead = [state for state in states or [] if state.failed or state.ended]
    for state in dead:
        _warn(options, f"motor {state.motor} {state.text}: nothing runs there until \\")
    return NOT_SO if dead else DONE


def _act(
    options: Namespace,
    act: Act,
    sent: str,
    enough: Callable[[list[bool]], bool],
    doubt: Doubt | None = None,
) -> int:
    """Do something to one motor or all, and say what has become of it."""
    node = node_of(options)
    with in_doubt(doubt or Doubt()) as doubt, open_line(port_of(options)) as line:
        motor = line.unit(node).motor(options.motor)
        told = act(motor.unit, motor.number, doubt)
    return _tell_act(options, motor, told, sent, enough)


def _tell_act(
    options: Namespace,
    motor: Motor,
    told: Sequence[Told],
    sent: str,
    enough: Callable[[list[bool]], bool],
) -> int:
    confirmed = bool(told) and all(each.done is not None for each in told)
    answer: dict[str, Any] = {**who(motor), "confirmed": confirmed}
    answer["motors"] = [each.as_json() for each in told]
    lines = [_line(motor, each) for each in told]
    if motor.unit.node == BROADCAST:
        lines = [f"{name_of(motor)}: {sent}; {acting.BROADCAST_NOTE}"]
    elif not confirmed:
        lines.append("NOT CONFIRMED: the unit has other software and tells positions only")
    tell(options, answer, "\n".join(lines))
    return DONE if enough([each.done is not False for each in told] or [True]) else NOT_SO


def _line(motor: Motor, told: Told) -> str:
    return f"unit {motor.unit.node}: motor {told.motor} {told.text}"


def _warn(options: Namespace, text: str) -> None:
    print(f"rkm04: {options.file}: {text}", file=sys.stderr)
