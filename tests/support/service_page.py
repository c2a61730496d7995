"""The service program with its page in a browser, as a user has it before them."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, expect
from tab import DESK, PATIENCE_SECONDS, Visit, opened_tab, shown_number

ROOT = Path(__file__).resolve().parents[2]
COMMAND = [sys.executable, "-P", "-m", "rkm04_tools", "service", "--no-browser", "--json"]
NOT_KNOWN = "\N{EN DASH}"
TABLET = (820, 1180)


def free_port() -> int:
    """A port of TCP that nobody uses now."""
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])


class Service:
    """A running `rkm04 service` on a free port, with a virtual unit of its own."""

    def __init__(self, *arguments: str, listen: int = 0) -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
        environment.pop("RKM04_PORT", None)
        self._process = subprocess.Popen(
            [*COMMAND, "--listen", str(listen), *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._process.stdout
        told = self._process.stdout.readline()
        if not told:
            self.end()
        self.url: str = json.loads(told)["url"]

    def tell(self, number: int) -> None:
        """Send a signal."""
        self._process.send_signal(number)

    def end(self, number: int = signal.SIGINT) -> None:
        """Ctrl-C, or another signal, if it still runs."""
        self.tell(signal.SIGCONT)
        self.tell(number)
        self._process.communicate(timeout=PATIENCE_SECONDS)


class ServicePage(Visit):
    """The page of `rkm04 service`; where it `waits`, it shows a unit."""

    def __init__(self, page: Page, url: str, waits: bool = True) -> None:
        super().__init__(page, url)
        if waits:
            self.ready()

    def ready(self) -> None:
        """Wait until the page is connected and has drawn."""
        expect(self.page.locator("body")).to_have_attribute("data-connected", "true")
        expect(self.plan).to_have_attribute("data-drawn", re.compile(r"\d+"))
        expect(self.position(1)).not_to_have_text(NOT_KNOWN)

    def connect(self, port: str, node: int = 1) -> None:
        """Leave the unit that is connected for another one."""
        button = self.page.locator("#connect")
        expect(button).to_be_enabled()
        if self.page.locator("#port").is_disabled():
            places = ("#port-other", "#node")
            if [self.page.locator(place).input_value() for place in places] == [port, str(node)]:
                return
            button.click()
            expect(self.page.locator("#port")).to_be_enabled()
        self.page.locator("#port").select_option("")
        self.page.locator("#port-other").fill(port)
        self.page.locator("#node").select_option(str(node))
        button.click()
        expect(self.page.locator("body")).to_have_attribute("data-connected", "true")

    @property
    def alarm(self) -> Locator:
        """The line under STOP; `data-kind` says asked, failed, done or none."""
        return self.page.locator("#alarm")

    def stopped(self) -> None:
        """Press STOP until all units have confirmed."""
        expect(self.page.locator("#state")).to_have_attribute("data-kind", "good")
        self.page.keyboard.press("Escape")
        expect(self.alarm).to_have_attribute("data-kind", "done")

    def state(self, motor: int) -> Locator:
        """What a motor does, in words."""
        return self.page.locator(f"#state-{motor}")

    @property
    def plan(self) -> Locator:
        """The panel with the curves."""
        return self.page.locator("#plan")

    @property
    def answers(self) -> Locator:
        """The log, the youngest answer first."""
        return self.page.locator("#log .log-item")

    def position(self, motor: int) -> Locator:
        """Where the live position of a motor is shown."""
        return self.page.locator(f"#position-{motor}")

    def steps(self, motor: int = 1) -> int:
        """The live position of a motor, once it is known."""
        return int(shown_number(self.position(motor)))

    def write(self, text: str) -> None:
        """Put a text in the place of the shown program, by the keyboard."""
        self.page.locator(".cm-content").click()
        self.page.keyboard.press("ControlOrMeta+a")
        self.page.keyboard.press("Delete")
        self.page.keyboard.insert_text(text)

    def text(self) -> str:
        """The shown program."""
        return "\n".join(self.page.locator(".cm-line").all_inner_texts())

    def send(self, text: str | None = None) -> None:
        """Send the shown program, or a new one, and wait for the answer."""
        if text is not None:
            self.write(text)
        before = self.answers.count()
        self.page.locator("#send").click()
        expect(self.answers).to_have_count(before + 1)

    def calm(self) -> None:
        """Bring all motors to rest at position 0, without programs, and all outputs to 0."""
        self.page.locator("#motors label").first.click()
        self.page.locator("#message").select_option("send")
        self.send("\\ C100 C01 C02 C03 C04 C05 C06 C07 C08")
        for motor in (1, 2, 3, 4):
            expect(self.position(motor)).to_have_text("0")

    def forget(self, motor: int) -> None:
        """Empty the memory of a motor, or of all four (0)."""
        self.page.locator("#motors label").nth(motor).click()
        reset = self.page.locator("#reset")
        reset.click()
        self.page.wait_for_timeout(600)
        reset.click()
        expect(self.answers.first).to_have_attribute("data-message", "reset")

    def expect_pulses(self, pulses: int) -> None:
        """Wait for a curve with so many pulses."""
        expect(self.plan).to_have_attribute("data-pulses", str(pulses))

    def expect_beyond(self, steps: int, motor: int = 1) -> None:
        """Wait until a motor has gone beyond a position."""
        for _ in range(10 * PATIENCE_SECONDS):
            if self.steps(motor) > steps:
                return
            self.page.wait_for_timeout(100)
        raise AssertionError(f"motor {motor} stays at {self.steps(motor)}, wanted beyond {steps}")

    def expect_sent(self, kind: str, count: int) -> None:
        """Wait until the page has sent so many of a type, and see that it sends no more."""
        for _ in range(10 * PATIENCE_SECONDS):
            if self.sent.count(kind) >= count:
                break
            self.page.wait_for_timeout(100)
        self.page.wait_for_timeout(100)
        assert self.sent.count(kind) == count

    def expect_standing(self, motor: int = 1) -> int:
        """Wait until a motor is known to stand, and stays where it is; return where."""
        expect(self.page.locator("#live")).to_have_attribute("data-fresh", "true")
        card = self.page.locator(".card").nth(motor - 1)
        expect(card).to_have_attribute("data-moving", "false")
        before = self.steps(motor)
        for _ in range(2 * PATIENCE_SECONDS):
            self.page.wait_for_timeout(500)
            before, last = self.steps(motor), before
            if before == last:
                return before
        raise AssertionError(f"motor {motor} does not stop")

    def underlined(self) -> list[tuple[int, int, str]]:
        """Line, column and text of every underlined error."""
        found: list[tuple[int, int, str]] = self.page.evaluate(
            """() => [...document.querySelectorAll(".cm-lintRange-error")].map((mark) => {
                const line = mark.closest(".cm-line");
                const before = document.createRange();
                before.setStart(line, 0);
                before.setEndBefore(mark);
                const lines = [...document.querySelectorAll(".cm-line")];
                const column = [...before.toString()].length + 1;
                return [lines.indexOf(line) + 1, column, mark.textContent];
            })"""
        )
        return [(line, column, text) for line, column, text in found]


@contextlib.contextmanager
def shown(
    browser: Browser,
    url: str,
    size: tuple[int, int] = DESK,
    locale: str = "en-GB",
    waits: bool = True,
    touch: bool = False,
) -> Iterator[ServicePage]:
    """Open the page in a tab of its own; where it `waits`, until it shows a unit."""
    with opened_tab(browser, size, locale, touch) as tab:
        service_page = ServicePage(tab, url, waits)
        yield service_page
        assert service_page.faults == []
