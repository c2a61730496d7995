"""How soon an edge at an input changes the pulses of the image: for `bench --target stm32`.

A stop takes effect at a pulse: up to it all pulses come as if nothing had been, after it the ramp
down begins. So two times belong to each edge: until the pulse at which the ramp begins (0 if that
was before the edge), and until the first pulse that comes at another time. The edges come at random
phases to the pulses.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from statistics import median

import numpy as np

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.table import thousands
from rkm04_tools.target_figures import Figures, flood
from rkm04_tools.target_run import (
    MOTORS,
    MOVES_BEGIN_MS,
    TICKS_PER_MS,
    Line,
    Move,
    Ran,
    Rig,
    Stop,
    ended_stopped,
    programs,
)

SEED = 20261121
TICK_HZ = 1000 * TICKS_PER_MS
TICKS_PER_US = TICKS_PER_MS // 1000

START_SPEED, ACCEL = 500, 60_000
SPEEDS = (16_000, 10_500, 2_000)
PAUSE_MS = 50.0
LEVEL_MS = 10.0
"""How long the input stays at 1."""
CRUISE_MS = 20.0
"""From the end of the ramp to the first moment at which an edge may come, at least."""
PHASE_MS = 10.0
"""An edge comes at a random moment of so long a time."""
GUARD_ROUNDS, STOP_RUNS, LIMIT_ROUNDS = 24, 8, 24
LIMIT_SPEED = 2_000

GUARD = b"S%d V%d A%d @1 M03 F90000 R W%d J1"
TOTAL_STOP = b"S%d V%d A%d X03 F90000 R"
LIMIT_RUN = b"S%d @1 )03 W%d J1"
BUSY = b"S2000 V16000 A60000 @1 F2 Y F3 Y F4 Y F5 Y R J1"
"""Plans all the time."""
INPUT = 3

FAST_MOVE = Move(80_000, START_SPEED, 200_000, 4_000_000)
"""Faster than the language allows: of the bench image."""
FAST_RUNS = 24
FAST_MS = 80.0
"""From MOVES_BEGIN_MS to the first moment at which an edge may come: it is in the cruise."""
OFF_TICKS = 1
"""A pulse is at most so far from where it belongs."""

GOAL_FAST_US, GOAL_US, FAST = 100, 1000, 10_000
"""The most that the first time may be, at rates above FAST and below."""


@dataclass
class Reaction:
    """The times of all edges of one kind, for each motor, in us."""

    kind: str
    speed: int
    motors: int
    begins: list[float] = field(default_factory=list)
    changes: list[float] = field(default_factory=list)
    stack_used: int = 0
    busy: bool = False
    """Whether the other motors begin moves all the time."""

    @property
    def goal(self) -> int:
        """What the longest of `begins` may be."""
        return GOAL_FAST_US if self.speed > FAST else GOAL_US

    @property
    def met(self) -> bool:
        """Whether it is."""
        return max(self.begins) <= self.goal

    @property
    def name(self) -> str:
        """For the table."""
        motors = "1 motor" if self.motors == 1 else f"{self.motors} motors"
        if self.busy:
            motors += " beside three busy"
        return f"{self.kind}, {thousands(self.speed)} steps/s, {motors}"


def spread(times: Sequence[float]) -> dict[str, float]:
    """The least, the median and the greatest of some times; nothing of none."""
    if not times:
        return {}
    named = {"min": min(times), "median": median(times), "max": max(times)}
    return {name: round(value, 2) for name, value in named.items()}


def braking(ticks: np.ndarray, edge: int, interval: int) -> tuple[float, float]:
    """The two times of an edge in a cruise with a known interval, in us."""
    changed = (ticks[1:] > edge) & (np.diff(ticks) != interval)
    first = int(changed.argmax())
    if not changed[first]:
        raise ValueError("no pulse has changed after the edge")
    return max(int(ticks[first]) - edge, 0) / TICKS_PER_US, (
        int(ticks[first + 1]) - edge
    ) / TICKS_PER_US


def halting(ticks: np.ndarray, edge: int, until: int) -> float:
    """How long after an edge the last pulse of a limit run came, in us; 0 if none came."""
    after = ticks[(ticks > edge) & (ticks <= until)]
    return (int(after[-1]) - edge) / TICKS_PER_US if len(after) else 0.0


def measure(rig: Rig) -> list[Reaction]:
    """All kinds, for one motor and for all together."""
    found = []
    for motors in (1, len(MOTORS)):
        found += [guard(rig, speed, motors) for speed in SPEEDS]
        found += [total_stop(rig, speed, motors) for speed in SPEEDS]
        found.append(limit_run(rig, motors))
    found += [guard(rig, speed, 1, busy=True) for speed in SPEEDS]
    return found


def _ramp_ms(speed: int) -> float:
    return 1000 * (speed - START_SPEED) / ACCEL


def _edges(first_ms: float, apart_ms: float, count: int, seed: int) -> list[float]:
    """Random moments; each comes `apart_ms` after the latest at which the one before could."""
    rng = random.Random(seed)
    edges, at = [], first_ms
    for _ in range(count):
        edges.append(round(at + rng.uniform(0, PHASE_MS), 6))
        at = edges[-1] + apart_ms
    return edges


def _inputs(edges: Sequence[float]) -> str:
    changes = ((ms, level) for edge in edges for ms, level in ((edge, 1), (edge + LEVEL_MS, 0)))
    return "".join(f"{ms:.6f},{INPUT},{level}\n" for ms, level in changes)


def _all(text: bytes, motors: int) -> Line:
    return programs(dict.fromkeys(range(1, motors + 1), text))


def _run(
    rig: Rig, line: Line, edges: Sequence[float], behind_ms: float, reaction: Reaction
) -> Iterator[tuple[np.ndarray, int]]:
    """Each motor's ticks with each edge."""
    seconds = (edges[-1] + behind_ms) / 1000
    ran = rig.run(seconds, line.lines, _inputs(edges), steps=True)
    reaction.stack_used = max(reaction.stack_used, ran.stack_used)
    found = ran.ticks()
    for ticks in (found[motor] for motor in MOTORS[: reaction.motors]):
        for edge in edges:
            yield ticks, round(edge * TICKS_PER_MS)


def guard(rig: Rig, speed: int, motors: int, *, busy: bool = False) -> Reaction:
    """Moves that a guard stops, one after the other."""
    reaction = Reaction("guard", speed, motors, busy=busy)
    text = GUARD % (START_SPEED, speed, ACCEL, round(PAUSE_MS))
    line = programs(
        {motor: text if motor <= motors else BUSY for motor in MOTORS if busy or motor <= motors}
    )
    ramp = _ramp_ms(speed)
    first = line.released_ms + ramp + CRUISE_MS
    apart = ramp + PAUSE_MS + ramp + 2 * CRUISE_MS
    edges = _edges(first, apart, GUARD_ROUNDS, SEED + speed + motors)
    for ticks, edge in _run(rig, line, edges, CRUISE_MS, reaction):
        begins, changes = braking(ticks, edge, TICK_HZ // speed)
        reaction.begins.append(begins)
        reaction.changes.append(changes)
    return reaction


def total_stop(rig: Rig, speed: int, motors: int) -> Reaction:
    """A total stop ends the program: a run for each edge."""
    reaction = Reaction("total stop", speed, motors)
    line = _all(TOTAL_STOP % (START_SPEED, speed, ACCEL), motors)
    first = line.released_ms + _ramp_ms(speed) + CRUISE_MS
    for i in range(STOP_RUNS):
        edges = _edges(first, 0, 1, SEED + speed + motors + i)
        for ticks, edge in _run(rig, line, edges, CRUISE_MS, reaction):
            begins, changes = braking(ticks, edge, TICK_HZ // speed)
            reaction.begins.append(begins)
            reaction.changes.append(changes)
    return reaction


def limit_run(rig: Rig, motors: int) -> Reaction:
    """Limit runs end at once: with the last pulse that was due before the edge was seen."""
    reaction = Reaction("limit run", LIMIT_SPEED, motors)
    line = _all(LIMIT_RUN % (LIMIT_SPEED, round(PAUSE_MS)), motors)
    edges = _edges(line.released_ms + CRUISE_MS, PAUSE_MS + CRUISE_MS, LIMIT_ROUNDS, SEED + motors)
    for ticks, edge in _run(rig, line, edges, CRUISE_MS, reaction):
        until = edge + round(PAUSE_MS / 2 * TICKS_PER_MS)
        reaction.begins.append(halting(ticks, edge, until))
    return reaction


def fast_stops(rig: Rig) -> Figures:
    """Moves at 200 000 steps/s that an input stops, with the line flooded."""
    figures: Figures = {"late_stops": 0, "stack_used": 0}
    for motors in (1, len(MOTORS)):
        begins = []
        for i in range(FAST_RUNS):
            (edge,) = _edges(MOVES_BEGIN_MS + FAST_MS, 0, 1, SEED + motors + i)
            ran = stopped(rig, motors, edge)
            at = round(edge * TICKS_PER_MS)
            begins += [begin_us(ticks, at, ran.late) for ticks in ran.ticks().values()]
            figures["late_stops"] += ran.late
            figures["stack_used"] = max(figures["stack_used"], ran.stack_used)
        figures[f"stop_fast_{motors}"] = max(begins)
    return figures


def stopped(rig: Rig, motors: int, edge: float) -> Ran:
    """Fast moves of the bench image that an edge stops in their cruise."""
    line = flood(MOVES_BEGIN_MS, edge + CRUISE_MS)
    ran = rig.run_moves([FAST_MOVE] * motors, line=line, stop=Stop(INPUT, edge))
    if not ended_stopped(ran, motors):
        raise Failure("4 x 200 000 steps/s: the stop did not end well", NOT_SO)
    return ran


def begin_us(ticks: np.ndarray, edge: int, late: int) -> float:
    """How long after an edge the ramp of a stopped FAST_MOVE begins; 0 if that was before it.

    The ramp is so flat at first that its pulses stand where they would have without it. Their
    number tells where it begins, and the times of all but late ones that this is so.
    """
    square, steep = FAST_MOVE.speed**2, 2 * FAST_MOVE.accel
    steps = np.arange((square - FAST_MOVE.start_speed**2) // steep + 1.0)
    ramp = (FAST_MOVE.speed - np.sqrt(square - steep * steps)) / FAST_MOVE.accel * TICK_HZ
    if len(ticks) < len(ramp):
        raise ValueError("the pulses are too few for a stop")
    off = ticks[-len(ramp) :] - ramp
    begin = np.median(off)
    if np.count_nonzero(np.abs(off - begin) > OFF_TICKS) > late:
        raise ValueError("the pulses are not those of a stop")
    return max(float(begin) - edge, 0) / TICKS_PER_US
