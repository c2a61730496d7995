"""The positioning unit against the contract: a session and what the unit did in it, side by side.

`compare` raises `Mismatch` with the first thing that no reading of the contract explains, and
`Unsure` where the model cannot tell; `judge` tells all that is wrong.

The unit may notice a change at any time within 1 ms of it. From then on it takes effect at the next
pulse, or at constant speed where the axis is (below 1 step/s within 20 ms); limits, the switch of
homing and faults stop likewise. What the contract decides only later is tried one way and then the
other (`pos_ways`). Undecided, thus `Unsure`, is what is left:

- changes so close together that more curves fit the pulses than can be followed: two and more of
  them between two pulses, or in the ramp of one another;
- a pulse within 1 µs of the edge of the reference switch, which is counted or is not;
- a switch that changes in the millisecond in which a part of homing starts, or that lets go before
  the axis turns: the contract has no part for it;
- ERROR_ACCEL so weak that the axis would brake past the end of its measure.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from pos_axis import EDGE_LATE, INITIATOR, Axis
from pos_change import CHANGE
from pos_motion import Train
from pos_read import check_sample, read
from pos_session import Act, Edge, Event, Sample, Session, Setting
from pos_target import Origin, Seat
from pos_ways import Ways
from pos_words import AXES, MOVES_ORIGIN, MS, REGISTER, US, Code, Mismatch, Settings, Unsure

NOTICED = 4
"""Ticks after a stand, by when its last pulse has come for sure."""

FAR_APART = 5 * MS // 2
"""Stands that are further apart cannot be told from what comes after them."""


@dataclass
class Done:
    """What a unit did: the pulses of the axes 1 to 4, and registers that were read."""

    trains: list[Train] = field(default_factory=lambda: [Train() for _ in AXES])
    samples: list[Sample] = field(default_factory=list)
    results: dict[int, int] = field(default_factory=dict)
    """Of instructions, by their index in the script, the error or 0."""


class Follower:
    """Leads one axis through a session."""

    def __init__(self, session: Session, done: Done, number: int, late: int = CHANGE) -> None:
        """Switch the unit on."""
        self.number = number
        self.train = done.trains[number - 1]
        self.late = late
        self.ways = Ways(self.train.growing)
        self.end = session.end
        self.results = {
            id(act): done.results[index]
            for index, act in enumerate(session.script)
            if isinstance(act, Act) and index in done.results
        }
        self.events = sorted(self._events(session, done), key=lambda event: event.tick)

    def _events(self, session: Session, done: Done) -> Iterator[Event]:
        yield from session.edges
        yield from (each for each in session.script if each.axis == self.number)
        if self.train.growing:
            yield from (Sample(t, a, {}) for t, a in session.reads if a == self.number)
        else:
            yield from (sample for sample in done.samples if sample.axis == self.number)

    def go(self) -> Iterator[Sample]:
        """Follow the session to its end; what a growing unit would tell, when it is asked."""
        self.axis = Axis(self.train, self.late, self.ways)
        self.edge_tick = -math.inf
        for event in self.events:
            self.advance(event.tick, event)
            if isinstance(event, Edge):
                self._edge(event)
            elif isinstance(event, Act):
                self._take(event)
            elif isinstance(event, Setting):
                self._set(event)
            elif self.train.growing:
                yield read(self.axis, event.tick, self.number)
            else:
                check_sample(self.axis, event)
        self.advance(self.end)

    def agrees(self) -> None:
        """Try all ways; the mismatch that comes last tells what is wrong."""
        wrong: Mismatch | None = None
        unsure: Unsure | None = None
        while True:
            try:
                for _ in self.go():
                    raise AssertionError("a unit that has been watched tells nothing more")
            except Mismatch as mismatch:
                wrong = mismatch if wrong is None or mismatch.tick > wrong.tick else wrong
            except Unsure as reason:
                unsure = reason
            else:
                return
            if not self.ways.turn():
                break
        if unsure or wrong is None:
            raise unsure or AssertionError("nothing was tried")
        raise wrong

    def _minds(self, event: Event | None) -> bool:
        """Whether it makes a difference to an event if the axis stands or is about to."""
        settings = self.axis.settings
        if isinstance(event, Edge):
            limits = {abs(settings.limit_minus), abs(settings.limit_plus)}
            return event.number in limits or self.axis.blocked(self.axis.motion.sign)
        return isinstance(event, Act) and self.axis.minds(event)

    def advance(self, tick: int, event: Event | None = None) -> None:
        """Let the axis come to all stands up to a tick, when something may happen."""
        axis, motion, bits = self.axis, self.axis.motion, self.axis.bits
        while bits.jede:
            first, last = motion.stand()
            if axis.goes_on and first < last and first < tick:
                # what comes after the first stand may be of the next motion, if it is that
                motion.verify(math.floor(first) - NOTICED, goes_on=True)
                first, last = motion.stand()
            stands = math.ceil(last + motion.blur_ticks) + NOTICED
            if first < tick and last - first > FAR_APART and axis.goes_on:
                motion.rests_early(self.ways, FAR_APART)
                continue
            motion.verify(min(stands, tick), goes_on=axis.goes_on)
            first, last = motion.stand()
            minds = self._minds(event)
            if math.ceil(last + motion.blur_ticks) + NOTICED <= min(stands, tick):
                unseen = INITIATOR if axis.goes_on else MS
                if minds and tick < last + unseen and self.ways.choose():
                    return
                axis.stands()
            elif minds and first <= tick:
                if not motion.stood(self.ways, tick, MS):
                    return
                axis.stands()
            elif stands >= tick:
                return
        motion.verify(tick)

    def _take(self, act: Act) -> None:
        self.axis.take(act)
        told = self.results.get(id(act))
        result = 0 if act.code == Code.POS_CONTROL else self.axis.bits.result
        if told not in (None, result):
            raise Mismatch(act.tick, f"{act.code.name} has the result {told}, not {result}")

    def _edge(self, edge: Edge) -> None:
        axis, bits = self.axis, self.axis.bits
        before = {name: axis.active(name) for name in ("capture", "reference")}
        late = EDGE_LATE if edge.tick - self.edge_tick < EDGE_LATE else 0
        axis.levels[edge.number] = edge.level
        self.edge_tick = edge.tick
        if bits.armed and axis.active("capture") and not before["capture"]:
            steps = [axis.seat_at(edge.tick + off).step for off in (-US, US, max(US, late))]
            axis.captured = set(range(min(steps), max(steps) + 1))
            bits.armed, bits.captures = False, bits.captures + 1
        if axis.homing and axis.active("reference") != before["reference"]:
            axis.homing.edge(edge.tick, late)
        if bits.jede and axis.blocked(axis.motion.sign) and not bits.fault:
            if axis.motion.may_wait(edge.tick) and axis.motion.waits(self.ways, edge.tick):
                axis.stays()
            axis.limit(edge.tick)
        axis.note(edge.tick, edge.tick + MS)

    def _set(self, event: Setting) -> None:
        axis = self.axis
        if axis.bits.disp or axis.bits.jede:
            return
        axis.settings = replace(axis.settings, **{event.name: event.value})
        if event.name in MOVES_ORIGIN:
            step = axis.seat.step
            backlash = axis.settings.backlash_steps
            if backlash != axis.seat.backlash:
                axis.seat = Seat(step, backlash, backlash)
            axis.origin = Origin(step, 0, step, 0)
            axis.bits.referenced = False
        axis.note(event.tick, event.tick + MS)


def compare(session: Session, done: Done, late: int = CHANGE) -> None:
    """Hold what a unit did against the contract; changes may take effect so late."""
    for number in AXES:
        Follower(session, done, number, late).agrees()


def judge(session: Session, done: Done) -> list[str]:
    """What is wrong: the first thing of each axis."""
    wrong = []
    for number in AXES:
        try:
            Follower(session, done, number).agrees()
        except Mismatch as mismatch:
            wrong.append(f"axis {number}: {mismatch}")
        except Unsure:
            continue
    return wrong


def imagine(session: Session, seed: object = 0) -> Done:
    """What a unit that keeps the contract could do; what is open is drawn from a seed."""
    done = Done([Train(growing=random.Random(f"{seed} {number}")) for number in AXES])
    for number in AXES:
        done.samples += Follower(session, done, number).go()
    for train in done.trains:
        train.growing = None
    done.samples.sort(key=lambda sample: sample.tick)
    return done


def setting(tick: int, axis: int, name: str, value: int) -> Setting:
    """A setting by its name."""
    assert hasattr(Settings(), name)
    return Setting(tick, 100 * axis + REGISTER[name], value)
