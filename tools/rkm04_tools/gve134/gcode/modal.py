"""What is modal in a program of G-code, and why a block cannot be done."""

from __future__ import annotations

from dataclasses import dataclass

from rkm04_tools.gve134.gcode import block as code
from rkm04_tools.gve134.gcode.axes import AXES, LETTERS, Axis, Mill
from rkm04_tools.gve134.gcode.block import Block
from rkm04_tools.gve134.gcode.path import Pace

MM_PER_INCH = 25.4
NANO, MM_PARTS, INCH_PARTS = 1e9, 5, 127
"""A number of nine decimals is whole in NANO; so many parts are a nanometre and a nanoinch."""

PLANES = {170: (0, 1), 180: (2, 0), 190: (1, 2)}
"""The axes of a plane: from the first to the second it is counterclockwise."""

SLACK = 1 + 1e-9


class Wrong(Exception):
    """What is wrong with a block; `place` is the letter or the group where."""

    def __init__(self, place: str, message: str) -> None:
        super().__init__(message)
        self.place = place


@dataclass(slots=True)
class Modal:
    """As a program begins: G17, G21, G90, G94, and no motion."""

    mill: Mill
    motion: int | None = None
    plane: int = 170
    is_inch: bool = False
    is_absolute: bool = True
    is_inverse: bool = False
    feed: float | None = None
    """mm, inch or degree a minute; in G93 one over minutes, of the block at hand."""
    _no_feed: str = "yet"
    """Since when there is none."""

    @property
    def is_arc(self) -> bool:
        """Whether the motion is along arcs."""
        return self.motion in (code.CLOCKWISE, code.COUNTER)

    @property
    def scale(self) -> float:
        """mm that a number of a block stands for."""
        return MM_PER_INCH if self.is_inch else 1.0

    def take(self, block: Block) -> None:
        """Take what is modal in a block."""
        codes = block.codes
        if (mode := codes.get(code.FEED_MODE)) is not None and self.is_inverse != (mode == 930):
            self._forget_feed("G93" if mode == 930 else "G94")
            self.is_inverse = mode == 930
        if (units := codes.get(code.UNITS)) is not None and self.is_inch != (units == 200):
            self._forget_feed("G20" if units == 200 else "G21")
            self.is_inch = units == 200
        self.plane = codes.get(code.PLANE, self.plane)
        if (distance := codes.get(code.DISTANCE)) is not None:
            self.is_absolute = distance == 900
        self.motion = codes.get(code.MOTION, self.motion)

    def _forget_feed(self, word: str) -> None:
        """Its unit is another one from now on."""
        if self.feed is not None or self._no_feed != "yet":
            self._no_feed = f"since {word}, with which that from before does not hold"
        self.feed = None

    def take_feed(self, block: Block) -> None:
        """Take the feed of a block; in G93 it is for that block alone."""
        feed = block.values.get("F")
        if feed is None:
            self.feed = None if self.is_inverse else self.feed
            return
        if feed <= 0:
            raise Wrong("F", f"F{feed:g}: a feed is more than 0")
        self.feed = feed
        if not self.is_inverse and feed > max(self.mill.feed_top / self.scale, self.mill.turn_top):
            self._require_reached("F", is_turn=False)

    def pace(self, block: Block) -> Pace:
        """How fast the motion of a block goes, which has a feed."""
        if self.feed is None:
            what = "of its own in G93" if self.is_inverse else self._no_feed
            raise Wrong(code.MOTION, f"the motion has no feed {what}; write F")
        if self.is_inverse:
            return Pace(seconds=60.0 / self.feed)
        values = block.values
        is_linear = self.is_arc or "X" in values or "Y" in values or "Z" in values
        self._require_reached("F" if "F" in values else code.MOTION, is_turn=not is_linear)
        return Pace(self.feed * self.scale / 60.0, self.feed / 60.0)

    def axis_values(self, block: Block) -> list[tuple[Axis, int]]:
        """The axes that a block names, with its numbers in parts."""
        found = []
        for index in AXES:
            letter = LETTERS[index]
            if letter in block.values:
                axis = self.mill.axes[index]
                if axis is None:
                    raise Wrong(letter, f"the machine has no axis {letter}")
                parts = INCH_PARTS if self.is_inch and index < 3 else MM_PARTS
                found.append((axis, round(block.values[letter] * NANO) * parts))
        return found

    def _require_reached(self, place: str, is_turn: bool) -> None:
        """Refuse a feed that the axes cannot have, whatever the direction."""
        top = self.mill.turn_top if is_turn else self.mill.feed_top / self.scale
        if self.feed is not None and self.feed > top * SLACK:
            unit = "degrees" if is_turn else "inch" if self.is_inch else "mm"
            raise Wrong(place, f"F{self.feed:g} is above the highest feed, {top:.6g} {unit}/min")
