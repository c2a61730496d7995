"""The pins of a motor in the model of the language: its pulses, and function 41.

In simulation the pulses of a motor are made all the same, but do not reach the pins, and its
position goes back at the end. When it was switched is taken from the record.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from language_signals import SEEN_TICKS, Difference, Moment, Unsure
from language_world import World

NEVER = 1 << 63


class Pins:
    """The position of a motor, its pulses, and whether they reach the pins."""

    def __init__(self, world: World) -> None:
        self.connected = True
        self.position = 0
        self._real_position = 0
        self._trains = world.trains
        self._ticks = {c: [abs(tick) for tick in train] for c, train in world.trains.items()}
        self._taken = {True: 0, False: 0}
        self._changes = world.connections
        self._switches = world.switches

    @property
    def ticks(self) -> Sequence[int]:
        """All pulses of the kind that it makes now."""
        return self._ticks[self.connected]

    @property
    def taken(self) -> int:
        """How many of them belong to moves that are over."""
        return self._taken[self.connected]

    def take(self, made: int) -> Sequence[int]:
        """Account for the pulses of a move; returns them."""
        first = self.taken
        self._taken[self.connected] += made
        return self._trains[self.connected][first : first + made]

    def end_move(self, heading: int, made: int, done: int, seen: int) -> None:
        """Account for a move that has ended, and follow what was switched meanwhile."""
        if any((tick > 0) != (heading > 0) for tick in self.take(made)):
            raise Difference(f"a pulse the wrong way before {done}")
        if self._next_tick < done:
            raise Difference(f"switched in the move that ends at {done}")
        self.position += heading * made
        if self._changes and self._changes[0].ends_move and self._next_tick <= seen + SEEN_TICKS:
            self._switch()

    def simulate(self, on: bool, now: Moment) -> None:
        """Switch simulation by this motor's own program: it stands, so it follows at once."""
        if self.connected == on:
            if not now.low <= self._next_tick <= now.high:
                raise Difference(f"not switched at {now.low} to {now.high}")
            now.pin(self._next_tick)
            self._switch()
        self._switches.append((replace(now), on))

    def follow(self, until: int) -> None:
        """Follow what others have switched before a tick; the motor stands."""
        while self._next_tick < until:
            self._switch()

    def settle(self, now: Moment) -> None:
        """The same before something is done now."""
        self.follow(now.low)
        if self._next_tick <= now.high:
            raise Unsure("another motor switches simulation meanwhile")

    @property
    def _next_tick(self) -> int:
        return self._changes[0].tick if self._changes else NEVER

    def _switch(self) -> None:
        change = self._changes.popleft()
        if change.connected == self.connected:
            raise Difference(f"switched twice at {change.tick}")
        self.connected = change.connected
        if change.connected:
            self.position = self._real_position
        else:
            self._real_position = self.position

    def expect_no_more(self, number: int) -> None:
        """All pulses belong to moves."""
        for connected, train in self._trains.items():
            if self._taken[connected] != len(train):
                where = "at the pins" if connected else "in simulation"
                made = self._taken[connected]
                raise Difference(f"motor {number}: {len(train)} pulses {where}, not {made}")
