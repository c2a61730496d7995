"""Browsers that come and go."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rkm04_tools.service.browsers import Browsers
from starlette.websockets import WebSocket


class Desk:
    """Nobody's desk; `left` are the browsers that have gone."""

    def __init__(self) -> None:
        self.left: list[int] = []

    def start(self) -> None: ...

    def close(self) -> None: ...

    def greetings(self) -> list[dict[str, Any]]:
        return []

    def take(self, text: str, client: int, is_late: Any) -> None: ...

    def leave(self, client: int) -> None:
        self.left.append(client)


class Gone(WebSocket):
    """A socket whose end was found out by sending, so that nothing can be received from it."""

    async def accept(self, *_: Any) -> None: ...

    async def send_json(self, *_: Any) -> None: ...

    async def receive_text(self) -> str:
        raise RuntimeError('WebSocket is not connected. Need to call "accept" first.')


async def nothing(*_: Any) -> Any:
    raise AssertionError


def test_a_browser_that_has_gone_while_it_was_told_something_just_leaves() -> None:
    desk = Desk()
    browsers = Browsers(lambda tell, is_watched: desk)

    # In a thread of its own, as there may be a loop of the browser's tests in this one.
    with ThreadPoolExecutor(1) as pool:
        talk = browsers.talk(Gone({"type": "websocket"}, nothing, nothing))
        pool.submit(asyncio.run, talk).result()

    assert len(desk.left) == 1
    assert not browsers.is_watched()
