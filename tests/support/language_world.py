"""What a motor of the model can be doing, and what surrounds it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from language_signals import US, Signal, Variables, Watch

BEHIND_TICKS = 200 * US
"""By so much a move or a wait may be late and still count from the program clock."""

LOCK = 40
"""The function that keeps a full memory from being overwritten."""

BURST_MAX = 3000
"""Commands without a wait; a program with more may be one that never waits."""

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
