"""What an axis and the unit tell of themselves, in words and in the units of people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rkm04_tools.positioning.table import bits, registers

FEED_PER_MM_MIN = 65_536
UM_PER_MM = 1000
INPUTS = 8
ERRORS = {
    1: "there is no such axis",
    2: "the space must be 0 to 6",
    3: "the axis is not taken: init comes first",
    4: "a measure is under way",
    5: "the way is too long",
    6: "the acceleration must not be 0",
    7: "a limit input is active",
    8: "the bus was silent for longer than WATCHDOG",
    9: "the unit has no crystal",
    10: "a software limit",
    11: "the switch was not found within HOME_WAY",
    12: "the input for it is not set",
    13: "the method must be 19, 21 or 37",
    14: "the stored settings are damaged: settings come first, then STORE",
    15: "there was a fault: init comes first",
}
"""The numbers of ERROR and RESULT."""
FAULTS = (7, 8, 10, 11)
"""Those that end a measure; the others refuse an instruction."""
EXCEPTIONS = {
    1: "the unit does not know this function",
    2: "there is no such register, or it cannot be written",
    3: "the value is out of its range",
    4: "STORE has failed; what was stored before still is",
    6: "not while an axis that it concerns is taken or moves",
    11: "the unit behind the gateway does not answer",
}
"""The exceptions of Modbus that a unit or a gateway answers with."""
CONDITIONS = {
    1: "no crystal: nothing can move",
    2: "THE STORED SETTINGS ARE DAMAGED, the delivered ones are in force",
    4: "settings are not as stored",
}
START_CAUSES = ("power", "by hand", "the processor's watchdog", "a fault of the processor")
IN_FIRST = 10
IN_NUMBERS = range(IN_FIRST, 28)
"""The registers of an axis that tell what it does."""
NAMES = {  # of AxisState: registers
    "status": "STATUS", "error": "ERROR", "done": "DONE", "result": "RESULT", "flags": "FLAGS",
    "captures": "CAPTURES", "position_um": "POSITION", "way_left_um": "WAY_LEFT",
    "speed": "SPEED", "position_steps": "POSITION_STEPS", "captured_um": "CAPTURED",
    "captured_steps": "CAPTURED_STEPS",
}  # fmt: skip
FLAG_WORDS = {2: "limit -", 4: "limit +", 8: "reference", 16: "capture"}
"""Inputs of an axis that are active."""


def error_text(number: int) -> str:
    """An error of an axis in words."""
    return f"error {number}: {ERRORS.get(number, 'not one that this tool knows')}"


def feed_text(feed: int) -> str:
    """A feed in mm/min."""
    return f"{feed / FEED_PER_MM_MIN:.3f}".rstrip("0").rstrip(".")


def mm_text(um: int) -> str:
    """A way in mm."""
    return f"{um / UM_PER_MM:.3f}"


@dataclass(frozen=True)
class AxisState:
    """What an axis tells at one moment: registers +10 to +27, or those of them that an image has.

    Ways in µm, `speed` in 1/65 536 mm/min.
    """

    axis: int
    status: int
    error: int
    flags: int
    captures: int
    position_um: int
    way_left_um: int = 0
    speed: int = 0
    position_steps: int = 0
    captured_um: int = 0
    captured_steps: int = 0
    done: int = 0
    result: int = 0

    def _has(self, name: str) -> bool:
        return bool(self.status & bits()[name])

    @property
    def moves(self) -> bool:
        """JEDE."""
        return self._has("JEDE")

    @property
    def is_negative(self) -> bool:
        """SMER: the direction, kept at rest."""
        return self._has("SMER")

    @property
    def is_reached(self) -> bool:
        """POL: it stands where the measure wants it."""
        return self._has("POL")

    @property
    def is_taken(self) -> bool:
        """DISP."""
        return self._has("DISP")

    @property
    def is_programmed(self) -> bool:
        """PROG: a measure was given."""
        return self._has("PROG")

    @property
    def may_move(self) -> bool:
        """Whether permission and feed let it move: there is a measure that is not reached."""
        return self.is_taken and self.is_programmed and not self.is_reached

    @property
    def has_error(self) -> bool:
        """ERR."""
        return self._has("ERR")

    @property
    def has_fault(self) -> bool:
        """Whether nothing moves before init, because of an error."""
        return self.error in FAULTS

    @property
    def is_referenced(self) -> bool:
        """Whether it was homed."""
        return bool(self.flags & bits()["REFERENCED"])

    @property
    def state(self) -> str:
        """The name that the documents give to what it does."""
        if not self.is_taken:
            return "FREE"
        if self.has_fault:
            return "FAULT"
        if not self.is_programmed:
            return "TAKEN"
        if self.is_reached:
            return "REACHED"
        return "MOVING" if self.moves else "READY"

    @property
    def words(self) -> str:
        """State and what else is to be known, in words."""
        parts = [self.state]
        parts += ["brakes"] if self.moves and self.state not in ("MOVING",) else []
        parts += ["homing"] if self.flags & bits()["HOMING"] else []
        parts += ["capture armed"] if self.flags & bits()["ARMED"] else []
        parts += [f"{word} active" for bit, word in FLAG_WORDS.items() if self.flags & bit]
        parts += [error_text(self.error)] if self.has_error else []
        return ", ".join(parts)

    def as_json(self) -> dict[str, Any]:
        """For scripts: the registers, and what they mean in mm and mm/min."""
        return {
            "axis": self.axis,
            "state": self.state,
            "moves": self.moves,
            "reached": self.is_reached,
            "referenced": self.is_referenced,
            "error": self.error,
            "error_text": ERRORS.get(self.error, "") if self.error else "",
            "position_mm": self.position_um / UM_PER_MM,
            "way_left_mm": self.way_left_um / UM_PER_MM,
            "speed_mm_min": self.speed / FEED_PER_MM_MIN,
            "position_steps": self.position_steps,
            "captures": self.captures,
            "captured_mm": self.captured_um / UM_PER_MM,
            "captured_steps": self.captured_steps,
            "status": f"{self.status:04X}",
            "flags": f"{self.flags:04X}",
            "done": self.done,
            "result": self.result,
        }


def axis_state(axis: int, numbers: Sequence[int], words: Sequence[int]) -> AxisState:
    """What an axis tells by the registers of these numbers, counted from its first one."""
    told = dict(zip(numbers, words, strict=True))
    values = {}
    for field, name in NAMES.items():
        row = registers()[name]
        if row.number in told:
            values[field] = row.of_words([told[row.number + i] for i in range(row.words)])
    return AxisState(axis=axis, **values)


@dataclass(frozen=True)
class UnitState:
    """What the unit tells of itself: the registers of its own, by their names."""

    node: int
    values: Mapping[str, int]

    @property
    def version(self) -> str:
        """Major and minor."""
        return f"{self.values['VERSION'] >> 8}.{self.values['VERSION'] & 0xFF:02d}"

    @property
    def conditions(self) -> list[str]:
        """What is not as it should be."""
        return [text for bit, text in CONDITIONS.items() if self.values["CONDITION"] & bit]

    @property
    def start_cause(self) -> str:
        """Why it has started."""
        cause = self.values["START_CAUSE"]
        return START_CAUSES[cause] if cause < len(START_CAUSES) else f"not known ({cause})"

    @property
    def inputs(self) -> list[int]:
        """The levels of BI1 to BI8."""
        return [self.values["INPUTS"] >> i & 1 for i in range(INPUTS)]

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        counts = {name.lower(): value for name, value in self.values.items()}
        return {
            "node": self.node,
            **counts,
            "version": self.version,
            "start_cause": self.start_cause,
            "conditions": self.conditions,
            "inputs": self.inputs,
        }
