"""What can go wrong with a positioning unit. Each error is one line, with what to do."""

from __future__ import annotations

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.line_errors import LineError, NoAnswer, UnitRestarted
from rkm04_tools.positioning.state import EXCEPTIONS, AxisState, error_text, mm_text


class WrongUnit(LineError):
    """Something answers that is no positioning unit of this kind."""

    def __init__(self, where: str) -> None:
        super().__init__(f"{where}: something answers that is no positioning unit; is it another?")


class Restarted(UnitRestarted):
    """The unit has started anew: axes are free, positions count from 0."""

    def __init__(self, where: str, executed: bool = False) -> None:
        self.repeated = executed
        what = "the last instruction may have been executed before that; " if executed else ""
        LineError.__init__(
            self,
            f"{where} HAS RESTARTED: its axes are free, positions count from 0, and what moved "
            f"stood at once; {what}positioning status tells what it is like",
        )


class NotBegun(Failure):
    """It has taken so long to get to the unit that nobody expects a motion any more."""

    def __init__(self, where: str) -> None:
        super().__init__(
            f"{where}: this took too long, and it was not told to move; "
            "look at the unit, then ask again", NOT_SO,
        )  # fmt: skip


class NotRepeated(NoAnswer):
    """The same, after it was sent and not answered."""

    def __init__(self, where: str) -> None:
        super().__init__(
            f"{where} does not answer; it was not told again to move, as that would be late; "
            "whether it has begun to is not known"
        )


class NotConfirmed(LineError):
    """Nobody has told that the axis stands."""


class NotHeld(Failure):
    """Axes were told to stand and do not, or may move at any moment."""

    def __init__(self, who: str, why: str) -> None:
        verb = "IS" if who.startswith("axis") else "ARE"
        super().__init__(f"{who} {verb} NOT HELD: {why}", NOT_SO)


class RequestRefused(Failure):
    """A request was answered by an exception, and has changed nothing."""

    def __init__(self, where: str, what: str, code: int) -> None:
        why = EXCEPTIONS.get(code, "an exception that this unit does not have")
        super().__init__(f"{where}: {what}: {why} (exception {code})", NOT_SO)
        self.code = code


class Refused(Failure):
    """An axis has refused an instruction. `fault` is the one that stands, 0: none."""

    def __init__(self, axis: int, what: str, number: int, fault: int = 0) -> None:
        cause = f" ({error_text(fault)}; {ADVICE[fault]})" if fault in ADVICE else ""
        super().__init__(f"axis {axis}: {what} was refused: {error_text(number)}{cause}", NOT_SO)
        self.number = number


class Faulted(Failure):
    """A fault has ended the measure of an axis."""

    def __init__(self, state: AxisState) -> None:
        at = mm_text(state.position_um)
        where = f"it brakes at {at} mm" if state.moves else f"it stands at {at} mm"
        super().__init__(
            f"axis {state.axis}: the measure was ended by {error_text(state.error)}; {where}; "
            f"{ADVICE.get(state.error, 'find out why')}; init comes before the next one",
            NOT_SO,
        )
        self.number = state.error


ADVICE = {
    7: "go the other way, or leave the switch by hand",
    8: "WATCHDOG must be longer than the pause to the next request, as between two commands; "
    "or reset first, and then move or home, which take the axis themselves",
    10: "go the other way, or change SOFT_MIN and SOFT_MAX",
    11: "look at the switch and its setting, the method and HOME_WAY",
}
"""What to do about faults."""
