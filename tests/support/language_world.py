"""What a motor of the model can be doing, and what surrounds it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from language_signals import Signal, Variables, Watch

STOPS = {"K": 1, "M": 2, "N": 3, "X": 4, "\\": 5, "limit": 6}


class Phase(Enum):
    """What a motor does; `ENDED` is by X or an error."""

    RUNNING = auto()
    IDLE = auto()
    HELD = auto()
    MOVING = auto()
    WAITING = auto()
    LOOKING = auto()
    STOPPED = auto()
    ENDED = auto()


@dataclass
class World:
    """What surrounds a motor: inputs by number, the variables as they were, its own record.

    `functions` are those of the whole unit that are on, the same set for all motors.
    """

    inputs: dict[int, Signal]
    variables: Variables
    watch: Watch
    pulses: list[int]
    functions: set[int]
