"""The application: what a page may ask for by HTTP."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp

from rkm04_tools.positioning import settings
from rkm04_tools.positioning.service.connection import LineForm
from rkm04_tools.positioning.service.desk import UnitDesk
from rkm04_tools.service.browsers import Browsers
from rkm04_tools.service.http import Site, application, bytes_of
from rkm04_tools.service.unit_orders import Connect
from rkm04_tools.source import decode

NAME_MAX = 200


def make_app(page: Path, token: str, port: int, first: Connect, form: LineForm) -> ASGIApp:
    """The application, which shows the page of a folder and connects to a first port."""

    def make_desk(*arguments: Any) -> UnitDesk:
        return UnitDesk(first, form, *arguments)

    async def read_backup(request: Request) -> Response:
        """The values of a file of settings; nothing is written."""
        name = request.query_params.get("name", "")[:NAME_MAX].strip() or "the file"
        data = await bytes_of(request, settings.FILE_BYTES_MAX)
        return JSONResponse(settings.read_values(decode(data), name))

    routes = [Route("/api/settings", read_backup, methods=["POST"])]
    return application(Site(page, "positioning.html", token, port), Browsers(make_desk), routes)
