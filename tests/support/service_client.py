"""A running `service` without a browser, and what a page does with it."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from served import PATIENCE_SECONDS, end_process
from websockets import Origin
from websockets.sync.client import ClientConnection, connect

ROOT = Path(__file__).resolve().parents[2]
PAGE = "<!doctype html><title>a page</title>"


def build_with_page(folder: Path) -> Path:
    """A build folder with the programs of the real one and a page of its own."""
    real = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host"))
    build = folder / "build"
    build.mkdir()
    (build / "host").symlink_to(real, target_is_directory=True)
    (build / "service").mkdir()
    (build / "service" / "index.html").write_text(PAGE)
    return build / "host"


@dataclass(frozen=True)
class Reply:
    """What a page gets by HTTP."""

    status: int
    text: str
    headers: Mapping[str, str]

    @property
    def json(self) -> Any:
        return json.loads(self.text)


def is_moving(motor: dict[str, Any]) -> bool:
    """Whether a motor moves, as far as its unit tells."""
    return bool(motor["speed"] if motor["moving"] is None else motor["moving"])


class Browser:
    """A web socket; keeps everything that has come."""

    def __init__(self, url: str, origin: str) -> None:
        self._stack = contextlib.ExitStack()
        self._socket: ClientConnection = self._stack.enter_context(
            connect(url, origin=Origin(origin), ping_interval=None, close_timeout=2)
        )
        self.heard: list[dict[str, Any]] = []
        self._number = 0

    def say(self, **told: Any) -> None:
        self._socket.send(json.dumps(told))

    def say_raw(self, text: str | bytes) -> None:
        self._socket.send(text)

    def until(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Return the next message that is wanted."""
        end = time.monotonic() + PATIENCE_SECONDS
        while True:
            message = json.loads(self._socket.recv(end - time.monotonic()))
            self.heard.append(message)
            if wanted(message):
                return dict(message)

    def next(self, kind: str) -> dict[str, Any]:
        return self.until(lambda message: message["type"] == kind)

    def begin(self, kind: str, **told: Any) -> int:
        """Ask, and return the number by which the answer is known."""
        self._number += 1
        self.say(type=kind, id=self._number, **told)
        return self._number

    def answer(self, number: int) -> dict[str, Any]:
        return self.until(lambda m: m["type"] == "answer" and m["id"] == number)

    def ask(self, kind: str, **told: Any) -> dict[str, Any]:
        return self.answer(self.begin(kind, **told))

    def request(self, message: str, motor: int = 1, **told: Any) -> dict[str, Any]:
        return self.ask("request", message=message, motor=motor, **told)

    def connected(self) -> dict[str, Any]:
        """Wait until the service has connected by itself."""
        return self.until(
            lambda m: m["type"] == "state" and m["connected"] and m["unit"] and not m["busy"]
        )

    def moves(self, motor: int = 1) -> dict[str, Any]:
        return self.until(lambda m: m["type"] == "live" and is_moving(m["motors"][motor - 1]))

    def stands(self, motor: int = 1) -> dict[str, Any]:
        return self.until(lambda m: m["type"] == "live" and not is_moving(m["motors"][motor - 1]))

    def state(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Wait for a state of the connection."""
        return self.until(lambda m: m["type"] == "state" and wanted(m))

    def live(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Wait for a look at the unit."""
        return self.until(lambda m: m["type"] == "live" and wanted(m))

    def quiet(self, seconds: float) -> list[dict[str, Any]]:
        """What comes for a while, live views and beats left out."""
        end = time.monotonic() + seconds
        came = []
        while (left := end - time.monotonic()) > 0:
            with contextlib.suppress(TimeoutError):
                came.append(json.loads(self._socket.recv(left)))
        return [message for message in came if message["type"] not in ("live", "beat")]

    def close(self) -> None:
        self._stack.close()


class Service:
    """A running `service`."""

    def __init__(self, build: Path, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", "rkm04_tools", "service", "--no-browser", "--json",
             "--listen", "0", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={**os.environ, "PYTHONPATH": str(ROOT / "tools"), "RKM04_BUILD": str(build)},
        )  # fmt: skip
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line, self.process.communicate()[1]
        self.url: str = json.loads(line)["url"]
        self.place, _, self.token = self.url.partition("/?token=")
        self.port = int(self.place.rpartition(":")[2])
        self._browsers: list[Browser] = []

    def call(self, path: str, body: Any = None, token: str | None = None, **headers: str) -> Reply:
        """Ask by HTTP; a body that is no bytes is sent as JSON."""
        data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
        token = self.token if token is None else token
        query = f"?token={token}" if token else ""
        request = urllib.request.Request(f"{self.place}{path}{query}", data, headers)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_SECONDS) as reply:
                return Reply(reply.status, reply.read().decode(), dict(reply.headers))
        except urllib.error.HTTPError as refusal:
            with refusal:
                return Reply(refusal.code, refusal.read().decode(), dict(refusal.headers))

    def browser(self, token: str | None = None, origin: str | None = None) -> Browser:
        place = self.place.replace("http://", "ws://")
        url = f"{place}/ws?token={self.token if token is None else token}"
        browser = Browser(url, origin or self.place)
        self._browsers.append(browser)
        return browser

    def end(self, number: int = signal.SIGINT) -> tuple[int, str]:
        """End it; return its status and what it has printed as errors."""
        for browser in self._browsers:
            browser.close()
        return self.wait(number)

    def wait(self, number: int = signal.SIGINT) -> tuple[int, str]:
        return end_process(self.process, number)
