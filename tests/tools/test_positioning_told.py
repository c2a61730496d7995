"""What the commands of `positioning` tell when something is refused, lost or interrupted."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from rkm04_tools.positioning.line_errors import Faulted
from rkm04_tools.positioning.unit import open_unit
from served import Served

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_SECONDS = 15.0
READ, WRITE_AND_READ = 3, 23
UPTIME = 8
Tool = Callable[..., Any]
Serve = Callable[..., Served]
Call = Callable[..., str]


def writes_and_reads(asked: bytes) -> bool:
    """What may act and is asked for at once."""
    return asked[1] == WRITE_AND_READ


class Line:
    """A line to a unit that loses some requests, or to none, that loses all of them."""

    def __init__(self, place: str = "", loses: Callable[[bytes], bool] = writes_and_reads) -> None:
        self._place, self._loses = place, loses
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.place = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"
        self.has_lost = threading.Event()
        threading.Thread(target=self._listen, daemon=True).start()

    def close(self) -> None:
        self._listener.close()

    def _listen(self) -> None:
        with suppress(OSError):
            while True:
                with self._listener.accept()[0] as client, suppress(OSError):
                    self._talk(client)

    def _talk(self, client: socket.socket) -> None:
        while asked := client.recv(1000):
            if not self._place or self._loses(asked):
                self.has_lost.set()
                continue
            host, _, number = self._place.removeprefix("socket://").rpartition(":")
            with socket.create_connection((host, int(number)), timeout=0.2) as unit:
                unit.sendall(asked)
                with suppress(TimeoutError):
                    while answer := unit.recv(1000):
                        client.sendall(answer)


@pytest.fixture
def silent() -> Iterator[Line]:
    """A line where nobody answers."""
    line = Line()
    yield line
    line.close()


@pytest.fixture
def losing(pos_serve: Serve) -> Iterator[Line]:
    """A line to a unit that reads, and loses what is to be done."""
    line = Line(pos_serve().place)
    yield line
    line.close()


# ---- refused ------------------------------------------------------------------------------------


def test_a_measure_that_a_fault_forbids_is_told_with_the_fault(pos_call: Call, positioning: Tool):
    pos_call("settings", "set", "WATCHDOG=10")
    pos_call("init")
    time.sleep(0.1)

    told = positioning("mode", "5").complaint
    assert "POS_MODE was refused: error 15: there was a fault: init comes first (error 8: " in told
    assert "or reset first, and then move or home" in told


def test_a_limit_that_is_active_at_the_start_is_told_as_that(pos_call: Call, positioning: Tool):
    pos_call("settings", "set", "LIMIT_MINUS=-3")

    result = positioning("move", "--", "-5")
    assert result.status == 1
    assert result.complaint == (
        "positioning: axis 1: the measure was ended by error 7: a limit input is active; it stands "
        "at 0.000 mm; go the other way, or leave the switch by hand; init comes before the next one"
    )
    pos_call("init")
    assert pos_call("move", "5", "--feed", "3000").startswith("axis 1: 5.000 mm, REACHED")


def test_a_fault_is_told_when_the_axis_stands(pos_serve: Serve):
    served = pos_serve(speed="1")
    control = served.control()
    with open_unit(served.place) as unit:
        unit.set("LIMIT_PLUS", 3, 1)
        axis = unit.axis(1)
        axis.init()
        axis.mode(1000.0, 100)
        axis.control(6000, permitted=True)
        control.wait_for("is fast", lambda state: state["positions"][0] > 3000)
        control.order("3=1")
        control.wait_for("brakes", lambda _: axis.read().has_fault)
        with pytest.raises(Faulted, match="it brakes at"):
            axis.control(100)
        with pytest.raises(Faulted) as told:
            axis.wait()
        assert f"it stands at {axis.read().position_um / 1000:.3f} mm" in str(told.value)


def test_a_feed_before_a_measure_is_told_what_is_missing(pos_call: Call, positioning: Tool):
    pos_call("init")

    told = positioning("feed", "5").complaint
    assert "axis 1 is TAKEN, and takes no feed before a measure: mode gives one" in told


def test_the_address_comes_from_the_environment(
    positioning: Tool, pos_serve: Serve, monkeypatch: pytest.MonkeyPatch
):
    port = ("--port", pos_serve("--node", "3", "--node", "7").place)
    monkeypatch.setenv("POSITIONING_NODE", "7")

    assert positioning("status", "--json", *port).json["node"] == 7
    assert positioning("status", "--json", "--node", "3", *port).json["node"] == 3
    monkeypatch.setenv("POSITIONING_NODE", "seven")
    assert positioning("status", *port).status == 2
    assert "POSITIONING_NODE seven: write an address" in positioning("status", *port).complaint


# ---- lost and interrupted -----------------------------------------------------------------------


@pytest.mark.parametrize("stop", [["reset"], ["feed", "0"], ["hold"]])
def test_a_stop_that_nobody_answers_is_shouted(positioning: Tool, silent: Line, stop: list[str]):
    result = positioning(*stop, "--port", silent.place)

    assert (result.status, result.out) == (3, "")
    assert "STOP NOT CONFIRMED: " in result.err
    assert "USE THE EMERGENCY STOP" in result.err


def test_an_instruction_that_is_lost_may_have_been_done(positioning: Tool, losing: Line):
    result = positioning("init", "--port", losing.place)

    assert result.status == 3
    assert "NOT CONFIRMED: whether init was done: " in result.complaint


def test_a_silent_line_leaves_nothing_in_doubt(positioning: Tool, silent: Line):
    assert "NOT CONFIRMED" not in positioning("init", "--port", silent.place).complaint


def interrupted(arguments: list[str], line: Line) -> tuple[int, str]:
    """Ctrl-C while a request is not answered: the exit status, and what is told."""
    line.has_lost.clear()
    command = [sys.executable, "-P", "-m", "rkm04_tools.positioning", *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
    process = subprocess.Popen(
        [*command, "--port", line.place],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
    )  # fmt: skip
    try:
        assert line.has_lost.wait(PATIENCE_SECONDS)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE_SECONDS)
    finally:
        process.kill()
        process.communicate()
    assert out == ""
    return process.returncode, err


def test_ctrl_c_before_a_move_tells_that_nothing_was_sent(silent: Line):
    told = "positioning: interrupted; nothing was sent that takes or moves the axis\n"
    assert interrupted(["move", "5"], silent) == (130, told)


def test_ctrl_c_in_a_move_that_has_only_looked_tells_it_too(pos_serve: Serve):
    told = "positioning: interrupted; nothing was sent that takes or moves the axis\n"
    line = Line(pos_serve().place, lambda asked: asked[1] == READ and asked[3] == UPTIME)
    try:
        assert interrupted(["move", "5"], line) == (130, told)
    finally:
        line.close()


def test_ctrl_c_in_an_instruction_tells_what_is_not_known(losing: Line):
    status, err = interrupted(["init"], losing)

    assert status == 130
    assert "NOT CONFIRMED: whether init was done: interrupted; positioning status" in err


def test_ctrl_c_in_a_stop_is_shouted(silent: Line):
    for stop in (["reset"], ["hold"]):
        status, err = interrupted(stop, silent)
        assert status == 130
        assert "STOP NOT CONFIRMED: the tool was ended before" in err
