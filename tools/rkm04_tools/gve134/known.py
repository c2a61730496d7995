"""What is known of the unit because it was sent to it: outputs, spindle, the factor of speed.

The unit does not tell these.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

FACTOR_ONE = 1 << 16
"""100 %."""
FACTOR_MIN, FACTOR_MAX = round(FACTOR_ONE / 100), 10 * FACTOR_ONE
ALL_OFF = 0xFF
SPINDLE_BIT = 1

PORT = re.compile(r"O0,([0-9A-F]{1,2})")
SPINDLE = re.compile(r"!7V(\d+)")
PERCENT = re.compile(r"XM(\d+)")
RESETS = ("J", "!7J")


@dataclass(frozen=True)
class Known:
    """`port` is port 0, `spindle` in 0.1 %, `factor` in 1/65 536; None: not known."""

    port: int | None = None
    spindle: int | None = None
    factor: int | None = None

    def after(self, command: str) -> Known:
        """What is known after a command that was executed."""
        if match := PORT.fullmatch(command):
            return replace(self, port=int(match[1], 16))
        if match := SPINDLE.fullmatch(command):
            on = int(match[1]) > 0
            port = None if self.port is None else self.port & ~SPINDLE_BIT | (not on)
            return replace(self, port=port, spindle=int(match[1]))
        if match := PERCENT.fullmatch(command):
            return replace(self, factor=_factor(int(match[1]) / 100))
        if command == "XA":
            return replace(self, factor=FACTOR_ONE)
        if command in ("XU", "XD") and self.factor is not None:
            return replace(self, factor=stepped(self.factor, command))
        return AFTER_RESET if command in RESETS else self

    def without(self, command: str) -> Known:
        """What is known after a command of which nobody knows whether it was executed."""
        changed = self.after(command)
        return Known(
            self.port if changed.port == self.port else None,
            self.spindle if changed.spindle == self.spindle else None,
            self.factor if changed.factor == self.factor else None,
        )

    @property
    def spindle_text(self) -> str:
        """What is to be said beside a confirmed stop; empty: it is off, or nobody knows."""
        if not self.spindle or (self.port or 0) & SPINDLE_BIT:
            return ""
        return f"; THE SPINDLE TURNS at {self.spindle / 10:g} %"

    @property
    def percent(self) -> float | None:
        """The factor of speed."""
        return None if self.factor is None else 100 * self.factor / FACTOR_ONE


AFTER_RESET = Known(ALL_OFF, 0, FACTOR_ONE)


def stepped(factor: int, command: str) -> int:
    """The factor after XU or XD, to the nearest, halves up."""
    return _within((factor * (17 if command == "XU" else 15) + 8) // 16)


def step_towards(factor: int, wanted_percent: float) -> str | None:
    """XU or XD, if it leads nearer to a wanted factor."""
    wanted = _factor(wanted_percent / 100)
    command = "XU" if wanted > factor else "XD"
    nearer = abs(stepped(factor, command) - wanted) < abs(factor - wanted)
    return command if nearer else None


def _factor(share: float) -> int:
    return _within(int(share * FACTOR_ONE + 0.5))


def _within(factor: int) -> int:
    return min(max(factor, FACTOR_MIN), FACTOR_MAX)
