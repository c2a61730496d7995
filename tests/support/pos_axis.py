"""An axis of the positioning unit: its states and bits, written from the contract alone."""

from __future__ import annotations

import math
from dataclasses import replace

from pos_bits import Bits
from pos_change import CHANGE
from pos_curve import Order
from pos_homing import Homing
from pos_motion import Motion, Train
from pos_refusal import refusal
from pos_session import Act
from pos_target import Goal, Origin, Seat, absolute, relative
from pos_ways import Ways
from pos_words import (
    MEASURES,
    MS,
    US,
    Code,
    Error,
    Settings,
    is_active,
)

EDGE_LATE = 60 * US
"""An edge of an input is noted so late, if it follows another one."""

INITIATOR = 2 * MS
"""From a stand to the start of what waits for it: a pass for the initiator, one for the start."""

RENEWING = MEASURES | {Code.POS_INIT, Code.POS_RESET}


class Axis:
    """The state of an axis."""

    def __init__(self, train: Train, late: int, ways: Ways) -> None:
        """Switch the unit on; changes take effect within so many ticks, or at the next pulse."""
        self.late, self.ways = late, ways
        self.settings = Settings()
        self.bits = Bits()
        self.history: list[tuple[float, float, Bits]] = [(0, 0, Bits())]
        self.origin = Origin()
        self.seat = Seat(0, 0, 0)
        self.motion = Motion(train)
        self.levels: dict[int, int] = {}
        self.goal: Goal | None = None
        self.programmed: Act | None = None
        self.cut = False
        self.target = 0
        """The step at which the measure ends."""
        self.order = Order(0, 0, 1, 0)
        self.homing: Homing | None = None
        self.captured: set[int] = set()
        """What CAPTURED_STEPS may be; empty: nothing was captured."""
        self.initiated = 0
        """By then the initiator has done its work."""
        self.permitted = 0
        """Since when a speed other than 0 is wanted."""
        self.before: tuple[Origin, Bits, Act] | None = None
        """What was before it, and the measure, if it has found nothing to do."""
        self.crystal = True
        self.damaged = False

    def note(self, low: float, high: float) -> None:
        """Keep what the registers tell from a time in a window on."""
        if self.history[-1][2] != self.bits:
            self.history.append((low, high, replace(self.bits)))

    def active(self, name: str) -> bool:
        """Whether one of the four inputs is active: limit_minus, limit_plus, reference, capture."""
        return is_active(self.levels, getattr(self.settings, name))

    def seat_at(self, tick: float) -> Seat:
        """Where the motor was at a tick of the measure."""
        made = self.motion.train.count_until(tick) - self.motion.offset
        return self.seat.moved(made * self.motion.sign)

    @property
    def goes_on(self) -> bool:
        """Whether it leaves the next stand by itself."""
        return self.programmed is not None or self.homing is not None

    # --- instructions ---

    def take(self, act: Act) -> None:
        """Execute an instruction."""
        bits = self.bits
        renews = act.code in RENEWING and (act.code != Code.POS_INIT or not refusal(self, act))
        waiting = None
        if self.before and act.tick < self.initiated and renews:
            waiting = self._undo(self.before)
        if act.code == Code.POS_CONTROL:
            self._control(act)
        else:
            bits.result = refusal(self, act)
            if bits.result:
                bits.err, bits.error = True, bits.error or bits.result
            elif act.code == Code.POS_INIT:
                self._release(act.tick, disp=True)
            elif act.code == Code.POS_RESET:
                self._release(act.tick, disp=False)
            elif act.code == Code.POS_CAPTURE:
                bits.armed = True
            else:
                self._measure(act)
        self.note(act.tick, act.tick + MS)
        if waiting and bits.result:
            self.initiate(waiting, act.tick, act.tick + MS)

    def _undo(self, before: tuple[Origin, Bits, Act]) -> Act | None:
        """A measure of no pulses may not have been looked at yet; then it is returned."""
        self.before = None
        if not self.ways.choose():
            return None
        self.origin, bits, measure = before
        for name in ("referenced", "pol", "err", "error", "disp", "prog"):
            setattr(self.bits, name, getattr(bits, name))
        self.goal = self.homing = None
        self.cut = False
        return measure

    def minds(self, act: Act) -> bool:
        """Whether it makes a difference if the axis stands or is about to."""
        if self.homing and self.homing.part:
            return act.code != Code.POS_CAPTURE
        aims = self.goal is not None or self.programmed is not None
        return act.code in MEASURES or (act.code in (Code.POS_INIT, Code.POS_RESET) and aims)

    def goal_of(self, act: Act) -> Goal:
        """What a measure aims at."""
        make = absolute if act.code == Code.POS_MODE_ABS else relative
        return make(self.origin, self.settings, act.values[-2])

    def _release(self, tick: int, *, disp: bool) -> None:
        bits = self.bits
        bits.disp = bits.mp = disp
        bits.prog = bits.pol = bits.err = bits.inic = bits.cont = False
        bits.error, bits.feed = Error.NONE, 0
        self._give_up(tick)

    def _give_up(self, tick: int, accel: int = 0) -> None:
        """Forget the measure; brake, with an acceleration of its own if it is not 0."""
        self.goal, self.programmed, self.homing, self.cut = None, None, None, False
        self.bits.homing = False
        if self.bits.jede:
            # also where it is to stand already: that may wait for a pulse, and this need not
            before, self.order = (
                self.order,
                replace(self.order, speed=0, accel=accel or self.order.accel),
            )
            self.motion.change(tick, self.order, self.late, anew=self.order != before)
        else:
            self.settle()

    def settle(self) -> None:
        """The axis stands on a step, and what it was to do is over."""
        self.settle_at_end()
        self.origin.given_up(self.settings, self.seat.step)

    def settle_at_end(self) -> None:
        """The axis stands on a step."""
        self.seat = self.seat.moved(self.motion.seen * self.motion.sign)
        self.motion.prepare(self.motion.sign)

    def _measure(self, act: Act) -> None:
        bits = self.bits
        bits.prog, bits.inic, bits.pol, bits.cont, bits.feed = True, True, False, False, 0
        bits.homing = False
        self.programmed = act
        if not bits.jede:
            self.note(act.tick, act.tick + MS)
            self.settle()
            self.initiated = act.tick + MS
            self.initiate(act, act.tick, act.tick + CHANGE)

    def initiate(self, act: Act, low: float, high: float) -> None:
        """The axis stands: the measure is there."""
        bits = self.bits
        bits.inic = False
        self.before = replace(self.origin), replace(bits), act
        self.programmed, self.goal, self.cut, self.homing = None, None, False, None
        accel = self.settings.accel(act.values[-1])
        if act.code == Code.POS_HOME:
            self.homing = Homing(self, act, accel)
            self.homing.initiate()
        else:
            self.goal = self.goal_of(act)
            step = self.target = self._inside(self.goal.step)
            self.cut = step != self.goal.step
            self.lay_out(self.seat.pulses_to(step), accel)
            bits.cont = self.order.end > 0
            bits.pol = not bits.cont
            if bits.pol:
                self._reached(low, high)
        if bits.cont:
            self.before = None
        self.note(low, high + MS)
        self.go(low, high)

    def _inside(self, step: int) -> int:
        """A step, or the last one that software limits let the axis reach."""
        settings, here = self.settings, self.seat.step
        if not (settings.soft and self.bits.referenced) or step == here:
            return step
        limit = settings.soft_max if step > here else settings.soft_min
        exact = self.origin.reference + (limit - self.origin.position) * settings.ratio
        sign = 1 if step > here else -1
        last = math.floor(sign * exact) * sign
        while (self.origin.position_of(settings, last + sign) - limit) * sign <= 0:
            last += sign
        return sign * min(sign * step, max(sign * here, sign * last))

    def lay_out(self, pulses: int, accel: int) -> None:
        """A motion of so many pulses, signed, from where the axis stands."""
        self.motion.prepare(1 if pulses > 0 else -1 if pulses < 0 else self.motion.sign)
        self.order = Order(0, self.settings.start_speed, accel, abs(pulses))

    # --- motion ---

    @property
    def speed(self) -> int:
        """W, in 1/256 step/s."""
        bits = self.bits
        feed = min(bits.feed, self.homing.feed) if self.homing else bits.feed
        return self.settings.speed(feed) if bits.mp else 0

    def _control(self, act: Act) -> None:
        feed, mp = act.values
        bits = self.bits
        if not bits.disp:
            return
        held = self.speed == 0
        if mp >= 0:
            bits.mp = bool(mp)
        if bits.prog:
            bits.feed = feed
            self.permitted = act.tick if held else self.permitted
            self.go(act.tick, max(act.tick, self.initiated) + CHANGE)

    def go(self, low: float, high: float) -> None:
        """Start, change or hold, if what is wanted says so."""
        bits = self.bits
        if not bits.prog or bits.pol or self.programmed:
            return
        if bits.jede:
            if not (self.homing and self.homing.stops):
                self.want(int(low), replace(self.order, speed=self.speed))
        elif self.speed and self.order.end:
            if self.homing:
                self.homing.begins()
            self._start(max(int(low), self.permitted), max(int(high), self.permitted + CHANGE))

    def _start(self, low: int, high: int) -> None:
        sign = self.motion.sign
        if self.blocked(sign):
            self.fault(Error.LIMIT, low, high)
            return
        self.order = replace(self.order, speed=self.speed)
        self.motion.begin(self.order, low, high)
        self.bits.jede, self.bits.smer = True, sign < 0
        self.note(low, high + MS)

    def blocked(self, sign: int) -> bool:
        """Whether the limit input of a direction is active, and counts."""
        name = "limit_plus" if sign > 0 else "limit_minus"
        if self.homing and self.homing.switch == abs(getattr(self.settings, name)):
            return False
        return self.active(name)

    def stays(self) -> None:
        """The start that was to come does not."""
        self.motion.prepare(self.motion.sign)
        self.bits.jede = False

    def want(self, tick: int, order: Order) -> None:
        """Want something else of an axis that moves."""
        if order != self.order:
            self.order = order
            self.motion.change(tick, order, self.late)

    def limit(self, tick: int) -> None:
        """Brake at a limit; of an axis that is free there is no fault to be told."""
        if self.bits.disp:
            self.fault(Error.LIMIT, tick, tick)
        else:
            self._give_up(tick, self.settings.accel(self.settings.error_accel))

    def fault(self, error: Error, low: int, high: float) -> None:
        """A fault ends the measure."""
        bits = self.bits
        bits.err = True
        if not bits.fault:
            bits.error = error
        bits.prog = bits.pol = bits.inic = bits.cont = False
        bits.feed = 0
        self._give_up(low, self.settings.accel(self.settings.error_accel))
        self.note(low, high + MS)

    def stands(self) -> None:
        """The axis has come to stand."""
        low, high = self.motion.stand()
        bits = self.bits
        if self.homing and self.homing.stands(low, high):
            return
        bits.jede = False
        if self.homing is None and self.goal is None:
            self.settle()
            act = self.programmed
            if act:
                self.note(low, high + MS)
                self.initiate(act, low, high + INITIATOR)
        elif self.motion.every(self.ways, lambda c: c.reaches):
            self.settle_at_end()
            bits.pol, bits.cont = True, False
            self._reached(low, high)
        self.note(low, high + MS)

    def _reached(self, low: float, high: float) -> None:
        """The last pulse, or none to make."""
        assert self.goal is not None
        if self.cut:
            self.bits.jede = False
            self.fault(Error.SOFT_LIMIT, int(low), high)
            return
        self.origin.base, self.origin.way = self.goal.base, self.goal.way
        self.goal = None
