"""What the unit does now, as its registers tell it, and whether somebody else gives it orders."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any

from rkm04_tools.positioning.line_errors import Restarted
from rkm04_tools.positioning.state import AxisState, UnitState
from rkm04_tools.positioning.table import AXES, read_image
from rkm04_tools.positioning.unit import CLOCK_HALF, Unit

OTHERS_SECONDS = 5.0
"""For so long an order of another master is told."""
OTHERS_A_SECOND = 0.5
"""Requests of others, on the mean of two looks: less may be one that was repeated."""
UPTIME_SLACK = (0.5, 0.01)
"""Seconds, and a share of the time from look to look, by which the unit's clock may be behind."""


@dataclass(frozen=True)
class Wanted:
    """CONTROL and FEED of an axis."""

    control: int
    feed: int

    @property
    def permitted(self) -> bool:
        """MP."""
        return bool(self.control & 1)

    @property
    def waits(self) -> bool:
        """INIC: a measure waits for the axis to stand."""
        return bool(self.control & 4)


@dataclass
class Looks:
    """Looks at a unit; to be used from one thread. Nothing here changes anything there."""

    unit: UnitState | None = None
    axes: list[AxisState] = field(default_factory=list)
    wanted: list[Wanted] = field(default_factory=list)
    _own: set[int] = field(default_factory=set)
    _others_at: dict[int, float] = field(default_factory=dict)
    _frames: tuple[int, int, float] | None = None
    _uptime: tuple[int, float] | None = None

    def touch(self, *axes: int) -> None:
        """Something is asked of axes from here: what changes there is no one else's."""
        self._own.update(axes)

    def look(self, unit: Unit) -> dict[str, Any]:
        """Ask for all of it, for the clock last: a restart in the middle is seen by that, or by
        the axes of the next look."""
        unit.require_known()
        words = unit.wire.read(IMAGE, IMAGE_WORDS * AXES)
        wanted = [Wanted(c, h << 16 | low) for c, h, low in zip(*[iter(words)] * 3, strict=True)]
        axes = [unit.axis(number).read() for number in range(1, AXES + 1)]
        state = unit.read()
        now = time.monotonic()
        others = self._others(state.values["FRAMES"], unit.wire.counts.requests, now)
        if self._has_restarted(state.values["UPTIME"], now, axes):
            raise Restarted(unit.wire.name)
        self._uptime = (state.values["UPTIME"], now)
        self._compare(axes, wanted, now)
        self.unit, self.axes, self.wanted = state, axes, wanted
        told = {name.lower(): value for name, value in state.values.items()}
        return {
            "type": "live",
            "time_s": round(now, 3),
            "unit": {**told, "inputs": state.inputs, "others": others},
            "axes": [self._as_json(number) for number in range(AXES)],
        }

    def _as_json(self, index: int) -> dict[str, Any]:
        axis, wanted = self.axes[index], self.wanted[index]
        at = self._others_at.get(axis.axis)
        return {
            **vars(axis),
            "state": "WAITING" if wanted.waits and axis.moves else axis.state,
            "feed": wanted.feed,
            "permitted": wanted.permitted,
            "by_other": at is not None and time.monotonic() - at < OTHERS_SECONDS,
        }

    def _has_restarted(self, uptime_ms: int, now: float, axes: list[AxisState]) -> bool:
        """Whether it has, since the last look, which may be long ago and on a port since closed.

        Its clock went back, or is behind and the axes are as after a start; a clock that is behind
        alone is that of a virtual unit, which may be slow.
        """
        if self._uptime is None:
            return False
        before_ms, at = self._uptime
        if (uptime_ms - before_ms) % (1 << 32) >= CLOCK_HALF:
            return True
        least, share = UPTIME_SLACK
        passed = now - at
        expected_ms = 1000 * (passed - max(least, share * passed))
        is_behind = (uptime_ms - before_ms) % (1 << 32) < expected_ms
        return is_behind and all(map(_is_new, axes)) and not all(map(_is_new, self.axes))

    def _others(self, frames: int, requests: int, now: float) -> float | None:
        """Requests a second that the unit has got and that were not from here."""
        before, self._frames = self._frames, (frames, requests, now)
        if before is None or requests < before[1]:
            return None
        more = (frames - before[0]) % (1 << 32) - (requests - before[1])
        rate = more / max(now - before[2], 0.01)
        return round(rate, 1) if rate > OTHERS_A_SECOND and more < 1 << 31 else 0.0

    def _compare(self, axes: list[AxisState], wanted: list[Wanted], now: float) -> None:
        """DONE, MP and FEED change by orders, or FEED by a fault: if not by an order from here,
        then by another's. A fault may have come after the FEED of its first look was read."""
        for before, old, axis, new in zip(self.axes, self.wanted, axes, wanted, strict=False):
            feed = old.feed if axis.has_fault and new.feed == 0 else new.feed
            is_same = (before.done, old.permitted, old.feed) == (axis.done, new.permitted, feed)
            if not is_same and axis.axis not in self._own:
                self._others_at[axis.axis] = now
        self._own.clear()


def _is_new(axis: AxisState) -> bool:
    """Whether an axis is as after a start."""
    return not (axis.status or axis.done or axis.position_steps or axis.captures)


IMAGE, IMAGE_WORDS = read_image("FAST_OUT")
