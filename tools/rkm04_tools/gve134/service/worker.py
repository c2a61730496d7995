"""The one thread that owns the line: orders wait for their turn, a halt does not.

A file is sent by this thread, too (`jobs`); between two of its commands a halt goes ahead, and what
may be done beside it is done. What cannot be done now is refused now: nothing is kept for a unit or
a port that comes back.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable
from threading import Condition, Thread
from typing import Any, TypeVar

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.service import acting
from rkm04_tools.gve134.service.board import Board, Tell
from rkm04_tools.gve134.service.connection import Connection
from rkm04_tools.gve134.service.files import File
from rkm04_tools.gve134.service.jobs import Held, Jobs
from rkm04_tools.gve134.service.orders import (
    Connect,
    Jog,
    Output,
    Override,
    Plain,
    Spindle,
    Start,
    Typed,
    Work,
    name_of,
)  # fmt: skip
from rkm04_tools.gve134.service.words import plain, told
from rkm04_tools.gve134.stopping import halted_text
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.line_errors import LineError
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.trouble import (
    BadRequest,
    Fault,
    Late,
    NotConnected,
    Stopped,
    Unsent,
)  # fmt: skip
from rkm04_tools.service.virtual import VirtualLine

LOOK_AGAIN_SECONDS = 1.0
"""From one look to the next while the unit does not answer, or the port is away."""
TURN_SECONDS = 10.0
"""What has waited longer for its turn is refused."""
GRACE_SECONDS = 0.3
"""For a command that is under way when a halt is asked for; packets take less."""
CLOSING_SECONDS = 10.0
ORDERS_MAX = 100

Got = TypeVar("Got")


class Worker:
    """Takes orders from any thread; `tell` gets all that browsers are to know.

    `is_watched` says whether anybody wants to know what the unit does.
    """

    def __init__(
        self, tell: Tell, is_watched: Callable[[], bool], units: VirtualLine, baud: int
    ) -> None:
        self.board = Board(tell)
        self._is_watched = is_watched
        self._line = Connection(self.board, units, baud, self._mind_halt)
        self._jobs = Jobs(self.board, self._line, self._beside)
        self._wakes = Condition()
        self._waiting: deque[tuple[Work, Asked, float]] = deque()
        self._halts: deque[Asked] = deque()
        self._halt_since = 0.0
        self._halting = False
        self._closing = False
        self._thread = Thread(target=self._run, name="line", daemon=True)

    # ---- from any thread ----

    def greetings(self) -> list[dict[str, Any]]:
        """What a browser that comes is told."""
        return [self.board.as_json(), self._line.made.as_json()]

    def start(self) -> None:
        """Begin to work."""
        self._thread.start()

    def give(self, order: Work, asked: Asked) -> None:
        """Put an order after those that wait."""
        with self._wakes:
            if len(self._waiting) >= ORDERS_MAX:
                raise Failure("too much is waiting for the line; wait for the answers")
            self._waiting.append((order, asked, time.monotonic()))
            self._wakes.notify()

    def halt(self, asked: Asked) -> None:
        """Send H next; what waits is given up."""
        with self._wakes:
            if not self._halts:
                self._halt_since = time.monotonic()
            self._halts.append(asked)
            self._wakes.notify()
        self._give_up(Stopped())

    def refuse(self, order: Work, asked: Asked, failure: Failure) -> None:
        """Say that an order is not obeyed, and why."""
        self._answer(name_of(order), asked, failure)

    def require_no_job(self) -> None:
        """Refuse what would take the file or the machine from a job."""
        job = self._line.job
        if job and job.is_open:
            raise BadRequest(f"{job.file.name} is not done; go on with it, or halt and delete it")

    def close(self) -> None:
        """End the work; the unit is left as it is."""
        with self._wakes:
            self._closing = True
            self._wakes.notify()
        if self._thread.is_alive():
            self._thread.join(CLOSING_SECONDS)

    def _give_up(self, failure: Failure) -> None:
        """Refuse what waits for the line."""
        with self._wakes:
            waiting = list(self._waiting)
            self._waiting = deque(each for each in waiting if not acting.is_for_unit(each[0]))
        for order, asked, _ in waiting:
            if acting.is_for_unit(order):
                self.refuse(order, asked, failure)

    # ---- the thread ----

    def _run(self) -> None:
        while not self._closing:
            with self._wakes:
                self._wakes.wait_for(self._has_work, self._rest_seconds())
                halts = [self._halts.popleft() for _ in range(len(self._halts))]
                work = self._waiting.popleft() if self._waiting and not halts else None
            if self._closing:
                break
            if halts:
                self._do_halt(halts)
            elif work:
                self._do(*work)
            else:
                self._override_or_look()
        self._line.close(abandons=True)

    def _has_work(self) -> bool:
        has_speed = self.board.state.wanted is not None and self._line.unit is not None
        return bool(self._closing or self._halts or self._waiting or has_speed)

    def _rest_seconds(self) -> float | None:
        if not self._line.unit and not self.board.state.away:
            return None
        return max(0.0, self._line.look_due - time.monotonic())

    def _mind_halt(self) -> None:
        """While an answer is waited for: a halt does not wait for long ones."""
        since = time.monotonic() - self._halt_since
        if self._closing or (self._halts and not self._halting and since > GRACE_SECONDS):
            raise Stopped

    def _beside(self, unit: Unit) -> None:
        """Between two commands of a job: a halt, an order, the speed."""
        if self._halts or self._closing:
            raise Held
        with self._wakes:
            work = self._waiting.popleft() if self._waiting else None
        if work:
            order, asked, _ = work
            got = _tried(lambda: self._act_beside(unit, order))
            self._answer(name_of(order), asked, got)
            if isinstance(got, LineError | Stopped):
                raise got
        sped = _tried(lambda: self._jobs.override(unit))
        if isinstance(sped, LineError | Stopped):
            raise sped
        if isinstance(sped, Failure):
            self._answer("override", Asked(), sped)

    def _do(self, order: Work, asked: Asked, since: float) -> None:
        name = name_of(order)
        if time.monotonic() - since > TURN_SECONDS:
            self.refuse(order, asked, Late())
            return
        self.board.change(busy=name)
        got = _tried(lambda: self._obey(order))
        if isinstance(got, LineError):
            self._give_up(Unsent())
        is_first = isinstance(order, Connect) and asked.client is None
        self._line.note(got, comes_back=is_first or not isinstance(order, Connect))
        self.board.change(busy=None)
        self._answer(name, asked, got)

    def _answer(self, name: str, asked: Asked, got: str | Failure) -> None:
        asker = {"type": "answer", "id": asked.number, "from": asked.client, "message": name}
        if isinstance(got, Failure):
            self.board.tell({**asker, "text": None, "error": told(got)})
        else:
            self.board.tell({**asker, "text": got, "error": None})

    def _obey(self, order: Work) -> str:
        if isinstance(order, Connect):
            return self._line.connect(order.port)
        if isinstance(order, Plain) and order.name == "disconnect":
            return self._line.disconnect()
        if isinstance(order, Plain) and order.name == "seen":
            self.board.change(restarted=False)
            return "noted"
        if not self._line.unit:
            raise NotConnected
        return self._act(self._line.unit, order)

    def _act(self, unit: Unit, order: Work) -> str:
        """What may be done while no job is under way."""
        if isinstance(order, Override):
            self.board.change(wanted=order.percent)
            return f"the speed becomes {order.percent} %"
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

    def _do_halt(self, halts: list[Asked]) -> None:
        """Send H for all who have asked for it until now; a later one sends another."""
        self.board.change(busy="halt", halt="asked", wanted=None)
        self._halting = True
        got = _tried(self._send_halt)
        self._halting = False
        halt = "failed" if isinstance(got, Failure) else None
        self.board.change(busy=None, halt=halt, reference=False)
        for asked in halts:
            self._answer("halt", asked, got)

    def _send_halt(self) -> str:
        unit = self._line.unit
        if not unit:
            raise NotConnected
        halted = unit.halt()
        if halted.restarted:
            self._line.restart()
        if self._line.jogging:
            unit.order("D")
        self._line.jogging = False
        self._line.look(unit)
        return plain(halted_text(halted))

    def _override_or_look(self) -> None:
        """What is done while nothing else is; a port that was lost comes back."""
        unit = self._line.unit
        if unit and self.board.state.wanted is not None:
            sped = _tried(lambda: self._jobs.override(unit))
            if isinstance(sped, Failure):
                self._line.note(sped)
                self._answer("override", Asked(), sped)
        if time.monotonic() >= self._line.look_due:
            self._look()

    def _look(self) -> None:
        """See what the unit does, if anybody wants to know."""
        started = time.monotonic()
        self._line.look_due = started + LOOK_AGAIN_SECONDS / 10
        if not self._is_watched():
            return
        seen = _tried(self._look_at_unit)
        now = time.monotonic()
        if seen is None:
            self._line.look_due = max(self._line.look_due, 2 * now - started)
            self.board.change(error=None)
        elif not isinstance(seen, Stopped):
            self._line.look_due = now + LOOK_AGAIN_SECONDS
            self._line.note(seen)

    def _look_at_unit(self) -> None:
        """Only asks, whatever has come back: the port, or a unit that may be another one."""
        unit = self._line.reopen()
        was_away = bool(self.board.state.error) or not self.board.state.version
        self._line.look(unit)
        if was_away:
            self.board.change(version=unit.link.version)
            self._give_up(Unsent())


def _tried(work: Callable[[], Got]) -> Got | Failure:
    """What comes of it, or the failure; a fault of the tool is one too, as the line must go on."""
    try:
        return work()
    except Failure as failure:
        return failure
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        print(f"gve134: {what}; this is a fault of the tool", file=sys.stderr)
        return Fault(what)
