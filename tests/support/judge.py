"""The judge of a simulated run: what must hold of every edge log, whatever ran.

In: the pulses of a run (`read_steps`) and its events (`read_trace`). Out: a list of
violations, each a sentence; an empty one for a lawful run. The judge knows no program
and no plan, so it can say only what holds for all of them:

- pulses lie inside moves, each move makes as many as its `done` says, in its
  direction, and the position follows them one by one;
- a move that was not stopped reaches its target;
- no two pulses of a motor stand closer than the top speed allows, none further apart
  inside a move than the lowest speed does;
- a move begins and ends at no more than the greatest start/stop speed, and between
  the speed changes no faster than the greatest acceleration lets it.

Whether each pulse stands at its exact tick is for the exact reference to say.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Ticks = NDArray[np.int64]
Flags = NDArray[np.bool_]

STEPS_HEADER = "tick,motor,position"
TRACE_HEADER = "tick,motor,event,value"
RATE_PREFIX = "# tick_hz="
MOTORS = range(1, 5)
CAUSES = ("stop", "error")


@dataclass(frozen=True)
class Steps:
    """The pulses of a run, sorted by tick.

    `tick` counts from the start of the simulation at `tick_hz` per second, `motor` is
    1 to 4, `position` the absolute position after the pulse. One entry per pulse.
    """

    tick_hz: int
    tick: Ticks
    motor: Ticks
    position: Ticks


@dataclass(frozen=True)
class Event:
    """One line of the trace; `value` is kept as text. Motor 0 is the whole unit."""

    tick: int
    motor: int
    event: str
    value: str


@dataclass(frozen=True)
class Limits:
    """The greatest values a run may use; as they stand, those of the language.

    Speeds in steps/s, `accel` in steps/s². `slack` is the rounding, in ticks, allowed
    to an interval: one tick for the pulse at each end. `lead` is the time in seconds
    by which a move may be begun later than its clock says.
    """

    slowest: int = 1
    start_speed: int = 2_000
    speed: int = 16_000
    accel: int = 60_000
    slack: int = 2
    lead: float = 100e-6


@dataclass(frozen=True)
class Move:
    """A move of one motor in the trace.

    `steps` is what was asked for (0 = without end), `made` what `done` reports; `end`
    and `made` are None when the run was over first. `cut` says that a stop or an error
    fell into it.
    """

    motor: int
    start: int
    steps: int
    end: int | None
    made: int | None
    cut: bool

    @property
    def name(self) -> str:
        """How a sentence names the move."""
        return f"motor {self.motor}: the move at tick {self.start}"


@dataclass(frozen=True)
class Track:
    """The pulses of one motor: ticks and positions."""

    tick: Ticks
    position: Ticks

    def inside(self, move: Move) -> slice:
        """Return the pulses behind the start of a move up to its end, inclusive."""
        first = int(np.searchsorted(self.tick, move.start, side="right"))
        if move.end is None:
            return slice(first, len(self.tick))
        return slice(first, int(np.searchsorted(self.tick, move.end, side="right")))


def read_steps(path: Path | str) -> Steps:
    """Read a steps file: rate, header, then tick, motor and position of each pulse."""
    with Path(path).open(encoding="utf-8") as lines:
        rate = lines.readline().rstrip("\n")
        header = lines.readline().rstrip("\n")
        if not rate.startswith(RATE_PREFIX) or header != STEPS_HEADER:
            raise ValueError(f"{path}: not a steps file: {rate!r}, {header!r}")
        rows = [[int(cell) for cell in row] for row in csv.reader(lines)]
    table = np.array(rows, dtype=np.int64).reshape(-1, 3)
    columns = (np.ascontiguousarray(table[:, column]) for column in range(3))
    return Steps(int(rate.removeprefix(RATE_PREFIX)), *columns)


def read_trace(path: Path | str) -> list[Event]:
    """Read a trace file: header, then tick, motor, event and value of each event."""
    with Path(path).open(encoding="utf-8", newline="") as lines:
        rows = csv.reader(lines)
        header = ",".join(next(rows, []))
        if header != TRACE_HEADER:
            raise ValueError(f"{path}: not a trace file: {header!r}")
        return [Event(int(t), int(m), event, value) for t, m, event, value in rows]


def judge(
    steps: Steps,
    trace: Sequence[Event],
    limits: Limits | None = None,
    *,
    counter_set: bool = False,
) -> list[str]:
    """Return what a run violates, as sentences; none for a lawful run.

    `counter_set` says that the program writes the position counter, so that the
    position may jump between moves and need not start at 0.
    """
    limits, hz = limits or Limits(), steps.tick_hz
    found = [*_unsorted(steps, trace), *_bad_motors(steps, trace)]
    for motor in MOTORS:
        own = steps.motor == motor
        track = Track(steps.tick[own], steps.position[own])
        moves, broken = _moves(motor, trace)
        found += [*broken, *_outside(motor, track, moves)]
        found += _positions(motor, track, moves, counter_set)
        found += _too_close(motor, track, hz, limits)
        found += [s for m in moves for s in _judge_move(m, track, hz, limits)]
    return found


def _judge_move(move: Move, track: Track, hz: int, limits: Limits) -> list[str]:
    return [
        *_count(move, track),
        *_target(move),
        *_gaps(move, track, hz, limits),
        *_ends(move, track, hz, limits),
        *_acceleration(move, track, hz, limits),
    ]


def _first(bad: Flags, what: str, tick: Ticks) -> list[str]:
    """Make one sentence of all places where `bad`; `tick` names the first of them."""
    places = np.flatnonzero(bad)
    if len(places) == 0:
        return []
    times = "" if len(places) == 1 else f" ({len(places)} times)"
    return [f"{what} at tick {tick[places[0]]}{times}"]


def _unsorted(steps: Steps, trace: Iterable[Event]) -> list[str]:
    events = np.array([event.tick for event in trace], dtype=np.int64)
    return [
        *_first(np.diff(steps.tick) < 0, "pulses go back in time", steps.tick[1:]),
        *_first(np.diff(events) < 0, "events go back in time", events[1:]),
    ]


def _bad_motors(steps: Steps, trace: Iterable[Event]) -> list[str]:
    pulses = {int(m) for m in np.unique(steps.motor)} - set(MOTORS)
    events = {event.motor for event in trace} - {0, *MOTORS}
    return [
        *(f"pulses of motor {m}, which does not exist" for m in sorted(pulses)),
        *(f"events of motor {m}, which does not exist" for m in sorted(events)),
    ]


def _moves(motor: int, trace: Iterable[Event]) -> tuple[list[Move], list[str]]:
    """Pair the `move` and `done` events of a motor; what does not pair is reported.

    The cause may come behind `done` where a move has no set end: a limit run ends with the
    pulse before its input.
    """
    moves: list[Move] = []
    found: list[str] = []
    is_open = False
    for event in (e for e in trace if e.motor == motor or (e.motor == 0 and e.event in CAUSES)):
        if event.event in CAUSES:
            if moves and (is_open or moves[-1].steps == 0):
                moves[-1] = replace(moves[-1], cut=True)
        elif event.event == "move":
            if is_open:
                found.append(f"motor {motor}: no done of the move at {moves[-1].start}")
                moves.pop()
            moves.append(Move(motor, event.tick, int(event.value), None, None, False))
            is_open = True
        elif event.event == "done":
            if is_open:
                moves[-1] = replace(moves[-1], end=event.tick, made=int(event.value))
            else:
                found.append(f"motor {motor}: done without a move at {event.tick}")
            is_open = False
    if is_open:
        moves[-1] = replace(moves[-1], cut=True)
    return moves, found


def _outside(motor: int, track: Track, moves: Iterable[Move]) -> list[str]:
    """Check that no pulse stands outside a move."""
    stray = np.ones(len(track.tick), dtype=np.bool_)
    for move in moves:
        stray[track.inside(move)] = False
    return _first(stray, f"motor {motor}: a pulse outside any move", track.tick)


def _positions(motor: int, track: Track, moves: Iterable[Move], counter_set: bool) -> list[str]:
    """Check that the position follows the pulses, between moves too."""
    change = np.diff(track.position, prepend=0)
    bad = np.abs(change) != 1
    if counter_set:
        firsts = [track.inside(move).start for move in moves]
        bad[[first for first in firsts if first < len(bad)]] = False
    what = f"motor {motor}: the position does not change by one"
    return _first(bad, what, track.tick)


def _too_close(motor: int, track: Track, hz: int, limits: Limits) -> list[str]:
    """Check that no two pulses are closer than the top speed allows."""
    bad = np.diff(track.tick) < hz / limits.speed - limits.slack
    what = f"motor {motor}: pulses faster than {limits.speed} steps/s"
    return _first(bad, what, track.tick[1:])


def _count(move: Move, track: Track) -> list[str]:
    """Check that a move makes the pulses its `done` reports, all in its direction."""
    pulses = track.inside(move)
    made = pulses.stop - pulses.start
    found = []
    if move.made is not None and made != abs(move.made):
        found.append(f"{move.name} made {made} pulses, its done says {move.made}")
    if move.steps and made > abs(move.steps):
        found.append(f"{move.name} made {made} pulses for {move.steps} steps")
    asked = move.steps or move.made
    change = np.diff(track.position[pulses])
    if asked and np.any(change * asked < 0):
        found += _first(change * asked < 0, f"{move.name} steps back", track.tick[pulses][1:])
    return found


def _target(move: Move) -> list[str]:
    """Check that a move ends at its target, unless a stop or an error fell into it."""
    if move.made is None:
        return []
    if move.steps and move.made * move.steps < 0:
        return [f"{move.name} of {move.steps} steps went the other way: {move.made}"]
    if move.made != move.steps and not move.cut:
        return [f"{move.name} of {move.steps} steps ended at {move.made} with no stop"]
    return []


def _gaps(move: Move, track: Track, hz: int, limits: Limits) -> list[str]:
    """Check that no interval of a move is longer than that of the lowest speed.

    The first one counts from the start of the move.
    """
    tick = track.tick[track.inside(move)]
    allowed = np.full(len(tick), hz / limits.slowest + limits.slack)
    allowed[:1] += limits.lead * hz
    bad = np.diff(tick, prepend=move.start) > allowed
    return _first(bad, f"{move.name} has a gap that ends", tick)


def _ends(move: Move, track: Track, hz: int, limits: Limits) -> list[str]:
    """Check that a move begins and ends no faster than the start/stop speed S.

    i steps behind the start w = v² is at most S² + 2·A·i. A stopped move may stand up
    to one step before the end of its ramp, so i steps before its last pulse w is at
    most S² + 2·A·(i + 1). The mean speed of an interval is below that at its fast end.
    """
    pulses = track.inside(move)
    tick = track.tick[max(pulses.start - 1, 0) : pulses.stop]
    speed = hz / (np.diff(tick) + float(limits.slack))
    from_start = np.arange(len(speed)) + (2.0 if pulses.start == 0 else 1.0)
    to_end = np.arange(len(speed))[::-1] + 2.0
    way = from_start if move.end is None else np.minimum(from_start, to_end)
    bad = speed**2 > limits.start_speed**2 + 2 * limits.accel * way
    return _first(bad, f"{move.name} starts or ends too fast", tick[1:])


def _acceleration(move: Move, track: Track, hz: int, limits: Limits) -> list[str]:
    """Check that above the start/stop speed speeds change by acceleration only.

    The mean speeds u1, u2 of two neighbouring intervals T1, T2 differ by no more than
    A·(T1 + T2)/2, unless the speed jumps, which it may up to S. It cannot where one
    of them, squared, is above S² + 4·A: two steps of braking would not reach S.
    Rounding moves each of them by up to u·slack/T.
    """
    tick = track.tick[track.inside(move)]
    interval = np.maximum(np.diff(tick).astype(np.float64), 1.0)
    speed = hz / interval
    rounding = speed * limits.slack / np.maximum(interval - limits.slack, 1.0)
    allowed = limits.accel * (interval[1:] + interval[:-1]) / (2 * hz)
    jump = np.abs(np.diff(speed)) - rounding[1:] - rounding[:-1]
    sure = speed - rounding
    no_jump = limits.start_speed**2 + 4 * limits.accel
    bad = (np.maximum(sure[1:], sure[:-1]) ** 2 > no_jump) & (jump > allowed)
    return _first(bad, f"{move.name} changes its speed too fast", tick[2:])
