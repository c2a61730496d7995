"""What can go wrong with a positioning unit. Each error is one line, with what to do."""

from __future__ import annotations

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.line_errors import LineError
from rkm04_tools.positioning.state import EXCEPTIONS, error_text


class WrongUnit(LineError):
    """Something answers that is no positioning unit of this kind."""

    def __init__(self, where: str) -> None:
        super().__init__(f"{where}: something answers that is no positioning unit; is it another?")


class Restarted(LineError):
    """The unit has started anew: axes are free, positions count from 0."""

    def __init__(self, where: str, executed: bool = False) -> None:
        what = "the last instruction may have been executed before that; " if executed else ""
        super().__init__(
            f"{where} HAS RESTARTED: its axes are free, positions count from 0, and what moved "
            f"stood at once; {what}positioning status tells what it is like"
        )


class NotConfirmed(LineError):
    """Nobody has told that the axis stands."""


class RequestRefused(Failure):
    """A request was answered by an exception, and has changed nothing."""

    def __init__(self, where: str, what: str, code: int) -> None:
        why = EXCEPTIONS.get(code, "an exception that this unit does not have")
        super().__init__(f"{where}: {what}: {why} (exception {code})", NOT_SO)
        self.code = code


class Refused(Failure):
    """An axis has refused an instruction."""

    def __init__(self, axis: int, what: str, number: int) -> None:
        super().__init__(f"axis {axis}: {what} was refused: {error_text(number)}", NOT_SO)
        self.number = number


class Faulted(Failure):
    """A fault has ended the measure of an axis."""

    def __init__(self, axis: int, number: int, at: str) -> None:
        super().__init__(
            f"axis {axis}: the measure was ended by {error_text(number)}; it stands at {at} mm; "
            "init comes before the next one",
            NOT_SO,
        )
        self.number = number
