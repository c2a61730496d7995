"""What a motor of the model can be doing, and what surrounds it."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum, auto

from language_signals import US, Moment, Signal, Variables, Watch
from program_probe import Connection

BEHIND_TICKS = 200 * US
"""By so much a move or a wait may be late and still count from the program clock."""

LOCK = 40
"""The function that keeps a full memory from being overwritten."""

SIMULATION = 41
"""The function that disconnects the outputs, and each motor when it stands."""

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

    `trains` are its pulses at the pins (True) and in simulation (False). `functions` are those of
    the whole unit that are on, the same set for all motors; `switches`, likewise, when simulation
    was switched on or off.
    """

    inputs: dict[int, Signal]
    variables: Variables
    watch: Watch
    trains: dict[bool, list[int]]
    connections: deque[Connection]
    functions: set[int]
    switches: list[tuple[Moment, bool]]
