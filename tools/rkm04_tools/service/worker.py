"""The one thread that owns the line: orders wait for their turn, a stop does not.

Whatever happens is told as JSON objects for the browsers, in the thread in which it happens. What
cannot be done now is refused now: nothing is kept for a unit or a port that comes back.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from threading import Condition, Thread
from typing import Any, TypeVar

from rkm04_tools.failure import Failure
from rkm04_tools.line import Line, Unit
from rkm04_tools.line_errors import LineError, PortError
from rkm04_tools.messages import ALL_MOTORS, SET_COMMAND, STORE_FLASH, VERSION
from rkm04_tools.service import talking, virtual
from rkm04_tools.service.answers import Answer, answer_of, whose
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.holding import Holds
from rkm04_tools.service.live import LOOKING, View
from rkm04_tools.service.orders import (
    MESSAGES,
    Act,
    Connect,
    Disconnect,
    Forget,
    Node,
    Queued,
    Request,
    Work,
    lets_go,
    motor_of,
    name_of,
    runs,
)
from rkm04_tools.service.stopping import stop_all
from rkm04_tools.service.trouble import (
    Fault,
    Late,
    NotConfirmed,
    NotConnected,
    Stopped,
    Unsent,
    as_json,
    nothing_kept_back,
)
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.service.wire import Exchange, Wire
from rkm04_tools.transport import open_transport

LOOK_SECONDS = 0.1
"""From one look to the next at least; looks take no more than half of the line's time."""

LOOK_AGAIN_SECONDS = 1.0
"""From one look to the next while the unit does not answer, or the port is away."""

TURN_SECONDS = 10.0
"""What has waited longer for its turn is refused."""

CLOSING_SECONDS = 10.0
ORDERS_MAX = 100

Got = TypeVar("Got")
Tell = Callable[[dict[str, Any]], None]


@dataclass(frozen=True)
class State:
    """What all browsers know about the connection.

    `busy`: what is being done. `away`: the port was lost, and is opened again when it
    is there. `nodes`: those that have answered on this port since the service began. `stop`: those
    that have not confirmed the last stop; None: all have, or there was none.
    """

    connected: bool = False
    port: str | None = None
    virtual: bool = False
    node: int = 1
    busy: str | None = None
    unit: dict[str, Any] | None = None
    error: dict[str, Any] | None = None
    away: bool = False
    nodes: tuple[Node, ...] = ()
    stop: tuple[Node, ...] | None = None


class Worker:
    """Takes orders from any thread; `tell` gets all that browsers are to know.

    `is_watched` says whether anybody wants to know what the unit does.
    """

    def __init__(self, tell: Tell, is_watched: Callable[[], bool], units: VirtualLine) -> None:
        self._tell = tell
        self._is_watched = is_watched
        self._units = units
        self.holds = Holds()
        """Who of them falls silent while it holds a button has all motors stopped."""
        self._view = View(tell)
        self._state = State()
        self._line: Line | None = None
        self._wire: Wire | None = None
        self._heard: dict[Node, float] = {}
        self._wakes = Condition()
        self._waiting: deque[tuple[Queued, Asked, float]] = deque()
        self._stops: deque[tuple[Asked, Sequence[Node]]] = deque()
        self._closing = False
        self._letting_go = False
        self._look_due = 0.0
        self._thread = Thread(target=self._run, name="line", daemon=True)

    @property
    def state(self) -> State:
        """What is known now."""
        return self._state

    def state_as_json(self) -> dict[str, Any]:
        """What browsers know now, and how long ago the unit answered; None: it never has."""
        state = self._state
        heard = self._heard.get(Node(state.port or "", state.node))
        ago = None if heard is None else round(time.monotonic() - heard, 1)
        return {"type": "state", **asdict(state), "seen_ago_s": ago}

    def start(self) -> None:
        """Begin to work."""
        self._thread.start()

    def give(self, order: Queued, asked: Asked) -> None:
        """Put an order after those that wait; K of a button that is let go ahead of them.

        Like a stop, it cuts short what is under way.
        """
        if lets_go(order):
            self.let_go(asked.client)
        with self._wakes:
            if len(self._waiting) >= ORDERS_MAX:
                raise Failure("too much is waiting for the line; wait for the answers")
            put = self._waiting.appendleft if lets_go(order) else self._waiting.append
            put((order, asked, time.monotonic()))
            self._wakes.notify()

    def stop(self, asked: Asked, nodes: Sequence[Node] = ()) -> None:
        """Send K to all motors, next; what waits is given up.

        Those who ask may know of `nodes` that have answered before this service began.
        """
        with self._wakes:
            self._stops.append((asked, nodes))
            self._wakes.notify()
        self._give_up(Stopped())

    def close(self) -> None:
        """End the work; the unit is left as it is."""
        with self._wakes:
            self._closing = True
            self._wakes.notify()
        if self._thread.is_alive():
            self._thread.join(CLOSING_SECONDS)

    def refuse(self, order: Work, asked: Asked, failure: Failure) -> None:
        """Say that an order is not obeyed, and why."""
        node = self._state.node
        self._tell(answer_of(name_of(order), motor_of(order), node, asked, failure))

    def let_go(self, client: int | None) -> None:
        """A browser has let its button go: a run that still waits for the line is never sent."""
        self.holds.let_go(client)
        self._give_up(Stopped(), lambda order, asked: asked.client == client and runs(order))

    def lose(self, client: int) -> None:
        """A browser has gone: if it holds a button, all motors stop."""
        with self._wakes:
            self.holds.lose(client)
            self._wakes.notify()

    def _give_up(
        self,
        failure: Failure,
        is_meant: Callable[[Request | Act, Asked], bool] = lambda order, asked: True,
    ) -> None:
        """Refuse what waits for the line, as far as it is meant."""
        with self._wakes:
            refused = [
                (order, asked)
                for order, asked, _ in self._waiting
                if isinstance(order, Request | Act) and is_meant(order, asked)
            ]
            self._waiting = deque(each for each in self._waiting if each[:2] not in refused)
        for order, asked in refused:
            self.refuse(order, asked, failure)

    def _run(self) -> None:
        while not self._closing:
            self._mind_holds()
            with self._wakes:
                self._wakes.wait_for(self._has_work, self._rest_seconds())
                is_lost = self.holds.is_lost()
                stops = [self._stops.popleft() for _ in range(len(self._stops))]
                is_free = not stops and not is_lost
                work = self._waiting.popleft() if self._waiting and is_free else None
            if self._closing:
                break
            if stops:
                self._do_stop(stops)
            elif work:
                self._do(*work)
            elif not is_lost and self._is_wanted:
                self._look()
        self._close_line()

    def _mind_holds(self) -> None:
        """Stop all motors if a browser that held a button has fallen silent."""
        if self.holds.is_lost():
            self.holds.forget()
            self.stop(Asked())

    def _has_work(self) -> bool:
        return bool(self._is_stop_wanted() or self._waiting)

    def _is_stop_wanted(self) -> bool:
        """Whether what is under way has to make room; also for a button that is let go."""
        waiting = self._waiting
        lets_one_go = bool(waiting) and lets_go(waiting[0][0]) and not self._letting_go
        return self._closing or bool(self._stops) or self.holds.is_lost() or lets_one_go

    @property
    def _is_wanted(self) -> bool:
        """Whether the port is open, or will be when it is there again."""
        return bool(self._line) or self._state.away

    def _rest_seconds(self) -> float | None:
        held = self.holds.rest_seconds()
        if not self._is_wanted:
            return held
        look = max(0.0, self._look_due - time.monotonic())
        return look if held is None else min(look, held)

    def _do(self, order: Queued, asked: Asked, since: float) -> None:
        if isinstance(order, Forget):
            stop = self._state.stop
            self._change(stop=stop and tuple(node for node in stop if node not in order.nodes))
        elif time.monotonic() - since > TURN_SECONDS:
            self.refuse(order, asked, Late())
        else:
            self._do_now(order, asked)

    def _do_now(self, order: Work, asked: Asked) -> None:
        if isinstance(order, Connect | Disconnect) and self.holds.rest_seconds() is not None:
            self.holds.forget()  # nobody could stop what it runs any more
            self._do_stop([(Asked(), ())])
        name = name_of(order)
        if self._wire:
            self._wire.forget()
        was_away = bool(self._state.error)
        self._change(busy=name)
        self._letting_go = lets_go(order)
        got = _tried(lambda: nothing_kept_back(lambda: self._obey(order, asked), self._take_back))
        self._letting_go = False
        if was_away or isinstance(got, LineError):
            self._give_up(Unsent())
        wanted = VERSION if isinstance(order, Connect) else MESSAGES.get(name, SET_COMMAND)
        node, exchanges = self._state.node, self._exchanges(wanted)
        is_first = isinstance(order, Connect) and asked.client is None
        self._note(got, comes_back=is_first or not isinstance(order, Connect))
        if exchanges and wanted in (SET_COMMAND, STORE_FLASH):
            talking.put_in_doubt(got, may_move=wanted == SET_COMMAND)
        told = answer_of(name, motor_of(order), node, asked, got, exchanges)
        self._change(busy=None)
        self._tell(told)

    def _take_back(self) -> None:
        if self._wire:
            self._wire.take_back()

    def _obey(self, order: Work, asked: Asked) -> Answer:
        if isinstance(order, Connect):
            return self._connect(order)
        if isinstance(order, Disconnect):
            self._close_line()
            self._change(
                connected=False, port=None, virtual=False, unit=None, error=None, away=False,
                nodes=(),
            )  # fmt: skip
            return Answer("the port is closed")
        unit = self._unit()
        if isinstance(order, Act):
            return talking.act(unit, order)

        def tell_progress(done: int, total: int) -> None:
            if self._is_stop_wanted():
                raise Stopped
            self._tell({"type": "progress", "value": done / total, **whose(asked)})
            if self._is_watched():
                _tried(lambda: self._view.look(unit))

        return talking.ask(unit, order, tell_progress)

    def _do_stop(self, stops: Sequence[tuple[Asked, Sequence[Node]]]) -> None:
        """Send K once for all who have asked for it until now; a later one sends another."""
        wire = self._wire
        there, elsewhere = self._to_be_stopped([node for _, nodes in stops for node in nodes])
        self._change(busy="stop", stop=(*there, *elsewhere))
        if wire:
            wire.forget()
            wire.yields = False
        got = _tried(lambda: self._send_stop(there, elsewhere))
        if wire:
            wire.yields = True
        self._note(got)
        exchanges = self._exchanges(SET_COMMAND)
        self._change(busy=None)
        for asked, _ in stops:
            self._tell(answer_of("stop", ALL_MOTORS, self._state.node, asked, got, exchanges))

    def _to_be_stopped(self, named: Sequence[Node]) -> tuple[list[Node], list[Node]]:
        """The nodes that are to confirm a stop, the last heard first, and those out of reach.

        The virtual units of a port that was closed are nobody's machine.
        """
        state = self._state
        here = state.port or ""
        heard = sorted(state.nodes, key=self._heard.__getitem__, reverse=True)
        known = list(dict.fromkeys([*heard, *named, *(state.stop or ())]))
        if not self._line:
            return [], [node for node in known if node.port != virtual.NAME]
        there = [node for node in known if node.port == here]
        if Node(here, state.node) not in there:
            there.append(Node(here, state.node))
        return there, [node for node in known if node.port not in (here, virtual.NAME)]

    def _send_stop(self, there: Sequence[Node], elsewhere: Sequence[Node]) -> Answer:
        if not self._line:
            raise NotConnected
        port = self._state.port or ""

        def leave(left: Sequence[int]) -> None:
            self._change(stop=(*(Node(port, node) for node in left), *elsewhere))

        left = stop_all(self._line, [each.node for each in there], leave, self._view_of)
        if left or elsewhere:
            names = [f"node {node}" for node in left]
            names += [f"node {each.node} of {each.port}" for each in elsewhere]
            raise NotConfirmed(", ".join(names))
        self._change(stop=None)
        return Answer("all motors stop", {"confirmed": [asdict(each) for each in there]})

    def _view_of(self, node: int, status: Any) -> None:
        if node == self._state.node:
            self._view.show(node, status)

    def _connect(self, order: Connect) -> Answer:
        """Open the port if it is not open, and ask the unit for its version: nothing moves."""
        if not self._line or self._state.port != order.port:
            self._close_line()
            self._change(
                connected=False, port=order.port, virtual=order.port == virtual.NAME,
                node=order.node, unit=None, error=None, away=False,
                nodes=self._nodes_of(order.port),
            )  # fmt: skip
            self._open(order.port)
        if self._state.node != order.node:
            self._change(node=order.node, unit=None)
        self._view.begin()
        self._change(connected=True)
        answer = talking.version(self._unit())
        self._change(unit=answer.values, error=None)
        if not self._state.stop:
            self._change(stop=None)  # a stop without any unit
        return answer

    def _open(self, port: str) -> None:
        place = self._units.open() if port == virtual.NAME else port

        def hear(node: int) -> None:
            self._hear(Node(port, node))

        self._wire = Wire(open_transport(place), self._is_stop_wanted, hear)
        self._line = Line(self._wire)

    def _hear(self, node: Node) -> None:
        self._heard[node] = time.monotonic()
        if node not in self._state.nodes:
            self._change(nodes=self._nodes_of(node.port))

    def _nodes_of(self, port: str) -> tuple[Node, ...]:
        return tuple(node for node in self._heard if node.port == port)

    def _unit(self) -> Unit:
        if not self._line:
            raise NotConnected
        return self._line.unit(self._state.node)

    def _look(self) -> None:
        """See what the unit does, if anybody wants to know; a port that was lost comes back."""
        started = time.monotonic()
        self._look_due = started + LOOK_SECONDS
        if not self._is_watched():
            return
        seen = _tried(self._look_at_unit)
        if self._wire:
            self._wire.forget()
        now = time.monotonic()
        if seen is None:
            self._look_due = max(self._look_due, 2 * now - started)
            self._change(error=None)
        elif not isinstance(seen, Stopped):
            self._look_due = now + LOOK_AGAIN_SECONDS
            self._note(seen)
            if not isinstance(seen, LineError):
                self._change(error=as_json(seen))

    def _look_at_unit(self) -> None:
        """Only asks, whatever has come back: the port, or a unit that may be another one."""
        if not self._line:
            self._open(self._state.port or "")
            self._change(connected=True, away=False, unit=None)
        unit = self._unit()
        was_away = bool(self._state.error) or not self._state.unit
        if was_away:
            self._view.begin()
            version = talking.version(unit, LOOKING)
            self._change(unit=version.values)
        self._view.look(unit)
        if was_away:
            self._give_up(Unsent())

    def _note(self, got: Answer | Failure, comes_back: bool = True) -> None:
        """Keep what says that there is no connection; a port that is lost is closed.

        A port that `comes_back` is opened again when it is there; virtual units need the user.
        """
        if isinstance(got, Answer):
            self._change(error=None)
        elif isinstance(got, PortError):
            self._close_line()
            away = comes_back and not self._state.virtual
            has_ended = self._state.virtual and not isinstance(got, Fault)
            error = as_json(virtual.ended() if has_ended else got)
            self._change(connected=False, unit=None, error=error, away=away)
        elif isinstance(got, LineError):
            self._change(error=as_json(got))
        elif not self._line and not isinstance(got, NotConnected | NotConfirmed):
            self._change(connected=False, error=as_json(got))

    def _close_line(self) -> None:
        if self._wire:
            self._wire.abandon()
        self._line = self._wire = None

    def _exchanges(self, message: int) -> list[Exchange]:
        """Those of the message that was asked for; a plan may have needed others."""
        all_of_them = self._wire.exchanges() if self._wire else []
        return [each for each in all_of_them if each.request.message[0] == message]

    def _change(self, **changes: Any) -> None:
        before = self._state
        self._state = State(**{**vars(before), **changes})
        if self._state != before:
            self._tell(self.state_as_json())


def _tried(work: Callable[[], Got]) -> Got | Failure:
    """What comes of it, or the failure; a fault of the tool is one too, as the line must go on."""
    try:
        return work()
    except Failure as failure:
        return failure
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        print(f"rkm04: {what}; this is a fault of the tool", file=sys.stderr)
        return Fault(what)
