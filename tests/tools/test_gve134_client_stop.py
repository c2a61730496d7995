"""Ctrl-C and SIGTERM: the axes are halted, and it is told, or shouted that nobody knows."""

from __future__ import annotations

import os
import pty
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve, lost
from gve134_ports import FakeGveLine
from rkm04_tools.gve134.answers import encoded
from rkm04_tools.gve134.client import RUNS
from rkm04_tools.stopper import TWICE_SECONDS

Start = Callable[..., "subprocess.Popen[str]"]
PATIENCE_S = 30.0


@pytest.fixture
def gve_unit() -> FakeGve:
    return FakeGve(vector_s=0.01)


@pytest.fixture
def unit(gve_unit: FakeGve, gve_line: FakeGveLine) -> FakeGve:
    return gve_unit


@pytest.fixture
def job(tmp_path: Path) -> Path:
    path = tmp_path / "a.gve"
    path.write_text("C1\n" * 2000)
    return path


def end(process: subprocess.Popen[str], *numbers: signal.Signals) -> tuple[int, str]:
    """Send signals: the second when the first is being obeyed."""
    shown = ""
    for place, number in enumerate(numbers):
        if place:
            while "halting" not in shown:
                assert process.stderr is not None
                line = process.stderr.readline()
                assert line, shown
                shown += line
            time.sleep(2 * TWICE_SECONDS)
        process.send_signal(number)
    _, told = process.communicate(timeout=PATIENCE_S)
    return process.returncode, shown + told


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_halts_a_job_and_tells_state_and_position(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, job: Path, number: signal.Signals
) -> None:
    process = start_gve("send", job)
    gve_line.until(lambda unit: len(unit.taken) > 200)

    status, told = end(process, number)

    assert status == 130
    assert unit.inta
    assert "of 2000 vectors; halting ..." in told
    assert "the axes stand at X " in told
    assert "the rest of the vectors waits (gve134 go or delete)" in told
    assert "NOT CONFIRMED" not in told


def test_a_stop_that_nobody_confirms_is_shouted_at_the_second_ctrl_c(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, job: Path
) -> None:
    process = start_gve("send", job)
    gve_line.until(lambda unit: len(unit.taken) > 200)
    unit.mute = True

    status, told = end(process, signal.SIGINT, signal.SIGINT)

    assert status == 3
    assert "STOP NOT CONFIRMED: the tool was ended before the unit had confirmed the stop" in told
    assert "USE THE EMERGENCY STOP" in told
    assert "Traceback" not in told
    assert any(each == "H" for each in unit.done)


def test_a_line_that_is_gone_leaves_the_motion_unknown_and_says_so(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, job: Path
) -> None:
    process = start_gve("send", job)
    gve_line.until(lambda unit: len(unit.taken) > 200)
    gve_line.close()

    status, told = end(process)

    assert status == 3
    assert "closed the connection" in told
    assert "whether the axes move is NOT KNOWN" in told


def test_a_signal_during_the_wait_for_the_axes_halts_them(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    unit.vector_s = 1000.0
    path = tmp_path / "a.gve"
    path.write_text("C1\nC2\n")
    process = start_gve("send", path)
    gve_line.until(lambda unit: unit.done.count("SR6") > 3)

    status, told = end(process, signal.SIGINT)

    assert status == 130
    assert "interrupted after 2 of 2 vectors" in told
    assert unit.inta


def test_a_signal_halts_a_reference_run(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.home_s = 1000.0
    process = start_gve("home", "X", "-20000", "1000", "20", "500")
    gve_line.until(lambda unit: unit.home_end < 1e9)

    status, told = end(process, signal.SIGINT)

    assert status == 130
    assert unit.inta
    assert "the axes stand at" in told
    assert "confirmed by the unit; " + SPINDLE in told


def test_a_signal_halts_a_jog_and_deletes_the_rest(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.vector_s = 1000.0
    process = start_gve("jog", "X100000")
    gve_line.until(lambda unit: unit.moves)

    status, told = end(process, signal.SIGTERM)

    assert status == 130
    assert not unit.queue
    assert not unit.inta
    assert "the axes stand at X 0  Y 0  Z 0  A 0; at rest; confirmed by the unit; " in told
    assert SPINDLE in told


def test_input_that_ends_lets_go_of_a_held_jog(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.vector_s = 1000.0
    process = start_gve("jog", "X100000", "--hold")
    gve_line.until(lambda unit: unit.moves)

    out, _ = process.communicate(input="", timeout=PATIENCE_S)

    assert process.returncode == 0
    assert "the axes stand at" in out
    assert not unit.queue


def test_a_signal_ends_a_watch_in_order(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    process = start_gve("watch", "--interval", "0.4")
    gve_line.until(lambda unit: unit.done.count("P4") > 2)

    assert end(process, signal.SIGINT) == (0, "")
    assert "H" not in unit.done


def test_a_halt_that_is_ended_before_it_is_confirmed_is_shouted(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.mute = True
    process = start_gve("halt")
    gve_line.until(lambda unit: "H" in unit.done)
    assert process.stderr is not None
    first = process.stderr.readline()
    assert "where the axes do not brake, use the emergency stop" in first

    status, told = end(process, signal.SIGINT)

    assert status == 3
    assert "STOP NOT CONFIRMED: the tool was ended before" in told


def test_a_restart_while_a_job_is_stopped_is_told(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    unit.vector_s = 1000.0
    path = tmp_path / "a.gve"
    path.write_text("C1\n;@wait 1000\n")
    process = start_gve("send", path)
    gve_line.until(lambda unit: unit.moves)
    time.sleep(0.3)
    with gve_line.lock:
        unit.restart()

    status, told = end(process, signal.SIGINT)

    assert status == 130
    assert "the unit HAS RESTARTED, its positions count anew; the axes stand" in told


def test_a_halt_tells_that_another_program_has_switched_checksums_off_and_no_restart(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    unit.vector_s = 1000.0
    path = tmp_path / "a.gve"
    path.write_text("!7V400\nC1\n;@wait 1000\n")
    process = start_gve("send", path)
    gve_line.until(lambda unit: unit.moves)
    time.sleep(0.3)
    with gve_line.lock:
        unit.take(encoded("%-", sums=True))

    status, told = end(process, signal.SIGINT)

    assert status == 130
    assert "another program has switched its checksums off; the axes stand at X" in told
    assert "whether the spindle turns is NOT KNOWN (gve134 spindle 0 stops it)" in told
    assert "RESTARTED" not in told
    assert "restart" not in told
    assert unit.ports["spindle"] == 400


SPINDLE = "whether the spindle turns is NOT KNOWN, the unit cannot be asked (gve134 spindle 0"


def test_a_run_that_takes_longer_than_it_can_is_halted(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.home_s = 1000.0
    process = start_gve("home", "X", "1", "10", "1", "10")

    status, told = end(process)

    assert status == 3
    assert unit.inta
    assert "it is NOT KNOWN whether the axes move; halting ..." in told
    assert "the axes stand at X 0  Y 0  Z 0  A 0; stopped, nothing waits" in told
    assert "confirmed by the unit" in told
    assert SPINDLE in told
    assert "STOP NOT CONFIRMED" not in told


MOVING = [("jog", "X100000"), ("home", "X", "-20000", "1000", "20", "500")]


@pytest.mark.parametrize("command", MOVING)
def test_a_line_that_breaks_in_a_motion_is_shouted_with_the_spindle(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, command: tuple[str, ...]
) -> None:
    unit.vector_s = unit.home_s = 1000.0
    process = start_gve(*command)
    gve_line.until(lambda unit: unit.moves or unit.home_end < 1e9)
    gve_line.close()

    status, told = end(process)

    assert status == 3
    assert "it is NOT KNOWN whether the axes move; halting ..." in told
    assert "STOP NOT CONFIRMED: " in told
    assert "USE THE EMERGENCY STOP" in told
    assert SPINDLE in told
    assert "Traceback" not in told


@pytest.mark.parametrize("command", MOVING)
def test_a_unit_that_restarts_in_a_motion_is_told_with_the_spindle(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, command: tuple[str, ...]
) -> None:
    unit.vector_s = unit.home_s = 1000.0
    process = start_gve(*command)
    gve_line.until(lambda unit: unit.moves or unit.home_end < 1e9)
    with gve_line.lock:
        unit.restart()

    status, told = end(process)

    assert status == 3
    assert "HAS RESTARTED" in told
    assert "the restart has switched the spindle off" in told


def test_an_interrupt_in_a_jog_is_told_with_place_and_spindle(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.vector_s = 1000.0
    process = start_gve("jog", "X100000")
    gve_line.until(lambda unit: unit.moves)
    with gve_line.lock:
        unit.interrupt(1)

    status, told = end(process)

    assert status == 1
    assert "INTERRUPTED by RefX, its rest is deleted; the axes stand at X 0  Y 0  Z 0  A 0" in told
    assert "at rest; confirmed by the unit" in told
    assert SPINDLE in told
    assert not unit.queue


@pytest.mark.parametrize("halts", [False, True])
def test_a_jog_whose_rest_cannot_be_deleted_says_that_it_waits(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve, halts: bool
) -> None:
    unit.vector_s, unit.codes["D"] = 1000.0, 7
    process = start_gve("jog", "X100000")
    gve_line.until(lambda unit: unit.moves)
    if not halts:
        with gve_line.lock:
            unit.interrupt(1)

    status, told = end(process, *([signal.SIGINT] if halts else []))

    assert status == (3 if halts else 1)
    assert "; ITS REST MAY WAIT, and gve134 go would make it: gve134 delete" in told
    assert unit.queue


def test_a_jog_that_does_not_hear_of_its_unit_for_long_is_halted_and_its_rest_deleted(
    start_gve: Start, gve_line: FakeGveLine, unit: FakeGve
) -> None:
    unit.vector_s = 1000.0
    process = start_gve("jog", "X100000")
    gve_line.until(lambda unit: unit.moves)
    with gve_line.lock:
        unit.faults.extend([lost] * 5)

    status, told = end(process)

    assert status == 3
    assert "it is NOT KNOWN whether the axes move; halting ..." in told
    assert "at rest; confirmed by the unit" in told
    assert not unit.queue


@pytest.mark.parametrize("words", ["home X 5 10 1 10", "jog X5", "send no.gve"])
def test_an_end_before_anything_moves_is_not_taken_for_a_halt(
    gve: Any, monkeypatch: pytest.MonkeyPatch, words: str
) -> None:
    name, *rest = words.split()

    def end(options: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setitem(RUNS, name, end)
    result = gve(name, *rest)

    assert result.status == 130
    assert result.err == f"gve134: {name} was ended while it moved nothing: no halt was sent\n"


class Typist:
    """A console on a terminal."""

    def __init__(self, tmp_path: Path) -> None:
        self._master, slave = pty.openpty()
        root = Path(__file__).resolve().parents[2]
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", "rkm04_tools.gve134", "console"],
            stdin=slave, stdout=slave, stderr=slave, cwd=tmp_path, start_new_session=True,
            env={**os.environ, "PYTHONPATH": str(root / "tools")},
        )  # fmt: skip
        os.close(slave)
        self.shown = ""

    def type(self, text: str) -> None:
        os.write(self._master, text.encode())

    def until(self, text: str) -> None:
        """Read up to a text that has not been read before."""
        end = time.monotonic() + PATIENCE_S
        while text not in self.shown:
            assert select.select([self._master], [], [], end - time.monotonic())[0], self.shown
            self.shown += os.read(self._master, 4096).decode()
        self.shown = self.shown.partition(text)[2]

    def close(self) -> int:
        self.until("> ")  # what is typed before is not for the line editor
        self.type("\x04")
        status = self.process.wait(PATIENCE_S)
        os.close(self._master)
        return status


def test_ctrl_c_in_a_console_halts_and_the_console_goes_on(
    gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    unit.vector_s = 1000.0
    console = Typist(tmp_path)
    console.until("> ")
    console.type("L1000\n")
    console.until("0  done")

    console.process.send_signal(signal.SIGINT)
    console.until("the axes stand at X 0")
    console.type("D\nP4\n")
    console.until("0,0,0,0,0  done")

    assert console.close() == 0
    assert not unit.queue


def test_tab_completes_the_commands_of_the_unit_in_a_console(
    gve_line: FakeGveLine, tmp_path: Path
) -> None:
    console = Typist(tmp_path)
    console.until("Tab completes")
    console.until("> ")

    console.type("x\t")
    console.until("XA  XD  XM  XU")
    console.type("m\t200\n")
    console.until("0  done")
    console.type("!7v300\n")
    console.until("0  done")

    assert console.close() == 0


def test_a_request_to_end_halts_and_ends_a_console(
    gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    unit.vector_s = 1000.0
    console = Typist(tmp_path)
    console.until("> ")
    console.type("L1000\n")
    console.until("0  done")

    console.process.send_signal(signal.SIGTERM)
    console.until("the axes stand at X 0")

    assert console.process.wait(PATIENCE_S) == 130
    assert unit.inta


def test_what_is_typed_while_nobody_answers_is_never_sent(
    gve_line: FakeGveLine, unit: FakeGve, tmp_path: Path
) -> None:
    console = Typist(tmp_path)
    console.until("> ")
    unit.mute = True
    console.type("V500\n")
    time.sleep(0.3)
    console.type("L1\nL2\nL3\n")
    console.until("does not answer")
    unit.mute = False
    console.until("> ")
    console.type("P4\n")
    console.until("0,0,0,0,0  done")

    assert console.close() == 0
    assert unit.taken == []
