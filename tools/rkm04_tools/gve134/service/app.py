"""The application: what a page may ask for by HTTP."""

from __future__ import annotations

import asyncio
from functools import cache
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.service.desk import UnitDesk
from rkm04_tools.gve134.service.files import FILE_BYTES_MAX, File
from rkm04_tools.gve134.service.machine_file import MachineFile
from rkm04_tools.service.browsers import Browsers
from rkm04_tools.service.http import Site, application, bytes_of, object_of
from rkm04_tools.service.trouble import BadRequest
from rkm04_tools.service.unit_orders import Connect
from rkm04_tools.tree import ROOT

EXAMPLES = ROOT / "tools" / "examples" / "gve"
MACHINE = EXAMPLES / "mill.rkm"
NAME_MAX = 200


def make_app(
    page: Path, token: str, port: int, first: Connect, baud: int, machine: MachineFile | None
) -> ASGIApp:
    """The application, which shows the page of a folder and connects to a first port."""
    desks: list[UnitDesk] = []

    def make_desk(*arguments: Any) -> UnitDesk:
        desks.append(UnitDesk(first, baud, machine, *arguments))
        return desks[0]

    browsers = Browsers(make_desk)
    desk = desks[0]

    async def open_file(request: Request) -> Response:
        name, data = _name(request), await bytes_of(request, FILE_BYTES_MAX)
        file = await asyncio.to_thread(desk.open_file, name, data)
        return JSONResponse(file.as_json())

    async def open_machine(request: Request) -> Response:
        name, data = _name(request), await bytes_of(request)
        await asyncio.to_thread(desk.open_machine, name, data)
        return JSONResponse({})

    async def show_machine(_: Request) -> Response:
        machine = desk.machine()
        return JSONResponse({"name": machine.name, "text": machine.text})

    async def open_example(request: Request) -> Response:
        name = (await object_of(request)).get("name")
        if name not in examples():
            raise BadRequest("there is no such example; reload the page")
        file = await asyncio.to_thread(_open_example, desk, str(name))
        return JSONResponse(file.as_json())

    async def show_examples(_: Request) -> Response:
        return JSONResponse(await asyncio.to_thread(examples))

    async def show_file(request: Request) -> Response:
        file = desk.file(_number(request))
        return JSONResponse({"text": file.text, "problems": file.problems, "more": file.more})

    async def show_course(request: Request) -> Response:
        rows = await asyncio.to_thread(desk.file(_number(request)).rows)
        return Response(rows, media_type="application/octet-stream")

    routes = [
        Route("/api/file", show_file),
        Route("/api/file", open_file, methods=["POST"]),
        Route("/api/course", show_course),
        Route("/api/machine", show_machine),
        Route("/api/machine", open_machine, methods=["POST"]),
        Route("/api/examples", show_examples),
        Route("/api/example", open_example, methods=["POST"]),
    ]
    return application(Site(page, "gve134.html", token, port), browsers, routes)


@cache
def examples() -> list[str]:
    """Names of the examples."""
    files = [*EXAMPLES.glob("*.nc"), *EXAMPLES.glob("*.gve")]
    return sorted(path.name for path in files)


def _open_example(desk: UnitDesk, name: str) -> File:
    """Open an example, and the machine that they are for unless there is one."""
    try:
        if not desk.has_machine:
            desk.open_machine(MACHINE.name, MACHINE.read_bytes())
        return desk.open_file(name, (EXAMPLES / name).read_bytes())
    except OSError as error:
        raise Failure(f"{name}: cannot be read ({error.strerror}); is the clone whole?") from None


def _name(request: Request) -> str:
    name = request.query_params.get("name", "").strip()
    if not name or len(name) > NAME_MAX:
        raise BadRequest(f"the file has no name, or one of more than {NAME_MAX} characters")
    return name


def _number(request: Request) -> int:
    text = request.query_params.get("number", "")
    if not text.isdecimal() or len(text) > 15:
        raise BadRequest("which file? give its number")
    return int(text)
