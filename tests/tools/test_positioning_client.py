"""The commands of `positioning` that talk to a unit, against `serve`."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from pymodbus.framer import FramerRTU
from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import GarbledAnswer, NoAnswer
from rkm04_tools.positioning.line_errors import (
    Faulted,
    NotConfirmed,
    Refused,
    RequestRefused,
    Restarted,
    WrongUnit,
)
from rkm04_tools.positioning.listing import places
from rkm04_tools.positioning.table import Register
from rkm04_tools.positioning.unit import Unit, open_unit
from served import POSITIONING_COMMAND, Served

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_SECONDS = 15.0
Tool = Callable[..., Any]
Serve = Callable[..., Served]


@pytest.fixture
def unit(pos_serve: Serve) -> Iterator[Unit]:
    """A unit that answers well."""
    with open_unit(pos_serve().place) as opened:
        yield opened


@pytest.fixture
def began(tmp_path: Path) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start a command as a process of its own."""
    started: list[subprocess.Popen[str]] = []

    def begin(*arguments: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-P", "-m", "rkm04_tools.positioning", *arguments]
        pipe = subprocess.PIPE
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
        started.append(
            subprocess.Popen(
                command, stdout=pipe, stderr=pipe, text=True, cwd=tmp_path, env=environment
            )
        )
        return started[-1]

    yield begin
    for process in started:
        process.kill()
        process.communicate()


def until(reached: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_SECONDS
    while not reached():
        assert time.monotonic() < end
        time.sleep(0.01)


# ---- the commands -------------------------------------------------------------------------------


def test_an_axis_is_moved_step_by_step(pos_call: Callable[..., str]):
    assert pos_call("init", "--axis", "2") == "axis 2: 0.000 mm, TAKEN\n"
    assert pos_call("mode", "3", "--axis", "2", "--accel", "400") == "axis 2: 0.000 mm, READY\n"
    assert "MOVING" in pos_call("feed", "6", "--axis", "2")
    assert "READY" in pos_call("hold", "--axis", "2")
    assert "MOVING" in pos_call("go", "--axis", "2")
    pos_call("feed", "3000", "--axis", "2")
    until(lambda: "REACHED" in pos_call("status"))
    assert pos_call("reset", "--axis", "2") == "axis 2: 3.000 mm, FREE\n"


def test_a_move_takes_the_axis_and_waits(pos_call: Callable[..., str]):
    assert pos_call("move", "10", "--feed", "3000") == "axis 1: 10.000 mm, REACHED\n"
    told = json.loads(pos_call("move", "-2.5", "--feed", "3000", "--abs", "--json"))
    assert (told["position_mm"], told["state"], told["position_steps"]) == (-2.5, "REACHED", -250)


def test_home_here_sets_the_position(pos_call: Callable[..., str]):
    assert pos_call("home", "--method", "37", "--position", "5") == "axis 1: 5.000 mm, REACHED\n"


def test_status_tells_of_the_unit_and_its_axes(pos_call: Callable[..., str]):
    told = json.loads(pos_call("status", "--json"))

    assert (told["node"], told["version"], told["start_cause"]) == (1, "1.00", "power")
    assert [axis["state"] for axis in told["axes"]] == ["FREE"] * 4
    assert "unit 1, version 1.00\n" in pos_call("status")


def test_watch_looks_as_often_as_asked(pos_call: Callable[..., str]):
    lines = pos_call("watch", "--count", "2", "--interval", "0.01").splitlines()

    assert len(lines) == 2
    assert all("axis 4: 0.000 mm, FREE" in line for line in lines)


def test_a_unit_as_fast_as_possible_answers_too(positioning: Tool, pos_serve: Serve):
    port = ["--port", pos_serve(speed="0").place]

    assert positioning("move", "1", *port).out == "axis 1: 1.000 mm, REACHED\n"
    assert positioning("settings", "set", "BACKLASH=5", "--store", *port).status == 1
    assert positioning("reset", *port).status == 0
    assert positioning("settings", "set", "BACKLASH=5", "--store", *port).status == 0


def test_scan_finds_every_unit(positioning: Tool, pos_serve: Serve):
    served = pos_serve("--node", "3", "--node", "7")

    result = positioning("scan", "--port", served.place, "--json")
    assert [each["node"] for each in result.json["units"]] == [3, 7]


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["mode", "5"], "error 3: the axis is not taken"),
        (["feed", "5"], "axis 1 is not taken: init comes first"),
        (["home", "--method", "19"], "error 12: the input for it is not set"),
    ],
)
def test_what_is_refused_ends_with_1(
    positioning: Tool, pos_serve: Serve, arguments: list[str], why: str
):
    result = positioning(*arguments, "--port", pos_serve().place)

    assert result.status == 1
    assert why in result.complaint


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["status", "--node", "17"], "--node 17"),
        (["status", "--node", "x"], "--node x: write an address"),
        (["init", "--axis", "5"], "axis 5"),
        (["init", "--space", "7"], "space 7: write 0 to 6"),
        (["init", "--space", "-1"], "space -1: write 0 to 6"),
        (["init", "--space", "65536"], "space 65536: write 0 to 6"),
        (["move", "0.0004"], "0.0004 mm: it would be none"),
        (["move", "5", "--feed", "0"], "more than 0"),
        (["move", "5", "--accel", "0"], "write an acceleration"),
        (["move", "5e9"], "up to 2147483.647 mm"),
        (["move", "nan"], "up to 2147483.647 mm"),
        (["move", "5", "--feed", "nan"], "write a feed"),
        (["home", "--method", "37", "--position", "inf"], "up to 2147483.647 mm"),
        (["mode", "inf"], "up to 2147483.647 mm"),
        (["feed", "70000"], "write a feed"),
        (["feed", "nan"], "write a feed"),
        (["settings", "get", "FOO"], "no such setting"),
        (["settings", "set", "STEPS"], "write STEPS=VALUE"),
        (["settings", "set", "RATE=100"], "write RATE=VALUE"),
    ],
)
def test_wrong_usage_ends_with_2(
    positioning: Tool, pos_serve: Serve, arguments: list[str], why: str
):
    place = pos_serve().place
    result = positioning(*arguments, "--port", place)

    assert result.status == 2
    assert why in result.complaint
    with open_unit(place) as unit:
        assert not any(unit.axis(number).read().is_taken for number in range(1, 5))


def test_the_slowest_feed_is_no_standstill(unit: Unit):
    axis = unit.axis(1)
    axis.init()
    axis.mode(1.0, 500)

    assert axis.control(feed=1e-9).is_programmed
    assert unit.wire.read(106, 2) == [0, 1]


def test_the_example_moves_there_and_back_started_as_its_text_says(pos_serve: Serve):
    environment = {**os.environ, "PYTHONPATH": "tools", "POSITIONING_PORT": pos_serve().place}
    del environment["RKM04_BUILD"]
    example = "tools/examples/positioning/first_move.py"

    done = subprocess.run(
        [sys.executable, example], cwd=ROOT, env=environment, capture_output=True, text=True
    )

    assert (done.stdout, done.stderr) == (
        "axis 1 stands at 10.0 mm\naxis 1 stands at 0.0 mm\n", "",
    )  # fmt: skip


def test_modbus_tcp_and_a_pty_are_ports_too(positioning: Tool, pos_serve: Serve, tmp_path: Path):
    places = [pos_serve(place="--modbus-tcp").place]
    pty = Served("--pty", "unit", cwd=tmp_path, command=POSITIONING_COMMAND)
    try:
        for port in [*places, str(tmp_path / "unit")]:
            result = positioning("move", "1", "--feed", "3000", "--port", port)
            assert result.out == "axis 1: 1.000 mm, REACHED\n", result
    finally:
        pty.end()


# ---- every register -----------------------------------------------------------------------------


def samples(row: Register) -> list[int]:
    """Values at the bounds of a register that is kept as it is written."""
    if row.form == "RATE":
        return [96, 1152, 192]
    if row.form == "FACTOR":
        return [row.start]
    if row.form == "ANY":
        return [row.all_values[0], row.all_values[-1], row.start]
    return [row.least, row.most, row.start]


def test_every_setting_is_written_and_read_back(unit: Unit):
    for place in places():
        row = place.register
        if row.is_setting:
            for value in samples(row):
                unit.set(row.name, value, place.axis)
                assert unit.get(row.name, place.axis) == value


def test_every_register_reads_and_only_those_that_can_be_written_are(unit: Unit):
    for place in places():
        row = place.register
        words = unit.wire.read(place.number, row.words)
        if row.access == "r":
            with pytest.raises(RequestRefused, match="exception 2"):
                unit.wire.write(place.number, words)
        elif row.name != "STORE":
            unit.wire.write(place.number, words)
            assert unit.wire.read(place.number, row.words) == words


# ---- what goes wrong ----------------------------------------------------------------------------


def test_every_instruction_is_done_once_on_a_bad_line(pos_serve: Serve):
    served = pos_serve("--noise", "3000", "--loss", "3000", "--seed", "5", speed="20")
    with open_unit(served.place) as unit:
        unit.wire.tries = 30
        axis = unit.axis(1)
        axis.init()
        for _ in range(10):
            axis.move(1.0, 6000, 2000)
        assert axis.read().position_steps == 1000
        assert unit.wire.counts.repeats > 0


def test_an_instruction_that_is_repeated_moves_once(unit: Unit):
    axis = unit.axis(1)
    axis.init()
    word = 77 << 8 | 2
    for _ in range(5):
        found, _ = unit.wire.write_and_read(100, [word, 0, 0, 1000, 500, 1, 3000, 0], 110, 18)
        assert found[2] == word
        unit.axis(1).wait()
    assert axis.read().position_um == 1000


@pytest.mark.parametrize(("later_ms", "told"), [(1 << 20, "HAS RESTARTED"), (0, "given it back")])
def test_what_is_refused_as_the_axis_is_free_again_tells_why(
    unit: Unit, monkeypatch: pytest.MonkeyPatch, later_ms: int, told: str
):
    axis = unit.axis(1)
    axis.init()
    write_and_read = unit.wire.write_and_read

    def freed(*asked: Any) -> Any:
        monkeypatch.undo()
        unit.axis(1).reset()
        unit._uptime_ms = (unit._uptime_ms or 0) + later_ms
        return write_and_read(*asked)

    monkeypatch.setattr(unit.wire, "write_and_read", freed)
    with pytest.raises(Failure, match=told):
        axis.mode(1.0, 500)


def test_a_restarted_unit_is_told(pos_serve: Serve, tmp_path: Path):
    class Relay(threading.Thread):
        """Where the unit is reached, whichever one it is."""

        def __init__(self) -> None:
            super().__init__(daemon=True)
            self.listener = socket.create_server(("127.0.0.1", 0))
            self.other: socket.socket | None = None
            self.to(pos_serve().place)
            self.start()

        def to(self, place: str) -> None:
            host, _, port = place.removeprefix("socket://").rpartition(":")
            if self.other:
                self.other.close()
            self.other = socket.create_connection((host, int(port)))
            time.sleep(0.2)

        def run(self) -> None:
            client, _ = self.listener.accept()
            with client, contextlib.suppress(OSError):
                while data := client.recv(1000):
                    assert self.other
                    self.other.sendall(data)
                    self.other.settimeout(0.2)
                    with contextlib.suppress(TimeoutError):
                        while answer := self.other.recv(1000):
                            client.sendall(answer)

    relay = Relay()
    try:
        with open_unit(f"socket://127.0.0.1:{relay.listener.getsockname()[1]}") as unit:
            axis = unit.axis(1)
            axis.init()
            axis.mode(1000.0, 500)
            relay.to(pos_serve().place)
            with pytest.raises(Restarted, match="HAS RESTARTED"):
                axis.mode(5.0, 500)
            assert axis.read().position_steps == 0
    finally:
        relay.join(PATIENCE_SECONDS)
        relay.listener.close()
        if relay.other:
            relay.other.close()


@pytest.fixture
def port() -> Iterator[tuple[str, Callable[[bytes], None]]]:
    """A place where somebody listens who answers always the same, or nothing."""
    said: list[bytes] = [b""]
    listener = socket.create_server(("127.0.0.1", 0))

    def listen() -> None:
        while True:
            try:
                client, _ = listener.accept()
            except OSError:
                return
            with client:
                try:
                    while client.recv(1000):
                        client.sendall(said[0])
                except OSError:
                    continue

    def say(data: bytes) -> None:
        said[0] = data

    thread = threading.Thread(target=listen, daemon=True)
    thread.start()
    yield f"socket://127.0.0.1:{listener.getsockname()[1]}", say
    listener.close()


Place = tuple[str, Callable[[bytes], None]]


def test_a_silent_unit_is_no_connection(positioning: Tool, port: Place):
    result = positioning("status", "--port", port[0])

    assert result.status == 3
    assert "does not answer" in result.complaint
    with open_unit(port[0]) as unit, pytest.raises(NoAnswer):
        unit.read()


def test_noise_is_no_answer(port: Place):
    port[1](b"\1\3\2\0\0\xff\xff" * 3)
    with open_unit(port[0]) as unit, pytest.raises(GarbledAnswer, match="--baud"):
        unit.read()


def test_an_echo_is_no_answer(port: Place):
    port[1](bytes.fromhex("01 2B 0E 01 00 70 77"))
    with open_unit(port[0]) as unit, pytest.raises(NoAnswer, match="only the adapter's echo"):
        unit.read()


def test_another_device_is_told(port: Place):
    frame = bytes([1, 0xAB, 1])
    port[1](frame + FramerRTU.compute_CRC(frame).to_bytes(2, "big"))
    with open_unit(port[0]) as unit, pytest.raises(WrongUnit):
        unit.read()


def test_nobody_listening_is_no_connection(positioning: Tool, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("POSITIONING_PORT", raising=False)
    assert positioning("status").status == 2
    with socket.create_server(("127.0.0.1", 0)) as closed:
        number = closed.getsockname()[1]
    for scheme in ("socket://", "modbus://"):
        result = positioning("status", "--port", f"{scheme}127.0.0.1:{number}")
        assert result.status == 3
        assert f"{scheme}127.0.0.1:{number}: nobody listens" in result.complaint
        wrong = positioning("status", "--port", f"{scheme}127.0.0.1")
        assert f"write {scheme}HOST:PORT" in wrong.complaint


def test_a_unit_that_is_not_there_by_modbus_tcp_is_no_connection(
    positioning: Tool, pos_serve: Serve
):
    served = pos_serve(place="--modbus-tcp")
    result = positioning("status", "--port", served.place, "--node", "9")

    assert result.status == 3
    assert "the gateway tells that the unit does not answer" in result.complaint


def test_a_fault_ends_a_move(pos_serve: Serve):
    served = pos_serve()
    control = served.control()
    with open_unit(served.place) as unit:
        unit.set("LIMIT_PLUS", 3, 1)
        axis = unit.axis(1)
        axis.init()
        axis.mode(100.0, 500)
        axis.control(600, permitted=True)
        control.order("3=1")
        with pytest.raises(Faulted, match="error 7: a limit input"):
            axis.wait()
        with pytest.raises(Refused, match="error 15"):
            axis.mode(-1.0, 500)
        with pytest.raises(Failure, match=r"axis 1 does not go on: error 7.*init comes first"):
            axis.go()


def test_ctrl_c_holds_and_tells_where(pos_serve: Serve, began: Callable[..., Any]):
    served = pos_serve(speed="1")
    process = began("move", "1000", "--feed", "600", "--port", served.place)
    control = served.control()
    control.wait_for("moves", lambda state: state["moving"][0])

    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE_SECONDS)

    assert (process.returncode, out) == (130, "")
    assert "positioning: it stands: axis 1:" in err
    assert "READY; go goes on, reset gives the axis back" in err
    assert not control.order("?")["moving"][0]


def test_a_hold_that_is_not_confirmed_is_shouted(pos_serve: Serve, began: Callable[..., Any]):
    served = pos_serve(speed="1")
    process = began("move", "1000", "--feed", "600", "--port", served.place)
    served.control().wait_for("moves", lambda state: state["moving"][0])
    served.process.send_signal(signal.SIGSTOP)
    try:
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=4 * PATIENCE_SECONDS)
    finally:
        served.process.send_signal(signal.SIGCONT)

    assert process.returncode == 3
    assert "STOP NOT CONFIRMED" in err
    assert "USE THE EMERGENCY STOP" in err


def test_hold_of_a_dumb_unit_is_not_confirmed(port: Place):
    with open_unit(port[0]) as unit:
        unit._known = True
        with pytest.raises(NotConfirmed):
            unit.axis(1).hold()


def test_a_line_that_dies_in_a_move_is_shouted(pos_serve: Serve, began: Callable[..., Any]):
    served = pos_serve(speed="1")
    process = began("move", "1000", "--feed", "600", "--port", served.place)
    served.control().wait_for("moves", lambda state: state["moving"][0])

    served.end(signal.SIGKILL)
    _, err = process.communicate(timeout=PATIENCE_SECONDS)

    assert process.returncode == 3
    assert err.startswith("STOP NOT CONFIRMED: ")


def test_nothing_is_shouted_where_nothing_has_begun(positioning: Tool, port: Place):
    result = positioning("move", "1", "--port", port[0])

    assert result.status == 3
    assert "STOP" not in result.err
