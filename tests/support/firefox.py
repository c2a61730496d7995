"""Debian's Firefox without a window, by the protocol that it speaks itself: WebDriver BiDi.

So it needs no driver: playwright's has to be a Firefox of its own, and geckodriver is no package.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import re
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

FIREFOX = Path("/usr/bin/firefox-esr")
PATIENCE_SECONDS = 30.0
POLL_SECONDS = 0.05
LISTENS = re.compile(r"WebDriver BiDi listening on (ws://\S+)")
KEYS = {"Escape": "\ue00c", "Control": "\ue009"}
MIDDLE = "{ block: 'center' }"
LOST = re.compile("was interrupted while the page was loading|establish a connection to the server")
"""What Firefox says itself of a socket whose page is left, or whose service has ended."""


@contextlib.contextmanager
def running(profile: Path) -> Iterator[Firefox]:
    """A Firefox with a new profile, in a folder of the test's own."""
    log = profile / "log"
    command = [str(FIREFOX), "--headless", "--no-remote", "--profile", str(profile)]
    with log.open("w") as out:
        process = subprocess.Popen(
            [*command, "--remote-debugging-port", "0"], stdout=out, stderr=subprocess.STDOUT
        )
    try:
        with connect(f"{_place(process, log)}/session", max_size=None) as socket:
            yield Firefox(socket)
    finally:
        process.terminate()
        process.wait(PATIENCE_SECONDS)


def _place(process: subprocess.Popen[bytes], log: Path) -> str:
    """Where it listens, as it says itself."""
    end = time.monotonic() + PATIENCE_SECONDS
    while not (found := LISTENS.search(log.read_text(errors="replace"))):
        assert process.poll() is None, log.read_text(errors="replace")
        assert time.monotonic() < end
        time.sleep(POLL_SECONDS)
    return found[1]


class Firefox:
    """A browser with one page. `faults` are errors of scripts that nobody has caught."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._ids = itertools.count(1)
        self.faults: list[str] = []
        self.command("session.new", capabilities={})
        self.command("session.subscribe", events=["log.entryAdded"])
        tree = self.command("browsingContext.getTree")
        self._context = tree["contexts"][0]["context"]

    def command(self, method: str, **parameters: Any) -> Any:
        """Send a command of the protocol; return its result."""
        number = next(self._ids)
        self._socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            told = json.loads(self._socket.recv(PATIENCE_SECONDS))
            if told.get("method") == "log.entryAdded":
                self._note(told["params"])
            if told.get("id") == number:
                assert told["type"] == "success", told
                return told["result"]

    def _note(self, entry: Any) -> None:
        if entry["type"] == "javascript" and not LOST.search(entry["text"]):
            self.faults.append(entry["text"])

    def open(self, url: str, script: str = "") -> None:
        """Show a page, in which a script runs before its own; wait until it has been loaded."""
        made = self.command("script.addPreloadScript", functionDeclaration=f"() => {{{script}}}")
        self.command("browsingContext.navigate", context=self._context, url=url, wait="complete")
        self.command("script.removePreloadScript", script=made["script"])

    def evaluate(self, script: str) -> Any:
        """The value of an expression, a text, a number or true and false."""
        told = self.command(
            "script.evaluate",
            expression=script,
            target={"context": self._context},
            awaitPromise=True,
            userActivation=True,
        )
        assert told["type"] == "success", told
        return told["result"].get("value")

    def text(self, place: str) -> str:
        """What an element says."""
        return str(self.evaluate(f"document.querySelector({json.dumps(place)}).textContent"))

    def wait_for(self, script: str) -> None:
        """Wait until an expression is true."""
        end = time.monotonic() + PATIENCE_SECONDS
        while not self.evaluate(f"Boolean({script})"):
            assert time.monotonic() < end, script
            time.sleep(POLL_SECONDS)

    def wait_for_text(self, place: str, words: str) -> None:
        """Wait until an element says some words."""
        part = json.dumps(words)
        self.wait_for(f"document.querySelector({json.dumps(place)}).textContent.includes({part})")

    def click(self, place: str, held_ms: int = 0) -> None:
        """Press the button of a mouse on an element, and let it go after a time."""
        self.evaluate(f"document.querySelector({json.dumps(place)}).scrollIntoView({MIDDLE})")
        element = self.command(
            "browsingContext.locateNodes",
            context=self._context,
            locator={"type": "css", "value": place},
        )["nodes"][0]
        origin = {"type": "element", "element": {"sharedId": element["sharedId"]}}
        move = {"type": "pointerMove", "x": 0, "y": 0, "origin": origin}
        down, up = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        self._act("pointer", move, down, {"type": "pause", "duration": held_ms}, up)

    def press(self, *keys: str) -> None:
        """Press keys together."""
        values = [KEYS.get(key, key) for key in keys]
        downs = [{"type": "keyDown", "value": value} for value in values]
        ups = [{"type": "keyUp", "value": value} for value in values[::-1]]
        self._act("key", *downs, *ups)

    def type(self, text: str) -> None:
        """Press the keys of a text one after the other."""
        kinds = ("keyDown", "keyUp")
        self._act("key", *({"type": kind, "value": each} for each in text for kind in kinds))

    def _act(self, kind: str, *actions: dict[str, Any]) -> None:
        device = {"type": kind, "id": kind, "actions": list(actions)}
        self.command("input.performActions", context=self._context, actions=[device])
