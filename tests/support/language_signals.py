"""What the model of the language sees of a run: levels over time, and events that it expects.

The contract leaves small gaps: how long commands take to run, and what comes first of two things
that are hardly apart. A script that falls into such a gap is `Unsure` and says nothing; everything
else that differs is a `Difference`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from program_probe import Event
from reference import TICK_HZ

MS = TICK_HZ // 1000
US = TICK_HZ // 1_000_000

SEEN_TICKS = 60 * US
"""The longest that main may take to notice something, and to begin with what follows."""

COMMAND_TICKS = 3 * US
"""The longest that a command may take."""

BRIEF_TICKS = 200 * US
"""A level that is shorter may be missed by a program that waits for it."""


class Unsure(Exception):
    """The script asks for something whose order the contract leaves open."""


class Difference(Exception):
    """The firmware did something else than the model."""


@dataclass
class Moment:
    """A time of which only bounds are known: the ticks `low` to `high`."""

    low: int
    high: int

    def pin(self, tick: int) -> None:
        """Something was seen to happen at a tick, and what follows comes soon after it."""
        self.low = max(self.low, tick)
        self.high = max(self.low, min(self.high, tick + SEEN_TICKS))


class Signal:
    """The level of one input over time: 0 at first, then changes (tick, level)."""

    def __init__(self, changes: Iterable[tuple[int, int]] = ()) -> None:
        self._ticks = [0]
        self._levels = [0]
        for tick, level in changes:
            if tick == self._ticks[-1]:
                self._levels[-1] = level
            elif level != self._levels[-1]:
                self._ticks.append(tick)
                self._levels.append(level)

    def at(self, tick: int) -> int:
        """The level at a tick; a change at that tick has happened."""
        return self._levels[bisect_right(self._ticks, tick) - 1]

    def during(self, moment: Moment) -> int:
        """The level at a moment that is not known exactly."""
        first, last = (bisect_right(self._ticks, t) for t in (moment.low, moment.high))
        if first != last or moment.low in self._ticks[1:]:
            raise Unsure("an input changes while it is looked at")
        return self._levels[first - 1]

    def first(self, level: int, tick: int) -> int | None:
        """The first tick, from a given one on, at which there is a level; None: never."""
        if self.at(tick) == level:
            return tick
        later = bisect_right(self._ticks, tick)
        return self._ticks[later] if later < len(self._ticks) else None

    def first_lasting(self, level: int, tick: int) -> int | None:
        """The same for one who looks from time to time; unsure if the level is a brief one."""
        found = self.first(level, tick)
        if found is None:
            return None
        end = self.first(1 - level, found)
        if end is not None and end - found < BRIEF_TICKS:
            raise Unsure("a level too brief to wait for")
        return found


class Variables:
    """The internal variables as they were really written: by whom, when and in which order.

    Each motor is compared with what it had to do given what the others have done.
    """

    def __init__(self, events: Sequence[Event]) -> None:
        self._writes = [event for event in events if event.name == "var"]

    def own_writes(self, motor: int) -> list[int]:
        """The places of a motor's writes in the order of all."""
        return [i for i, write in enumerate(self._writes) if write.motor == motor]

    def level(self, number: int, place: int, next_own: int | None, moment: Moment) -> int:
        """The level of a variable for a motor whose last write had a place, at a moment.

        `next_own` is the place of its next write, which lies after the moment.
        """
        level, sure = 0, True
        for i, write in enumerate(self._writes[:next_own]):
            if write.tick > moment.high:
                break
            if abs(write.value) != number:
                continue
            before, level = level, int(write.value > 0)
            settled = i <= place or write.tick < moment.low
            sure = settled or (sure and before == level)
        if not sure:
            raise Unsure("a variable changes while it is looked at")
        return level

    def signal(self, number: int) -> Signal:
        """The variable over time."""
        writes = (write for write in self._writes if abs(write.value) == number)
        return Signal((write.tick, int(write.value > 0)) for write in writes)


class Levels:
    """The levels that the program of a motor sees; `writes_made` counts its own so far."""

    def __init__(self, inputs: dict[int, Signal], variables: Variables, motor: int) -> None:
        self._inputs = inputs
        self._variables = variables
        self._own = variables.own_writes(motor)
        self.writes_made = 0

    def at(self, number: int, moment: Moment) -> int:
        """The level of an input or a variable."""
        if number <= 8:
            return self._inputs[number].during(moment)
        made = self.writes_made
        place = self._own[made - 1] if made else -1
        next_own = self._own[made] if made < len(self._own) else None
        return self._variables.level(number, place, next_own, moment)

    def signal(self, number: int) -> Signal:
        """The same over time."""
        return self._inputs[number] if number <= 8 else self._variables.signal(number)


class Watch:
    """The events of one motor, those of each name in their order, as the model expects them."""

    def __init__(self, motor: int, events: Iterable[Event]) -> None:
        self._motor = motor
        self._queues: dict[str, deque[Event]] = {}
        for event in events:
            if event.motor == motor and event.name != "start":
                self._queues.setdefault(event.name, deque()).append(event)

    def next(self, name: str) -> Event | None:
        """The next event of a name that has not been taken."""
        queue = self._queues.get(name)
        return queue[0] if queue else None

    def expect(self, name: str, value: int, low: int, high: int) -> int:
        """Take an event that must come between two ticks; returns its tick."""
        event = self.next(name)
        if event is None or event.value != value or not low <= event.tick <= high:
            wanted = f"{name} {value} at {low}" + (f" to {high}" if high > low else "")
            raise Difference(f"motor {self._motor}: expected {wanted}, found {event}")
        self._queues[name].popleft()
        return event.tick

    def allow(self, name: str, value: int, low: int, high: int) -> bool:
        """Take an event that may come between two ticks; whether it did."""
        event = self.next(name)
        if event is None or event.value != value or not low <= event.tick <= high:
            return False
        self._queues[name].popleft()
        return True

    def expect_no_more(self) -> None:
        """Whatever has not been taken should not have happened."""
        left = [event for queue in self._queues.values() for event in queue]
        if left:
            raise Difference(f"motor {self._motor}: not expected: {left[:4]}")
