"""One way in which the axes of a GVE134 unit may have moved, laid beside the pulses that it made.

The contract leaves the unit some freedom: when a chain starts, at which whole step a change takes
effect. A course has settled all of these in one way; `gve_motion.py` keeps those that agree with
the pulses. Legs are laid only as far as they are looked at. Times are ticks, those of legs scaled
by 2^ROOT_BITS.
"""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from exact import Fraction
from path_reference import (
    AXES,
    ROOT_BITS,
    Leg,
    Limits,
    Vector,
    braking,
    corners,
    lay,
    look,
    look_for_rest,
    whole,
)
from reference import TICK_HZ

MS = TICK_HZ // 1000
PATIENCE = MS // 2
"""A change takes effect at the latest at the first whole step that is due so long after it."""

TOLERANCE = 1.0
"""Ticks by which a pulse may be off its ideal time."""

FLOAT_ERROR = 2**-12
LIMITS = Limits(turn_us=12)
Place = tuple[int, Fraction]
Vectors = tuple[Vector, ...]


class Mismatch(Exception):
    """What the unit did is not what the contract says."""

    def __init__(self, tick: float, text: str) -> None:
        """Say when and what."""
        super().__init__(f"at {tick / MS:.3f} ms (tick {tick:.0f}): {text}")
        self.tick = tick


class Train:
    """The pulses of a motor."""

    def __init__(self) -> None:
        """No pulses yet."""
        self.ticks = array("q")
        self.places = array("q", [0])
        """Where the motor is after so many pulses."""

    def add(self, tick: int, way: int) -> None:
        """Add a pulse."""
        self.ticks.append(tick)
        self.places.append(self.places[-1] + way)

    def place_at(self, tick: int) -> int:
        """Where the motor is when the pulses of a tick have been made."""
        return self.places[bisect_right(self.ticks, tick)]

    def last_before(self, tick: int) -> int:
        """The tick of the last pulse up to one; far in the past if there is none."""
        count = self.count_until(tick)
        return self.ticks[count - 1] if count else -TICK_HZ

    def count_until(self, tick: int) -> int:
        """How many pulses have been made when those of a tick have."""
        return bisect_right(self.ticks, tick)

    def between(self, low: int, high: int) -> Sequence[int]:
        """The ticks of the pulses of a window."""
        return self.ticks[bisect_right(self.ticks, low) : bisect_right(self.ticks, high)]


@dataclass
class Record:
    """The pulses of the motors, and how long they were watched."""

    end: int
    trains: list[Train] = field(default_factory=lambda: [Train() for _ in range(AXES)])
    resets: list[int] = field(default_factory=list)
    """When J came: soon after it no pulse is of what was before."""
    growing: bool = False
    """The pulses are made as the courses go: there is nothing yet to compare them with."""

    def watched_until(self, tick: int) -> int:
        """Up to when pulses tell of what was planned at a tick."""
        return min([self.end, *(reset for reset in self.resets if reset >= tick)])

    def last_before(self, tick: int) -> int:
        """The tick of the last pulse of any motor up to one."""
        return max(train.last_before(tick) for train in self.trains)


@dataclass
class Cursor:
    """How far the pulses of an axis have been compared."""

    leg: int = 0
    done: int = 0
    """Of the pulses on that leg."""
    seen: int = 0
    """Of those that the motor made."""


@dataclass
class Step:
    """A whole step of the longest axis that is yet to come."""

    leg: int
    vector: int
    place: int | Fraction
    time: int


@dataclass
class Course:
    """Legs that have been laid, the plan of those that follow, and where the path rests."""

    record: Record
    legs: list[tuple[Leg, Vector]] = field(default_factory=list)
    cursors: list[Cursor] = field(default_factory=lambda: [Cursor() for _ in range(AXES)])
    vectors: Vectors = ()
    first: int = 0
    """The first vector of the plan."""
    ends: list[tuple[int, int]] = field(default_factory=list)
    """With what squares of the speed the vectors of the plan are entered and left."""
    laid: int = 0
    place: Fraction = Fraction(0)
    time: int = 0
    stops: bool = False
    rests: bool = False
    rest: Place = (0, Fraction(0))
    pending: tuple[int, int] | None = None
    """The window in which the start lies that has yet to come."""
    kept: Place = (0, Fraction(0))
    begun: tuple[Place, int] = (0, Fraction(0)), 0
    """The place and the time at which the path last left a stand."""
    worst: float = 0.0
    follows: int | None = None
    """The axis whose pulses axis A makes, too."""

    def fork(self) -> Course:
        """Return a copy without legs that are of no use any more."""
        old = min(cursor.leg for cursor in self.cursors)
        cursors = [replace(cursor, leg=cursor.leg - old) for cursor in self.cursors]
        return replace(self, legs=self.legs[old:], cursors=cursors)

    # --- what is planned ---

    def plan(self, at: Place, square: int, time: int, *, stops: bool) -> None:
        """Plan the path anew from a place."""
        self.first, self.place = at
        self.time, self.stops, self.laid, self.rests = time, stops, 0, False
        ahead = self.vectors[self.first :]
        if stops:
            self.ends, self.rests = look_for_rest(ahead, self.place, square, LIMITS)
        else:
            self.ends, _ = look(ahead, self.place, square, LIMITS, None)

    @property
    def ended(self) -> bool:
        """Whether all of the plan has been laid."""
        return self.laid == len(self.ends)

    def lay_next(self) -> None:
        """Lay the legs of one more vector."""
        index = self.first + self.laid
        vector, ends = self.vectors[index], self.ends[self.laid]
        at = whole(2 * vector.gain * self.place) if self.laid == 0 else 0
        course = corners(vector, at, ends, 0 if self.stops else vector.speed, 0)
        self.laid += 1
        if self.rests and self.ended:
            course = braking(at, ends)
        legs = lay(index, 2 * vector.gain, at, self.time, course)
        if legs:
            self.time, at = legs[-1].end_time, whole(legs[-1].x1)
        self.legs += ((leg, vector) for leg in legs)
        if self.ended:
            through = at == 2 * vector.gain * vector.length
            self.rest = (
                (index + 1, Fraction(0)) if through else (index, Fraction(at, 2 * vector.gain))
            )

    def lay_until(self, tick: int) -> None:
        """Lay legs up to a tick."""
        while not self.ended and self.time <= tick << ROOT_BITS:
            self.lay_next()

    def end_tick(self) -> float:
        """When the path comes to rest."""
        while not self.ended:
            self.lay_next()
        return float(self.time / 2**ROOT_BITS)

    def vector_at(self, tick: int) -> int:
        """The vector in which the path is."""
        if self.pending:
            return self.rest[0]
        self.lay_until(tick)
        if self.ended and self.time <= tick << ROOT_BITS:
            return self.rest[0]
        ahead = (leg.vector for leg, _ in self.legs if leg.end_time > tick << ROOT_BITS)
        return next(ahead, self.first)

    def way_from(self, tick: int) -> object:
        """The way from a tick on, but for its times: where it is equal, two courses go on alike.

        None: it has not begun.
        """
        leg = self._leg_at(tick)
        if self.pending or leg is None:
            return None
        ahead = max(leg.vector, self.first)
        plan = ahead, tuple(self.ends[ahead - self.first :]), self.stops, self.rests
        return leg.vector, leg.sign, leg.x1, leg.square_at_end, plan, self.begun

    def end_of_leg(self, tick: int) -> int:
        """When the leg ends that the course is on."""
        leg = self._leg_at(tick)
        return leg.end_time if leg else 0

    def _leg_at(self, tick: int) -> Leg | None:
        self.lay_until(tick)
        for leg, _ in reversed(self.legs):
            if leg.time <= tick << ROOT_BITS < leg.end_time:
                return leg
        return None

    # --- starts and changes ---

    def begin(self, vectors: Vectors, at: Place, window: tuple[int, int]) -> None:
        """Leave the stand within a window of ticks."""
        self.vectors, self.rest, self.pending = vectors, at, window
        self.ends, self.laid = [], 0

    def settle(self, tick: int, late: int = 0) -> list[Course]:
        """Return the courses for a start that has come by a tick, and for one that has not.

        What happens at the tick may be taken up so late; until then the start is as if it were not.
        """
        if self.pending is None:
            return [self]
        low, high = self.pending
        if high <= tick:
            return self.starts(low, high)
        courses = []
        if low <= tick + late:
            with suppress(Mismatch):
                courses = self.starts(low, min(high, tick + late))
        if high > tick:
            waits = self.fork()
            waits.pending = (max(low, tick), high)
            courses.append(waits)
        return courses

    def settle_late(self, tick: int) -> list[Course]:
        """Return the courses for a start that must have come by a tick; else the one that waits."""
        if self.pending and (self.pending[1] <= tick or self._has_started(tick)):
            return self.starts(*self.pending)
        return [self]

    def _has_started(self, tick: int) -> bool:
        """Whether a path that waits for its start has made a pulse by a tick."""
        if self.record.growing:
            return False
        self._finish()
        steps = self.vectors[self.rest[0]].steps
        axis = max(range(AXES), key=lambda j: abs(steps[j]))
        ticks = self.record.trains[axis].ticks[self.cursors[axis].seen :][:1]
        return bool(ticks) and ticks[0] <= tick

    def _finish(self) -> None:
        """Compare what is left of the pulses before a start."""
        if self.legs:
            self._verify_all(math.ceil(self.legs[-1][0].end_time / 2**ROOT_BITS) + 2)

    def starts(self, low: int, high: int) -> list[Course]:
        """Return the courses for each start tick in a window that agrees with the first pulse."""
        self._finish()
        trial = Course(self.record, vectors=self.vectors)
        trial.plan(self.rest, 0, 0, stops=False)
        step = next(trial.steps_from(0))
        ticks = self._start_ticks(step.time, low, high)
        return [self._start_at(tick, trial.ends) for tick in ticks]

    def _start_ticks(self, due: int, low: int, high: int) -> range:
        """The start ticks that agree with the first pulse, which comes so long after them."""
        steps = self.vectors[self.rest[0]].steps
        axis = max(range(AXES), key=lambda j: abs(steps[j]))
        after = due / 2**ROOT_BITS
        if self.record.growing:
            tick = low + (high - low) // 2
            return range(tick, tick + 1)
        seen, ticks = self.cursors[axis].seen, self.record.trains[axis].ticks
        end = self.record.watched_until(low)
        if seen == len(ticks) or ticks[seen] > end + 50 * MS:
            if high + after + TOLERANCE < end:
                raise Mismatch(high, "the axes do not start")
            return range(high, high + 1)
        least = max(low, math.ceil(ticks[seen] - after - TOLERANCE))
        most = min(high, math.floor(ticks[seen] - after + TOLERANCE))
        if least > most:
            begin = (ticks[seen] - after) / MS
            raise Mismatch(
                low,
                f"the first pulse is at {ticks[seen]}, so the path began at {begin:.4f} ms, "
                f"not from {low / MS:.4f} to {high / MS:.4f}",
            )
        return range(least, most + 1)

    def _start_at(self, tick: int, ends: list[tuple[int, int]]) -> Course:
        new = self.fork()
        new.pending = None
        new.ends, new.laid, new.stops, new.rests = ends, 0, False, False
        (new.first, new.place), new.time = self.rest, tick << ROOT_BITS
        new.begun = self.rest, new.time
        return new

    def steps_from(self, tick: int) -> Iterator[Step]:
        """The whole steps of the longest axis from a tick on."""
        at = 0
        self.lay_until(tick)
        while True:
            while at == len(self.legs) and not self.ended:
                self.lay_next()
            if at == len(self.legs):
                return
            leg, vector = self.legs[at]
            if leg.end_time + 1 >= tick - 1 << ROOT_BITS:
                yield from self._steps_on(at, leg, vector.length, tick)
            at += 1

    @staticmethod
    def _steps_on(at: int, leg: Leg, length: int, tick: int) -> Iterator[Step]:
        steps = leg.pulses(length, length)
        low, high = 0, len(steps)
        while low < high:
            middle = (low + high) // 2
            if leg.pulse_time(length, length, steps[middle]) < tick - 1 << ROOT_BITS:
                low = middle + 1
            else:
                high = middle
        for step in steps[low:]:
            yield Step(at, leg.vector, step, leg.pulse_time(length, length, step))

    def begin_step(self, tick: int) -> Step | None:
        """The place where the path has left its stand, if it has made no pulse by a tick."""
        (vector, place), time = self.begun
        legs = [at for at, (leg, _) in enumerate(self.legs) if leg.time >= time]
        if (
            not legs
            or time > tick << ROOT_BITS
            or self.record.last_before(tick) >= time >> ROOT_BITS
        ):
            return None
        return Step(legs[0], vector, place, time)

    def places(self, earliest: int, cause: int) -> list[Step]:
        """Where a change may take effect that was caused between two ticks.

        That is a step yet to come, or the stand that the path has just left.
        """
        begin = self.begin_step(earliest)
        found = [begin] if begin else []
        for step in self.steps_from(earliest):
            found.append(step)
            if step.time >= cause + PATIENCE << ROOT_BITS:
                break
        return found

    def change(self, step: Step, vectors: Vectors, *, stops: bool) -> Course:
        """Return the course that is planned anew from a whole step."""
        old_first, old_ends, old = self.first, self.ends, self.vectors
        new = replace(self, legs=self.legs[: step.leg + 1], vectors=vectors)
        new.cursors = [replace(cursor) for cursor in self.cursors]
        leg, vector = new.legs[step.leg]
        if (step.vector, step.place) == self.begun[0] and step.time == self.begun[1]:
            new.legs.pop()
            new.plan((step.vector, Fraction(step.place)), 0, step.time, stops=stops)
            return new.fork()
        if step.place == vector.length:
            behind = step.vector + 1
            if behind == len(vectors):
                return replace(self.fork(), vectors=vectors)
            known = behind < len(old) and behind - old_first < len(old_ends)
            square = old_ends[behind - old_first][0] if known else 0
            new.plan((behind, Fraction(0)), square, step.time, stops=stops)
            return new.fork()
        square = whole(leg.square_at(step.place))
        new.legs[step.leg] = (replace(leg, x1=leg.place(step.place)), vector)
        new.plan((step.vector, Fraction(step.place)), square, step.time, stops=stops)
        return new.fork()

    # --- comparison ---

    def verify(self, until: int) -> None:
        """Compare the pulses up to a tick."""
        if not self.pending:
            self.lay_until(until + 2)
            self._verify_all(until)

    def _verify_all(self, until: int) -> None:
        for axis in range(AXES):
            if self.record.growing:
                self._make(axis, until)
            else:
                self._verify_axis(axis, until)

    def _steps_of(self, vector: Vector, axis: int) -> int:
        return vector.steps[self.follows if axis == 3 and self.follows is not None else axis]

    def _due(self, axis: int, until: int) -> Iterator[tuple[Leg, Vector, int, range]]:
        """The pulses that are yet to be compared on legs that begin before a tick.

        Who is given them moves the cursor on; where it does not come to their end, they were all.
        """
        cursor = self.cursors[axis]
        while cursor.leg < len(self.legs):
            leg, vector = self.legs[cursor.leg]
            if leg.time >> ROOT_BITS >= until:
                return
            steps = self._steps_of(vector, axis)
            if steps:
                pulses = leg.pulses(vector.length, abs(steps))
                if len(pulses) > cursor.done:
                    yield leg, vector, steps, pulses[cursor.done :]
                if len(pulses) > cursor.done:
                    return
            if leg.end_time >> ROOT_BITS >= until:
                return
            cursor.leg, cursor.done = cursor.leg + 1, 0

    def _verify_axis(self, axis: int, until: int) -> None:
        cursor, train = self.cursors[axis], self.record.trains[axis]
        stop = bisect_right(train.ticks, until)
        for leg, vector, steps, pulses in self._due(axis, until):
            take = min(len(pulses), stop - cursor.seen)
            if take:
                self._compare(axis, leg, vector.length, steps, pulses[:take])
            cursor.seen += take
            cursor.done += take
            if take < len(pulses):
                due = leg.pulse_time(vector.length, abs(steps), pulses[take])
                if due < until - 1 << ROOT_BITS:
                    raise Mismatch(due / 2**ROOT_BITS, f"axis {axis}: a pulse is missing")

    def _compare(self, axis: int, leg: Leg, length: int, steps: int, pulses: range) -> None:
        train, seen = self.record.trains[axis], self.cursors[axis].seen
        ticks = train.ticks[seen : seen + len(pulses)]
        way = train.places[seen + len(pulses)] - train.places[seen]
        begin = leg.time >> ROOT_BITS
        part = (leg.time - (begin << ROOT_BITS)) / 2**ROOT_BITS
        if leg.is_short:
            times = leg.rough_times(length, abs(steps), pulses)
            offs = [tick - begin - part - time for tick, time in zip(ticks, times, strict=True)]
        else:
            offs = [
                ((tick << ROOT_BITS) - leg.pulse_time(length, abs(steps), k)) / 2**ROOT_BITS
                for tick, k in zip(ticks, pulses, strict=True)
            ]
        worst = max(max(offs), -min(offs))
        if worst > TOLERANCE + FLOAT_ERROR:
            which = next(i for i, off in enumerate(offs) if abs(off) > TOLERANCE + FLOAT_ERROR)
            raise Mismatch(
                ticks[which], f"axis {axis}: pulse {pulses[which]} is {offs[which]:+.2f} ticks off"
            )
        if way != (len(pulses) if steps > 0 else -len(pulses)):
            raise Mismatch(ticks[0], f"axis {axis}: pulses go the wrong way")
        self.worst = max(self.worst, worst)

    def _make(self, axis: int, until: int) -> None:
        cursor, train = self.cursors[axis], self.record.trains[axis]
        for leg, vector, steps, pulses in self._due(axis, until):
            take = 0
            for pulse in pulses:
                time = leg.pulse_time(vector.length, abs(steps), pulse)
                tick = time + (1 << ROOT_BITS - 1) >> ROOT_BITS
                if tick > until:
                    break
                train.add(tick, 1 if steps > 0 else -1)
                take += 1
            cursor.seen += take
            cursor.done += take
