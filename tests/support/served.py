"""A running `serve`, and clients of it that use the second implementation of the frames."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from frames import FLAG, fcs16, frame, unescape

ROOT = Path(__file__).resolve().parents[2]
COMMAND = [sys.executable, "-P", "-m", "rkm04_tools", "serve"]
GVE_COMMAND = [sys.executable, "-P", "-m", "rkm04_tools.gve134", "serve"]
POSITIONING_COMMAND = [sys.executable, "-P", "-m", "rkm04_tools.positioning", "serve"]
PATIENCE_SECONDS = 15.0
ANSWER = 0x80


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT / "tools")}


def refusal(*arguments: str | Path, command: Sequence[str] = COMMAND) -> tuple[int, str]:
    """Run a `serve` that ends by itself."""
    done = subprocess.run(
        [*command, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=PATIENCE_SECONDS,
        env=environment(),
    )
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    return done.returncode, done.stderr


class Talker:
    """A client: frames out, frames in."""

    def __init__(self, fd: int, close: Callable[[], None]) -> None:
        self._fd = fd
        self._number = 0
        self._in_session: set[int] = set()
        self._came = b""
        self.close = close

    def send(self, data: bytes) -> None:
        while data:
            data = data[os.write(self._fd, data) :]

    def receive(self, seconds: float = PATIENCE_SECONDS) -> tuple[int, int, bytes] | None:
        """Return the next good frame: address, number, message."""
        end = time.monotonic() + seconds
        while True:
            body, flag, rest = self._came.partition(bytes([FLAG]))
            if flag:
                self._came = rest
                content = unescape(body)
                if len(content) > 4 and fcs16(content[:-2]).to_bytes(2, "little") == content[-2:]:
                    return content[0], content[1], content[2:-2]
                continue
            left = end - time.monotonic()
            if left <= 0 or not select.select([self._fd], [], [], left)[0]:
                return None
            self._came += os.read(self._fd, 65_536)

    def ask(self, message: bytes, node: int = 1, number: int | None = None) -> bytes:
        """Ask for an answer, in a session."""
        if node not in self._in_session:
            self._in_session.add(node)
            self.ask(b"\1", node)
        self._number = self._number % 255 + 1 if number is None else number
        self.send(frame(node, self._number, message))
        answer = self.receive()
        assert answer is not None
        assert answer[:2] == (ANSWER | node, self._number)
        return answer[2]

    def position(self, motor: int = 1, node: int = 1) -> int:
        answer = self.ask(b"\x04%d" % motor, node)
        assert answer[:2] == b"\x04%d" % motor
        return int(answer[3:])


class Control:
    """The control port: a line out, lines of JSON in."""

    def __init__(self, address: str) -> None:
        self._socket = connect(address)
        self._file = self._socket.makefile("rw", encoding="ascii")

    def order(self, text: str) -> Any:
        self._file.write(f"{text}\n")
        self._file.flush()
        return self.line()

    def line(self) -> Any:
        return json.loads(self._file.readline())

    def wait_for(self, text: str, reached: Callable[[Any], bool]) -> None:
        end = time.monotonic() + PATIENCE_SECONDS
        while not reached(state := self.order("?")):
            assert time.monotonic() < end, (text, state)
            time.sleep(0.002)

    def close(self) -> None:
        self._file.close()
        self._socket.close()


class Served:
    """A running `serve`."""

    def __init__(self, *arguments: str | Path, cwd: Path, command: Sequence[str] = COMMAND) -> None:
        self._open: list[Callable[[], None]] = []
        self.process = subprocess.Popen(
            [*command, "--json", *map(str, arguments)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=cwd,
            env=environment(),
        )
        ready = self.line()
        self.place: str = ready["listening"]
        self.control_place: str | None = ready["control"]
        self.nodes: list[int] = ready.get("nodes", [])

    def line(self) -> Any:
        """Read a line of standard output, byte by byte: select knows nothing of Python's buffer."""
        assert self.process.stdout is not None
        text = b""
        while not text.endswith(b"\n"):
            assert select.select([self.process.stdout], [], [], PATIENCE_SECONDS)[0], text
            byte = os.read(self.process.stdout.fileno(), 1)
            assert byte, self.process.communicate(timeout=PATIENCE_SECONDS)[1]
            text += byte
        return json.loads(text)

    def talker(self) -> Talker:
        if self.place.startswith("socket://"):
            connection = connect(self.place)
            talker = Talker(connection.fileno(), connection.close)
        else:
            fd = os.open(self.place, os.O_RDWR | os.O_NOCTTY)
            talker = Talker(fd, lambda: os.close(fd))
        self._open.append(talker.close)
        return talker

    def control(self) -> Control:
        assert self.control_place is not None
        control = Control(self.control_place)
        self._open.append(control.close)
        return control

    def end(self, number: int = signal.SIGTERM) -> tuple[int, str]:
        """End it; return its status and what it said on standard error."""
        for close in self._open:
            with contextlib.suppress(OSError):
                close()
        self._open.clear()
        return end_process(self.process, number)


def end_process(process: subprocess.Popen[str], number: int) -> tuple[int, str]:
    """Send a signal to what still runs; return its status and what it said on standard error."""
    if process.poll() is None:
        process.send_signal(number)
    try:
        _, complaint = process.communicate(timeout=PATIENCE_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise
    return process.returncode, complaint


def connect(place: str) -> socket.socket:
    host, port = place.removeprefix("socket://").split(":")
    connection = socket.create_connection((host, int(port)), PATIENCE_SECONDS)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection
