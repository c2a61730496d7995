"""All ways in which the axes of a GVE134 unit may have moved so far, as its pulses show.

Where the contract leaves the unit a choice, each course becomes one for every choice; those that do
not agree with the pulses are dropped, and when none is left the unit has broken the contract.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace

from exact import Fraction
from gve_course import MS, PATIENCE, Course, Mismatch, Place, Record, Step, Vectors
from path_reference import ROOT_BITS

COURSES_MANY = 8
"""From so many on those that stand alike are merged."""

COURSES_MAX = 400
NEAR = 8 << ROOT_BITS
SAME = 1 << ROOT_BITS - 20


def same_time(course: Course, step: Step) -> bool:
    """Whether a course passes a step when another one does."""
    course.lay_until(step.time >> ROOT_BITS)
    for leg, vector in reversed(course.legs):
        if leg.vector == step.vector and leg.x0 < step.place * leg.per_step <= leg.x1:
            time = leg.pulse_time(vector.length, vector.length, int(step.place))
            return abs(time - step.time) < SAME
    return False


def merged(courses: list[Course], tick: int) -> list[Course]:
    """Keep one of the courses that came to rest at the same place, some ticks apart.

    Of those that move, one of those that go on alike.
    """
    kept: list[Course] = []
    resting: dict[object, Course] = {}
    for course in courses:
        seen = tuple(cursor.seen for cursor in course.cursors)
        if not course.ended or course.time > tick << ROOT_BITS:
            way = course.way_from(tick)
            other = resting.setdefault((way, seen, course.kept), course) if way else course
            if other is course or abs(other.end_of_leg(tick) - course.end_of_leg(tick)) > SAME:
                kept.append(course)
            continue
        key = (course.rest, course.kept, len(course.vectors), seen, course.pending is None)
        other = resting.setdefault(key, course)
        if other is course or abs(other.time - course.time) > NEAR:
            kept.append(course)
        elif other.pending and course.pending:
            (a, b), (c, d) = other.pending, course.pending
            other.pending = min(a, c), max(b, d)
    return kept


class Motion:
    """The courses that agree with the pulses."""

    def __init__(self, record: Record) -> None:
        """The axes stand."""
        self.record = record
        self.courses = [Course(record)]

    def _keep(self, courses: list[Course]) -> None:
        if self.record.growing:
            courses = courses[-1:]
        if len(courses) > COURSES_MAX:
            raise Mismatch(self.record.end, "too many courses to follow")
        self.courses = courses

    def each(self, act: Callable[[Course], Iterable[Course]]) -> None:
        """Replace each course by those that come of it; one that contradicts the pulses by none."""
        courses: list[Course] = []
        wrong: list[Mismatch] = []
        for course in self.courses:
            try:
                courses += act(course)
            except Mismatch as mismatch:
                wrong.append(mismatch)
        if not courses:
            raise max(wrong, key=lambda mismatch: mismatch.tick)
        self._keep(courses)

    def keep(self, holds: Callable[[Course], bool], tick: int, otherwise: str) -> None:
        """Drop the courses for which something does not hold."""
        courses = [course for course in self.courses if holds(course)]
        if not courses:
            raise Mismatch(tick, otherwise)
        self._keep(courses)

    def verify(self, until: int) -> None:
        """Compare the pulses up to a tick."""

        def check(course: Course) -> list[Course]:
            course.verify(until)
            return [course]

        self.each(lambda course: course.settle_late(until))
        self.each(check)
        if len(self.courses) > COURSES_MANY:
            self.courses = merged(self.courses, until)

    # --- what the unit does ---

    def begin(self, vectors: Vectors, at: Place | None, window: tuple[int, int]) -> None:
        """Leave the stand within a window, from a place, or from where each course rests."""
        for course in self.courses:
            course.begin(vectors, at or course.rest, window)

    def add(self, tick: int, vectors: Vectors, pause: int) -> None:
        """More vectors are known from a tick on; a new chain would begin after a pause."""

        def add_to(course: Course) -> list[Course]:
            if course.pending:
                return [replace(course.fork(), vectors=vectors)]
            places = course.places(tick, tick)
            joined = [course.change(step, vectors, stops=False) for step in places[:1]]
            if len(places) > 1 and not same_time(joined[0], places[-1]):
                joined += [course.change(step, vectors, stops=False) for step in places[1:]]
            if not places or places[-1].time < tick + PATIENCE << ROOT_BITS:
                joined.append(self._after(course, vectors, tick, pause))
            return joined

        self._settled(tick, add_to)

    @staticmethod
    def _after(course: Course, vectors: Vectors, tick: int, pause: int) -> Course:
        """The course whose path comes to its end, so that the vectors begin a chain."""
        new = course.fork()
        end = math.ceil(course.end_tick())
        new.lay_until(end + 1)
        low = max(tick, end, end + pause - 2)
        window = low, max(tick + MS, end + pause + 1)
        new.begin(vectors, (len(course.vectors), Fraction(0)), window)
        return new

    def _settled(
        self, tick: int, act: Callable[[Course], Iterable[Course]], late: int = PATIENCE
    ) -> None:
        self.each(lambda course: course.settle(tick, late))
        self.each(act)

    def change(self, tick: int, vectors: Vectors, *, stops: bool, latest: int = 0) -> None:
        """Plan anew, for other limits or to stop, because of something in a window of ticks."""

        def plan(course: Course) -> list[Course]:
            if course.pending:
                new = replace(course.fork(), vectors=vectors)
                if stops:
                    new.pending, new.time, new.ends, new.laid = None, tick << ROOT_BITS, [], 0
                return [new]
            places = course.places(tick, max(tick, latest))
            changed = [course.change(step, vectors, stops=stops) for step in places]
            return changed or [replace(course.fork(), vectors=vectors)]

        self._settled(tick, plan, PATIENCE + max(0, latest - tick))

    def forget(self, tick: int) -> None:
        """Delete what waits from a tick on, where the axes stand."""
        for course in self.courses:
            course.time = tick << ROOT_BITS
            course.vectors, course.ends, course.laid = (), [], 0
            course.rest, course.pending = (0, Fraction(0)), None

    # --- what there is to know ---

    def ends(self, tick: int) -> list[float | None]:
        """When each course came to rest; None: not by that tick."""
        found: list[float | None] = []
        for course in self.courses:
            course.lay_until(tick)
            stands = not course.pending and course.ended and course.time <= tick << ROOT_BITS
            found.append(course.time / 2**ROOT_BITS if stands else None)
        return found

    def end(self) -> tuple[float, float]:
        """When the first and the last of the courses come to rest, if nothing happens."""
        self.each(lambda course: course.settle(course.pending[1]) if course.pending else [course])
        ends = [course.end_tick() for course in self.courses]
        return min(ends), max(ends)

    def keep_ended(self, tick: int, *, since: float) -> None:
        """Keep the courses that came to rest up to a tick, and not before another one."""
        ends = {id(c): end for c, end in zip(self.courses, self.ends(tick), strict=True)}
        self.keep(
            lambda course: (end := ends[id(course)]) is not None and end >= since,
            tick,
            "the axes stand too early or too late",
        )

    def keep_moving(self, tick: float, until: int) -> None:
        """Keep the courses that have not come to rest before a tick."""
        ends = {id(c): end for c, end in zip(self.courses, self.ends(until), strict=True)}
        self.keep(
            lambda course: (end := ends[id(course)]) is None or end > tick,
            until,
            "the axes stand",
        )

    def vectors_done(self, tick: int) -> tuple[int, int]:
        """How many vectors are done by a tick: the least and the most."""
        done = [course.vector_at(tick) for course in self.courses]
        return min(done), max(done)
