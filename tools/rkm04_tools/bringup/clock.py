"""The clock of the board, held against that of this computer."""

from __future__ import annotations

import time
from dataclasses import dataclass

from rkm04_tools.bringup.findings import Seen, compared
from rkm04_tools.bringup.step import Bench

TICK_HZ = 84_000_000
SECONDS = 5.0
TRIES = 5
"""Of those the one whose answer came soonest counts: an adapter lets bytes wait for up to 16 ms."""
PERCENT = 0.5
"""A crystal is right to 0.01 %; what the line adds is less than the rest."""
CYCLES_A_TICK = 2.0
WORD = 1 << 32


@dataclass(frozen=True)
class Moment:
    """The same moment on both clocks."""

    seconds: float
    ticks: int
    took: float


def _moment(bench: Bench) -> Moment:
    answer = bench.talk.ask("k")
    asked = bench.talk.asked
    return Moment(asked, answer.number("ticks"), time.monotonic() - asked)


def _best(bench: Bench) -> Moment:
    return min((_moment(bench) for _ in range(TRIES)), key=lambda moment: moment.took)


def look_at_clock(bench: Bench) -> list[Seen]:
    """Whether the crystal is the one that the image takes it for, and the timers count as they
    should."""
    bench.person.tell(f"The clock runs against that of this computer, {SECONDS:g} s.")
    first = _best(bench)
    time.sleep(SECONDS)
    last = _best(bench)
    ticks = (last.ticks - first.ticks) % WORD
    percent = (ticks / TICK_HZ / (last.seconds - first.seconds) - 1) * 100
    right = abs(percent) <= PERCENT
    seen = "as fast" if right else ("slow" if percent < 0 else "fast")
    answer = bench.talk.ask("k")
    ratio = answer.number("cycles_passed") / max(answer.number("ticks_passed"), 1)
    return [
        compared("clock against this computer's", f"{seen} ({percent:+.2f} %)",
                 f"within {PERCENT:g} %; else another crystal", right),
        compared("timers against the processor", f"{ratio:.3f} cycles a tick",
                 f"{CYCLES_A_TICK:.3f}", abs(ratio / CYCLES_A_TICK - 1) < 0.002),
    ]  # fmt: skip
