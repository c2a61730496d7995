"""The model of a whole unit: compares a run of the firmware with what the language says.

`compare(script, record)` raises `Difference` where they differ and `Unsure` where the contract
leaves the order of two things open.
"""

from __future__ import annotations

from collections import deque

from language_motor import Motor
from language_signals import SEEN_TICKS, Difference, Moment, Signal, Variables, Watch
from language_text import Command, Refused, parse
from language_world import World
from program_probe import MOTORS, Record, Request, Script

SET_COMMAND, GET_POSITION, GET_COMMAND, GET_PROGRESS = 2, 4, 5, 7
SEVERITY = (0, 3, 1, 2)
FULL = 3


def compare(script: Script, record: Record) -> None:
    """Compare all motors, from power-on to the end of the script."""
    if record.complaints:
        raise Difference(f"the judge: {record.complaints}")
    if record.late:
        raise Difference(f"{record.late} pulses were late")
    switches: list[tuple[Moment, bool]] = []
    motors = _motors(script, record, switches)
    for request, answer in zip(script.requests, record.answers, strict=True):
        _compare_answer(motors, request, answer)
    for number, motor in motors.items():
        motor.advance(script.end)
        position = motor.position_at(script.end)
        if position != record.positions[number - 1]:
            raise Difference(f"motor {number} is at {record.positions[number - 1]}, not {position}")
        motor.expect_no_more(script.end)
    _compare_simulation(motors, switches)


def _motors(
    script: Script, record: Record, switches: list[tuple[Moment, bool]]
) -> dict[int, Motor]:
    inputs = {
        n: Signal((edge.tick, edge.level) for edge in script.edges if edge.number == n)
        for n in range(1, 9)
    }
    variables = Variables(record.events)
    functions: set[int] = set()

    def world(n: int) -> World:
        trains = {True: record.pulses[n], False: record.simulated[n]}
        watch, connections = Watch(n, record.events), deque(record.connections[n])
        return World(inputs, variables, watch, trains, connections, functions, switches)

    return {n: Motor(n, world(n)) for n in MOTORS}


def _compare_simulation(motors: dict[int, Motor], switches: list[tuple[Moment, bool]]) -> None:
    """Each move reaches the pins if simulation was off when it began; unsure near a switch."""
    switches.sort(key=lambda switch: switch[0].high)
    for number, motor in motors.items():
        for begun, connected in motor.starts:
            last = [(m, on) for m, on in switches if m.low <= begun.high][-2:]
            near = any(m.high >= begun.low - SEEN_TICKS for m, _ in last)
            known = len({on for _, on in last}) < 2 or last[0][0].high < last[1][0].low
            wanted = not last[-1][1] if last else True
            if known and not near and connected != wanted:
                raise Difference(f"motor {number}: connected is {connected} at {begun.low}")


def _compare_answer(motors: dict[int, Motor], request: Request, answer: bytes) -> None:
    kind, number = request.data[0], request.data[1] - ord("0")
    addressed = [motor for n, motor in motors.items() if number in (0, n)]
    for motor in motors.values():
        motor.advance(request.tick, motor in addressed)
    if kind == SET_COMMAND:
        expected = _set_command(addressed, request)
    elif kind == GET_POSITION:
        expected = _positions(addressed, request)
    elif kind == GET_COMMAND:
        expected = request.data[:2] + addressed[0].memory.text
    elif kind == GET_PROGRESS:
        motor = addressed[0]
        place = f"{motor.made_at(request.tick):6};{motor.place:2}"
        expected = request.data[:2] + place.encode()
    else:
        raise ValueError(f"the model does not know message {kind}")
    if answer != expected:
        raise Difference(f"at {request.tick}: {request.data!r}: {answer!r}, not {expected!r}")


def _positions(addressed: list[Motor], request: Request) -> bytes:
    texts = [b"%10d" % motor.position_at(request.tick) for motor in addressed]
    return request.data[:2] + b"".join(bytes([len(text)]) + text for text in texts)


def _set_command(addressed: list[Motor], request: Request) -> bytes:
    head = request.data[:2]
    try:
        commands = parse(request.data[2:])
    except Refused as refused:
        return head + bytes([refused.flag, refused.char])
    flags = [_take(motor, commands, request.tick) for motor in addressed]
    return head + bytes([max(flags, key=SEVERITY.index), 0])


def _take(motor: Motor, commands: list[Command], tick: int) -> int:
    """Give the commands of a good text to a motor; returns the flag."""
    if len(commands) == 1 and _is_immediate(motor, commands[0], tick):
        return 0
    letters = [command.letter for command in commands]
    if "\\" in letters:
        motor.reset(tick)
        commands = commands[len(letters) - letters[::-1].index("\\") :]
    stored = [c for c in commands if c.letter != "K" and c != Command("C", 75)]
    jog_stopped, end = motor.is_jog_stopped, motor.memory.end
    had_room = [motor.memory.write(command, motor.is_locked) for command in stored]
    if jog_stopped and motor.memory.end > end:
        motor.leave_jog(tick)
    motor.wake(tick)
    return 0 if all(had_room) else FULL


def _is_immediate(motor: Motor, command: Command, tick: int) -> bool:
    """Do a command that has a meaning of its own when it stands alone."""
    if command.letter == "K":
        motor.halt(tick)
    elif command == Command("C", 75):
        motor.resume(tick)
    elif command.letter == "V":
        return motor.change_speed(tick, command.number)
    else:
        return False
    return True
