"""What a simulation wrote: pulses, events and inputs, as arrays and lists for the plot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rkm04_tools.failure import Failure, reading_failed
from rkm04_tools.inputs import read_inputs

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

RATE = "# tick_hz="


@dataclass(frozen=True)
class Event:
    """A line of the trace; motor 0 is the whole unit."""

    tick: int
    motor: int
    name: str
    value: str


@dataclass(frozen=True)
class Pulses:
    """The pulses of one motor: tick and absolute position after the pulse."""

    tick: Ints
    position: Ints


@dataclass(frozen=True)
class Move:
    """When a move began and ended, in ticks, and the sign of its direction (0: unknown).

    One that is not `done` ends with the simulation.
    """

    start: int
    end: int
    sign: int
    done: bool


@dataclass(frozen=True)
class Record:
    """A simulation from tick 0 to `end`."""

    tick_hz: int
    end: int
    pulses: dict[int, Pulses]
    events: list[Event]
    inputs: list[tuple[float, int, int]]
    """Milliseconds, input, level, sorted by time."""
    turns: bool = False
    """Motors may turn in a move, and counters begin at 0: positions tell the directions."""

    @property
    def seconds(self) -> float:
        """How long it lasted."""
        return self.end / self.tick_hz

    def signs(self, motor: int) -> Ints | None:
        """The direction of each pulse of a motor that may turn in a move."""
        if not self.turns:
            return None
        change = np.diff(self.pulses[motor].position, prepend=0)
        told = np.abs(change) == 1  # else the counter has been written in between
        after = np.minimum(np.arange(len(change)) + 1, len(change) - 1)
        return np.sign(np.where(told, change, change[after]))

    def positions(self, motor: int) -> Pulses:
        """The pulses of a motor, and positions that commands have written."""
        pulses = self.pulses[motor]
        written = [e for e in self.events if e.name == "position" and e.motor == motor]
        if not written:
            return pulses
        tick = np.append(pulses.tick, [e.tick for e in written])
        position = np.append(pulses.position, [int(e.value) for e in written])
        order = np.argsort(tick, kind="stable")
        return Pulses(tick[order], position[order])

    def first_position(self, motor: int) -> int:
        """The position of a motor at the start."""
        if self.turns:
            return 0
        sign = next((move.sign for move in self.moves(motor) if move.sign), 1)
        return int(self.pulses[motor].position[0]) - sign

    def moves(self, motor: int) -> list[Move]:
        """The moves of a motor."""
        moves: list[Move] = []
        for event in self.events:
            if event.motor != motor:
                continue
            if event.name == "move":
                moves.append(Move(event.tick, self.end, _sign(event.value), done=False))
            elif event.name == "done" and moves:
                sign = moves[-1].sign or _sign(event.value)
                moves[-1] = Move(moves[-1].start, event.tick, sign, done=True)
        if moves and not moves[-1].sign:
            moves[-1] = replace(moves[-1], sign=self._last_sign(motor))
        return moves

    def _last_sign(self, motor: int) -> int:
        """The direction in which a motor has moved last, by its positions."""
        if motor not in self.pulses or len(self.pulses[motor].position) < 2:
            return 1
        before, last = self.pulses[motor].position[-2:]
        return int(np.sign(last - before))


def read_record(
    steps: Path, trace: Path, inputs: Path | None, seconds: float, *, turns: bool = False
) -> Record:
    """Read the files of a simulation that lasted so long."""
    hz, table = _read_steps(steps)
    return Record(
        hz,
        round(seconds * hz),
        {int(m): _of_motor(table, int(m)) for m in np.unique(table[:, 1])},
        _read_trace(trace),
        read_inputs(inputs) if inputs else [],
        turns,
    )


def read_extremes(steps: Path) -> dict[int, tuple[int, int]]:
    """The lowest and the highest position of each motor that has moved."""
    _, table = _read_steps(steps)
    found = {int(m): table[table[:, 1] == m, 2] for m in np.unique(table[:, 1])}
    return {motor: (int(at.min()), int(at.max())) for motor, at in found.items()}


def _read_steps(path: Path) -> tuple[int, Ints]:
    """Rate of the ticks, and rows of tick, motor, position."""
    try:
        with path.open(encoding="ascii") as file:
            rate, header = file.readline(), file.readline()
            if not rate.startswith(RATE) or not header:
                raise Failure(f"{path}: cannot be read back for the plot; leave --steps out")
            if not file.read(1):
                return int(rate.removeprefix(RATE)), np.empty((0, 3), dtype=np.int64)
        table = np.loadtxt(path, dtype=np.int64, delimiter=",", skiprows=2, ndmin=2)
    except OSError as error:
        raise reading_failed(path, error) from None
    return int(rate.removeprefix(RATE)), table


def _of_motor(table: Ints, motor: int) -> Pulses:
    own = table[table[:, 1] == motor]
    return Pulses(np.ascontiguousarray(own[:, 0]), np.ascontiguousarray(own[:, 2]))


def _read_trace(path: Path) -> list[Event]:
    lines = path.read_text(encoding="ascii").splitlines()[1:]
    cells = (line.split(",", 3) for line in lines)
    return [Event(int(tick), int(motor), name, value) for tick, motor, name, value in cells]


def _sign(value: str) -> int:
    return (int(value) > 0) - (int(value) < 0)
