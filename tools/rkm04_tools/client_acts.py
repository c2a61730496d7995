"""The commands that make motors do something: send, stop, resume, reset and speed."""

from __future__ import annotations

import signal
import sys
from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rkm04_tools import acting
from rkm04_tools.acting import Told
from rkm04_tools.bar import Bar
from rkm04_tools.check import Checked
from rkm04_tools.client_base import (
    checked_file,
    count_of,
    name_of,
    node_of,
    port_of,
    tell,
    who,
)
from rkm04_tools.failure import DONE, INTERRUPTED, NOT_SO, Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.host import opcode_rows
from rkm04_tools.line import Motor, Unit, open_line
from rkm04_tools.sending import Sent, plan_program, send_program
from rkm04_tools.streaming import stream_program

Act = Callable[[Unit, int], list[Told]]


def run_stop(options: Namespace) -> int:
    """Stop motors, and tell which stand; one that goes on is status 1."""
    return _act(options, acting.stop, "K was sent", enough=all)


def run_resume(options: Namespace) -> int:
    """Let motors go on; status 1 if none does."""
    return _act(options, acting.resume, "C75 was sent", enough=any)


def run_reset(options: Namespace) -> int:
    """Reset motors."""
    return _act(options, acting.reset, "\\ was sent, the program memory is empty", enough=all)


def run_speed(options: Namespace) -> int:
    """Change the speed of moves; status 1 if none is in progress."""
    (row,) = (row for row in opcode_rows() if row.name == "SPEED")
    if not row.min <= options.speed <= row.max:
        raise Failure(f"speed {options.speed}: write steps/s, {row.min} to {row.max}")

    def act(unit: Unit, number: int) -> list[Told]:
        return acting.change_speed(unit, number, options.speed)

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
    with open_line(port) as line, Bar("sending") as bar:
        motor = line.unit(node).motor(options.motor)
        if act := {"K": acting.stop, "C75": acting.resume}.get("".join(plan.texts)):
            return _tell_act(options, motor, act(motor.unit, motor.number), "sent", all)
        sent = send_program(motor, checked, bar.show)
        return _tell_sent(options, motor, sent)


def _stream(options: Namespace, node: int, port: str, checked: Checked) -> int:
    """Feed a program; an interruption stops the motor, and tells what it does then."""
    total = fed = 0

    def show(done: int, of: int) -> None:
        nonlocal total, fed
        fed, total = done, of
        bar.show(done, of)

    with open_line(port) as line, Bar("feeding") as bar:
        motor = line.unit(node).motor(options.motor)
        try:
            with _interrupted_by_any_signal():
                sent = stream_program(motor, checked, show, lambda text: _warn(options, text))
            return _tell_sent(options, motor, sent)
        except KeyboardInterrupt:
            with _undisturbed():
                found = acting.stop(motor.unit, motor.number)
            for each in found:
                text = f"interrupted after {fed} of {total} commands; {_line(motor, each)}"
                print(f"rkm04: {text}", file=sys.stderr)
            return INTERRUPTED


@contextmanager
def _interrupted_by_any_signal() -> Iterator[None]:
    """Make the ends that a process is asked for be as Ctrl-C."""
    numbers = [signal.SIGTERM, signal.SIGHUP] if hasattr(signal, "SIGHUP") else [signal.SIGTERM]
    before = [signal.signal(number, signal.default_int_handler) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Let nobody interrupt the stop, which takes a few seconds at the most."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _tell_sent(options: Namespace, motor: Motor, sent: Sent) -> int:
    """Print what was sent, and what the motors do after it."""
    if sent.overflow:
        _warn(
            options,
            "warning: the program memory was full, the oldest commands were overwritten; "
            "jumps and loops do not find them any more; begin a program with \\ to empty it",
        )
    states = acting.states(motor.unit, motor.number)
    counts = f"{count_of(sent.commands, 'command')} in {count_of(sent.messages, 'message')}"
    lines = [f"{options.file}: {counts} sent to {name_of(motor)}"]
    for state in states or []:
        waits = ": what was sent waits for rkm04 resume" if state.stopped else ""
        lines.append(f"motor {state.motor}: {state.text}{waits}")
    answer = {
        "file": options.file,
        **who(motor),
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


def _act(options: Namespace, act: Act, sent: str, enough: Callable[[list[bool]], bool]) -> int:
    """Do something to one motor or all, and say what has become of it."""
    node = node_of(options)
    with open_line(port_of(options)) as line:
        motor = line.unit(node).motor(options.motor)
        told = act(motor.unit, motor.number)
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
