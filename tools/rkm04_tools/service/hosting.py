"""Serves a page on this machine until Ctrl-C."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import re
import secrets
import signal
import socket
import webbrowser
from argparse import Namespace
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import uvicorn
from starlette.types import ASGIApp

from rkm04_tools import host
from rkm04_tools.failure import DONE, NO_CONNECTION, Failure

ADDRESS = "127.0.0.1"
MESSAGE_BYTES_MAX = 2_000_000
CLOSING_SECONDS = 2
TOKEN_BYTES = 24
TOKEN = re.compile(r"[\w-]{32}")
OPEN_ONLY_HERE = 0o600


class Server(uvicorn.Server):
    """Ends at a signal without passing it on, so that the command ends as others do."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Be told of the signals."""
        loop = asyncio.get_running_loop()
        names = [name for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
        for name in names:
            number = getattr(signal, name)
            try:
                loop.add_signal_handler(number, self.handle_exit, number, None)
            except NotImplementedError:  # Windows
                signal.signal(number, self.handle_exit)
        yield


@dataclass(frozen=True)
class Shown:
    """The page of a tool: its file, and the port that is tried first."""

    tool: str
    index: str
    usual_port: int


def serve_page(
    options: Namespace, shown: Shown, make_app: Callable[[Path, str, int], ASGIApp]
) -> int:
    """Serve what `make_app` makes of the page's folder, a token and a port."""
    page = host.program_path().parents[2] / "service"
    if not (page / shown.index).is_file():
        raise Failure(f"{page}: the page is not there; start the command as tools/{shown.tool}")
    with _listen(options.listen, shown.usual_port) as listener:
        port = listener.getsockname()[1]
        is_chosen = port in (options.listen, shown.usual_port)
        token = _kept_token(page.parent, port) if is_chosen else _new_token()
        url = f"http://{ADDRESS}:{port}/?token={token}"
        config = uvicorn.Config(
            make_app(page, token, port),
            log_config=None, access_log=False, server_header=False, proxy_headers=False,
            ws_max_size=MESSAGE_BYTES_MAX, timeout_graceful_shutdown=CLOSING_SECONDS,
        )  # fmt: skip
        _tell(url, options.json)
        if options.browser:
            webbrowser.open(url)
        Server(config).run([listener])
    return DONE


def _new_token() -> str:
    return secrets.token_urlsafe(TOKEN_BYTES)


def _kept_token(folder: Path, port: int) -> str:
    """The token that the last service on this port had, so that its pages go on by themselves.

    Only its owner may read the file; one that others can read or write is not believed.
    """
    path = folder / f"service-{port}.token"
    with contextlib.suppress(OSError, ValueError):
        status = path.lstat()
        is_ours = os.name == "posix" and (status.st_uid, status.st_mode & 0o77) == (os.getuid(), 0)
        token = path.read_text(encoding="ascii")
        if is_ours and path.is_file() and not path.is_symlink() and TOKEN.fullmatch(token):
            return token
    token = _new_token()
    # Where it cannot be kept, an open page has to be opened anew.
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)
        path.touch(OPEN_ONLY_HERE, exist_ok=False)
        path.write_text(token, encoding="ascii")
    return token


def _tell(url: str, as_json: bool) -> None:
    if as_json:
        print(json.dumps({"url": url}), flush=True)
    else:
        print(f"{url}\nThis address opens the service in a browser; Ctrl-C ends it.", flush=True)


def _listen(wanted: int | None, usual: int) -> socket.socket:
    """Listen on a port: the one that is wanted, or the usual one, or any that is free.

    What a browser keeps for a page belongs to its port, too.
    """
    if wanted is not None and wanted not in range(65_536):
        raise Failure(f"--listen {wanted}: write a port, 1 to 65535, or 0 for any free one")
    for port in [usual, 0] if wanted is None else [wanted]:
        listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((ADDRESS, port))
            listener.listen()
            return listener
        except OSError as error:
            listener.close()
            reason = (error.strerror or str(error)).lower()
    raise Failure(
        f"port {port} of {ADDRESS} cannot be used ({reason}); name another with --listen",
        NO_CONNECTION,
    )
