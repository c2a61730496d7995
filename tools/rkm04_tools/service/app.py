"""The application: what a page may ask for."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from rkm04_tools.failure import Failure
from rkm04_tools.service.browsers import Browsers
from rkm04_tools.service.checking import check, examples
from rkm04_tools.service.curves import Curves, read_wanted
from rkm04_tools.service.guard import Guard
from rkm04_tools.service.orders import TEXT_MAX, Asked, Connect
from rkm04_tools.service.trouble import BadRequest, Superseded, TooLarge, as_json

BODY_BYTES_MAX = 5_000_000
BAD_REQUEST, CONFLICT, TOO_LARGE, FAULT = 400, 409, 413, 500


def make_app(page: Path, token: str, port: int, first: Connect) -> ASGIApp:
    """The application, which shows the page of a folder and connects to a first port."""
    browsers = Browsers()
    curves = Curves()

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        browsers.start()
        browsers.worker.give(first, Asked())
        try:
            yield
        finally:
            await browsers.close()

    async def show_page(_: Request) -> Response:
        return FileResponse(page / "index.html")

    async def show_examples(_: Request) -> Response:
        return JSONResponse(await asyncio.to_thread(examples))

    async def make_check(request: Request) -> Response:
        body = await _body(request)
        text = body.get("text")
        if not isinstance(text, str):
            raise BadRequest('no text; write {"text": "F100 R"}')
        _require_size(text)
        return JSONResponse(await asyncio.to_thread(check, text))

    async def make_curve(request: Request) -> Response:
        wanted = read_wanted(await _body(request))
        for text in wanted.programs.values():
            _require_size(text)
        return JSONResponse(await curves.make(wanted))

    async def talk(socket: WebSocket) -> None:
        await browsers.talk(socket)

    routes = [
        Route("/", show_page),
        Route("/api/examples", show_examples),
        Route("/api/check", make_check, methods=["POST"]),
        Route("/api/curve", make_curve, methods=["POST"]),
        WebSocketRoute("/ws", talk),
        Mount("/static", StaticFiles(directory=page)),
    ]
    handlers: dict[Any, Callable[..., Any]] = {Failure: _refuse, Exception: _report}
    app = Starlette(routes=routes, lifespan=lifespan, exception_handlers=handlers)
    return Guard(app, token, port)


async def _body(request: Request) -> dict[str, Any]:
    """The JSON object that a request brings."""
    content = b""
    try:
        async for part in request.stream():
            content += part
            if len(content) > BODY_BYTES_MAX:
                raise TooLarge(f"more than {BODY_BYTES_MAX} bytes; that is no program")
        body = json.loads(content)
    except ClientDisconnect:
        raise Superseded from None
    except (ValueError, RecursionError):
        raise BadRequest("this is not JSON; send an object") from None
    if not isinstance(body, dict):
        raise BadRequest("this is no object; send one")
    return body


def _require_size(text: str) -> None:
    if len(text) > TEXT_MAX:
        raise TooLarge(f"the text is too long; {TEXT_MAX} characters are the most")


async def _refuse(_: Request, failure: Exception) -> Response:
    assert isinstance(failure, Failure)
    status = BAD_REQUEST
    if isinstance(failure, TooLarge):
        status = TOO_LARGE
    elif isinstance(failure, Superseded):
        status = CONFLICT
    return JSONResponse({"error": as_json(failure)}, status)


async def _report(request: Request, error: Exception) -> Response:
    """A fault of the service itself: one line for the user, and the page goes on."""
    what = f"{type(error).__name__}: {error}"
    print(f"rkm04: {request.url.path}: {what}; this is a fault of the tool", file=sys.stderr)
    failure = Failure(f"the service has failed ({type(error).__name__}); reload the page")
    return JSONResponse({"error": as_json(failure)}, FAULT)
