"""What a machine file (.rkm) says of a machine with a GVE134 unit: axes, spindle, probe.

Positions are whole numbers of 1/5 000 000 000 mm or degree, so that nine decimals of mm and of
inches (127 for a nanoinch) are whole, and sums of them never err.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import sqrt
from pathlib import Path
from typing import Any

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.machine.machine import Machine, read_machine

LETTERS = "XYZA"
AXES = range(4)
PARTS = 5_000_000_000
"""So many make a mm or a degree."""

PULSES_TOP = 200_000
"""The unit's highest speed, pulses/s."""

PULSES_LEAST = 10
"""Its lowest one."""


@dataclass(frozen=True)
class Homing:
    """The reference run of an axis, as W has it, and where the axis is after it."""

    way_steps: int
    speed: int
    back_steps: int
    back_speed: int
    position_steps: int
    opens: bool
    """The switch opens when it is hit."""


@dataclass(frozen=True)
class Axis:
    """An axis: how far a pulse goes, and what it must not exceed, in pulses and seconds."""

    index: int
    unit: str
    """mm or degree."""
    steps_per_unit: Fraction
    speed: int
    accel: int
    jump: int
    lowest: int | None
    highest: int | None
    homing: Homing | None

    @property
    def letter(self) -> str:
        """X, Y, Z or A."""
        return LETTERS[self.index]

    def steps_of(self, parts: int) -> int:
        """The pulse nearest to a position, halves up."""
        scale = self.steps_per_unit / PARTS
        return (2 * parts * scale.numerator + scale.denominator) // (2 * scale.denominator)

    def parts_of(self, steps: int) -> int:
        """The position of a pulse."""
        return round(steps * PARTS / self.steps_per_unit)


@dataclass(frozen=True)
class Spindle:
    """The spindle: the speed of 100 %, how long it takes to start, and how it is turned round."""

    rpm: float
    start_s: float
    reverse_bit: int | None
    """The bit of port 0 that turns it round; None: it turns one way."""


@dataclass(frozen=True)
class Probe:
    """The tool sensor."""

    interrupt: int
    """14 or 15."""
    opens: bool


@dataclass(frozen=True)
class Mill:
    """A machine with its axes; None: there is none."""

    name: str
    axes: tuple[Axis | None, ...]
    spindle: Spindle | None
    probe: Probe | None
    corner_deviation: float = 0.0
    """mm, the measure of corners (see `corners`); 0: the axes' jumps alone."""

    @cached_property
    def turn_top(self) -> float:
        """The fastest feed of A alone, degrees/min; 0 without A."""
        axis = self.axes[3]
        return float(60 * axis.speed / axis.steps_per_unit) if axis else 0.0

    @cached_property
    def feed_top(self) -> float:
        """The fastest of all feeds, mm/min: that of all linear axes together."""
        speeds = [axis.speed / axis.steps_per_unit for axis in self.axes[:3] if axis]
        return 60.0 * sqrt(sum(speed * speed for speed in speeds))


def read_mill(name: str | Path) -> Mill:
    """Read the machine file of a GVE134 unit."""
    return mill_of(read_machine(name))


def mill_of(machine: Machine) -> Mill:
    """What a machine file says of a GVE134 unit."""
    told = machine.content.get("gve134")
    if told is None:
        raise Failure(
            f'{machine.file}: lacks "gve134", the part for this unit; tools/examples/gve/mill.rkm '
            "shows one",
            NOT_SO,
        )
    axes = tuple(_axis(machine, index, told["axes"].get(LETTERS[index].lower())) for index in AXES)
    spindle, probe = told.get("spindle"), told.get("probe")
    return Mill(
        machine.name,
        axes,
        spindle
        and Spindle(spindle["rpm"], spindle.get("start_s", 0.0), spindle.get("reverse_bit")),
        probe and Probe(probe["interrupt"], probe.get("opens", False)),
        told.get("corner_deviation_mm", 0.0),
    )


def _axis(machine: Machine, index: int, told: dict[str, Any] | None) -> Axis | None:
    if told is None:
        return None
    motor = machine.content["motors"][index]
    unit = "degree" if "steps_per_degree" in motor else "mm"
    steps = motor.get(f"steps_per_{unit}")
    if steps is None or (unit == "mm") != (index < 3):
        wanted = "steps_per_mm" if index < 3 else "steps_per_degree"
        raise Failure(
            f"{machine.file}: motor {index + 1} is axis {LETTERS[index]} and needs {wanted}", NOT_SO
        )
    limits = motor.get("limits", {})
    return Axis(
        index,
        unit,
        Fraction(str(steps)),
        told["speed_steps_per_s"],
        told["accel_steps_per_s2"],
        told["jump_steps_per_s"],
        limits.get("position_min_steps"),
        limits.get("position_max_steps"),
        _homing(told.get("homing")),
    )


def _homing(told: dict[str, Any] | None) -> Homing | None:
    if told is None:
        return None
    return Homing(
        told["way_steps"],
        told["speed_steps_per_s"],
        told["back_steps"],
        told["back_speed_steps_per_s"],
        told.get("position_steps", 0),
        told.get("opens", True),
    )
