"""The outputs that a move sets when its last section begins, in the model of the language."""

from __future__ import annotations

from language_pulses import Follower
from language_setup import Order
from language_signals import SEEN_TICKS, Unsure, Watch


class Marks:
    """The marks of one move, which are looked for in the record."""

    def __init__(self, order: Order, watch: Watch, follower: Follower) -> None:
        self._outputs = order.marks
        self._border = order.last_begins
        self._watch = watch
        self._follower = follower

    def start(self, high: int) -> None:
        """Take those of a single section."""
        if self._border == 0:
            self._expect(self._follower.start, high)

    def pass_by(self, made: int) -> bool:
        """Take those of a move that ends; whether they came at its very last pulse, as they may."""
        tick = self._follower.tick_of(min(self._border, made))
        high = tick + SEEN_TICKS
        if 0 < self._border < made:
            self._expect(tick, high)
        if not 0 < self._border == made:
            return False
        came = [self._watch.allow("out", n, tick, high) for n in self._outputs]
        return any(came)

    def forget(self, tick: int, made: int) -> None:
        r"""With a `\`, a last section that begins after it sets no outputs."""
        if made < self._border:
            self._outputs = ()
            return
        passed = tick - self._follower.tick_of(self._border)
        if self._outputs and self._border and passed < SEEN_TICKS:
            raise Unsure("a total reset when the last section begins")

    def _expect(self, low: int, high: int) -> None:
        for output in self._outputs:
            self._watch.expect("out", output, low, high)
