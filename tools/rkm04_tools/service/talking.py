"""What a unit is asked, and what it answers in words and as values for the page."""

from __future__ import annotations

from collections.abc import Callable

from rkm04_tools import acting, messages
from rkm04_tools.check import check_source
from rkm04_tools.doubt import CUT_SHORT
from rkm04_tools.frame import BROADCAST
from rkm04_tools.line import USUAL, Motor, Unit, Wait
from rkm04_tools.line_errors import UnitRefused, UnitRestarted
from rkm04_tools.messages import ALL_MOTORS, MOTORS, SET_COMMAND, VERSION
from rkm04_tools.sending import Tell, check_program, held_commands, plan_program, send_program
from rkm04_tools.service.answers import Answer, ProgramWrong
from rkm04_tools.service.checking import NAME, first_error
from rkm04_tools.service.orders import LETS_GO, MESSAGES, SCAN, SEND_ALL, Act, Request, lets_go
from rkm04_tools.service.together import send_all
from rkm04_tools.source import Source
from rkm04_tools.speeding import send_speed_briefly


def ask(unit: Unit, request: Request, tell: Tell) -> Answer:
    """Send one of the seven messages; `tell` is told of the progress of a long program."""
    if request.everywhere:
        return _broadcast(unit.line.unit(BROADCAST).motor(request.motor), request, tell)
    if request.name == SCAN:
        return _scan(unit, tell)
    if request.name == SEND_ALL:
        return send_all(unit, dict(request.texts), request.together, tell)
    if lets_go(request):
        return _let_go(unit.motor(request.motor))
    if request.name == "send":
        return _send(unit.motor(request.motor), request.text, tell)
    if request.name == "store":
        return _store(unit.motor(request.motor), request.text)
    if request.name == "version":
        return version(unit)
    if request.name == "position":
        return _positions(unit, request.motor)
    if request.motor == ALL_MOTORS:
        return _raw(unit, MESSAGES[request.name])
    return READS[request.name](unit.motor(request.motor))


def act(unit: Unit, order: Act) -> Answer:
    """Send C75, a reset or V."""
    motor = unit.motor(order.motor)
    if order.name == "resume":
        motor.resume()
        return Answer("told to go on")
    if order.name == "reset":
        motor.reset()
        return Answer("reset, the program memory is empty")
    return _speed(unit, order)


def put_in_doubt(got: object, may_move: bool) -> None:
    """Say of an order that was on the line and was cut short that the unit may have taken it.

    A restart says itself what became of the order, and what has notes was forgotten by the unit.
    """
    is_told = isinstance(got, UnitRestarted) or hasattr(got, "__notes__")
    if isinstance(got, CUT_SHORT) and not is_told:
        moves = ["motors may move"] if may_move else []
        got.args = ("; ".join(["NOT CONFIRMED: it may have been taken", *moves, str(got)]),)


def _speed(unit: Unit, order: Act) -> Answer:
    """Change the speed of those motors that move."""
    told = acting.change_speed(unit, order.motor, order.value, send_speed_briefly)
    words = ", ".join(f"motor {each.motor} {each.text}" for each in told)
    changed = [each.motor for each in told if each.done]
    if not changed:
        raise UnitRefused(f"{words}; a speed is for moves in progress")
    return Answer(words, {"speed": order.value, "motors": changed})


def version(unit: Unit, wait: Wait = USUAL) -> Answer:
    """Ask for version and date."""
    told = messages.parse_version(unit.ask(bytes([VERSION]), wait))
    date = told.date.isoformat()
    return Answer(f"version {told.number} of {date}", {"version": told.number, "date": date})


def _send(motor: Motor, text: str, tell: Tell) -> Answer:
    checked = check_source(Source(NAME, text))
    if told := first_error(checked):
        raise ProgramWrong(told)
    sent = send_program(motor, checked, tell)
    if not sent.commands and not sent.notes:  # K, C75 or \
        alone = checked.parsed.commands[0].text
        return Answer(f"{alone} sent", {"alone": alone})
    words = f"{_count(sent.commands, 'command')} in {_count(sent.messages, 'message')} sent"
    if sent.overflow:
        words += "; the program memory was full, commands were lost"
    values = {
        "commands": sent.commands,
        "messages": sent.messages,
        "overflow": sent.overflow,
        "notes": list(sent.notes),
    }
    return Answer("; ".join([words, *sent.notes]), values)


def _let_go(motor: Motor) -> Answer:
    """Send K at once: it may be taken twice, so that it needs no session."""
    message = messages.request(SET_COMMAND, motor.number, LETS_GO.encode())
    answer = motor.unit.line.request_at_once(motor.unit.node, message)
    messages.parse_set_command(answer, motor.number)
    return Answer(f"{LETS_GO} sent", {"alone": LETS_GO})


def _broadcast(motor: Motor, request: Request, tell: Tell) -> Answer:
    """Send or store on all units of the line: nobody answers, so what came of it is not known."""
    if request.name == "send":
        sent = _send(motor, request.text, tell)
    else:
        motor.store()
        sent = Answer("told to store")
    words = f"to all units: {sent.text}; none of them answers, so it is not known who has got it"
    return Answer(words, {**sent.values, "everywhere": True}, BROADCAST)


def _scan(unit: Unit, tell: Tell) -> Answer:
    """Ask all addresses who is there; nothing but Version is sent."""
    found = [
        {
            "node": each.node,
            "version": each.version.number if each.version else None,
            "date": each.version.date.isoformat() if each.version else None,
            "remark": each.remark,
        }
        for each in unit.line.scan(tell=tell)
    ]
    nodes = ", ".join(str(each["node"]) for each in found)
    return Answer(f"units that answer: {nodes or 'none'}", {"found": found})


def _store(motor: Motor, text: str) -> Answer:
    """Store the program in the memory; if a text is given, only if it is the one."""
    numbers = MOTORS if motor.number == ALL_MOTORS else [motor.number]
    motors = [motor.unit.motor(number) for number in numbers]
    plan = plan_program(check_program(text, NAME)) if text else None
    before = [held_commands(each) for each in motors]
    for each, held in zip(motors, before, strict=True):
        if plan and not plan.is_held(held):
            raise UnitRefused(
                f"motor {each.number} holds another program, nothing stored; send this one first"
            )
    motor.store()
    if [held_commands(each) for each in motors] != before:
        raise UnitRefused("the program has changed while it was stored; store it again")
    counts = {str(each.number): len(held) for each, held in zip(motors, before, strict=True)}
    words = [f"motor {number}: {_count(n, 'command')} stored" for number, n in counts.items()]
    return Answer(", ".join(words), {"stored": counts})


def _positions(unit: Unit, motor: int) -> Answer:
    if motor == ALL_MOTORS:
        found = dict(zip(MOTORS, unit.positions(), strict=True))
    else:
        found = {motor: unit.motor(motor).position()}
    words = [f"motor {number}: {position}" for number, position in found.items()]
    return Answer(", ".join(words), {"positions": {str(k): v for k, v in found.items()}})


def _program(motor: Motor) -> Answer:
    text = motor.program()
    return Answer(text, {"program": text})


def _table(motor: Motor) -> Answer:
    points = [[point.step, point.speed] for point in motor.table()]
    words = " ".join(f"({step}; {speed})" for step, speed in points)
    return Answer(words or "no move in progress", {"points": points})


def _progress(motor: Motor) -> Answer:
    told = motor.progress()
    words = f"{_count(told.steps, 'step')} made, command {told.command}"
    return Answer(words, {"steps": told.steps, "command": told.command})


READS: dict[str, Callable[[Motor], Answer]] = {
    "program": _program,
    "table": _table,
    "progress": _progress,
}


def _raw(unit: Unit, message: int) -> Answer:
    """Ask all motors what only one can tell: the unit answers with a complaint of its own."""
    answer = unit.ask(messages.request(message, ALL_MOTORS))
    return Answer(answer[2:].decode("ascii", "backslashreplace").strip())


def _count(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"
