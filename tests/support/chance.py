"""Chance of a run of the tests: RKM04_SEED repeats it; pytest tells the seed at its end."""

from __future__ import annotations

import os
import random
import time

from motion_probe import EPOCH_BITS

SEED = int(os.environ.get("RKM04_SEED") or time.time_ns() // 1000 % 2**32)


def epoch(*of: object) -> int:
    """A unit's time at its start: of so many bits, the same for the same objects in a run."""
    return random.Random(f"{SEED} {of}").getrandbits(EPOCH_BITS)


def timer_start() -> int:
    """What the timer of a board counts from; in half of all runs it turns within some seconds."""
    chance = random.Random(SEED)
    return -chance.randrange(1, 2**28) % 2**32 if chance.random() < 0.5 else chance.getrandbits(32)
