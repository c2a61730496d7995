"""4 x 100 000 steps/s while a PLC gives every axis another feed each 15 ms."""

from __future__ import annotations

import random

from rkm04_tools.positioning.bench.line import (
    AXES,
    BAUD,
    CYCLE_MS,
    Asked,
    cycle,
    longest_ms,
    measures,
    play,
    unanswered,
)
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_run import Rig

SEED = 20261123
TOP = 60_000 << 16
"""mm/min, which is 100 000 steps/s as delivered."""
FAR_UM = 2**31 - 1
ACCEL = 20_000
BEGIN_MS, SPACE_MS, RAMP_MS = 50.0, 25.0, 100.0
CYCLES = 90
FULL, WIDE = 1.0, 50.0
"""How far under the top feeds may be, in percent."""


def begin(
    accel: int, feeds: list[int], at: float = BEGIN_MS, apart: float = SPACE_MS, baud: int = BAUD
) -> list[Asked]:
    """The requests that set all axes in motion."""
    frames = measures([FAR_UM] * len(AXES), accel, feeds)
    return [Asked(at + i * apart, frame, baud) for i, frame in enumerate(frames)]


def measure(rig: Rig, name: str, spread: float, cycles: int = CYCLES) -> Figures:
    """New feeds in each cycle, so far under the top."""
    chance = random.Random(SEED)
    first = begin(ACCEL, [TOP] * len(AXES))
    at = first[-1].ms + SPACE_MS + RAMP_MS
    least = round(TOP * (1 - spread / 100))
    asked = [
        Asked(at + i * CYCLE_MS, cycle([chance.randint(least, TOP) for _ in AXES]))
        for i in range(cycles)
    ]
    end = asked[-1].ms + CYCLE_MS
    ran, said = play(rig, [*first, *asked], end / 1000, "--measure-from", f"{at:.3f}")
    return {
        f"load_{name}": ran.load,
        f"late_{name}": ran.late,
        f"unanswered_{name}": unanswered([*first, *asked], said),
        f"answer_{name}": longest_ms(asked, said),
        "stack_used": ran.stack_used,
    }


def full(rig: Rig) -> Figures:
    """Nearly at the top all the time."""
    return measure(rig, "full", FULL)


def wide(rig: Rig) -> Figures:
    """Up and down all the time."""
    return measure(rig, "wide", WIDE)
