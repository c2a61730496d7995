"""The line without hardware: `serve` of a host program, which ends with this one."""

from __future__ import annotations

import json
import socket
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from typing import Any

from rkm04_tools import host
from rkm04_tools.failure import Failure
from rkm04_tools.frame import NODES
from rkm04_tools.line_errors import PortLost

NAME = "virtual"
PATIENCE_SECONDS = 5.0
AT_EVERY_ADDRESS = [word for node in NODES for word in ("--node", str(node))]


class VirtualLine:
    """Starts when it is first needed; what has been stored stays until it is closed for good.

    It is that of `program`, started with `more` arguments.
    """

    def __init__(
        self,
        program: Callable[[], Path] = host.program_path,
        more: Sequence[str] = AT_EVERY_ADDRESS,
    ) -> None:
        self._program = program
        self._more = more
        self._lock = Lock()
        self._folder: TemporaryDirectory[str] | None = None
        self._process: subprocess.Popen[str] | None = None
        self._control: socket.socket | None = None
        self._came = b""
        self._place = ""

    def open(self) -> str:
        """Return the port of the line; starts it, or starts it again if it has ended."""
        with self._lock:
            if self._process is None or self._process.poll() is not None:
                self._end()
                self._start()
            return self._place

    def set_input(self, name: str, level: bool) -> None:
        """Change an input by its name in orders, 3 or, of one among several units, 2.3."""
        with self._lock:
            self._say(f"{name}={int(level)}")
            self._hear()

    def close(self) -> None:
        """End it."""
        with self._lock:
            self._end()
            if self._folder:
                self._folder.cleanup()
                self._folder = None

    def _start(self) -> None:
        self._folder = self._folder or TemporaryDirectory(prefix="rkm04-units-")
        # It ends with its standard input, and so with this process, whatever ends that.
        arguments = ["serve", "--json", "--until-eof", "--tcp", "0", "--control", "0"]
        arguments += ["--flash", str(Path(self._folder.name) / "flash")]
        arguments += self._more
        # Ctrl-C is for the service, which ends the units when nothing needs them any more.
        process = subprocess.Popen(
            [str(self._program()), *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, text=True, start_new_session=True,
        )  # fmt: skip
        self._process = process
        assert process.stdout
        line = process.stdout.readline()
        if not line:
            self._end()
            raise Failure("the virtual unit does not start; try the command serve, which says why")
        ready = json.loads(line)
        self._place = ready["listening"]
        name, _, port = ready["control"].removeprefix("socket://").rpartition(":")
        self._came = b""
        try:
            self._control = socket.create_connection((name, int(port)), PATIENCE_SECONDS)
            self._control.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except OSError:
            raise ended() from None

    def _say(self, order: str) -> None:
        if not self._control:
            raise ended()
        try:
            self._control.sendall(f"{order}\n".encode("ascii"))
        except OSError:
            raise ended() from None

    def _hear(self) -> Any:
        assert self._control
        while b"\n" not in self._came:
            try:
                came = self._control.recv(65_536)
            except OSError:
                came = b""
            if not came:
                self._control.close()
                self._control = None
                raise ended()
            self._came += came
        line, _, self._came = self._came.partition(b"\n")
        return json.loads(line)

    def _end(self) -> None:
        if self._control:
            self._control.close()
            self._control = None
        process, self._process = self._process, None
        if not process:
            return
        if process.poll() is None:
            process.terminate()
            try:
                process.wait(PATIENCE_SECONDS)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        for stream in (process.stdin, process.stdout):
            if stream:
                stream.close()


def ended() -> PortLost:
    """That the units are there no more."""
    return PortLost("the virtual unit has ended; connect again to start it")
