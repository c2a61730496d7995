"""What can go wrong on the line. Each error is one line: what is wrong, why, and what to do."""

from __future__ import annotations

from rkm04_tools.failure import NO_CONNECTION, NOT_SO, Failure


class LineError(Failure):
    """There is no connection to a unit."""

    def __init__(self, message: str) -> None:
        super().__init__(message, NO_CONNECTION)


class PortError(LineError):
    """The port cannot be used."""


class PortMissing(PortError):
    """There is no such port, or nobody listens there."""


class PortForbidden(PortError):
    """The user may not open it."""


class PortBusy(PortError):
    """Another program has it open."""


class PortLost(PortError):
    """It went away while it was in use."""


class NoAnswer(LineError):
    """Nothing came back, or only what was sent."""


class GarbledAnswer(LineError):
    """Something came back, and no frame of it was whole."""


class UnitRestarted(LineError):
    """The unit has started anew, and so does not execute the request.

    `repeated`: the request had been sent before, so it may have been executed before the start.
    """

    def __init__(self, where: str, repeated: bool) -> None:
        what = "executed before that or not at all" if repeated else "not executed"
        super().__init__(
            f"{where} has restarted, the request was {what}; "
            "look at the unit (rkm04 status) before you send it again"
        )
        self.repeated = repeated


class UnitRefused(Failure):
    """The unit understood the request and does not do it.

    `flag` and `character` are those of a refused Set Command, else 0 and empty.
    """

    def __init__(self, message: str, flag: int = 0, character: str = "") -> None:
        super().__init__(message, NOT_SO)
        self.flag = flag
        self.character = character


class UnknownMessage(UnitRefused):
    """The unit has other software, which does not know this request."""


class WrongAnswer(Failure):
    """A whole frame whose content is not what the request asks for."""

    def __init__(self, asked: str, answer: bytes) -> None:
        shown = answer[:24].hex(" ") + (" ..." if len(answer) > 24 else "")
        super().__init__(
            f"the answer to {asked} is not one of an RKM04 ({shown}); "
            "is it another unit, or does another program use this line?",
            NOT_SO,
        )
        self.answer = answer
