"""The reference run W of the GVE134 unit, written from the contract alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from gve_course import MS
from gve_line import Request
from gve_unit import NEAR_US, NONE, Unit, Unsure
from gve_vector import limited
from gve_words import BOUNDS

INTERRUPTED, FOUND, NOT_FOUND = range(3)


@dataclass
class Run:
    """A reference run in progress."""

    item: Request
    axis: int
    ways: tuple[int, int]
    """To the switch, signed, and away from it."""
    speeds: tuple[int, int]
    part: int = 0
    over: bool = False
    """By H or an interrupt."""
    met: bool = False
    """The switch did what ends the part."""
    begun: int = 0
    """Pulses of the axis before the part."""
    pulses: set[int] = field(default_factory=set)
    """What k may be."""
    seen_tick: int = 0


class Runner:
    """Leads the unit through a reference run."""

    def __init__(self, unit: Unit) -> None:
        """No run is in progress."""
        self.unit = unit
        self.now: Run | None = None

    def start(self, item: Request, args: tuple[int, ...], low: int, high: int) -> None:
        """Begin a run."""
        axis, way, speed, way_back, speed_back = args
        self.now = Run(item, axis, (way, -way_back if way > 0 else way_back), (speed, speed_back))
        unit = self.unit
        unit.phase = "run"
        if any(self.causes()):
            unit.motion.forget(low)
            self.interrupt(low, high)
        else:
            self._go(2 if unit.state.switch_active(axis) else 1, low, low + MS)

    def causes(self) -> tuple[int, int]:
        """The enabled INTR that are active, without the switch of the axis."""
        assert self.now is not None
        low, high = self.unit.state.causes
        return low & ~(1 << self.now.axis), high

    def _go(self, part: int, low: int, high: int, steps: int = 0) -> None:
        run, unit = self.now, self.unit
        assert run is not None
        run.part, run.met = part, False
        if part == 2 and not unit.state.switch_active(run.axis):
            raise Unsure("the switch lets go before the axis leaves it")
        way = [0, *run.ways, steps][part]
        four = [0, 0, 0, 0]
        four[run.axis] = way
        entry = unit.state.modal.entry(
            (four[0], four[1], four[2], four[3]), run.speeds[0 if part == 1 else 1]
        )
        unit.entries = [entry]
        unit.vectors = (limited(entry, None),)
        run.begun = unit.done.motors.trains[run.axis].count_until(low)
        for course in unit.motion.courses:
            course.follows = unit.state.follows
        unit.motion.begin(unit.vectors, NONE, (low, high))

    def edge(self, tick: int) -> None:
        """An input has changed."""
        run, unit = self.now, self.unit
        if run is None:
            return
        if any(self.causes()):
            self.interrupt(tick, tick)
        active = unit.state.switch_active(run.axis)
        if run.met or run.over or run.part == 3 or active != (run.part == 1):
            return
        if run.part == 2 and any(course.pending for course in unit.motion.courses):
            raise Unsure("the switch lets go before the axis leaves it")
        run.met, run.seen_tick = True, tick
        train = unit.done.motors.trains[run.axis]
        made = (train.count_until(tick + off) - run.begun for off in (-NEAR_US, NEAR_US))
        run.pulses = {count + 1 for count in made}
        unit.stop(tick, tick)

    def interrupt(self, low: int, high: int) -> None:
        """An INTR ends the run."""
        run, unit = self.now, self.unit
        assert run is not None
        causes = self.causes()
        unit.caught = (unit.caught[0] | causes[0], unit.caught[1] | causes[1])
        if run.over:
            return
        run.over = True
        old = unit.state.latched
        unit.latch(low, high)
        if run.met:
            unit.state.latched = tuple(a | b for a, b in zip(old, unit.state.latched, strict=True))
        elif run.part:
            unit.stop(low, high)

    def halt(self, low: int, high: int) -> None:
        """H ends the run."""
        run, unit = self.now, self.unit
        assert run is not None
        unit.came_from_h = True
        if not run.over and not run.met:
            unit.stop(low, high)
        run.over = True

    @property
    def next_tick(self) -> int:
        """When the run has to be looked at next."""
        windows = [course.pending for course in self.unit.motion.courses if course.pending]
        if windows:
            return max(high for _, high in windows)
        return math.ceil(self.unit.motion.end()[1])

    def look(self, tick: int) -> None:
        """Go on at a tick that was asked for."""
        run, unit = self.now, self.unit
        assert run is not None
        unit.motion.verify(tick)
        ends = [end for end in unit.motion.ends(tick) if end is not None]
        if len(ends) < len(unit.motion.courses):
            return
        low, high = math.floor(min(ends)), math.ceil(max(ends))
        if run.over:
            self._end(low, high, INTERRUPTED)
        elif run.part == 3:
            self._end(low, high, FOUND)
        elif not run.met:
            self._end(low, high, NOT_FOUND)
        elif run.part == 1:
            self._go(2, low, high + MS)
        else:
            self._return(low, high)

    def _return(self, low: int, high: int) -> None:
        run, unit = self.now, self.unit
        assert run is not None
        made = unit.done.motors.trains[run.axis].count_until(high + 1) - run.begun
        pulses = sorted(run.pulses)
        number = pulses[unit.chooser.pick(len(pulses))] if len(pulses) > 1 else pulses[0]
        back = made - number
        if back < 0:
            raise Unsure("the switch lets go after the last pulse")
        if back == 0:
            self._end(low, high, FOUND)
        else:
            self._go(3, low, high + MS, back if run.ways[0] > 0 else -back)

    def _end(self, low: int, high: int, how: int) -> None:
        run, unit = self.now, self.unit
        assert run is not None
        self.now = None
        unit.phase, unit.entries, unit.vectors = "rest", [], ()
        unit.motion.forget(high)
        if any(low <= reset <= high + MS for reset in unit.done.motors.resets):
            raise Unsure("a J just when a reference run ends")
        if how != FOUND:
            unit.interrupted()
        unit.note_outputs(low, high)
        text = unit.code(BOUNDS if how == NOT_FOUND else 0)
        unit.answer(run.item, [text], max(low, unit.ready_tick), max(high, unit.ready_tick) + MS)
