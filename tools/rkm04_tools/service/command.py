"""`service`: serves the page until Ctrl-C."""

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
from collections.abc import Iterator
from pathlib import Path

import uvicorn

from rkm04_tools import host
from rkm04_tools.client_base import PORT_VARIABLE, reading_node_of
from rkm04_tools.failure import DONE, NO_CONNECTION, Failure
from rkm04_tools.service import virtual
from rkm04_tools.service.app import make_app
from rkm04_tools.service.orders import Connect

ADDRESS = "127.0.0.1"
USUAL_PORT = 8404
"""Tried first: what a browser keeps for a page belongs to its port too."""
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


def run(options: Namespace) -> int:
    """Serve."""
    first = Connect(options.port or os.environ.get(PORT_VARIABLE) or virtual.NAME,
                    reading_node_of(options))  # fmt: skip
    page = host.program_path().parents[2] / "service"
    if not (page / "index.html").is_file():
        raise Failure(f"{page}: the page is not there; start the command as tools/rkm04")
    with _listen(options.listen) as listener:
        port = listener.getsockname()[1]
        is_chosen = port in (options.listen, USUAL_PORT)
        token = _kept_token(page.parent, port) if is_chosen else _new_token()
        url = f"http://{ADDRESS}:{port}/?token={token}"
        config = uvicorn.Config(
            make_app(page, token, port, first),
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


def _listen(wanted: int | None) -> socket.socket:
    """Listen on a port: the one that is wanted, or the usual one, or any that is free."""
    if wanted is not None and wanted not in range(65_536):
        raise Failure(f"--listen {wanted}: write a port, 1 to 65535, or 0 for any free one")
    for port in [USUAL_PORT, 0] if wanted is None else [wanted]:
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
