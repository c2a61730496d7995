"""Runs scripted units on the firmware, many in one process.

`build/host/bin/program-probe` (`program_probe.c`) runs them; `RKM04_BUILD` names another build
folder.
"""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from motion_probe import ROOT, Missing

EVENTS = ("start", "move", "done", "stop", "out", "var", "wait", "speed", "error", "end")
MOTORS = range(1, 5)


@dataclass(frozen=True)
class Request:
    """A message that comes at a tick."""

    tick: int
    data: bytes


@dataclass(frozen=True)
class Edge:
    """An input (1 to 8) that has a new level from a tick on."""

    tick: int
    number: int
    level: int


@dataclass(frozen=True)
class Script:
    """A run: what comes to the unit and when, sorted by tick; ticks count from power-on.

    `ahead`: ticks that pulses are laid ahead; 0: one at a time.
    """

    requests: tuple[Request, ...]
    edges: tuple[Edge, ...] = ()
    end: int = 0
    epoch: int = 0
    ahead: int = 0

    @property
    def lines(self) -> str:
        """The script as the probe reads it."""
        lines = [f"epoch {self.epoch}", f"ahead {self.ahead}"]
        lines += [f"in {edge.tick} {edge.number} {edge.level}" for edge in self.edges]
        lines += [f"send {request.tick} {request.data.hex()}" for request in self.requests]
        return "\n".join([*lines, f"run {self.end}\n"])


@dataclass(frozen=True)
class Event:
    """One line of the trace."""

    tick: int
    motor: int
    name: str
    value: int


@dataclass(frozen=True)
class Connection:
    """STEP and DIR of a motor are connected to their pins, or disconnected.

    `ends_move`: it is the very next thing after the end of a move of this motor.
    """

    tick: int
    connected: bool
    ends_move: bool


def _trains() -> dict[int, list[int]]:
    return {motor: [] for motor in MOTORS}


@dataclass
class Record:
    """What a run did; pulses of a motor are ticks, negative ones backward.

    Those that are `simulated` did not reach the pins.
    """

    pulses: dict[int, list[int]] = field(default_factory=_trains)
    simulated: dict[int, list[int]] = field(default_factory=_trains)
    events: list[Event] = field(default_factory=list)
    connections: dict[int, list[Connection]] = field(
        default_factory=lambda: {motor: [] for motor in MOTORS}
    )
    answers: list[bytes] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)
    late: int = 0
    positions: list[int] = field(default_factory=list)


class Probe:
    """A process that runs scripts one after the other; use it as a context."""

    def __init__(self) -> None:
        path = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin/program-probe"
        try:
            self._process = subprocess.Popen(
                [path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        except FileNotFoundError as error:
            raise Missing(f"{path} is not there: build the preset 'host' first") from error

    def __enter__(self) -> Probe:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate()

    def run(self, script: Script) -> Record:
        """Run a script from power-on."""
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write(script.lines)
        self._process.stdin.flush()
        record = Record()
        for line in self._process.stdout:
            if _read(record, line.split()):
                return record
        raise RuntimeError(f"the probe ended with status {self._process.wait()}:\n{script.lines}")


def _read(record: Record, words: list[str]) -> bool:
    """Read one line of an answer; whether it was the last one."""
    kind = words[0]
    if kind == "event":
        tick, motor, number, value = map(int, words[1:])
        record.events.append(Event(tick, motor, EVENTS[number], value))
    elif kind == "answer":
        record.answers.append(bytes.fromhex(words[2]) if len(words) > 2 else b"")
    elif kind == "judge":
        record.complaints.append(" ".join(words[1:]))
    elif kind in ("pulses", "simulated"):
        trains = record.pulses if kind == "pulses" else record.simulated
        trains[int(words[1])] = [int(tick) for tick in words[2:]]
    elif kind == "connection":
        tick, motor, level = map(int, words[1:])
        last = record.events[-1] if record.events else None
        ends_move = last is not None and (last.motor, last.name) == (motor, "done")
        record.connections[motor].append(Connection(tick, bool(level), ends_move))
    else:
        record.late, *record.positions = map(int, words[1:])
    return kind == "end"
