"""A program of G-code, block by block."""

from __future__ import annotations

from collections.abc import Callable

from rkm04_tools.gve134.gcode import block as code
from rkm04_tools.gve134.gcode.arcs import NoArc
from rkm04_tools.gve134.gcode.axes import LETTERS
from rkm04_tools.gve134.gcode.block import Block, read_block
from rkm04_tools.gve134.gcode.modal import Modal, Wrong
from rkm04_tools.gve134.gcode.motions import Motions
from rkm04_tools.gve134.gcode.outputs import Outputs
from rkm04_tools.gve134.gcode.path import OutOfReach, Path
from rkm04_tools.gve134.gcode.words import Pair
from rkm04_tools.gve134.gcode.writer import TooSlow, Writer

DWELL_MANY_S = 60.0
TAPE_END = "%"
GEOMETRY = "RIJKXYZAF"
"""The words to which a motion that cannot be is put down."""

MOVING = frozenset("XYZAIJK")
MOVES_ONLY = frozenset("XYZAF")
PATH_TOLERANCE = (
    "G64 takes no tolerance (P) here: the path is kept exactly, and corners are slowed by the "
    "machine file's jumps; write G64 alone"
)
ALWAYS = frozenset("XYZAFST")
OF_ARCS = frozenset("IJKR")

Fault = tuple[int, str]
"""The index of a word, -1 for the whole line, and what is wrong there."""


class Program:
    """The state of a program, and its acts."""

    def __init__(self, path: Path, writer: Writer, tell: Callable[[str], None]) -> None:
        self.ended = False
        self._dwelt_s = 0.0
        self._begun = False
        self._tell = tell
        self._writer = writer
        self._modal = Modal(path.mill)
        self._motions = Motions(self._modal, path)
        self._path = path
        self._outputs = Outputs(path.mill, writer)

    @property
    def dwelt_s(self) -> float:
        """How long it has the axes stand, pauses for a person left out."""
        return self._dwelt_s + self._outputs.dwelt_s

    def take(self, words: list[Pair], comment: str) -> list[Fault]:
        """Do what a block says; what is wrong with it."""
        if words[0][0] == TAPE_END:
            self.ended, self._begun = self._begun, True
            return []
        self._begun = True
        block = read_block(words)
        if block.faults:
            self._modal.take(block)
            self._modal.feed = block.values.get("F") or self._modal.feed
            return block.faults
        try:
            self._run(block, comment)
        except Wrong as wrong:
            return [(block.places.get(wrong.place, -1), str(wrong))]
        except (NoArc, OutOfReach, TooSlow) as wrong:
            place = next((block.places[each] for each in GEOMETRY if each in block.places), -1)
            return [(place, str(wrong))]
        return []

    def end(self) -> None:
        """There are no more blocks."""
        if self._outputs.is_turning:
            self._tell("the program ends without M2 or M30: the spindle stays on")
        self._writer.sync()

    def _run(self, block: Block, comment: str) -> None:
        codes, values, commands = block.codes, block.values, block.commands
        once = None
        if codes:
            self._modal.take(block)
            once = codes.get(code.NOTHING)
        if once == code.NO_OFFSET or not values.keys() <= MOVES_ONLY:
            self._require_used(block, once)
        if "F" in values or self._modal.is_inverse:
            self._modal.take_feed(block)
        if commands or "S" in values or "T" in values:
            self._outputs.act(block, comment)
        if once is not None:
            self._do_once(block, once)
        if once not in code.TAKES_AXES:
            if self._outputs.stopped_by_change:
                self._warn_of_spindle(block)
            self._motions.move(block)
        if (stop := commands.get("stop")) is not None:
            self.ended = self._outputs.stop(stop, comment)

    def _warn_of_spindle(self, block: Block) -> None:
        """Tell of the first motion with a feed whose spindle M6 has stopped."""
        is_feed = self._modal.is_arc or self._modal.motion == code.LINEAR
        if is_feed and not block.values.keys().isdisjoint(MOVING):
            self._outputs.stopped_by_change = False
            self._tell("the spindle is off since the tool was changed (M6); write M3 after it")

    def _do_once(self, block: Block, once: int) -> None:
        if once in code.TAKES_AXES and code.MOTION in block.codes:
            raise Wrong(code.MOTION, "the line has two G that take its positions; divide it")
        if once == code.DWELL:
            self._dwell(block)
        elif once == code.HOME:
            self._motions.home(block)
        elif once == code.OFFSET:
            self._motions.set_offset(block)
        else:
            self._path.offset = [0, 0, 0, 0]

    def _dwell(self, block: Block) -> None:
        seconds = block.values.get("P", -1.0)
        if seconds < 0:
            raise Wrong("P" if "P" in block.values else code.NOTHING,
                        "G4 takes how long to dwell: P, in seconds")  # fmt: skip
        if seconds >= DWELL_MANY_S:
            self._tell(f"G4 P{seconds:g} is a dwell of {seconds:g} s; P is in seconds here")
        self._writer.sync()
        self._writer.wait(seconds)
        self._dwelt_s += seconds

    def _require_used(self, block: Block, once: int | None) -> None:
        """Refuse words that no part of the block takes."""
        is_arc = self._modal.is_arc and once not in code.TAKES_AXES
        taken = ALWAYS | (OF_ARCS if is_arc else set()) | ({"P"} if once == code.DWELL else set())
        if once == code.NO_OFFSET:
            taken -= set(LETTERS)
        for letter in block.values:
            if letter not in taken:
                if letter == "P" and "path" in block.codes:
                    raise Wrong(letter, PATH_TOLERANCE)
                raise Wrong(letter, f"{letter} has no meaning in this line")
