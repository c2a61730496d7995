"""Settings, numbers and limits of the positioning unit, written from the contract alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from enum import IntEnum

from exact import Fraction
from reference import TICK_HZ

MS = TICK_HZ // 1000
US = TICK_HZ // 1_000_000
AXES = (1, 2, 3, 4)
WAY_MAX = 2**31 - 1
REMAINDER_MAX = 2**62
SPEED_UNITS, ACCEL_UNITS = 256, 128
SPEED_MAX = 200_000 * SPEED_UNITS
ACCEL_MAX = 8_000_000 * ACCEL_UNITS
FEED_UNITS = 65_536
"""Of a mm/min."""

JEDE, SMER, POL, DISP, PROG, ERR = 0x0100, 0x0200, 0x0800, 0x0001, 0x0002, 0x0004
MP, RESET, INIC, CONT = 1, 2, 4, 8
FORWARD_METHOD, BACKWARD_METHOD, HERE_METHOD = 19, 21, 37


class Error(IntEnum):
    """Numbers of section 3."""

    NONE = 0
    AXIS = 1
    SPACE = 2
    NOT_TAKEN = 3
    MOVES = 4
    WAY = 5
    ACCEL = 6
    LIMIT = 7
    SILENCE = 8
    NO_CRYSTAL = 9
    SOFT_LIMIT = 10
    NOT_FOUND = 11
    NO_INPUT = 12
    METHOD = 13
    DAMAGED = 14
    FAULT = 15


FAULTS = frozenset({Error.LIMIT, Error.SILENCE, Error.SOFT_LIMIT, Error.NOT_FOUND})
PRIORITY = tuple(map(Error, (1, 3, 15, 4, 13, 14, 9, 12, 6, 5, 2)))


class Code(IntEnum):
    """Instructions, with their codes in the register."""

    NONE = 0
    POS_INIT = 1
    POS_MODE = 2
    POS_RESET = 3
    POS_MODE_ABS = 4
    POS_HOME = 5
    POS_CAPTURE = 6
    POS_CONTROL = 7
    """Has no code on the line, where it is CONTROL and FEED."""


MEASURES = frozenset({Code.POS_MODE, Code.POS_MODE_ABS, Code.POS_HOME})


def half_up(value: Fraction) -> int:
    """The nearest whole number, halves up."""
    return math.floor(value + Fraction(1, 2))


@dataclass(frozen=True)
class Settings:
    """The settings of an axis, named and scaled as its registers."""

    steps: int = 1
    micrometres: int = 10
    invert: int = 0
    highest_accel: int = 65_535
    highest_feed: int = 2**32 - 1
    start_feed: int = 0
    error_accel: int = 0
    backlash: int = 0
    soft_min: int = 0
    soft_max: int = 0
    limit_minus: int = 0
    limit_plus: int = 0
    reference: int = 0
    capture: int = 0
    home_feed: int = 600 * FEED_UNITS
    home_slow: int = 60 * FEED_UNITS
    home_way: int = 1_000_000

    @property
    def ratio(self) -> Fraction:
        """Steps in a micrometre."""
        return Fraction(self.steps, self.micrometres)

    def speed(self, feed: int) -> int:
        """V of a feed, in 1/256 step/s."""
        exact = min(feed, self.highest_feed) * self.ratio * Fraction(25, 384)
        return min(SPEED_MAX, max(half_up(exact), 1 if feed else 0))

    def accel(self, mm_s2: int) -> int:
        """The acceleration of a slope, in 1/128 step/s²."""
        exact = min(mm_s2, self.highest_accel) * self.ratio * 1000 * ACCEL_UNITS
        return min(ACCEL_MAX, max(half_up(exact), 1 if mm_s2 else 0))

    @property
    def start_speed(self) -> int:
        """S, in 1/256 step/s."""
        return self.speed(self.start_feed)

    def way_steps(self, micrometres: int) -> int:
        """The steps of a way from a step."""
        return half_up(micrometres * self.ratio)

    @property
    def backlash_steps(self) -> int:
        """The steps that a turn costs."""
        return self.way_steps(self.backlash)

    @property
    def soft(self) -> bool:
        """Whether the software limits are set."""
        return self.soft_min < self.soft_max


OFFSETS = {
    30: "steps",
    32: "micrometres",
    34: "invert",
    35: "highest_accel",
    36: "highest_feed",
    38: "start_feed",
    40: "error_accel",
    41: "backlash",
    42: "soft_min",
    44: "soft_max",
    46: "limit_minus",
    47: "limit_plus",
    48: "reference",
    49: "capture",
    50: "home_feed",
    52: "home_slow",
    54: "home_way",
}
"""The settings of axis n are the registers 100 n + these."""

REGISTER = {name: offset for offset, name in OFFSETS.items()}
MOVES_ORIGIN = frozenset({"steps", "micrometres", "invert", "backlash"})
"""A change of one of them makes the present step the origin."""

assert set(REGISTER) == {field.name for field in fields(Settings)}


def is_active(levels: dict[int, int], number: int) -> bool:
    """Whether an input is active that a setting names: 0 none, n BIn at 1, -n BIn at 0."""
    return number != 0 and levels.get(abs(number), 0) == (number > 0)


def signed32(value: int) -> int:
    """A number modulo 2^32, as i32."""
    return (value + 2**31) % 2**32 - 2**31


class Mismatch(Exception):
    """The unit has broken the contract, at the latest at a tick."""

    def __init__(self, tick: float, what: str) -> None:
        """Say when, and what."""
        super().__init__(f"{tick / MS:.4f} ms: {what}")
        self.tick = tick


class Unsure(Exception):
    """The contract does not tell what has to come."""
