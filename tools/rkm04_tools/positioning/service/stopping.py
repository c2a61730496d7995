"""Taking the permission away from axes, until they are seen to stand, and to be held for a while.

Who gives it back meanwhile is overruled: POS_INIT ends the measure, so that no permission moves the
axis any more. Who then gives it yet again, as a PLC on the same unit that writes it in every cycle,
may move the axis at any moment, so that nothing is confirmed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from rkm04_tools.line_errors import LineError, PortError
from rkm04_tools.positioning.line_errors import NotConfirmed, NotHeld, Restarted
from rkm04_tools.positioning.service.connection import Connection
from rkm04_tools.positioning.service.looking import IMAGE, IMAGE_WORDS
from rkm04_tools.positioning.service.orders import ALL_AXES
from rkm04_tools.positioning.state import AxisState, mm_text
from rkm04_tools.positioning.table import AXES
from rkm04_tools.positioning.unit import (
    BRAKE_SECONDS,
    GIVEN_AGAIN,
    HELD_SECONDS,
    STOP_SECONDS,
    Unit,
)

PAUSE_SECONDS = 0.02


@dataclass
class Stop:
    """A stop under way. `more` gives axes that are to be stopped, too, as they come."""

    line: Connection
    unit: Unit
    more: Callable[[], list[tuple[int, ...]]]
    axes: set[int] = field(default_factory=set)
    ended: set[int] = field(default_factory=set)
    _given: set[int] = field(default_factory=set)
    """Those that have got the permission yet again."""
    _new: set[int] = field(default_factory=set)
    _answer_end: float = 0.0
    _brake_end: float = 0.0
    _held_from: float = 0.0

    def run(self) -> str:
        """Stop, and see them held."""
        tries, self.unit.wire.tries = self.unit.wire.tries, 1
        try:
            while not self._do():
                time.sleep(PAUSE_SECONDS)
        finally:
            self.unit.wire.tries = tries
        if self._given:
            raise NotHeld(
                _names(self._given),
                f"{GIVEN_AGAIN}; the measure is ended now, take the permission away there",
            )
        return self._text()

    def _do(self) -> bool:
        """A turn; whether all are held."""
        if come := {axis for axes in self.more() for axis in axes}:
            self._new |= come
            self._answer_end = time.monotonic() + STOP_SECONDS
            self._brake_end = time.monotonic() + BRAKE_SECONDS
        try:
            return self._stop()
        except Restarted:
            self.line.restart()  # what has restarted stands
        except PortError:
            raise
        except LineError as error:
            if time.monotonic() > self._answer_end:
                raise NotConfirmed(str(error)) from None
        return False

    def _stop(self) -> bool:
        if self._new:
            self.unit.require_no_other()
            self._take_permission()
            self.axes |= self._new
            is_first = not self._new <= self._given
            self._new = set()
            self._held_from = time.monotonic() if is_first else self._held_from
        looked_at = time.monotonic()
        self.line.look(self.unit)
        self._answer_end = time.monotonic() + STOP_SECONDS
        again = self._end_again()
        moving = [each for each in self._own() if each.moves and each.axis not in self._given]
        if moving and time.monotonic() > self._brake_end:
            which = ", ".join(str(axis.axis) for axis in moving)
            raise NotConfirmed(f"{self.unit.wire.name}, axis {which}: it still moves")
        if again or moving:
            self._held_from = time.monotonic()
        return looked_at >= self._held_from + HELD_SECONDS

    def _end_again(self) -> bool:
        """End the measures of axes that have got the permission again; whether it was the first
        time of one."""
        is_first = False
        for state in self._own():
            number, was_ended = state.axis, state.axis in self.ended
            is_permitted = self.line.looks.wanted[number - 1].permitted
            if not is_permitted or not (was_ended or state.may_move):
                continue
            (self._given if was_ended else self.ended).add(number)
            is_first |= not was_ended
            self._new.add(number)  # POS_INIT gives the permission
            self.line.looks.touch(number)
            self.unit.axis(number).init()
        return is_first

    def _own(self) -> list[AxisState]:
        return [axis for axis in self.line.looks.axes if axis.axis in self.axes]

    def _take_permission(self) -> None:
        """MP = 0; of all axes in one request, with feed 0 too."""
        self.line.looks.touch(*self._new)
        if self._new == set(ALL_AXES):
            self.unit.wire.write(IMAGE, [0] * IMAGE_WORDS * AXES)
            return
        for axis in sorted(self._new):
            self.unit.wire.write(IMAGE + IMAGE_WORDS * (axis - 1), [0])

    def _text(self) -> str:
        states = self._own()
        if len(states) == 1:
            text = f"axis {states[0].axis} stands at {mm_text(states[0].position_um)} mm"
        else:
            taken = [axis for axis in states if axis.is_taken]
            at = ", ".join(f"{axis.axis} at {mm_text(axis.position_um)} mm" for axis in taken)
            text = f"{_names(self.axes)} stand{f': {at}' if at else ''}"
        if self.ended:
            text += (
                f"; another master gave {_names(self.ended)} the permission again, "
                "so the measure was ended there"
            )
        return text


def _names(axes: Iterable[int]) -> str:
    numbers = sorted(axes)
    if numbers == list(ALL_AXES):
        return "all axes"
    return f"{'axis' if len(numbers) == 1 else 'axes'} {', '.join(map(str, numbers))}"
