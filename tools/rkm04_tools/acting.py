"""K, C75, `\\` and V sent to motors, and what has become of it: asked for, not supposed.

A unit tells what its motors do by Get Status. One that does not know it is asked for positions
again and again: what moves is seen, what stands is not known for sure. Nobody answers a broadcast.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rkm04_tools.doubt import Doubt
from rkm04_tools.failure import Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.line import Motor, Unit
from rkm04_tools.line_errors import UnitRestarted, UnknownMessage
from rkm04_tools.messages import ALL_MOTORS, MOTORS
from rkm04_tools.status import MotorStatus

STAND_SECONDS = 1.0
"""How long motors are given to come to a stand before it is told that they brake."""
LOOK_SECONDS = 1.0
"""How long positions are watched for a change: at least a step where nobody moves slower."""
QUIET_SECONDS = 0.5
"""Without a change so long a motor is told to stand, where only positions are known."""
POLL_SECONDS = 0.05
EMERGENCY = "use the emergency stop"
MAY_MOVE = "it may move: rkm04 status tells what it does, rkm04 stop stops it"
RESUMES = " (rkm04 resume goes on)"
KEPT = "nothing was changed: a motor that moves goes on"
BROADCAST_NOTE = "NOT CONFIRMED: no unit answers a broadcast; look at each motor, or ask each unit"


@dataclass(frozen=True)
class Told:
    """What a motor does after an order. `done`: whether it obeys; None: nobody knows."""

    motor: int
    text: str
    done: bool | None

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        return {"motor": self.motor, "state": self.text, "done": self.done}


def numbers_of(number: int) -> list[int]:
    """The motor of a number, or all four for 0."""
    return list(MOTORS) if number == ALL_MOTORS else [number]


def stop(unit: Unit, number: int, doubt: Doubt) -> list[Told]:
    """Send K, and tell what each motor does then; nothing of a broadcast."""
    doubt.what, doubt.advice = "K", EMERGENCY
    unit.motor(number).stop()
    if unit.node == BROADCAST:
        return []
    doubt.what = "K was taken, but whether the motors stand"
    return _after_stop(unit, number)


def resume(unit: Unit, number: int, doubt: Doubt) -> list[Told]:
    """Send C75, and tell which motors go on; nothing of a broadcast."""
    before = states(unit, number)
    doubt.about("whether C75 was taken", MAY_MOVE)
    unit.motor(number).resume()
    if unit.node == BROADCAST:
        return []
    doubt.what = "C75 was taken, but whether the motor goes on"
    after = states_since(unit, number)
    if before is None or after is None:
        return [Told(each, "was told to go on", None) for each in numbers_of(number)]
    return [_resumed(*both) for both in zip(before, after, strict=True)]


def reset(unit: Unit, number: int, doubt: Doubt) -> list[Told]:
    """Send \\, and tell what each motor does then; nothing of a broadcast."""
    doubt.about("whether \\ was taken, and the motor stands", MAY_MOVE)
    with unit.line.one_session(unit.node):
        unit.motor(number).reset()
        doubt.what = "\\ was taken, but whether the motor stands"
        return [] if unit.node == BROADCAST else _after_stop(unit, number)


def change_speed(
    unit: Unit, number: int, steps_per_s: int, send: Callable[[Motor, int], Told]
) -> list[Told]:
    """`send` V to those motors that move: to others it would be a command of their program."""
    if unit.node == BROADCAST:
        raise Failure(
            "node 0 means all units, and none can say which of its motors move; name one, 1 to 16"
        )
    with unit.line.one_session(unit.node):
        # One look decides, and gives the reason: in the next one the motor may move again.
        found = states(unit, number)
        still = _still(found) if found else _unmoved(unit, number)
        return [
            Told(each, still[each], False) if each in still else send(unit.motor(each), steps_per_s)
            for each in numbers_of(number)
        ]


def _still(found: Sequence[MotorStatus]) -> dict[int, str]:
    """What those motors do that run no move of their program."""
    return {
        each.motor: f"{_does(each)}: nothing was sent"
        for each in found
        if not (each.moving and each.running)
    }


def _unmoved(unit: Unit, number: int) -> dict[int, str]:
    moved = _moved(unit, number)
    words = "has not moved while it was watched: nothing was sent"
    return {each: words for each in numbers_of(number) if each not in moved}


def states(unit: Unit, number: int) -> list[MotorStatus] | None:
    """What motors do; None: the unit cannot tell."""
    if unit.node == BROADCAST:
        return None
    try:
        motors = unit.status().motors
    except UnknownMessage:
        return None
    return [motors[each - 1] for each in numbers_of(number)]


def states_since(unit: Unit, number: int) -> list[MotorStatus] | None:
    """The same, of a unit that has not restarted since the last request to it."""
    sessions = unit.line.sessions
    session = sessions[unit.node]
    found = states(unit, number)
    if sessions[unit.node] != session:
        raise UnitRestarted(f"unit {unit.node}", repeated=True)
    return found


def _after_stop(unit: Unit, number: int) -> list[Told]:
    """Wait a while for the motors to stand."""
    end = time.monotonic() + STAND_SECONDS
    while True:
        found = states(unit, number)
        if found is None:
            return _after_stop_by_positions(unit, number)
        if not any(each.moving for each in found) or time.monotonic() > end:
            return [_stopped(each) for each in found]
        time.sleep(POLL_SECONDS)


def _after_stop_by_positions(unit: Unit, number: int) -> list[Told]:
    end = time.monotonic() + STAND_SECONDS
    while (moved := _moved(unit, number, QUIET_SECONDS)) and time.monotonic() < end:
        pass
    return [
        Told(each, "still moves", None)
        if each in moved
        else Told(each, f"has not moved for {QUIET_SECONDS} s", None)
        for each in numbers_of(number)
    ]


def _stopped(motor: MotorStatus) -> Told:
    if motor.running:
        return Told(motor.motor, f"WAS NOT STOPPED: {motor.text}", False)
    if motor.moving:
        return Told(motor.motor, "still brakes", True)
    why = RESUMES if motor.stopped else ""
    return Told(motor.motor, f"{_does(motor)}{why}", True)


def _does(motor: MotorStatus) -> str:
    """What a motor does that does not run its program."""
    if motor.running:
        return motor.text if motor.moving else f"stands, {motor.text}"
    if motor.moving:
        return "brakes"
    return "stands" if motor.at_rest else f"stands, {motor.text}"


def _resumed(before: MotorStatus, after: MotorStatus) -> Told:
    if not before.stopped:
        return Told(after.motor, f"was not stopped by K ({before.text}): C75 does nothing", False)
    if after.stopped:
        return Told(after.motor, "goes on when it stands", after.moving)
    return Told(after.motor, f"goes on: {after.text}", True)


def _moved(unit: Unit, number: int, seconds: float = LOOK_SECONDS) -> set[int]:
    """Those whose positions change."""
    end = time.monotonic() + seconds
    first = unit.positions()
    moved: set[int] = set()
    wanted = numbers_of(number)
    while time.monotonic() < end and len(moved) < len(wanted):
        time.sleep(POLL_SECONDS)
        now = unit.positions()
        moved |= {each for each in wanted if now[each - 1] != first[each - 1]}
    return moved
