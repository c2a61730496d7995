"""How soon a request changes the pulses of the image, from when it has come.

At 4 x 100 000 steps/s intervals are whole ticks, and a ramp begins with the last pulse that stands
where it would have; in a cruise of two steps/s the instant is found from the next pulse.
"""

from __future__ import annotations

import random
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.positioning.bench.line import AXES, BAUD, Asked, cycle, measures, play
from rkm04_tools.positioning.bench.loads import BEGIN_MS, RAMP_MS, SEED, SPACE_MS, TOP, begin
from rkm04_tools.positioning.board_line import DELIVERED_BAUD
from rkm04_tools.positioning.frames import write
from rkm04_tools.positioning.table import AXIS_STEP, registers
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_reactions import TICK_HZ, braking
from rkm04_tools.target_run import TICKS_PER_MS, Ran, Rig

CRUISE_MS = 10.0
"""Before a cause, in which pulses have their interval."""
STEEP = 65_535
"""mm/s^2: pulses show at once that they are on a ramp."""
TOP_TICKS, LOWER_TICKS = 840, 960
LOWER = TOP * TOP_TICKS // LOWER_TICKS
ROUNDS = 24
PHASE_MS = 1.0
DELIVERED_ROUNDS, DELIVERED_MS = 8, 120.0
"""A request to all axes and its answer take 88 ms at 19 200 Bd."""

STARTS, START_MS, WAY_UM = 12, 45.0, 3000
INPUT, LIMIT_PLUS = 3, 47
LIMIT_ROUNDS, LEVEL_MS, STAND_MS = 8, 10.0, 60.0

SLOW = 1_000 * 3840 // 25 // 2
"""A feed: 500/256 steps/s."""
SLOW_STEPS_PER_S, QUICK_STEPS_PER_S = 500 / 256, 100.0
QUICK = round(QUICK_STEPS_PER_S * 256 * 3840 / 25)
GENTLE = 100
GENTLE_STEPS_PER_S2 = 10_000.0
SLOW_MS, QUICK_MS, SLOW_ROUNDS = 1300.0, 120.0, 6


@dataclass(frozen=True)
class Pace:
    """How often requests come, and at which rate."""

    rounds: int
    apart_ms: float = 20.0
    space_ms: float = SPACE_MS
    baud: int = BAUD


def _feeds(rig: Rig, name: str, moved: Collection[int], pace: Pace) -> Figures:
    """Other feeds for some axes at full speed, and back."""
    chance = random.Random(SEED)
    first = begin(STEEP, [TOP] * len(AXES), apart=pace.space_ms, baud=pace.baud)
    at, asked = first[-1].ms + pace.space_ms + RAMP_MS, []
    for number in range(pace.rounds):
        feeds = [LOWER if axis in moved and number % 2 == 0 else TOP for axis in AXES]
        asked.append(Asked(at, cycle(feeds), pace.baud))
        at += pace.apart_ms + chance.uniform(0, PHASE_MS)
    ran, _ = play(rig, [*first, *asked], at / 1000)
    intervals = [LOWER_TICKS if i % 2 else TOP_TICKS for i in range(pace.rounds)]
    return _figures(name, ran, [each.come_ms for each in asked], intervals, moved)


def fast(rig: Rig) -> Figures:
    """Of all axes."""
    return _feeds(rig, "change", AXES, Pace(ROUNDS))


def delivered(rig: Rig) -> Figures:
    """Of all axes, with the line as it is delivered."""
    pace = Pace(DELIVERED_ROUNDS, DELIVERED_MS, DELIVERED_MS, DELIVERED_BAUD)
    return _feeds(rig, "delivered", AXES, pace)


def alone(rig: Rig) -> Figures:
    """Of one axis."""
    return _feeds(rig, "alone", (1,), Pace(ROUNDS))


def hold(rig: Rig) -> Figures:
    """Holds at full speed, and on again."""
    chance = random.Random(SEED)
    first = begin(STEEP, [TOP] * len(AXES))
    at, asked = first[-1].ms + SPACE_MS + RAMP_MS, []
    for number in range(ROUNDS):
        asked.append(Asked(at, cycle([TOP] * len(AXES), permitted=number % 2)))
        at += 40.0 + chance.uniform(0, PHASE_MS)
    ran, _ = play(rig, [*first, *asked], at / 1000)
    come = [each.come_ms for each in asked[::2]]
    return _figures("hold", ran, come, [TOP_TICKS] * len(come), AXES)


def start(rig: Rig) -> Figures:
    """A measure and its feed of all axes, again and again; its first pulse has the interval of the
    feed."""
    chance = random.Random(SEED)
    number = registers()["START_FEED"].number
    feed = [TOP >> 16, TOP & 0xFFFF]
    asked = [
        Asked(BEGIN_MS + i * SPACE_MS, write(AXIS_STEP * axis + number, feed))
        for i, axis in enumerate(AXES)
    ]
    at, come = asked[-1].ms + SPACE_MS, []
    for _ in range(STARTS):
        for frame in measures([WAY_UM] * len(AXES), STEEP, [TOP] * len(AXES)):
            asked.append(Asked(at, frame))
            at += START_MS + chance.uniform(0, PHASE_MS)
        come.append(asked[-1].come_ms)
    ran, _ = play(rig, asked, at / 1000)
    firsts = [
        ticks[np.searchsorted(ticks, each * TICKS_PER_MS)] / TICKS_PER_MS - each
        for ticks in ran.ticks().values()
        for each in come
    ]
    begins = 1000 * (float(max(firsts)) - TOP_TICKS / TICKS_PER_MS)
    return {"begins_start": begins, "late_start": ran.late, "stack_used": ran.stack_used}


def _limits(rig: Rig, name: str, moved: Collection[int]) -> Figures:
    """A limit input of some axes at full speed, again and again; the others are given up then."""
    chance = random.Random(SEED)
    asked = [
        Asked(BEGIN_MS + i * SPACE_MS, write(AXIS_STEP * axis + LIMIT_PLUS, [INPUT]))
        for i, axis in enumerate(moved)
    ]
    at, edges = asked[-1].ms + SPACE_MS, []
    for _ in range(LIMIT_ROUNDS):
        asked += begin(STEEP, [TOP] * len(AXES), at)
        edges.append(asked[-1].ms + SPACE_MS + RAMP_MS + chance.uniform(0, PHASE_MS))
        at = edges[-1] + STAND_MS
    changes = ((ms, level) for edge in edges for ms, level in ((edge, 1), (edge + LEVEL_MS, 0)))
    inputs = "".join(f"{ms:.6f},{INPUT},{level}\n" for ms, level in changes)
    ran, _ = play(rig, asked, at / 1000, inputs=inputs)
    return _figures(name, ran, edges, [TOP_TICKS] * len(edges), moved)


def limit(rig: Rig) -> Figures:
    """Of one axis."""
    return _limits(rig, "limit", (1,))


def limits(rig: Rig) -> Figures:
    """Of all axes, the same input."""
    return _limits(rig, "limits", AXES)


def _figures(
    name: str, ran: Ran, come_ms: Sequence[float], intervals: Sequence[int], moved: Collection[int]
) -> Figures:
    begins, changes = [], []
    pulses = ran.ticks()
    for ticks in (pulses[axis] for axis in moved):
        for each, interval in zip(come_ms, intervals, strict=True):
            come = round(each * TICKS_PER_MS)
            near = ticks[ticks > come - round(CRUISE_MS * TICKS_PER_MS)]
            began, changed = braking(near, come, interval)
            begins.append(began)
            changes.append(changed)
    return {
        f"begins_{name}": max(begins),
        f"changes_{name}": max(changes),
        f"late_{name}": ran.late,
        "stack_used": ran.stack_used,
    }


def slow(rig: Rig) -> Figures:
    """Other feeds in a cruise whose pulses are half a second apart."""
    chance = random.Random(SEED)
    first = begin(GENTLE, [SLOW] * len(AXES))
    at, asked = first[-1].ms + SPACE_MS, []
    for _ in range(SLOW_ROUNDS):
        at += SLOW_MS + chance.uniform(0, 500)
        asked.append(Asked(at, cycle([QUICK] * len(AXES))))
        at += QUICK_MS
        asked.append(Asked(at, cycle([SLOW] * len(AXES))))
    ran, _ = play(rig, [*first, *asked], (at + SLOW_MS) / 1000)
    found = [
        effect_ms(ticks, each.come_ms) - each.come_ms
        for ticks in ran.ticks().values()
        for each in asked[::2]
    ]
    if min(found) < 0:
        raise Failure("a request acts before it has come", NOT_SO)
    return {"begins_slow": max(found), "late_slow": ran.late, "stack_used": ran.stack_used}


def effect_ms(ticks: np.ndarray, come_ms: float) -> float:
    """When the slow cruise has ended, from the pulses before and after."""
    after = int(np.searchsorted(ticks, come_ms * TICKS_PER_MS))
    last, following = (ticks[at] / TICK_HZ for at in (after - 1, after))
    low, high = last, following
    for _ in range(60):
        middle = (low + high) / 2
        if middle + _until_pulse(1 - SLOW_STEPS_PER_S * (middle - last)) < following:
            low = middle
        else:
            high = middle
    return float(1000 * high)


def _until_pulse(way: float) -> float:
    """How long what is left of a step takes from the change on."""
    slow_speed, quick = SLOW_STEPS_PER_S, QUICK_STEPS_PER_S
    ramp = (quick**2 - slow_speed**2) / (2 * GENTLE_STEPS_PER_S2)
    if way <= ramp:
        reached = float((slow_speed**2 + 2 * GENTLE_STEPS_PER_S2 * max(way, 0)) ** 0.5)
        return (reached - slow_speed) / GENTLE_STEPS_PER_S2
    return (quick - slow_speed) / GENTLE_STEPS_PER_S2 + (way - ramp) / quick
