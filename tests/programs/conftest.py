"""Runs example programs on the simulated unit, and compares what they did with what they should."""

from __future__ import annotations

import itertools
import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from chance import epoch
from judge import Event, Limits, Steps, judge_files, read_steps, read_trace
from reference import TICK_HZ, Curve
from rkm04_tools import host
from rkm04_tools.cli import main

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "tools" / "examples"
TICKS_PER_MS = TICK_HZ // 1000
EPOCH_MAX = 10**18
"""What the simulator takes."""
REACTION_TICKS = TICKS_PER_MS
"""From an edge at a pin to the pulse from which it acts, if that is not the next one."""


@dataclass(frozen=True)
class Move:
    """A move in the trace: its ticks, the steps asked for (0: without end) and made, signed."""

    start: int
    end: int
    steps: int
    made: int


@dataclass
class Run:
    """What a simulation wrote and said about motor 1."""

    summary: dict[str, object]
    steps: Steps
    events: list[Event]
    moves: list[Move] = field(default_factory=list)

    @property
    def motor(self) -> dict[str, object]:
        motors = self.summary["motors"]
        assert isinstance(motors, list)
        first = motors[0]
        assert isinstance(first, dict)
        return first

    def values(self, *names: str) -> list[tuple[str, str]]:
        """The events of these names, in order, without their ticks."""
        return [(e.event, e.value) for e in self.events if e.event in names]

    def ticks(self, name: str, value: str | int) -> list[int]:
        """When an event happened."""
        return [e.tick for e in self.events if (e.event, e.value) == (name, str(value))]

    def pulses(self, move: Move) -> list[int]:
        """Ticks of the pulses of a move, counted from its start."""
        tick = self.steps.tick
        inside = tick[(tick > move.start) & (tick <= move.end)]
        return [int(t) - move.start for t in inside]

    def pauses_ms(self) -> list[float]:
        """From the end of each move to the start of the next one."""
        pairs = itertools.pairwise(self.moves)
        return [(after.start - before.end) / TICKS_PER_MS for before, after in pairs]

    def expect_moves(self, *steps: int) -> None:
        """These moves have begun, whole ones that came to their end."""
        assert [move.steps for move in self.moves] == list(steps)
        assert [move.made for move in self.moves] == list(steps)

    def expect_curve(self, index: int, curve: Curve) -> None:
        """Each pulse of a move stands within a tick of its time on a curve."""
        assert worst_ticks(self.pulses(self.moves[index]), curve) <= 1

    def expect_stopped(self, index: int, curve: Curve, cause_tick: int) -> None:
        """A move was stopped down its ramp: from the next pulse, or within the time to react."""
        move = self.moves[index]
        pulses = self.pulses(move)
        at = cause_tick - move.start
        first = curve.pulses_before(at) + 1
        last = max(first, curve.pulses_before(at + REACTION_TICKS))
        fits = [curve.stopped_at(k) for k in range(first, last + 1)]
        assert len(pulses) in [each.last for each in fits]
        assert min(worst_ticks(pulses, c) for c in fits if c.last == len(pulses)) <= 1


def worst_ticks(pulses: Sequence[int], curve: Curve) -> float:
    """The greatest distance of a pulse from its time on the curve."""
    due = curve.ticks(range(1, len(pulses) + 1))
    return max(
        (abs(float(tick - ideal)) for tick, ideal in zip(pulses, due, strict=True)), default=0
    )


def moves_of(events: Sequence[Event]) -> list[Move]:
    """Pair `move` and `done`; a move that was not done yet is left out."""
    moves: list[Move] = []
    begun: Event | None = None
    for event in events:
        if event.event == "move":
            begun = event
        elif event.event == "done" and begun:
            moves.append(Move(begun.tick, event.tick, int(begun.value), int(event.value)))
            begun = None
    return moves


RunProgram = Callable[..., Run]


@pytest.fixture
def run_program(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> RunProgram:
    """Run an example on motor 1, with its inputs or without, and let the judge look at it."""
    if "RKM04_BUILD" not in os.environ:
        monkeypatch.setenv("RKM04_BUILD", str(ROOT / "build" / "host"))
    simulate = host.simulate

    def simulate_then(arguments: Sequence[str], *others: Any) -> dict[str, Any]:
        """Let the unit's time begin anywhere."""
        return simulate([*arguments, "--epoch", str(epoch() % EPOCH_MAX)], *others)

    monkeypatch.setattr(host, "simulate", simulate_then)

    def run(
        name: str, inputs: str | None = None, seconds: float = 60, limits: Limits | None = None
    ) -> Run:
        steps, trace = tmp_path / "steps.csv", tmp_path / "trace.csv"
        arguments = ["sim", str(EXAMPLES / f"{name}.rks"), "--json", "--for", str(seconds)]
        arguments += ["--steps", str(steps), "--trace", str(trace)]
        arguments += ["--inputs", str(EXAMPLES / f"{inputs}.csv")] if inputs else []
        capsys.readouterr()
        status = main(arguments)
        told = capsys.readouterr()
        assert (status, told.err) == (0, "")
        events = read_trace(trace)
        result = Run(json.loads(told.out), read_steps(steps), events, moves_of(events))
        assert judge_files(steps, trace, limits) == []
        assert result.summary["late_steps"] == 0
        return result

    return run
