"""A file on its way to the unit, and what else is done meanwhile."""

from __future__ import annotations

import time
from collections.abc import Callable

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.known import step_towards
from rkm04_tools.gve134.link_errors import Restarted
from rkm04_tools.gve134.sending import Interrupted, Sender
from rkm04_tools.gve134.service import acting, working
from rkm04_tools.gve134.service.board import Board
from rkm04_tools.gve134.service.connection import Connection
from rkm04_tools.gve134.service.files import File
from rkm04_tools.gve134.state import RUN, positions_text
from rkm04_tools.gve134.unit import POLL_SECONDS, Unit
from rkm04_tools.line_errors import LineError, PortError, PortLost
from rkm04_tools.service.trouble import BadRequest, Stopped

LOOK_SECONDS = 0.25
"""From one look to the next while a file is sent."""
PAUSE_SECONDS = 0.1
"""The same while nothing is sent."""
OVERRIDE_STEPS = 4
"""Commands to change the speed that are sent in a turn."""


class Cut(Stopped):
    """A job was halted in the middle of a command."""

    def __init__(self) -> None:
        Failure.__init__(
            self,
            "halted in the middle of a command, of which the end is not known, and the rest was "
            "not sent; look at the unit, and begin anew",
        )


class Held(Stopped):
    """A job was left between two of its commands, and can be gone on with."""

    def __init__(self) -> None:
        Failure.__init__(self, "halted; Go goes on with the job, Delete ends it")


class Jobs:
    """Sends files. `beside` is called between two commands of one: it does what may be done then,
    and raises Held where a halt is wanted."""

    def __init__(self, board: Board, line: Connection, beside: Callable[[Unit], None]) -> None:
        self._board = board
        self._line = line
        self._beside = beside
        self._resumed = False

    def begin(self, unit: Unit, file: File) -> str:
        """Send a file, and wait for its end."""
        if file.job is None or file.course is None:
            raise BadRequest(f"{file.name} has errors; nothing was sent")
        if self._board.state.restarted:
            raise BadRequest(f"{file.name}: the unit has restarted; take note of that first")
        acting.require_free(unit.flags())
        begin = unit.positions()
        unit.order(f"XM{self._board.state.wanted or round(self._line.known.percent or 100)}")
        self._board.change(wanted=None)
        self._line.begin_way()
        sender = Sender(unit, file.job, lambda _: self._between(), ask_person=self._ask_person)
        self._line.job = working.Work(file, sender, begin)
        return self._work(unit)

    def go_on(self, unit: Unit) -> str:
        """Let the axes go on, and the job that was halted or interrupted."""
        job = self._line.job
        is_job = job is not None and job.is_open
        if job and is_job:
            self._require_own(unit, job)
        text = acting.go(unit, may_be_empty=is_job)
        return self._work(unit) if is_job else text

    def _require_own(self, unit: Unit, job: working.Work) -> None:
        """End a job that another program has used the unit beside.

        Whoever has only halted it changes nothing: the axes stand as they did then.
        """
        held = job.trouble
        if isinstance(held, Interrupted) and held.left == (unit.flags(), unit.positions()):
            unit.link.connect()  # what was counted until now is known
            return
        try:
            unit.link.require_own()
        except LineError as error:
            ended = _end_of(error, job.sender.sent_text)
            self._line.end_job(working.FAILED, ended)
            raise ended from None

    def resume(self) -> str:
        """The person whom the job waits for is ready."""
        if not self._line.job or self._line.job.phase != working.WAITS:
            raise BadRequest("no job waits for anybody; look at the unit")
        self._resumed = True
        return "the job goes on"

    def delete(self, unit: Unit) -> str:
        """Delete the queue, and give up the job that was halted."""
        text = acting.delete(unit)
        if self._line.job and self._line.job.is_open:
            self._line.end_job(working.FAILED, Failure("deleted; the rest was not sent"))
        return text

    def _work(self, unit: Unit) -> str:
        job, line = self._line.job, self._line
        assert job is not None
        try:
            job.trouble = None
            line.enter(working.SENDING)
            job.sender.send()
            line.enter(working.FINISHING)
            job.sender.finish()
        except (Held, Interrupted) as reason:
            job.trouble = None if isinstance(reason, Held) else reason
            line.enter(working.HELD)
            raise
        except Failure as failure:
            ended = _end_of(failure, job.sender.sent_text)
            line.end_job(working.FAILED, ended)
            raise ended from None
        line.look(unit)
        line.end_job(working.DONE, None)
        at = positions_text(unit.positions())
        return f"{job.file.name}: {job.sender.sent} vectors made; the axes stand at {at}"

    def _between(self) -> None:
        """Between two commands: the unit is looked at, too."""
        unit, job = self._line.unit, self._line.job
        assert unit is not None
        assert job is not None
        self._beside(unit)
        if time.monotonic() >= self._line.look_due:
            self._line.look(unit, LOOK_SECONDS if job.phase == working.SENDING else PAUSE_SECONDS)

    def _ask_person(self, text: str) -> None:
        assert self._line.unit is not None
        self._resumed = False
        self._line.enter(working.WAITS, text)
        while not self._resumed:
            self._line.unit.link.pause(POLL_SECONDS)
            self._between()
        self._line.enter(working.SENDING)

    def override(self, unit: Unit) -> None:
        """Bring a wanted speed about, a few steps at a time where vectors are queued.

        XM would give all of them the last V.
        """
        wanted, flags = self._board.state.wanted, self._line.looks.flags
        if wanted is None:
            return
        is_job = self._line.job is not None and self._line.job.is_under_way
        try:
            if not is_job and flags is not None and not flags.has(RUN):
                unit.order(f"XM{wanted}")
                is_done = True
            else:
                is_done = self._step(unit, wanted)
        except Failure:
            self._board.change(wanted=None)
            raise
        if is_done and self._board.state.wanted == wanted:
            self._board.change(wanted=None)

    def _step(self, unit: Unit, wanted: int) -> bool:
        """Go some steps; whether that is all."""
        for _ in range(OVERRIDE_STEPS):
            factor = self._line.known.factor
            if factor is None:
                raise BadRequest(
                    f"the speed that the vectors have is not known, so it cannot become {wanted} % "
                    "while they are made; type XU or XD to change it by a sixteenth"
                )
            command = step_towards(factor, wanted)
            if command is None:
                return True
            unit.order(command)
        return False


def _end_of(failure: Failure, sent: str) -> Failure:
    """Why a job has ended, with what is not known then."""
    if isinstance(failure, Stopped):
        return Cut()
    if isinstance(failure, LineError) and not isinstance(failure, Restarted):
        text = f"{failure}; {sent} vectors were sent and go on by themselves: whether the axes "
        text += "move is NOT KNOWN"
        return PortLost(text) if isinstance(failure, PortError) else LineError(text)
    return failure
