"""The programs of all motors at once: all are checked before the first is sent."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

from rkm04_tools.check import check_source
from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.line import Motor, Unit
from rkm04_tools.messages import ALL_MOTORS, MOTORS
from rkm04_tools.sending import (
    BRACKETS,
    COMMANDS_MAX,
    POLL_SECONDS,
    STAND_SECONDS,
    Hold,
    Plan,
    Tell,
    held_commands,
    pack,
    plan_program,
    require_room,
    send_program,
    send_texts,
    waits_for_release,
)
from rkm04_tools.service.answers import Answer, ProgramWrong
from rkm04_tools.service.checking import first_error
from rkm04_tools.source import Source

HOLD, RELEASE = "[", "]"


def send_all(unit: Unit, texts: Mapping[int, str], together: bool, tell: Tell) -> Answer:
    """Send each motor its own program, or nothing if one of them is wrong.

    Each runs as soon as it has arrived; or, `together`, each waits after `[` until one `]` for all
    motors lets them start on the same tick. There is no `]` for some of them only: the others must
    be empty, and hold it then, where it does nothing.
    """
    plans = {motor: _planned(motor, text) for motor, text in texts.items()}
    # What has started anew before ] runs what it has stored when that comes.
    with unit.line.one_session(unit.node):
        return _send_plans(unit, plans, together, tell)


def _send_plans(unit: Unit, plans: dict[int, Plan], together: bool, tell: Tell) -> Answer:
    if together:
        plans = {motor: _held_back(motor, plan) for motor, plan in plans.items()}
        for motor, plan in plans.items():
            _require_room(unit.motor(motor), plan)
        if len(plans) > 1:
            _require_others_empty(unit, [motor for motor in MOTORS if motor not in plans])
    total = sum(len(plan.texts) for plan in plans.values())
    done = 0
    full: list[int] = []
    for number, plan in plans.items():

        def tell_part(part: int, _: int, before: int = done) -> None:
            tell(before + part, total)

        try:
            if _send(unit.motor(number), plan, together, tell_part):
                full.append(number)
        except Failure as failure:
            raise _told(failure, number, list(plans), together) from None
        done += len(plan.texts)
    tell(done, total)
    if together and _start(unit, list(plans)) and not full:
        full = list(plans)
    counts = {str(motor): len(plan.commands) for motor, plan in plans.items()}
    words = ", ".join(f"motor {motor}: commands {count}" for motor, count in counts.items())
    words += "; started together" if together else "; each runs since it arrived"
    notes = [f"motor {motor}: {note}" for motor, plan in plans.items() for note in plan.notes]
    values = {
        "sent": counts, "together": together, "overflow": bool(full), "full": full, "notes": notes
    }  # fmt: skip
    return Answer("; ".join([words, *notes]), values)


def _planned(motor: int, text: str) -> Plan:
    checked = check_source(Source(f"motor {motor}", text))
    if told := first_error(checked):
        cause = f"motor {motor}: {told['cause']}"
        advice = f"nothing was sent to any motor; {told['next']}"
        raise ProgramWrong({**told, "cause": cause, "next": advice, "motor": motor})
    return plan_program(checked)


def _held_back(motor: int, plan: Plan) -> Plan:
    """The same program after `[`, in as many texts as it needs."""
    if any(command.opcode in BRACKETS for command in plan.commands):
        raise Failure(
            f"motor {motor}: the program has [ or ] of its own, so it cannot wait for the others; "
            "nothing was sent to any motor; send without starting together",
            NOT_SO,
        )
    if len(plan.commands) + len(BRACKETS) > COMMANDS_MAX:
        raise Failure(
            f"motor {motor}: the memory has no room for [ and ] beside the program; nothing was "
            "sent to any motor; send without starting together",
            NOT_SO,
        )
    if not plan.commands and not plan.resets:
        raise Failure(
            f"motor {motor}: {plan.texts[0]} is no program; nothing was sent to any motor; send it "
            "alone",
            NOT_SO,
        )
    start = ["\\"] if plan.resets else []
    return replace(plan, hold=Hold.BRACKETS, texts=pack([*start, HOLD, *plan.plain]))


def _require_room(motor: Motor, plan: Plan) -> None:
    try:
        require_room(motor, plan)
    except Failure as failure:
        raise _told(failure, motor.number, [motor.number], together=True) from None


def _require_others_empty(unit: Unit, others: Sequence[int]) -> None:
    """`]` for all motors would be stored in their programs, and let one start that waits."""
    for number in others:
        held = held_commands(unit.motor(number))
        if waits_for_release(held):
            why = "waits at [ in another program and would start too"
        elif set(held) - {HOLD, RELEASE}:
            why = "holds another program, and ] to all motors would be added to it"
        else:
            continue
        raise Failure(
            f"motor {number} {why}; nothing was sent to any motor; reset it, or send without "
            "starting together",
            NOT_SO,
        )


def _send(motor: Motor, plan: Plan, together: bool, tell: Tell) -> bool:
    """Send a program; return whether the memory has overflowed."""
    if not together:
        return send_program(motor, plan.checked, tell).overflow
    return send_texts(motor, plan, tell).overflow


def _told(failure: Failure, motor: int, motors: Sequence[int], together: bool) -> Failure:
    """The same failure, with the motor and what has become of the others."""
    sent = ", ".join(str(each) for each in motors[: list(motors).index(motor)])
    others = "nothing was started" if together else f"already sent to motor {sent}"
    words = f"motor {motor}" + (f" ({others})" if sent else "")
    failure.args = (f"{words}: {str(failure).removeprefix(f'motor {motor}: ')}",)
    return failure


def _start(unit: Unit, motors: Sequence[int]) -> bool:
    """Let all motors start, when none of them slows down any more because of `\\`.

    True: the memory of one of them has overflowed.
    """
    end = time.monotonic() + STAND_SECONDS
    for number in motors:
        while unit.motor(number).table():
            if time.monotonic() > end:
                raise Failure(
                    f"motor {number} still moves, so nothing was started; the programs wait for ] "
                    "to all motors",
                    NOT_SO,
                )
            time.sleep(POLL_SECONDS)
    return unit.motor(ALL_MOTORS if len(motors) > 1 else motors[0]).command(RELEASE)
