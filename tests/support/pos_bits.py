"""What an axis of the positioning unit tells of itself, written from the contract alone."""

from __future__ import annotations

from dataclasses import dataclass

from pos_words import (
    CONT,
    DISP,
    ERR,
    FAULTS,
    INIC,
    JEDE,
    MP,
    POL,
    PROG,
    SMER,
    Error,
)


@dataclass
class Bits:
    """What the records and registers tell."""

    disp: bool = False
    prog: bool = False
    pol: bool = False
    err: bool = False
    error: Error = Error.NONE
    mp: bool = False
    inic: bool = False
    cont: bool = False
    feed: int = 0
    jede: bool = False
    smer: bool = False
    referenced: bool = False
    armed: bool = False
    homing: bool = False
    result: Error = Error.NONE
    captures: int = 0

    @property
    def fault(self) -> bool:
        """Whether the axis is in the state FAULT."""
        return self.error in FAULTS

    @property
    def status(self) -> int:
        """POS_STATUS."""
        named = {JEDE: self.jede, SMER: self.smer, POL: self.pol}
        named |= {DISP: self.disp, PROG: self.prog, ERR: self.err}
        return sum(bit for bit, holds in named.items() if holds)

    @property
    def control(self) -> int:
        """POS_CONTROL; RESET is over when anybody looks."""
        named = {MP: self.mp, INIC: self.inic, CONT: self.cont}
        return sum(bit for bit, holds in named.items() if holds)

    @property
    def registers(self) -> dict[str, int]:
        """The registers that change with the state."""
        return {
            "STATUS": self.status,
            "ERROR": int(self.error),
            "RESULT": int(self.result),
            "CONTROL": self.control,
            "FEED": self.feed,
            "CAPTURES": self.captures & 0xFFFF,
        }
