"""The one thread that owns the line: orders wait for their turn, a stop does not.

Whatever happens is told as JSON objects for the browsers, in the thread in which it happens.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable
from dataclasses import asdict, dataclass
from threading import Condition, Thread
from typing import Any, TypeVar

from rkm04_tools import messages
from rkm04_tools.failure import Failure
from rkm04_tools.line import Line, Unit, Wait
from rkm04_tools.line_errors import LineError, PortError, PortLost
from rkm04_tools.messages import ALL_MOTORS, GET_POSITION, SET_COMMAND, VERSION
from rkm04_tools.service import talking, virtual
from rkm04_tools.service.answers import Answer, answer_of, whose
from rkm04_tools.service.orders import (
    MESSAGES,
    Act,
    Asked,
    Connect,
    Disconnect,
    Request,
)
from rkm04_tools.service.trouble import NotConnected, Stopped, as_json
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.service.wire import Exchange, Wire
from rkm04_tools.transport import open_transport

LOOK_SECONDS = 0.1
LOOK_AGAIN_SECONDS = 1.0
"""From one look to the next while the unit does not answer."""
LOOKING = Wait(attempts=2)
CLOSING_SECONDS = 10.0
ORDERS_MAX = 100

Got = TypeVar("Got")
Tell = Callable[[dict[str, Any]], None]


@dataclass(frozen=True)
class Lost:
    """The port has gone, as somebody else has found out."""

    failure: Failure


Work = Connect | Disconnect | Request | Act


@dataclass(frozen=True)
class State:
    """What all browsers know about the connection. `busy`: what is being done on the line."""

    connected: bool = False
    port: str | None = None
    virtual: bool = False
    node: int = 1
    busy: str | None = None
    unit: dict[str, Any] | None = None
    error: dict[str, Any] | None = None

    def as_json(self) -> dict[str, Any]:
        """For browsers."""
        return {"type": "state", **asdict(self)}


class Worker:
    """Takes orders from any thread; `tell` gets all that browsers are to know.

    `seen` gets the positions of a unit on a line that has no other way to tell them, `is_watched`
    says whether anybody wants to know.
    """

    def __init__(
        self,
        tell: Tell,
        seen: Callable[[list[int]], None],
        is_watched: Callable[[], bool],
        units: VirtualLine,
    ) -> None:
        self._tell = tell
        self._seen = seen
        self._is_watched = is_watched
        self._units = units
        self._state = State()
        self._line: Line | None = None
        self._wire: Wire | None = None
        self._wakes = Condition()
        self._waiting: deque[tuple[Work | Lost, Asked]] = deque()
        self._stops: deque[Asked] = deque()
        self._closing = False
        self._look_due = 0.0
        self._thread = Thread(target=self._run, name="line", daemon=True)

    @property
    def state(self) -> State:
        """What browsers know now."""
        return self._state

    def start(self) -> None:
        """Begin to work."""
        self._thread.start()

    def give(self, order: Work, asked: Asked) -> None:
        """Put an order behind those that wait."""
        with self._wakes:
            if len(self._waiting) >= ORDERS_MAX:
                raise Failure("too much is waiting for the line; wait for the answers")
            self._waiting.append((order, asked))
            self._wakes.notify()

    def stop(self, asked: Asked) -> None:
        """Send K to all motors, next; what waits is given up."""
        with self._wakes:
            self._stops.append(asked)
            waiting = list(self._waiting)
            self._waiting = deque(
                each for each in waiting if not isinstance(each[0], Request | Act)
            )
            self._wakes.notify()
        for order, by_whom in waiting:
            if isinstance(order, Request | Act):
                told = answer_of(order.name, order.motor, self._state.node, by_whom, Stopped())
                self._tell(told)

    def close(self) -> None:
        """End the work; the unit is left as it is."""
        with self._wakes:
            self._closing = True
            self._wakes.notify()
        if self._thread.is_alive():
            self._thread.join(CLOSING_SECONDS)

    def _run(self) -> None:
        while not self._closing:
            with self._wakes:
                self._wakes.wait_for(self._has_work, self._rest_seconds())
                stops = [self._stops.popleft() for _ in range(len(self._stops))]
                work = self._waiting.popleft() if self._waiting and not stops else None
            if self._closing:
                break
            if stops:
                self._do_stop(stops)
            elif work:
                self._do(*work)
            else:
                self._look()
        self._close_line()

    def _has_work(self) -> bool:
        return bool(self._closing or self._stops or self._waiting)

    def _is_stop_wanted(self) -> bool:
        return self._closing or bool(self._stops)

    def _looks(self) -> bool:
        return bool(self._line) and not self._state.virtual

    def _rest_seconds(self) -> float | None:
        return max(0.0, self._look_due - time.monotonic()) if self._looks() else None

    def _do(self, order: Work | Lost, asked: Asked) -> None:
        if isinstance(order, Lost):
            if self._line:
                self._note(order.failure)
            return
        name, motor = _name(order), _motor(order)
        if self._wire:
            self._wire.forget()
        self._change(busy=name)
        got = _tried(lambda: self._obey(order, asked))
        self._note(got)
        wanted = VERSION if isinstance(order, Connect) else MESSAGES.get(name, SET_COMMAND)
        told = answer_of(name, motor, self._state.node, asked, got, self._exchanges(wanted))
        self._change(busy=None)
        self._tell(told)

    def _obey(self, order: Work, asked: Asked) -> Answer:
        if isinstance(order, Connect):
            return self._connect(order)
        if isinstance(order, Disconnect):
            self._close_line()
            self._change(connected=False, port=None, virtual=False, unit=None, error=None)
            return Answer("the port is closed")
        unit = self._unit()
        if isinstance(order, Act):
            return talking.act(unit, order)

        def tell_progress(done: int, total: int) -> None:
            if self._is_stop_wanted():
                raise Stopped
            value = done / total
            self._tell({"type": "progress", "value": value, **whose(asked)})

        return talking.ask(unit, order, tell_progress)

    def _do_stop(self, stops: list[Asked]) -> None:
        """Send K once for all who have asked for it until now; a later one sends another."""
        wire = self._wire
        self._change(busy="stop")
        if wire:
            wire.forget()
            wire.yields = False
        got = _tried(self._send_stop)
        if wire:
            wire.yields = True
        self._note(got)
        exchanges = self._exchanges(SET_COMMAND)
        self._change(busy=None)
        for asked in stops:
            self._tell(answer_of("stop", ALL_MOTORS, self._state.node, asked, got, exchanges))

    def _send_stop(self) -> Answer:
        self._unit().motor(ALL_MOTORS).stop()
        return Answer("all motors stop")

    def _connect(self, order: Connect) -> Answer:
        """Open the port if it is not open, and ask the unit for its version: nothing moves."""
        is_virtual = order.port == virtual.NAME
        if not self._line or self._state.port != order.port:
            self._close_line()
            self._change(
                connected=False, port=order.port, virtual=is_virtual, node=order.node,
                unit=None, error=None,
            )  # fmt: skip
            place = self._units.open() if is_virtual else order.port
            self._wire = Wire(open_transport(place), self._is_stop_wanted)
            self._line = Line(self._wire)
        if self._state.node != order.node:
            self._change(node=order.node, unit=None)
        self._change(connected=True)
        answer = talking.version(self._unit())
        self._change(unit=answer.values, error=None)
        return answer

    def _unit(self) -> Unit:
        if not self._line:
            raise NotConnected
        return self._line.unit(self._state.node)

    def _look(self) -> None:
        """Ask for the positions, if anybody wants to know."""
        self._look_due = time.monotonic() + LOOK_SECONDS
        if not self._looks() or not self._is_watched():
            return
        positions = _tried(self._ask_positions)
        if self._wire:
            self._wire.forget()
        if isinstance(positions, list):
            self._change(error=None)
            self._seen(positions)
        elif not isinstance(positions, Stopped):
            self._look_due = time.monotonic() + LOOK_AGAIN_SECONDS
            self._note(positions)

    def _ask_positions(self) -> list[int]:
        answer = self._unit().ask(messages.request(GET_POSITION, ALL_MOTORS), LOOKING)
        return messages.parse_positions(answer, ALL_MOTORS)

    def lose(self, failure: Failure) -> None:
        """Say that the port has gone; from any thread."""
        with self._wakes:
            self._waiting.append((Lost(failure), Asked()))
            self._wakes.notify()

    def _note(self, got: Answer | Failure) -> None:
        """Keep what says that there is no connection; a port that is lost is closed."""
        if isinstance(got, Answer):
            self._change(error=None)
        elif isinstance(got, PortError):
            self._close_line()
            self._change(connected=False, unit=None, error=as_json(got))
        elif isinstance(got, LineError):
            self._change(error=as_json(got))
        elif isinstance(got, Failure) and not self._line and not isinstance(got, NotConnected):
            self._change(connected=False, error=as_json(got))

    def _close_line(self) -> None:
        if self._line:
            self._line.close()
        self._line = self._wire = None

    def _exchanges(self, message: int) -> list[Exchange]:
        """Those of the message that was asked for; a plan may have needed others."""
        all_of_them = self._wire.exchanges() if self._wire else []
        return [each for each in all_of_them if each.request.message[0] == message]

    def _change(self, **changes: Any) -> None:
        before = self._state
        self._state = State(**{**vars(before), **changes})
        if self._state != before:
            self._tell(self._state.as_json())


def _tried(work: Callable[[], Got]) -> Got | Failure:
    """What comes of it, or the failure; a fault of the tool is one too, as the line must go on."""
    try:
        return work()
    except Failure as failure:
        return failure
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        print(f"rkm04: {what}; this is a fault of the tool", file=sys.stderr)
        return PortLost(f"{what}; this is a fault of the tool, connect again")


def _name(order: Work) -> str:
    if isinstance(order, Request | Act):
        return order.name
    return "connect" if isinstance(order, Connect) else "disconnect"


def _motor(order: Work) -> int | None:
    return order.motor if isinstance(order, Request | Act) else None
