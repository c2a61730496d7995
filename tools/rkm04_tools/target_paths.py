"""What `bench --target stm32` measures of paths: vectors that four motors follow together.

The image has a main of its own (hal/stm32/bench/path_main.c), which adds vectors as soon as there
is room for them. As all else of the bench: modelled.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from statistics import mean

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.target_figures import (
    CRUISE_SECONDS,
    Figures,
    flood,
    highest_rate,
    ramp_accel,
)
from rkm04_tools.target_run import MOTORS, TICKS_PER_MS, Ran, Rig

SYMBOLS = ("path_bench_table", "path_bench_report", "path_bench_done")
KINDS = 2
BEGIN_MS = 45.0
"""The image is up by then, its first vectors are there, and nothing has moved."""
SECONDS_MAX = 2.0
"""No path takes one; at too high a rate the image resets itself again and again."""

CYCLES_PER_TICK = 2
TICKS_PER_US = TICKS_PER_MS / 1000

BORDER_STEPS = 100
ALIKE = (BORDER_STEPS,) * 4
APART = (100, -99, 57, 33)
"""Shares that are fractions, so that the axes' accelerations are rounded."""
PASSING = (100, -99, 98, -97)
"""Rates so near to each other that pulses of all axes pass those of the others, in every order."""
WIDE_BOARD = "weact-f405"
"""Its pulses are 2.5 us wide, those of the reference board 0.5 us."""
FAST, FAST_VECTORS, FAST_ACCEL = 200_000, 600, 3_000_000
RATES = range(192_000, FAST + 1, 2000)
"""What a border costs is the mean at these: how the portions of a run fall is worth more."""
SLOW, SLOW_VECTORS, SLOW_ACCEL = 50_000, 200, 1_000_000
RARE = 20
"""So many times fewer borders."""
PACKET = 32
SPEED_LIMIT = 1_000_000
"""STEP_SPEED_MAX: what paths and the step generator are built for."""
PASSES = 50
"""So often pulses of a motor pass those of the next, where the highest rate of four is sought."""
ACT_MS, ACT_SPEED = 130.0, 120_000


class Act(IntEnum):
    """What is done while the path moves: enum act."""

    NONE = 0
    SPEED = 1
    HOLD = 2
    INPUT = 3


@dataclass(frozen=True)
class Kind:
    """Steps of the motors in a vector, and its speed in steps/s."""

    steps: Sequence[int]
    speed: int


@dataclass(frozen=True)
class Course:
    """What the image is to do: vectors of two kinds in turns, and an act."""

    vectors: int
    kinds: Sequence[Kind]
    accel: int
    packet: int = 1
    act: Act = Act.NONE

    @property
    def packed(self) -> bytes:
        """As struct path_bench_table."""
        act = (self.act, round(ACT_MS * TICKS_PER_MS), ACT_SPEED)
        kinds = b"".join(struct.pack("<4iI", *kind.steps, kind.speed) for kind in self.kinds)
        rest = struct.pack("<5I", self.accel, self.packet, *act)
        return struct.pack("<I", self.vectors) + kinds + rest

    @property
    def ends(self) -> list[int]:
        """Where the motors are at the end of all vectors."""
        counts = [(self.vectors + 1) // KINDS, self.vectors // KINDS]
        return [
            sum(count * kind.steps[i] for count, kind in zip(counts, self.kinds, strict=True))
            for i in range(len(MOTORS))
        ]


@dataclass(frozen=True)
class Report:
    """As struct path_bench_report; times in ticks."""

    late: int
    positions: list[int]
    added: int
    path: int
    add: int
    poll: int
    act: int
    effect: int


def report(ran: Ran) -> Report:
    """What the image told."""
    late, *rest = ran.summary["watch"][SYMBOLS[1]]
    positions = [int.from_bytes(p.to_bytes(4, "little"), "little", signed=True) for p in rest[:4]]
    return Report(late, positions, *rest[4:])


def run(rig: Rig, course: Course, *options: str) -> Ran:
    """Run the image to the end of its path, with the line flooded; it must be all of the path."""
    table, told, done = SYMBOLS
    arguments = ["--set", f"{table}={course.packed.hex()}", "--end-at", done, "--watch", told]
    arguments += ["--measure-from", str(BEGIN_MS), *options]
    return rig.run_other(rig.paths_elf, SECONDS_MAX, arguments, flood(BEGIN_MS, BEGIN_MS + 1000))


def fast(
    steps: Sequence[int], rarely: int = 1, packet: int = 1, act: Act = Act.NONE, rate: int = FAST
) -> Course:
    """Four motors up to 200 000 steps/s, with 2000 borders a second or fewer."""
    kind = Kind([rarely * count for count in steps], rate)
    return Course(FAST_VECTORS // rarely, [kind] * KINDS, FAST_ACCEL, packet, act)


def whole(rig: Rig, name: str, course: Course) -> tuple[Ran, Report]:
    """The same, of all vectors: the motors must be where these end."""
    ran = run(rig, course)
    told = report(ran)
    if told.positions != course.ends or ran.positions != course.ends:
        raise Failure(f"{name}: the path did not come to its end", NOT_SO)
    return ran, told


def ramps(motors: int, speed: int, apart: int = 0) -> Course:
    """One vector: a ramp, a cruise and a ramp of motors that move together, each by so many steps
    less than the one before."""
    accel = ramp_accel(speed)
    steps = speed * speed // accel + round(speed * CRUISE_SECONDS)
    course = [steps - i * apart for i in range(motors)] + [0] * (len(MOTORS) - motors)
    return Course(1, [Kind(course, speed)] * KINDS, accel)


def rates(rig: Rig) -> Figures:
    """The highest rates without a late step on a path, with the line flooded."""
    return {
        "rate_1": highest_rate(lambda speed: _holds(rig, ramps(1, speed)), SPEED_LIMIT),
        "rate_4_together": highest_rate(
            lambda speed: _holds(rig, ramps(len(MOTORS), speed)), SPEED_LIMIT
        ),
        "rate_4_apart": highest_rate(
            lambda speed: _holds(rig, ramps(len(MOTORS), speed, PASSES)), SPEED_LIMIT
        ),
    }


def _holds(rig: Rig, course: Course) -> bool:
    ran = run(rig, course)
    told = report(ran)
    return told.late == 0 and told.positions == course.ends and ran.positions == course.ends


def slow(steps: Sequence[int]) -> Course:
    """Four motors up to 50 000 steps/s, with 500 borders a second."""
    return Course(SLOW_VECTORS, [Kind(steps, SLOW)] * KINDS, SLOW_ACCEL)


def us(ticks: int) -> float:
    """Of ticks."""
    return ticks / TICKS_PER_US


def cycles(ran: Ran) -> float:
    """All that were not asleep while it was measured."""
    return float(ran.summary["cycles"]) * ran.load / 100


def _steps(ran: Ran) -> int:
    """Cycles of the step interrupt."""
    return int(ran.step_interrupt["cycles"])


def busy(rig: Rig) -> Figures:
    """The one of `borders` that has a budget."""
    ran, _ = whole(rig, "4 x 200 000 steps/s, alike", fast(ALIKE))
    return {"load_path_alike": ran.load}


def borders(rig: Rig) -> Figures:
    """Borders on all axes 2000 times a second at 200 000 steps/s, and 500 times at 50 000."""
    figures: Figures = {"stack_used": 0}
    count = len(MOTORS) * (FAST_VECTORS - FAST_VECTORS // RARE)
    for name, steps in (("alike", ALIKE), ("apart", APART)):
        runs = [
            [whole(rig, f"4 x {rate} steps/s, {name}", fast(steps, rarely, rate=rate))
             for rarely in (1, RARE)]
            for rate in RATES
        ]  # fmt: skip
        pairs = [(many, few) for (many, _), (few, _) in runs]
        many, told = runs[-1][0]
        figures |= {
            f"load_path_{name}": many.load,
            f"late_path_{name}": sum(report.late for pair in runs for _, report in pair),
            f"time_path_{name}": us(told.path) / 1000,
            f"border_{name}": mean(cycles(many) - cycles(few) for many, few in pairs) / count,
            f"border_step_{name}": mean(_steps(many) - _steps(few) for many, few in pairs) / count,
            f"interrupt_path_{name}": many.step_interrupt["max"],
        }
        figures["stack_used"] = max(
            figures["stack_used"], *(ran.stack_used for pair in runs for ran, _ in pair)
        )
    calm, told = whole(rig, "4 x 50 000 steps/s", slow(APART))
    return figures | {"load_path_slow": calm.load, "late_path_slow": told.late}


def wide(rig: Rig) -> Figures:
    """Borders on all axes 2000 times a second at 200 000 steps/s, with pulses of 2.5 us."""
    wide_rig = rig.of(WIDE_BOARD)
    figures: Figures = {"width_wide": math.inf, "stack_used": 0}
    for name, steps in (("alike", ALIKE), ("passing", PASSING)):
        ran, told = whole(wide_rig, f"4 x 200 000 steps/s, wide pulses, {name}", fast(steps))
        figures |= {f"load_wide_{name}": ran.load, f"late_wide_{name}": told.late}
        figures["width_wide"] = min(figures["width_wide"], ran.shortest_us)
        figures["stack_used"] = max(figures["stack_used"], ran.stack_used)
    return figures


def changes(rig: Rig) -> Figures:
    """What planning anew takes at 4 x 200 000 steps/s, with 128 vectors ahead."""
    _, calm = whole(rig, "nothing changed", fast(APART))
    packets, added = whole(rig, "vectors in packets", fast(APART, packet=PACKET))
    speeds, changed = whole(rig, "another speed", fast(APART, act=Act.SPEED))
    holds = [run(rig, fast(APART, act=act)) for act in (Act.HOLD, Act.INPUT)]
    held = [report(ran) for ran in holds]
    return {
        "add_packet": us(added.add),
        "late_packets": added.late,
        "effect_speed": us(changed.effect),
        "late_speed": changed.late,
        "effect_hold": max(us(told.effect) for told in held),
        "late_hold": max(told.late for told in held),
        "pass_path": us(calm.poll),
        "stack_used": max(ran.stack_used for ran in (packets, speeds, *holds)),
    }
