"""A line over TCP that a test can mute, cut, and lead to another unit."""

from __future__ import annotations

import contextlib
import select
import socket
import threading

import pytest
from served import connect

LOOK_SECONDS = 0.01


class Relay:
    """Passes bytes between a client and a unit; what is muted is lost. `dumb`: answers alone are.

    `heard` counts what has come from clients since it was set to 0.
    """

    def __init__(self, place: str) -> None:
        self.muted = False
        self.dumb = False
        self.heard = 0
        self._lock = threading.Lock()
        self._unit = connect(place)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._number: int = self._listener.getsockname()[1]
        self.port = f"socket://127.0.0.1:{self._number}"
        self._client: socket.socket | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def to(self, place: str) -> None:
        """Lead to another unit, as if it were the same one, started anew."""
        with self._lock:
            self._unit.close()
            self._unit = connect(place)

    def cut(self) -> None:
        """Let the port be gone."""
        with self._lock:
            self._listener.close()
            if self._client:
                self._client.close()
            self._client = None

    def mend(self) -> None:
        """Let it be there again."""
        with self._lock:
            self._listener = socket.create_server(("127.0.0.1", self._number))

    def close(self) -> None:
        self._ended.set()
        self._thread.join()
        self.cut()
        self._unit.close()

    def _run(self) -> None:
        while not self._ended.is_set():
            with self._lock, contextlib.suppress(OSError, ValueError):
                self._pass_on()
            self._ended.wait(0.001)

    def _pass_on(self) -> None:
        wanted = [each for each in (self._listener, self._client, self._unit) if each]
        wanted = [each for each in wanted if each.fileno() >= 0]
        for ready in select.select(wanted, [], [], LOOK_SECONDS)[0]:
            if ready is self._listener:
                if self._client:
                    self._client.close()
                self._client = self._listener.accept()[0]
                self._client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            elif ready is self._client:
                self._from_client(ready)
            else:
                data = ready.recv(4096)
                if self._client and not (self.muted or self.dumb):
                    self._client.sendall(data)

    def _from_client(self, client: socket.socket) -> None:
        data = client.recv(4096)
        if not data:
            client.close()
            self._client = None
            return
        self.heard += len(data)
        if not self.muted:
            self._unit.sendall(data)


def expect_reset(listener: socket.socket) -> None:
    """A connection that is given up drops what has not gone out."""
    connection, _ = listener.accept()
    with connection, pytest.raises(ConnectionResetError):
        _ = list(iter(lambda: connection.recv(4096), b""))
