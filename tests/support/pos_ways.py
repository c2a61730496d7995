"""What a unit may do one way or another, written from the contract alone.

Where the contract leaves two ways open that pulses and registers tell apart only later, the model
tries one, and if that does not agree the next one, from the start of the session.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field

from pos_words import Unsure

WAYS_MAX = 400


@dataclass
class Ways:
    """The choices of one try: which was taken, and of how many."""

    drawn: random.Random | None = None
    """A unit that is imagined draws."""
    taken: list[int] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)
    at: int = 0
    tries: int = 0

    def choose(self, count: int = 2) -> int:
        """Which of so many ways is gone: the first one, when it is met for the first time."""
        if self.drawn:
            return self.drawn.randrange(count)
        if self.at == len(self.taken):
            self.taken.append(0)
            self.counts.append(count)
        self.at += 1
        return self.taken[self.at - 1]

    def turn(self) -> bool:
        """Go back to the last choice that has another way; false: there is none."""
        del self.taken[self.at :], self.counts[self.at :]
        self.at, self.tries = 0, self.tries + 1
        if self.tries > WAYS_MAX:
            raise Unsure("too many ways to follow")
        while self.taken and self.taken[-1] + 1 == self.counts[-1]:
            self.taken.pop()
            self.counts.pop()
        if self.taken:
            self.taken[-1] += 1
        return bool(self.taken)
