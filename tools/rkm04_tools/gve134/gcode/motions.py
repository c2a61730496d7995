"""The motions of a program: lines, arcs, probing, reference runs, and positions that are set."""

from __future__ import annotations

from dataclasses import dataclass

from rkm04_tools.gve134.gcode import block as code
from rkm04_tools.gve134.gcode.arcs import CLOSING_MM, Point, arc_around, centre_of
from rkm04_tools.gve134.gcode.axes import LETTERS, PARTS
from rkm04_tools.gve134.gcode.block import Block
from rkm04_tools.gve134.gcode.modal import (
    INCH_PARTS,
    MM_PARTS,
    NANO,
    PLANES,
    Modal,
    Wrong,
)
from rkm04_tools.gve134.gcode.path import FEED, RAPID, Pace, Path

CENTRE_LETTERS = "IJK"
HOMING_ORDER = "ZXYA"


@dataclass(slots=True)
class Motions:
    """What moves, by what is modal."""

    modal: Modal
    path: Path

    def move(self, block: Block) -> None:
        """Do the motion of a block, if it has one."""
        modal, values = self.modal, block.values
        has_place = "X" in values or "Y" in values or "Z" in values or "A" in values
        if not has_place and not (
            modal.is_arc and ("I" in values or "J" in values or "K" in values or "R" in values)
        ):
            if block.codes.get(code.MOTION) == code.PROBE:
                raise Wrong(code.MOTION, "G38.2 takes the position to which the probe may go")
            return
        if modal.motion == code.LINEAR:
            self.path.line_to(self._target(block), modal.pace(block), FEED)
        elif modal.motion == code.RAPID:
            self.path.line_to(self._target(block), Pace(), RAPID)
        elif modal.is_arc:
            self._follow_arc(block)
        elif modal.motion == code.PROBE:
            self._probe(block)
        else:
            letter = next(letter for letter in LETTERS if letter in values)
            raise Wrong(letter, f"{letter}: no motion is in force; write G0, G1, G2 or G3")

    def set_offset(self, block: Block) -> None:
        """G92: axes are where the block says, from there on."""
        given = self.modal.axis_values(block)
        if not given:
            raise Wrong(code.NOTHING, "G92 takes the positions that axes are to have")
        for axis, parts in given:
            self.path.offset[axis.index] = self.path.parts[axis.index] - parts
            self.path.unknown.discard(axis.index)

    def home(self, block: Block) -> None:
        """G28: by way of the position in the block, if there is one, to the reference."""
        given = [axis for axis, _ in self.modal.axis_values(block)]
        axes = given or [axis for axis in self.path.mill.axes if axis and axis.homing]
        if not axes:
            raise Wrong(code.NOTHING, "G28: the machine file tells of no reference run")
        for axis in axes:
            if axis.homing is None:
                raise Wrong(axis.letter, f"the machine file has no reference run of {axis.letter}")
        if given:
            self.path.line_to(self._target(block), Pace(), RAPID)
        for axis in sorted(axes, key=lambda axis: HOMING_ORDER.index(axis.letter)):
            self.path.home(axis)

    def _target(self, block: Block) -> list[int]:
        """The position to which the block goes, in parts."""
        modal, path, values = self.modal, self.path, block.values
        target = list(path.parts)
        size = INCH_PARTS if modal.is_inch else MM_PARTS
        for index, letter in enumerate(LETTERS):
            if letter not in values:
                continue
            if modal.mill.axes[index] is None:
                raise Wrong(letter, f"the machine has no axis {letter}")
            parts = round(values[letter] * NANO) * (size if index < 3 else MM_PARTS)
            if not modal.is_absolute:
                target[index] += parts
            elif index in path.unknown:
                raise Wrong(
                    letter,
                    f"where {letter} is after G38.2 is known when it runs only; tell it with G92, "
                    "or move by G91",
                )
            else:
                target[index] = path.offset[index] + parts
        return target

    def _follow_arc(self, block: Block) -> None:
        target, path = self._target(block), self.path
        one, two = PLANES[self.modal.plane]
        begin = path.parts
        end = (target[one] - begin[one]) / PARTS, (target[two] - begin[two]) / PARTS
        clockwise = self.modal.motion == code.CLOCKWISE
        closing = max(path.tolerance, CLOSING_MM)
        pace = self.modal.pace(block)
        centre = self._centre(block, end, clockwise, closing)
        arc = arc_around(centre, end, clockwise, closing)
        place = begin[one] + round(centre[0] * PARTS), begin[two] + round(centre[1] * PARTS)
        path.arc_to(target, arc, place, (one, two), pace)

    def _centre(self, block: Block, end: Point, clockwise: bool, closing: float) -> Point:
        """The centre of an arc, counted from its start, mm."""
        values, scale = block.values, self.modal.scale
        letters = [CENTRE_LETTERS[index] for index in PLANES[self.modal.plane]]
        given = [letter for letter in CENTRE_LETTERS if letter in values]
        for letter in given:
            if letter not in letters:
                plane = f"G{self.modal.plane // 10}"
                raise Wrong(letter, f"{letter} is not in the plane of the arc, {plane}")
        if "R" in values:
            if given:
                raise Wrong("R", "the arc has both R and a centre; keep one of them")
            return centre_of(end, values["R"] * scale, clockwise, closing)
        if not given:
            what = " and ".join(sorted(letters))
            raise Wrong(code.MOTION, f"the arc has no centre; write {what}, or R")
        one, two = letters
        return values.get(one, 0.0) * scale, values.get(two, 0.0) * scale

    def _probe(self, block: Block) -> None:
        if self.path.mill.probe is None:
            raise Wrong(code.MOTION, "the machine file tells of no probe")
        if self.modal.is_inverse:
            raise Wrong(code.MOTION, "G38.2 takes a feed of G94")
        self.path.probe_to(self._target(block), self.modal.pace(block))
