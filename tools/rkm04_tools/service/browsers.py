"""The browsers that look: each has a web socket, and all of them see the same."""

from __future__ import annotations

import asyncio
import itertools
import time
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol, TypeAlias

from starlette.websockets import WebSocket, WebSocketDisconnect

from rkm04_tools.failure import Failure
from rkm04_tools.service.trouble import as_json

WAITING_MAX = 1000
"""Messages for a browser that does not take them; then it is let go and may come again."""
SERVICE_VERSION = "1"
TOO_SLOW = 1013
"""Of RFC 6455: try again later."""

BEAT_SECONDS = 0.5
LATE_SECONDS = 2.0
"""What a page asks for when it has not heard from the service for longer is refused: it has waited
in between, in a browser or a service that stood still, and nobody expects it any more."""

Messages: TypeAlias = "asyncio.Queue[dict[str, Any] | None]"
Tell: TypeAlias = Callable[[dict[str, Any]], None]
IsLate: TypeAlias = Callable[[int | None], bool]
Aside: TypeAlias = Callable[[], dict[str, Any] | None]
"""Work that may take a moment, and what the browser that has asked for it is told then."""


class Desk(Protocol):
    """Where browsers bring what they ask for."""

    def start(self) -> None:
        """Begin to work."""

    def close(self) -> None:
        """End the work; may take a moment."""

    def greetings(self) -> list[dict[str, Any]]:
        """What a browser that comes is told."""

    def take(self, text: str, client: int, is_late: IsLate) -> Aside | None:
        """Take what a browser says; a Failure is for this one alone."""

    def leave(self, client: int) -> None:
        """A browser has gone."""


class Beats:
    """Signs of life with numbers, so that a request shows how old it is."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)
        self._times: deque[tuple[int, float]] = deque(maxlen=64)
        self.next()

    def next(self) -> int:
        """Begin another one."""
        number = next(self._numbers)
        self._times.append((number, time.monotonic()))
        return number

    @property
    def last(self) -> int:
        """The youngest."""
        return self._times[-1][0]

    def is_late(self, number: int | None) -> bool:
        """Whether one is too long ago, or from another life of the service."""
        if number is None:
            return False
        times = dict(self._times)
        return number not in times or time.monotonic() - times[number] > LATE_SECONDS


class Browsers:
    """Passes orders on and tells everybody what has happened. To be used inside the event loop."""

    def __init__(self, desk_of: Callable[[Tell, Callable[[], bool]], Desk]) -> None:
        """`desk_of` makes the desk: it tells all browsers by the first, and asks the second
        whether any browser looks."""
        self._queues: dict[int, Messages] = {}
        self._numbers = itertools.count(1)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._tasks: set[asyncio.Task[None]] = set()
        self._beats = Beats()
        self._desk = desk_of(self.tell, self.is_watched)

    def start(self) -> None:
        """Begin."""
        self._loop = asyncio.get_running_loop()
        self._keep(self._beat())
        self._desk.start()

    async def close(self) -> None:
        """End line, virtual units and threads."""
        for task in self._tasks:
            task.cancel()
        await asyncio.to_thread(self._desk.close)

    def is_watched(self) -> bool:
        """Whether any browser looks."""
        return bool(self._queues)

    def tell(self, told: dict[str, Any]) -> None:
        """Tell all browsers; from any thread."""
        if self._loop and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._put, told)

    async def talk(self, socket: WebSocket) -> None:
        """Serve a browser until it goes."""
        await socket.accept()
        number = next(self._numbers)
        queue: Messages = asyncio.Queue(WAITING_MAX)
        queue.put_nowait(
            {
                "type": "hello",
                "version": SERVICE_VERSION,
                "language_default": "en",
                "client": number,
                "beat": self._beats.next(),
            }
        )
        for told in self._desk.greetings():
            queue.put_nowait(told)
        self._queues[number] = queue
        sender = asyncio.create_task(_send_all(socket, queue))
        try:
            while True:
                self._take(await _received(socket), number, queue)
        except (WebSocketDisconnect, KeyError):
            pass  # a KeyError is a message of bytes, which no page sends
        finally:
            self._queues.pop(number, None)
            self._desk.leave(number)
            sender.cancel()
            await asyncio.gather(sender, return_exceptions=True)

    async def _beat(self) -> None:
        while True:
            self._put({"type": "beat", "beat": self._beats.next()})
            await asyncio.sleep(BEAT_SECONDS)

    def _put(self, told: dict[str, Any]) -> None:
        for number, queue in list(self._queues.items()):
            if told["type"] in ("live", "beat") and queue.qsize() > 2:
                continue  # it will get a later one
            if queue.full():
                del self._queues[number]
                queue.get_nowait()
                queue.put_nowait(None)
            else:
                queue.put_nowait(told)

    def _take(self, text: str, client: int, queue: Messages) -> None:
        """Take what a browser says; only this one learns what is wrong with it."""
        try:
            work = self._desk.take(text, client, self._beats.is_late)
        except Failure as failure:
            _put_if_room(queue, {"type": "error", "error": as_json(failure)})
        else:
            if work:
                self._aside(work, queue)

    def _aside(self, work: Aside, queue: Messages) -> None:
        """Do what may take a moment, so that a stop need not wait for it."""

        async def do() -> None:
            try:
                told = await asyncio.to_thread(work)
            except Failure as failure:
                told = {"type": "error", "error": as_json(failure)}
            if told:
                _put_if_room(queue, told)

        self._keep(do())

    def _keep(self, work: Any) -> None:
        """Run a coroutine; the event loop alone would forget it."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


async def _received(socket: WebSocket) -> str:
    """What it says next; where a send has found out that it is gone, nothing can be received."""
    try:
        return await socket.receive_text()
    except RuntimeError:
        raise WebSocketDisconnect from None


async def _send_all(socket: WebSocket, queue: Messages) -> None:
    """Send what is put into the queue; its end, None, ends the connection."""
    try:
        while (told := await queue.get()) is not None:
            await socket.send_json(told)
        await socket.close(TOO_SLOW)
    except (WebSocketDisconnect, RuntimeError):
        return  # it has gone; who receives from it learns that too


def _put_if_room(queue: Messages, told: dict[str, Any]) -> None:
    if not queue.full():
        queue.put_nowait(told)
