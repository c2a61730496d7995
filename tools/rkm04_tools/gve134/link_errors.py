"""What can go wrong on the line of a GVE134 unit. Each error is one line, with what to do."""

from __future__ import annotations

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.line_errors import GarbledAnswer, LineError, NoAnswer

__all__ = [
    "EndUnknown", "GarbledAnswer", "LineError", "NoAnswer", "NotConfirmed", "OtherDevice",
    "OutOfStep", "Refused", "Restarted", "SumsOff",
]  # fmt: skip


class OtherDevice(LineError):
    """Something answers in the form of the line, but is no GVE134."""


class OutOfStep(LineError):
    """The unit has counted other commands than were sent."""

    def __init__(self, where: str) -> None:
        super().__init__(
            f"{where} has counted commands that were not sent from here, or was restarted; what "
            "was sent last may have been executed; look at the unit (gve134 status) and see that "
            "no other program uses this line"
        )


class SumsOff(OutOfStep):
    """Another program has switched checksums off. The unit has not restarted: all goes on there."""

    def __init__(self, where: str) -> None:
        LineError.__init__(
            self,
            f"{where}: another program has switched its checksums off; what was sent last may have "
            "been executed; look at the unit (gve134 status) and see that no other program uses "
            "this line",
        )


class Restarted(LineError):
    """The unit has started anew, so its queue, positions and settings are gone.

    `executed`: whether the command that was under way may have been executed before that.
    """

    def __init__(self, where: str, executed: bool) -> None:
        what = "executed before that or not at all" if executed else "not executed"
        super().__init__(
            f"{where} HAS RESTARTED: its queue, positions and settings are gone, and what moved "
            f"stood at once; the command under way was {what}, and nothing was sent after it; "
            "gve134 status tells what the unit is like"
        )
        self.executed = executed


class EndUnknown(LineError):
    """A command was executed, and how it ended cannot be told any more."""

    def __init__(self, where: str, command: str) -> None:
        super().__init__(
            f"{where} has executed {command} or refused it, and the answer was lost for good; "
            "look at the unit (gve134 status) before anything is sent again"
        )


class NotConfirmed(LineError):
    """The unit has not told that its axes stand."""


class Refused(Failure):
    """The unit does not do what it was asked for."""

    def __init__(self, what: str, answer: Answer, why: str = "") -> None:
        super().__init__(f"{what}: {why or answer.words} (answer {answer.text})", NOT_SO)
        self.answer = answer
