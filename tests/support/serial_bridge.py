"""What is at the other end of a page's serial port: a line on TCP or on a pty, over a WebSocket."""

from __future__ import annotations

import contextlib
import os
import select
import threading
from pathlib import Path

from served import connect
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve

FAKE = Path(__file__).with_name("fake_serial.js")
POLL_SECONDS = 0.01
PATIENCE_SECONDS = 30


class SerialBridge:
    """Passes bytes on; `silent` keeps back what units say, `sent` is all that the page has said."""

    def __init__(self, place: str) -> None:
        self.place = place
        self.silent = False
        self.sent = b""
        self._is_free = threading.Event()
        self._is_free.set()
        self._server: Server = serve(self._carry, "127.0.0.1", 0)
        self._thread = threading.Thread(target=self._server.serve_forever)
        self._thread.start()

    @property
    def script(self) -> str:
        """What gives a page a port that ends here."""
        port = self._server.socket.getsockname()[1]
        return FAKE.read_text(encoding="utf-8").replace("PLACE", f"ws://127.0.0.1:{port}")

    def close(self) -> None:
        """Let everybody go."""
        self._server.shutdown()
        self._thread.join()

    def wait_until_free(self) -> None:
        """Wait until the page has let go, and all that it has said was passed on."""
        assert self._is_free.wait(PATIENCE_SECONDS)

    def to_unit(self, data: bytes) -> bytes:
        """What a bad line makes of it."""
        return data

    def to_page(self, data: bytes) -> bytes:
        """The same, the other way."""
        return data

    def _carry(self, page: ServerConnection) -> None:
        self._is_free.clear()
        with contextlib.ExitStack() as stack:
            stack.callback(self._is_free.set)
            if self.place.startswith("socket://"):
                line = stack.enter_context(connect(self.place)).fileno()
            else:
                line = os.open(self.place, os.O_RDWR | os.O_NOCTTY)
                stack.callback(os.close, line)
            ended = threading.Event()
            hearing = threading.Thread(target=self._hear, args=(page, line, ended))
            hearing.start()
            with contextlib.suppress(ConnectionClosed, OSError):
                for data in page:
                    assert isinstance(data, bytes)
                    self.sent += data
                    os.write(line, self.to_unit(data))
            ended.set()
            hearing.join()

    def _hear(self, page: ServerConnection, line: int, ended: threading.Event) -> None:
        while not ended.is_set():
            if not select.select([line], [], [], POLL_SECONDS)[0]:
                continue
            try:
                data = os.read(line, 4096)
            except OSError:  # a unit that was killed
                break
            if not data:
                break
            if not self.silent:
                with contextlib.suppress(ConnectionClosed):
                    page.send(self.to_page(data))
