"""The application: what a page may ask for."""

from __future__ import annotations

import asyncio
from functools import partial
from pathlib import Path

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp

from rkm04_tools.service.browsers import Browsers
from rkm04_tools.service.checking import check, examples
from rkm04_tools.service.curves import Curves, read_wanted
from rkm04_tools.service.desk import UnitDesk
from rkm04_tools.service.http import Site, application, object_of
from rkm04_tools.service.orders import TEXT_MAX, Connect
from rkm04_tools.service.trouble import BadRequest, TooLarge


def make_app(page: Path, token: str, port: int, first: Connect) -> ASGIApp:
    """The application, which shows the page of a folder and connects to a first port."""
    curves = Curves()

    async def show_examples(_: Request) -> Response:
        return JSONResponse(await asyncio.to_thread(examples))

    async def make_check(request: Request) -> Response:
        body = await object_of(request)
        text = body.get("text")
        if not isinstance(text, str):
            raise BadRequest('no text; write {"text": "F100 R"}')
        _require_size(text)
        return JSONResponse(await asyncio.to_thread(check, text))

    async def make_curve(request: Request) -> Response:
        wanted = read_wanted(await object_of(request))
        for text in wanted.programs.values():
            _require_size(text)
        return JSONResponse(await curves.make(wanted))

    routes = [
        Route("/api/examples", show_examples),
        Route("/api/check", make_check, methods=["POST"]),
        Route("/api/curve", make_curve, methods=["POST"]),
    ]
    site = Site(page, "index.html", token, port)
    return application(site, Browsers(partial(UnitDesk, first)), routes)


def _require_size(text: str) -> None:
    if len(text) > TEXT_MAX:
        raise TooLarge(f"the text is too long; {TEXT_MAX} characters are the most")
