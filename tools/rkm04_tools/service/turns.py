"""The one thread that owns a line: orders wait for their turn, a halt does not.

What cannot be done now is refused now: nothing is kept for a unit or a port that comes back.
"""

from __future__ import annotations

import sys
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from threading import Condition, Thread
from typing import Any, Generic, TypeVar

from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import LineError
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.trouble import (
    Fault,
    Late,
    NotConnected,
    Stopped,
    Unsent,
    nothing_kept_back,
)
from rkm04_tools.service.unit_board import Board
from rkm04_tools.service.unit_line import UnitLine
from rkm04_tools.service.unit_orders import Connect, Plain, is_for_unit, name_of

LOOK_AGAIN_SECONDS = 1.0
"""From one look to the next while the unit does not answer, or the port is away."""
TURN_SECONDS = 10.0
"""What has waited longer for its turn is refused."""
CLOSING_SECONDS = 10.0
ORDERS_MAX = 100

Unit = TypeVar("Unit")
Got = TypeVar("Got")


class Turns(ABC, Generic[Unit]):
    """Takes orders from any thread.

    `is_watched` says whether anybody wants to know what the unit does. `grace_seconds`: for what
    is under way on the line when a halt is asked for.
    """

    grace_seconds = 0.0

    def __init__(
        self, board: Board[Any], line: UnitLine[Unit, Any], is_watched: Callable[[], bool]
    ) -> None:
        self.board = board
        self._own_line = line
        self._is_watched = is_watched
        self._wakes = Condition()
        self._waiting: deque[tuple[Any, Asked, float]] = deque()
        self._halts: deque[tuple[Asked, Any]] = deque()
        self._answered: list[tuple[Asked, Any]] = []
        self._asked_now = Asked()
        """By whom that was asked which is being done."""
        self._halt_since = 0.0
        self._halting = False
        self._closing = False
        self._thread = Thread(target=self._run, name="line", daemon=True)

    # ---- what each unit has of its own ----

    @abstractmethod
    def _act(self, unit: Unit, order: Any) -> str:
        """Do what is for the unit; what has come of it."""

    @abstractmethod
    def _send_halt(self, whats: list[Any]) -> str:
        """Halt, and see the axes stand."""

    def _begin_halt(self) -> dict[str, Any]:
        """What of the state changes with a halt."""
        return {}

    def _end_halt(self, got: str | Failure) -> dict[str, Any]:
        """What of the state changes at its end."""
        return {"halt": "failed" if isinstance(got, Failure) else None}

    def halt_name(self, what: Any) -> str:
        """The name under which the page knows what has asked for a halt."""
        return "halt"

    def _has_more(self) -> bool:
        """Whether there is something to be done beside orders."""
        return False

    def _do_more(self) -> None:
        """Do it."""

    def greetings(self) -> list[dict[str, Any]]:
        """What a browser that comes is told."""
        return [self.board.as_json()]

    # ---- from any thread ----

    def start(self) -> None:
        """Begin to work."""
        self._thread.start()

    def give(self, order: Any, asked: Asked) -> None:
        """Put an order after those that wait."""
        with self._wakes:
            if len(self._waiting) >= ORDERS_MAX:
                raise Failure("too much is waiting for the line; wait for the answers")
            is_refused = is_for_unit(order) and (self._halts or self._halting)
            if not is_refused:
                self._waiting.append((order, asked, time.monotonic()))
                self._wakes.notify()
        if is_refused:
            self.refuse(order, asked, Stopped())

    def halt(self, asked: Asked, what: Any = None) -> None:
        """Halt next; what waits is given up."""
        with self._wakes:
            if not self._halts:
                self._halt_since = time.monotonic()
            self._halts.append((asked, what))
            self._wakes.notify()
        self._give_up(Stopped())

    def refuse(self, order: Any, asked: Asked, failure: Failure) -> None:
        """Say that an order is not obeyed, and why."""
        self._answer(name_of(order), asked, failure)

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
            self._waiting = deque(each for each in waiting if not is_for_unit(each[0]))
        for order, asked, _ in waiting:
            if is_for_unit(order):
                self.refuse(order, asked, failure)

    # ---- the thread ----

    def _run(self) -> None:
        while not self._closing:
            with self._wakes:
                self._wakes.wait_for(self._has_work, self._rest_seconds())
                has_halts = bool(self._halts)
                work = self._waiting.popleft() if self._waiting and not has_halts else None
            if self._closing:
                break
            if has_halts:
                self._do_halt()
            elif work:
                self._do(*work)
            else:
                self._do_more()
                if time.monotonic() >= self._own_line.look_due:
                    self._look()
        self._own_line.close()

    def _has_work(self) -> bool:
        return bool(self._closing or self._halts or self._waiting or self._has_more())

    def _rest_seconds(self) -> float | None:
        if not self._own_line.unit and not self.board.state.away:
            return None
        return max(0.0, self._own_line.look_due - time.monotonic())

    def _mind_halt(self) -> None:
        """While the line is used: a halt does not wait for long."""
        since = time.monotonic() - self._halt_since
        is_due = self._halts and not self._halting and since >= self.grace_seconds
        if self._closing or is_due:
            raise Stopped

    def _do(self, order: Any, asked: Asked, since: float) -> None:
        name = name_of(order)
        if time.monotonic() - since > TURN_SECONDS:
            self.refuse(order, asked, Late())
            return
        was_away = bool(self.board.state.error)
        self.board.change(busy=name)
        self._asked_now = asked
        got = self._tried(
            lambda: nothing_kept_back(lambda: self._obey(order), self._own_line.take_back)
        )
        if was_away or isinstance(got, LineError):
            self._give_up(Unsent())
        is_first = isinstance(order, Connect) and asked.client is None
        self._own_line.note(got, comes_back=is_first or not isinstance(order, Connect))
        self.board.change(busy=None)
        self._answer(name, asked, got)

    def _answer(self, name: str, asked: Asked, got: str | Failure) -> None:
        asker = {"type": "answer", "id": asked.number, "from": asked.client, "message": name}
        if isinstance(got, Failure):
            self.board.tell({**asker, "text": None, "error": self._own_line.words.told(got)})
        else:
            self.board.tell({**asker, "text": got, "error": None})

    def _obey(self, order: Any) -> str:
        if isinstance(order, Connect):
            return self._own_line.connect(order)
        if isinstance(order, Plain) and order.name == "disconnect":
            return self._own_line.disconnect()
        if isinstance(order, Plain) and order.name == "seen":
            self.board.change(restarted=False)
            return "noted"
        if not self._own_line.unit:
            raise NotConnected
        return self._act(self._own_line.unit, order)

    def _do_halt(self) -> None:
        """Halt for all who have asked for it until now; a later one halts again."""
        self.board.change(busy="halt", halt="asked", **self._begin_halt())
        self._halting = True
        self._answered = []
        got = self._tried(lambda: self._send_halt(self._more_halts()))
        self._halting = False
        self.board.change(busy=None, **self._end_halt(got))
        for asked, what in self._answered:
            self._answer(self.halt_name(what), asked, got)

    def _more_halts(self) -> list[Any]:
        """What was asked to be halted since the last time; its askers are answered with it."""
        with self._wakes:
            halts = [self._halts.popleft() for _ in range(len(self._halts))]
        self._answered += halts
        return [what for _, what in halts]

    def _look(self) -> None:
        """See what the unit does, if anybody wants to know; a port that was lost comes back."""
        line = self._own_line
        started = time.monotonic()
        line.look_due = started + LOOK_AGAIN_SECONDS / 10
        if not self._is_watched():
            return
        seen = self._tried(self._look_at_unit)
        now = time.monotonic()
        if seen is None:
            line.look_due = max(line.look_due, now + self._pause_seconds(now - started))
            self.board.change(error=None)
        elif not isinstance(seen, Stopped):
            line.look_due = now + LOOK_AGAIN_SECONDS
            line.note(seen)

    def _pause_seconds(self, looked_seconds: float) -> float:
        """The rest of the line after a look that took so long."""
        return looked_seconds

    def _look_at_unit(self) -> None:
        """Only asks, whatever has come back: the port, or a unit that may be another one."""
        line = self._own_line
        unit = line.reopen()
        was_away = bool(self.board.state.error) or not self.board.state.version
        line.look(unit)
        if was_away:
            self.board.change(version=line.version_of(unit))
            self._give_up(Unsent())

    def _tried(self, work: Callable[[], Got]) -> Got | Failure:
        """What comes of it, or the failure; a fault of the tool is one too: the line must go on."""
        try:
            return work()
        except Failure as failure:
            return failure
        except Exception as error:
            what = f"{type(error).__name__}: {error}"
            tool = self._own_line.words.tool
            print(f"{tool}: {what}; this is a fault of the tool", file=sys.stderr)
            return Fault(what)
