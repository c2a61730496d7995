"""The worker of a GVE134: a file is sent by its thread, too (`jobs`); between two of its commands
a halt goes ahead, and what may be done beside it is done.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.service import acting
from rkm04_tools.gve134.service.board import make_board
from rkm04_tools.gve134.service.connection import Connection
from rkm04_tools.gve134.service.files import File
from rkm04_tools.gve134.service.jobs import Held, Jobs
from rkm04_tools.gve134.service.orders import Jog, Output, Override, Spindle, Start, Typed, Work
from rkm04_tools.gve134.service.saying import WORDS
from rkm04_tools.gve134.stopping import halted_text
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.line_errors import LineError
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.trouble import BadRequest, NotConnected, Stopped
from rkm04_tools.service.turns import Turns
from rkm04_tools.service.unit_board import Tell
from rkm04_tools.service.unit_orders import Plain, name_of
from rkm04_tools.service.virtual import VirtualLine


class Worker(Turns[Unit]):
    """Takes orders from any thread; `tell` gets all that browsers are to know.

    `is_watched` says whether anybody wants to know what the unit does.
    """

    grace_seconds = 0.3
    """Packets take less."""

    def __init__(
        self, tell: Tell, is_watched: Callable[[], bool], units: VirtualLine, baud: int
    ) -> None:
        board = make_board(tell)
        self._line = Connection(board, units, baud, self._mind_halt)
        super().__init__(board, self._line, is_watched)
        self._jobs = Jobs(board, self._line, self._beside)

    def greetings(self) -> list[dict[str, Any]]:
        """What a browser that comes is told."""
        return [self.board.as_json(), self._line.made.as_json()]

    def require_no_job(self) -> None:
        """Refuse what would take the file or the machine from a job."""
        job = self._line.job
        if job and job.is_open:
            raise BadRequest(f"{job.file.name} is not done; go on with it, or halt and delete it")

    def _beside(self, unit: Unit) -> None:
        """Between two commands of a job: a halt, an order, the speed."""
        if self._halts or self._closing:
            raise Held
        with self._wakes:
            work = self._waiting.popleft() if self._waiting else None
        if work:
            order, asked, _ = work
            got = self._tried(lambda: self._act_beside(unit, order))
            self._answer(name_of(order), asked, got)
            if isinstance(got, LineError | Stopped):
                raise got
        sped = self._tried(lambda: self._jobs.override(unit))
        if isinstance(sped, LineError | Stopped):
            raise sped
        if isinstance(sped, Failure):
            self._answer("override", Asked(), sped)

    def _act(self, unit: Unit, order: Work) -> str:
        """What may be done while no job is under way."""
        if isinstance(order, Override):
            self.board.change(wanted=order.percent)
            return f"the speed becomes {order.percent} %"
        if isinstance(order, Typed) and acting.cuts_in(order.text):
            self.require_no_job()
        if isinstance(order, Typed | Output | Spindle):
            return acting.act(unit, order)
        if isinstance(order, Plain):
            acts = {"go": self._jobs.go_on, "delete": self._jobs.delete}
            return acts[order.name](unit) if order.name in acts else self._jobs.resume()
        self.require_no_job()
        if isinstance(order, Jog):
            text = acting.jog(unit, order)
            self._line.jogging = True
            return text
        assert isinstance(order, Start)
        assert isinstance(order.file, File)
        return self._jobs.begin(unit, order.file)

    def _act_beside(self, unit: Unit, order: Work) -> str:
        """What may be done while a job is under way."""
        is_question = isinstance(order, Typed) and acting.only_asks(order.text)
        if is_question or isinstance(order, Override | Output | Spindle):
            return self._act(unit, order)
        if order == Plain("resume"):
            return self._jobs.resume()
        if order == Plain("seen"):
            return self._obey(order)
        raise BadRequest("a job is under way, and this would disturb it; halt it first")

    def _begin_halt(self) -> dict[str, Any]:
        return {"wanted": None}

    def _send_halt(self, whats: list[Any]) -> str:
        """Send H for all who have asked for it."""
        unit = self._line.unit
        if not unit:
            raise NotConnected
        halted = unit.halt()
        if halted.restarted:
            self._line.restart()
        elif halted.others:
            self._line.lose(Failure(f"{halted.others}; the job is gone"))
        if self._line.jogging:
            unit.order("D")
            halted = replace(halted, flags=unit.flags())
        self._line.jogging = False
        self._line.look(unit)
        return WORDS.plain(halted_text(halted)) + self._line.known.spindle_text

    def _has_more(self) -> bool:
        return self.board.state.wanted is not None and self._line.unit is not None

    def _do_more(self) -> None:
        """Bring the speed about that is wanted."""
        unit = self._line.unit
        if unit and self.board.state.wanted is not None:
            sped = self._tried(lambda: self._jobs.override(unit))
            if isinstance(sped, Failure):
                self._line.note(sped)
                self._answer("override", Asked(), sped)
