"""Keys while `send` runs on a terminal: speed, halt, go on; and who has the line meanwhile."""

from __future__ import annotations

import os
import pty
import re
import select
import signal
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine
from rkm04_tools.stopper import TWICE_SECONDS

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 60.0
RUN = (
    "import fcntl, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0);"
    "from rkm04_tools.gve134.__main__ import run; sys.exit(run())"
)
Start = Callable[..., "subprocess.Popen[str]"]


class Sending:
    """A `send` on a terminal of its own."""

    def __init__(self, *arguments: str | Path) -> None:
        self.master, self._slave = pty.openpty()
        termios.tcsetwinsize(self.master, (24, 200))
        self.before = termios.tcgetattr(self._slave)
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-c", RUN, "send", *map(str, arguments)],
            stdin=self._slave, stdout=self._slave, stderr=self._slave, start_new_session=True,
            env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        )  # fmt: skip
        self.shown = ""

    def press(self, keys: str) -> None:
        os.write(self.master, keys.encode())

    def until(self, text: str) -> str:
        """Read up to a text that has not been read before."""
        end = time.monotonic() + PATIENCE_S
        while not (match := re.search(text, self.shown)):
            assert select.select([self.master], [], [], end - time.monotonic())[0], self.shown
            self.shown += os.read(self.master, 4096).decode()
        found = self.shown[: match.end()]
        self.shown = self.shown[match.end() :]
        return found

    def end(self) -> int:
        """Wait for the end; the terminal is then as it was."""
        while self.process.poll() is None:
            if select.select([self.master], [], [], 0.05)[0]:
                self.shown += os.read(self.master, 4096).decode()
        assert termios.tcgetattr(self._slave) == self.before
        while select.select([self.master], [], [], 0)[0]:
            self.shown += os.read(self.master, 4096).decode()
        return self.process.returncode

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(PATIENCE_S)
        os.close(self.master)
        os.close(self._slave)


@pytest.fixture
def gve_unit() -> FakeGve:
    return FakeGve(vector_s=0.05)


@pytest.fixture
def unit(gve_unit: FakeGve, gve_line: FakeGveLine) -> FakeGve:
    return gve_unit


@pytest.fixture
def sending(unit: FakeGve, tmp_path: Path) -> Iterator[Callable[..., Sending]]:
    started: list[Sending] = []

    def start(text: str) -> Sending:
        path = tmp_path / "a.gve"
        path.write_text(text)
        started.append(Sending(path))
        started[-1].until("keys: .*Ctrl-C halts and ends")
        return started[-1]

    yield start
    for each in started:
        each.close()


def chain(count: int, first: str = "") -> str:
    return first + "C7,3\n" * count


def x_commands(unit: FakeGve) -> list[str]:
    return [each for each in unit.done if each.startswith("X")]


def test_keys_change_the_speed_and_the_line_shows_it(
    sending: Callable[..., Sending], unit: FakeGve
) -> None:
    job = sending(chain(100))
    job.until("executing")
    job.press("++")
    job.until(r"speed x1\.13")
    job.press("-")
    job.until(r"speed x1\.06")
    job.press("0")
    job.until(r"speed x0\.99")

    assert job.end() == 0
    assert x_commands(unit) == ["XU", "XU", "XD", "XD"]
    assert len(unit.taken) == 100


def test_a_speed_that_the_file_sets_is_shown_as_it_is(
    sending: Callable[..., Sending], unit: FakeGve
) -> None:
    job = sending(chain(100, "XM50\n"))
    job.until(r"speed 50\.0 %")
    job.press("+")
    job.until(r"speed 53\.1 %")

    assert job.end() == 0


@pytest.mark.parametrize("key", " !")
def test_a_key_halts_and_another_goes_on(
    sending: Callable[..., Sending], unit: FakeGve, key: str
) -> None:
    job = sending(chain(100, "!7V300\n"))
    job.until("executing")
    job.press(key)
    told = job.until("g goes on, Ctrl-C ends the job")
    taken = len(unit.taken)
    assert unit.inta
    assert "the rest of the vectors waits" in told
    assert "confirmed by the unit; " in told
    assert "of 100 vectors were executed; THE SPINDLE TURNS at 30 %" in told
    time.sleep(0.3)
    assert len(unit.taken) == taken
    job.press("g")

    assert job.end() == 0
    assert "100 vectors sent; the unit is at rest, the axes stand at X 700  Y 300" in job.shown
    assert unit.taken == [(7, 3, 0, 0)] * 100


def test_a_job_that_is_held_ends_by_ctrl_c(sending: Callable[..., Sending], unit: FakeGve) -> None:
    job = sending(chain(100))
    job.until("executing")
    job.press(" ")
    job.until("g goes on")
    job.press("+  \x03")

    assert job.end() == 130
    assert "confirmed by the unit" in job.shown
    assert "NOT CONFIRMED" not in job.shown
    assert x_commands(unit) == []


def test_a_restart_while_a_job_is_held_is_told(
    sending: Callable[..., Sending], unit: FakeGve, gve_line: FakeGveLine
) -> None:
    job = sending(chain(100))
    job.until("executing")
    job.press(" ")
    job.until("g goes on")
    with gve_line.lock:
        unit.restart()

    assert job.end() == 3
    assert "HAS RESTARTED" in job.shown


def test_a_halt_in_a_reference_run_ends_the_job(
    sending: Callable[..., Sending], unit: FakeGve, gve_line: FakeGveLine
) -> None:
    unit.home_s = 1000.0
    job = sending("C1\nWX-100,100,10,100\nC2\n")
    gve_line.until(lambda unit: unit.home_end < 1e9)
    job.press(" ")

    assert job.end() == 130
    assert "the axes stand at" in job.shown
    assert "confirmed by the unit" in job.shown
    assert len(unit.taken) == 1


def test_a_stop_by_key_that_nobody_confirms_is_shouted(
    sending: Callable[..., Sending], unit: FakeGve
) -> None:
    job = sending(chain(2000))
    job.until("executing")
    unit.mute = True
    job.press(" ")
    job.until("halting ...")
    while job.process.poll() is None:
        time.sleep(2 * TWICE_SECONDS)
        job.process.send_signal(signal.SIGINT)

    assert job.end() == 3
    assert "STOP NOT CONFIRMED: the tool was ended before" in job.shown
    assert "# " in job.shown
    assert "whether the spindle turns is NOT KNOWN" in job.shown


def test_a_person_who_is_asked_presses_enter_as_ever(
    sending: Callable[..., Sending], unit: FakeGve
) -> None:
    job = sending("C1\n;@pause put in tool 2\nC2\n")
    job.until("put in tool 2; Enter goes on")
    time.sleep(0.2)
    job.press("+ g\n")

    assert job.end() == 0
    assert x_commands(unit) == []
    assert len(unit.taken) == 2


def test_without_a_terminal_keys_are_not_read(
    start_gve: Start, unit: FakeGve, tmp_path: Path
) -> None:
    path = tmp_path / "a.gve"
    path.write_text(chain(20))

    _, told = start_gve("send", path).communicate("+ \n", timeout=PATIENCE_S)

    assert told == ""
    assert "H" not in unit.done
    assert x_commands(unit) == []


def test_who_has_the_line_is_named(
    start_gve: Start, gve: Any, gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    unit.vector_s = 1000.0
    path = tmp_path / "a.gve"
    path.write_text(chain(20))
    process = start_gve("send", path)
    gve_line.until(lambda unit: len(unit.taken) == 20)

    refused = gve("override", "up")
    assert refused.status == 3
    assert f"a.gve (process {process.pid}) has this line; use its keys" in refused.complaint
    assert x_commands(unit) == []
    process.terminate()
    process.communicate(timeout=PATIENCE_S)
