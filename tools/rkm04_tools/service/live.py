"""What the motors of a unit do now, as the line tells it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

from rkm04_tools import messages
from rkm04_tools.line import Unit, Wait
from rkm04_tools.line_errors import UnknownMessage
from rkm04_tools.messages import ALL_MOTORS, GET_POSITION, GET_PROGRESS, GET_STATUS, MOTORS
from rkm04_tools.status import Status, parse_status

LOOKING = Wait(attempts=2)
PLACES_SECONDS = 1.0
"""For so long the place of a program is told after it was asked for."""

PAUSE_SECONDS = 2.0
"""Looks that are further apart tell no speed."""

POSSIBLE = 20_000
"""Steps/s, with a margin for the time of a look; what is faster is a position that was written."""

Tell = Callable[[dict[str, Any]], None]


class Speeds:
    """Speeds from positions: the mean from one look to the next."""

    def __init__(self) -> None:
        self._before: tuple[float, list[int]] | None = None

    def of(self, seconds: float, positions: list[int]) -> list[float | None]:
        """Steps/s at a look; None where they are not known, as at the first one."""
        before, self._before = self._before, (seconds, positions)
        if before is None or not 0 < seconds - before[0] < PAUSE_SECONDS:
            return [None] * len(positions)
        passed = seconds - before[0]
        found = [(new - old) / passed for old, new in zip(before[1], positions, strict=True)]
        return [round(speed, 1) if abs(speed) <= POSSIBLE else None for speed in found]


class Places:
    """Where the programs are, one motor asked for in each look: four would slow down the rest."""

    def __init__(self) -> None:
        self._seen: dict[int, tuple[float, int]] = {}

    def look(self, unit: Unit, running: Sequence[int]) -> None:
        """Ask that of these motors that was asked longest ago; the others run no command."""
        self._seen = {motor: seen for motor, seen in self._seen.items() if motor in running}
        if not running:
            return
        motor = min(running, key=lambda each: self._seen.get(each, (0.0, 0))[0])
        request = messages.request(GET_PROGRESS, motor)
        try:
            answer = unit.line.request_at_once(unit.node, request, LOOKING)
        except UnknownMessage:
            return
        self._seen[motor] = time.monotonic(), messages.parse_progress(answer, motor).command

    def of(self, motor: int) -> int | None:
        """The ordinal of the command that is being run; None: not known, or there is none."""
        at, place = self._seen.get(motor, (0.0, 0))
        return place or None if time.monotonic() - at < PLACES_SECONDS else None


def from_positions(
    node: int,
    seconds: float,
    positions: Sequence[int],
    speeds: Sequence[float | None],
    places: Places,
) -> dict[str, Any]:
    """What is known of a unit that tells positions only."""
    motors = [
        {"position": position, "speed": speed, "moving": None, "place": places.of(motor)}
        for motor, (position, speed) in enumerate(zip(positions, speeds, strict=True), 1)
    ]
    return _live(node, seconds, motors, None, None, None)


def from_status(
    node: int, seconds: float, status: Status, speeds: Sequence[float | None], places: Places
) -> dict[str, Any]:
    """What a unit tells that knows Get Status: a motor that does not move has no speed."""
    motors = [
        {**asdict(each), "speed": speed if each.moving else 0.0, "place": places.of(motor)}
        for motor, (each, speed) in enumerate(zip(status.motors, speeds, strict=True), 1)
    ]
    told = status.as_json()
    del told["motors"]
    return _live(node, seconds, motors, told.pop("inputs"), told.pop("outputs"), told)


def _live(
    node: int,
    seconds: float,
    motors: list[dict[str, Any]],
    inputs: list[int] | None,
    outputs: list[int] | None,
    unit: dict[str, Any] | None,
) -> dict[str, Any]:
    return {
        "type": "live",
        "node": node,
        "time_s": round(seconds, 3),
        "motors": motors,
        "inputs": inputs,
        "outputs": outputs,
        "unit": unit,
    }


class View:
    """Looks at a unit and tells what there is to be seen; to be used from one thread."""

    def __init__(self, tell: Tell) -> None:
        self._tell = tell
        self.begin()

    def begin(self) -> None:
        """Forget what was seen: it is another unit, or may be."""
        self._speeds = Speeds()
        self._places = Places()
        self._tells_status = True

    def look(self, unit: Unit) -> None:
        """Ask for the status, or for what an original unit can tell; changes nothing there.

        No session is needed: the questions may be answered twice.
        """
        if self._tells_status:
            try:
                answer = unit.line.request_at_once(unit.node, bytes([GET_STATUS]), LOOKING)
                status = parse_status(answer)
                running = [motor for motor in MOTORS if status.motors[motor - 1].running]
                self._places.look(unit, running)
                self.show(unit.node, status)
                return
            except UnknownMessage:
                self._tells_status = False
        request = messages.request(GET_POSITION, ALL_MOTORS)
        answer = unit.line.request_at_once(unit.node, request, LOOKING)
        positions = messages.parse_positions(answer, ALL_MOTORS)
        now = time.monotonic()
        speeds = self._speeds.of(now, positions)
        self._places.look(unit, MOTORS)
        self._tell(from_positions(unit.node, now, positions, speeds, self._places))

    def show(self, node: int, status: Status) -> None:
        """Tell a status that has just come."""
        now = time.monotonic()
        speeds = self._speeds.of(now, [motor.position for motor in status.motors])
        self._tell(from_status(node, now, status, speeds, self._places))
