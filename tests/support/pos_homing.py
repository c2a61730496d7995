"""Homing of the positioning unit, written from the contract alone."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from pos_session import Act
from pos_words import FORWARD_METHOD, HERE_METHOD, MS, US, Error, Unsure

if TYPE_CHECKING:
    from pos_axis import Axis

TO_SWITCH, OFF_SWITCH, TO_REFERENCE = 1, 2, 3


class Homing:
    """A homing in progress."""

    def __init__(self, axis: Axis, act: Act, accel: int) -> None:
        """It is programmed."""
        self.axis = axis
        self.method, self.position = act.values[:2]
        self.accel = accel
        self.sign = 1 if self.method == FORWARD_METHOD else -1
        self.part = 0
        self.stops = False
        """What ended the part has happened."""
        self.steps: set[int] = set()
        """What the reference step may be."""

    @property
    def switch(self) -> int:
        """The input of the switch."""
        return abs(self.axis.settings.reference)

    @property
    def feed(self) -> int:
        """The most of it in this part."""
        settings = self.axis.settings
        return settings.home_feed if self.part <= TO_SWITCH else settings.home_slow

    def initiate(self) -> None:
        """The axis stands and its initiator is at work."""
        axis = self.axis
        if self.method == HERE_METHOD:
            self._found()
            return
        axis.bits.cont = True
        axis.bits.homing = True
        axis.lay_out(self._way(self.sign), self.accel)

    def _way(self, sign: int) -> int:
        axis = self.axis
        steps = axis.settings.way_steps(axis.settings.home_way)
        if steps == 0:
            raise Unsure("a homing without a way")
        return axis.seat.pulses_to(axis.seat.step + sign * steps)

    def begins(self) -> None:
        """The axis leaves a stand."""
        axis = self.axis
        axis.bits.referenced = False
        if self.part == 0:
            self.part = OFF_SWITCH if axis.active("reference") else TO_SWITCH
            if self.part == OFF_SWITCH:
                axis.lay_out(self._way(-self.sign), self.accel)

    def edge(self, tick: int, late: int) -> None:
        """The switch has changed."""
        axis = self.axis
        active = axis.active("reference")
        if self.part == 0 or self.stops or self.part == TO_REFERENCE:
            return
        if active != (self.part == TO_SWITCH):
            return
        if axis.motion.may_wait(tick) and axis.motion.waits(axis.ways, tick):
            raise Unsure("the switch changes just when a part of the homing begins")
        self.stops = True
        if self.part == OFF_SWITCH:
            ticks = (tick - US, tick + US, tick + max(US, late))
            low, *_, high = (axis.seat_at(at).step for at in ticks)
            self.steps = set(range(min(low, high), max(low, high) + 1))
        if axis.bits.jede:
            axis.want(tick, replace(axis.order, speed=0))
        else:
            self._next_part(tick, tick + MS)

    def stands(self, low: float, high: float) -> bool:
        """The axis stands; true if it goes on by itself."""
        axis = self.axis
        if self.method == HERE_METHOD:
            return False
        if self.stops:
            self._next_part(low, high)
            return True
        if not axis.motion.every(axis.ways, lambda c: c.reaches):
            return False
        if self.part == TO_REFERENCE:
            axis.bits.jede = False
            axis.settle_at_end()
            self._found()
            axis.note(low, high + MS)
        else:
            axis.bits.jede = False
            axis.fault(Error.NOT_FOUND, int(low), high)
        return True

    def _next_part(self, low: float, high: float) -> None:
        axis = self.axis
        axis.settle_at_end()
        self.stops = False
        if self.part == TO_SWITCH:
            if not axis.active("reference"):
                raise Unsure("the switch lets go before the axis turns")
            self.part = OFF_SWITCH
            axis.lay_out(self._way(-self.sign), self.accel)
        else:
            self.part = TO_REFERENCE
            if len(self.steps) > 1:
                raise Unsure("a pulse just at the edge of the switch")
            axis.lay_out(axis.seat.pulses_to(min(self.steps)), self.accel)
            if axis.order.end == 0:
                axis.bits.jede = False
                self._found()
                axis.note(low, high + MS)
                return
        moved = axis.bits.jede
        axis.bits.jede = False
        axis.go(low, high + 2 * MS)
        if moved and not axis.bits.jede:
            axis.note(low, high + MS)

    def _found(self) -> None:
        """The axis stands on the reference step."""
        axis, bits = self.axis, self.axis.bits
        axis.origin.refer(axis.seat.step, self.position)
        bits.referenced, bits.pol, bits.cont, bits.homing = True, True, False, False
        axis.homing = None
