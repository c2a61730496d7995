"""What the applications of all units have in common: bodies, refusals, the guard, the browsers."""

from __future__ import annotations

import json
import sys
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp

from rkm04_tools.failure import Failure
from rkm04_tools.service.browsers import Browsers
from rkm04_tools.service.guard import Guard
from rkm04_tools.service.trouble import BadRequest, Superseded, TooLarge, as_json

BODY_BYTES_MAX = 5_000_000
BAD_REQUEST, CONFLICT, TOO_LARGE, FAULT = 400, 409, 413, 500


@dataclass(frozen=True)
class Site:
    """The page's folder and its file there, and by what the guard knows it."""

    folder: Path
    index: str
    token: str
    port: int


def application(site: Site, browsers: Browsers, routes: Sequence[BaseRoute]) -> ASGIApp:
    """The page, what belongs to it, and the routes of a unit."""

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        browsers.start()
        try:
            yield
        finally:
            await browsers.close()

    async def show_page(_: Request) -> Response:
        return FileResponse(site.folder / site.index)

    handlers: dict[Any, Callable[..., Any]] = {Failure: _refuse, Exception: _report}
    app = Starlette(
        routes=[
            Route("/", show_page),
            *routes,
            WebSocketRoute("/ws", browsers.talk),
            Mount("/static", StaticFiles(directory=site.folder)),
        ],
        lifespan=lifespan,
        exception_handlers=handlers,
    )
    return Guard(app, site.token, site.port)


async def bytes_of(request: Request, most: int = BODY_BYTES_MAX) -> bytes:
    """What a request brings."""
    content = b""
    try:
        async for part in request.stream():
            content += part
            if len(content) > most:
                raise TooLarge(f"more than {most} bytes; that is no program")
    except ClientDisconnect:
        raise Superseded from None
    return content


async def object_of(request: Request) -> dict[str, Any]:
    """The JSON object that a request brings."""
    content = await bytes_of(request)
    try:
        body = json.loads(content)
    except (ValueError, RecursionError):
        raise BadRequest("this is not JSON; send an object") from None
    if not isinstance(body, dict):
        raise BadRequest("this is no object; send one")
    return body


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
