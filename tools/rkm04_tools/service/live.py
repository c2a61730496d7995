"""What the motors do now, ten times a second."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from threading import Event, Thread
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import PortLost
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.service.worker import State

PERIOD_SECONDS = 0.1
CLOSING_SECONDS = 10.0
PAUSE_SECONDS = 2.0
"""Looks that are further apart tell no speed."""

POSSIBLE = 20_000
"""Steps/s, with a margin for the time of a look; what is faster is a position that was written."""

Tell = Callable[[dict[str, Any]], None]


class Speeds:
    """Speeds from positions: the mean from one look to the next."""

    def __init__(self) -> None:
        self._before: tuple[float, list[int]] | None = None

    def of(self, seconds: float, positions: list[int]) -> list[float]:
        """Steps/s at a look; 0 at the first one."""
        before, self._before = self._before, (seconds, positions)
        if before is None or not 0 < seconds - before[0] < PAUSE_SECONDS:
            return [0.0] * len(positions)
        passed = seconds - before[0]
        found = [(new - old) / passed for old, new in zip(before[1], positions, strict=True)]
        return [round(speed, 1) if abs(speed) <= POSSIBLE else 0.0 for speed in found]


def from_positions(speeds: Speeds, seconds: float, positions: list[int]) -> dict[str, Any]:
    """What a line tells: a motor is idle that has not moved since the look before."""
    found = speeds.of(seconds, positions)
    return _live(seconds, positions, found, [speed == 0 for speed in found], None, None)


def from_state(speeds: Speeds, state: dict[str, Any]) -> dict[str, Any]:
    """What a virtual unit tells; the speeds are of its pulses, as positions may be written."""
    found = speeds.of(state["seconds"], state["travel"])
    idle = [not moving for moving in state["moving"]]
    return _live(
        state["seconds"], state["positions"], found, idle, state["inputs"], state["outputs"]
    )


def _live(
    seconds: float,
    positions: Sequence[int],
    speeds: Sequence[float],
    idle: Sequence[bool],
    inputs: list[int] | None,
    outputs: list[int] | None,
) -> dict[str, Any]:
    motors = [
        {"position": position, "speed": speed, "idle": rests}
        for position, speed, rests in zip(positions, speeds, idle, strict=True)
    ]
    return {
        "type": "live",
        "time_s": round(seconds, 3),
        "motors": motors,
        "inputs": inputs,
        "outputs": outputs,
    }


class LineView:
    """Turns the positions that the worker sees into what browsers get."""

    def __init__(self, tell: Tell) -> None:
        self._tell = tell
        self._speeds = Speeds()

    def see(self, positions: list[int]) -> None:
        """Take a look; time counts from some moment."""
        self._tell(from_positions(self._speeds, time.monotonic(), positions))


class VirtualView:
    """Watches the virtual unit that is connected, on a thread of its own, beside the line."""

    def __init__(
        self,
        tell: Tell,
        is_watched: Callable[[], bool],
        state: Callable[[], State],
        lose: Callable[[Failure], None],
        units: VirtualLine,
    ) -> None:
        self._tell = tell
        self._is_watched = is_watched
        self._state = state
        self._lose = lose
        self._units = units
        self._node = 0
        self._speeds = Speeds()
        self._ends = Event()
        self._thread = Thread(target=self._run, name="live", daemon=True)

    def start(self) -> None:
        """Begin to watch."""
        self._thread.start()

    def close(self) -> None:
        """End."""
        self._ends.set()
        if self._thread.is_alive():
            self._thread.join(CLOSING_SECONDS)

    def _run(self) -> None:
        due = time.monotonic()
        while not self._ends.wait(max(0.0, due - time.monotonic())):
            due = max(due + PERIOD_SECONDS, time.monotonic())
            state = self._state()
            if state.connected and state.virtual and self._is_watched():
                self._look(state.node)

    def _look(self, node: int) -> None:
        try:
            told = self._units.states()[node]
        except Failure as failure:
            self._lose(failure)
            return
        except (KeyError, ValueError) as error:
            self._lose(PortLost(f"the virtual unit tells nonsense ({error}); connect again"))
            return
        if node != self._node:
            self._node, self._speeds = node, Speeds()
        self._tell(from_state(self._speeds, told))
