"""Where an axis of the positioning unit is and where it goes, written from the contract alone."""

from __future__ import annotations

from dataclasses import dataclass

from exact import Fraction
from pos_words import REMAINDER_MAX, Settings, half_up


@dataclass
class Origin:
    """What an axis keeps of its way: B and M of what it last reached, C and X of the position."""

    base: int = 0
    way: int = 0
    reference: int = 0
    position: int = 0

    def step_of(self, settings: Settings, way: int) -> int:
        """The step that lies a way from B."""
        return self.base + half_up(way * settings.ratio)

    def given_up(self, settings: Settings, step: int) -> None:
        """A measure is given up, and the axis stands on a step."""
        if step != self.step_of(settings, self.way):
            self.base, self.way = step, 0

    def position_of(self, settings: Settings, step: int) -> int:
        """The position of a step, in micrometres."""
        return self.position + half_up((step - self.reference) / settings.ratio)

    def exact(self, settings: Settings, step: int) -> Fraction:
        """The position of a step, not rounded."""
        return self.position + (step - self.reference) / settings.ratio

    def refer(self, step: int, position: int) -> None:
        """A step becomes a position."""
        self.reference, self.position = step, position
        self.base, self.way = step, 0


@dataclass(frozen=True)
class Goal:
    """A measure: the step it aims at, and what B and M are when it is reached."""

    step: int
    base: int
    way: int

    @property
    def possible(self) -> bool:
        """Whether M is in its range."""
        return abs(self.way) <= REMAINDER_MAX


def relative(origin: Origin, settings: Settings, way: int) -> Goal:
    """The goal of POS_MODE."""
    whole = origin.way + way
    return Goal(origin.step_of(settings, whole), origin.base, whole)


def absolute(origin: Origin, settings: Settings, position: int) -> Goal:
    """The goal of POS_MODE_ABS."""
    way = position - origin.position
    return Goal(origin.reference + half_up(way * settings.ratio), origin.reference, way)


@dataclass(frozen=True)
class Seat:
    """Where the motor stands: the position counter, and how far it is in the backlash, 0 to b."""

    step: int
    slack: int
    backlash: int

    def moved(self, pulses: int) -> Seat:
        """The seat so many pulses forward, or backward."""
        taken = max(-self.slack, min(pulses, self.backlash - self.slack))
        return Seat(self.step + pulses - taken, self.slack + taken, self.backlash)

    def pulses_to(self, step: int) -> int:
        """The pulses of a measure to a step, with their sign."""
        way = step - self.step
        if way > 0:
            return way + self.backlash - self.slack
        return way - self.slack if way < 0 else 0
