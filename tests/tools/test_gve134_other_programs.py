"""What other programs do at the same unit is noticed, and told as what it is."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve
from gve134_ports import Ends, FakeGveLine, VirtualPort
from gve_desk import GveDesk
from rkm04_tools import holding
from rkm04_tools.gve134.answers import encoded
from rkm04_tools.gve134.job import job_of
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.link_errors import OutOfStep, SumsOff
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.line_errors import PortBusy
from rkm04_tools.service import turns
from rkm04_tools.source import Source

BAUD = 115_200
CHAIN = "L0,0,0,0\nV500\n" + "C10,20\n" * 400 + ";@wait 0.1\nC0,0,1\n"


@pytest.fixture
def unit() -> FakeGve:
    return FakeGve(vector_s=0.01)


@pytest.fixture
def gve_unit(unit: FakeGve) -> FakeGve:
    return unit


@pytest.fixture
def link(unit: FakeGve) -> Link:
    port = Ends(unit)
    link = Link(Wire(port, BAUD, clock=port.clock))
    link.connect()
    return link


@pytest.fixture
def server(unit: FakeGve) -> Iterator[FakeGveLine]:
    server = FakeGveLine(unit)
    yield server
    server.close()


@pytest.fixture
def desk(server: FakeGveLine, monkeypatch: pytest.MonkeyPatch) -> Iterator[GveDesk]:
    monkeypatch.setattr(turns, "LOOK_AGAIN_SECONDS", 0.2)
    desk = GveDesk(server.port)
    desk.connected()
    yield desk
    desk.close()


def start(desk: GveDesk) -> int:
    number = desk.say("start", file=desk.open("a.gve", CHAIN))
    desk.phase("sending")
    return number


# ---- the line ----


def test_checksums_that_another_program_has_switched_off_are_no_restart(
    link: Link, unit: FakeGve
) -> None:
    for _ in range(100):
        link.ask("P")
    unit.take(encoded("%-", sums=True))

    with pytest.raises(SumsOff, match="another program has switched its checksums off"):
        link.ask("G")
    assert link.ask("P").code == 0
    unit.take(encoded("%-", sums=True))
    link.halt()
    assert (link.restarted, link.others) == (
        False,
        "another program has switched its checksums off",
    )


def test_where_a_restart_cannot_be_told_from_another_program_that_is_said(
    link: Link, unit: FakeGve
) -> None:
    unit.index = 250
    link.connect()
    unit.restart()

    with pytest.raises(OutOfStep, match="or was restarted"):
        link.ask("G")


def test_commands_of_another_program_are_found_when_that_is_asked_for(
    link: Link, unit: FakeGve
) -> None:
    link.ask("V50")
    link.require_own()
    unit.take(encoded("V60", sums=True))

    with pytest.raises(OutOfStep):
        link.require_own()
    assert unit.modal["V"] == "60"


@pytest.mark.parametrize("asks", ["wait 2.5", "pause put in tool 2"])
def test_what_another_program_has_sent_while_the_host_waited_ends_the_job(asks: str) -> None:
    unit = FakeGve(vector_s=0.5)
    port = VirtualPort(unit)
    job = job_of(Source("a.gve", f"C1\n;@{asks}\nC3\n"))
    sending = Sender(Unit(Link(Wire(port, BAUD, clock=port.clock))), job)
    stranger = encoded("L640,0,0,0", sums=True)
    sending.ask_person = lambda _: unit.take(stranger)
    read = port.read

    def reading(seconds: float) -> bytes:
        if "wait" in asks and port.now > 1.5 and (640, 0, 0, 0) not in unit.taken:
            unit.take(stranger)
        return read(seconds)

    port.read = reading  # type: ignore[method-assign]

    with pytest.raises(OutOfStep):
        sending.send()
    assert unit.taken == [(1, 0, 0, 0), (640, 0, 0, 0)]


# ---- commands that read or halt ----


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("command", ["position", "status", "halt"])
def test_what_only_reads_or_halts_leaves_checksums_as_they_are_without_them(
    gve: Any, gve_line: FakeGveLine, unit: FakeGve, command: str, sums: bool
) -> None:
    unit.receiver.sums = sums

    assert gve(command, "--no-sums").status == 0
    assert unit.receiver.sums == sums


# ---- the page ----


def stranger(server: FakeGveLine, command: str) -> None:
    """Another program sends something that the unit takes."""
    with server.lock:
        server.unit.take(encoded(command, sums=True))


def test_checksums_that_another_program_switches_off_end_the_job_and_are_no_restart(
    desk: GveDesk, server: FakeGveLine, unit: FakeGve
) -> None:
    unit.vector_s = 0.1
    desk.ask("spindle", permille=400)
    number = start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    stranger(server, "%-")
    told = desk.answer(number)

    assert unit.run
    assert "another program has switched its checksums off" in told["error"]["cause"]
    assert "whether the axes move is NOT KNOWN" in told["error"]["next"]
    assert desk.now["job"]["phase"] == "failed"
    assert not desk.now["restarted"]
    assert desk.state(lambda m: m["error"] is None)["known"]["spindle"] is None


def test_a_job_that_was_halted_does_not_go_on_where_another_program_has_used_the_unit(
    desk: GveDesk, server: FakeGveLine, unit: FakeGve
) -> None:
    start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    desk.ask("halt")
    stranger(server, "V600")
    taken = len(unit.taken)

    assert "counted commands that were not sent from here" in desk.ask("go")["error"]["cause"]
    assert desk.now["job"]["phase"] == "failed"
    assert len(unit.taken) == taken
    assert not unit.moves


def test_a_job_that_another_one_has_halted_goes_on(
    desk: GveDesk, server: FakeGveLine, unit: FakeGve
) -> None:
    number = start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    stranger(server, "H")
    assert "INTERRUPTED by H" in desk.answer(number)["error"]["cause"]
    stranger(server, "P4")

    assert "402 vectors made" in desk.ask("go")["text"]


def test_halting_a_motion_by_hand_tells_that_nothing_waits_any_more(
    desk: GveDesk, unit: FakeGve
) -> None:
    unit.vector_s = 100.0
    desk.ask("jog", parts=[1000, 0, 0, 0], speed=500)

    told = desk.ask("halt")["text"]
    assert "confirmed by the unit" in told
    assert "waits" not in told
    assert not unit.queue


@pytest.mark.parametrize("text", ["SW6,00", "!0L5", "g", "D", "NX0", "J"])
def test_nothing_is_typed_that_a_job_which_was_halted_would_not_know_of(
    desk: GveDesk, unit: FakeGve, text: str
) -> None:
    start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    desk.ask("halt")
    waits, done = len(unit.queue), len(unit.done)

    assert "a.gve is not done" in desk.ask("typed", text=text)["error"]["cause"]
    assert len(unit.queue) == waits
    assert not {"G", "D", "J", "SW6,00", "NX0", "L5,0,0,0"} & set(unit.done[done:])


# ---- who has the line ----


def test_no_command_moves_axes_beside_a_page(
    desk: GveDesk, server: FakeGveLine, unit: FakeGve, gve: Any
) -> None:
    refused = gve("jog", "X640", "--port", server.port)
    spelt = gve("jog", "X640", "--port", server.port.replace("127.0.0.1", "localhost"))

    assert (refused.status, spelt.status) == (3, 3)
    assert "has this line" in refused.complaint
    assert unit.taken == []
    desk.ask("disconnect")
    assert gve("delete", "--port", server.port).status == 0


def test_a_page_does_not_connect_beside_a_command(desk: GveDesk, server: FakeGveLine) -> None:
    desk.ask("disconnect")
    with holding.held(server.port, "gve134", ""):
        error = desk.ask("connect", port=server.port)["error"]
    assert error["kind"] == "PortBusy"
    assert "the command" in error["cause"]
    assert "has this line" in error["cause"]
    assert desk.ask("connect", port=server.port)["error"] is None


def test_a_line_is_the_same_however_its_port_is_spelt(tmp_path: Path) -> None:
    link = tmp_path / "unit"
    link.symlink_to("/dev/null")
    place = holding.place_of("socket://127.0.0.1:5000")

    for spelt in (
        "localhost:5000",
        "LOCALHOST:5000/",
        "127.0.0.1:05000",
        "[::1]:5000",
        "0.0.0.0:5000",
    ):
        assert holding.place_of(f"socket://{spelt}") == place
    assert holding.place_of("SOCKET://127.0.0.1:5000") == place
    assert holding.place_of(str(link)) == "/dev/null"
    assert holding.place_of("socket://127.0.0.1:5001") != place
    with holding.held("socket://localhost:5000", "gve134", ""), pytest.raises(PortBusy):
        holding.held("socket://127.0.0.1:5000", "gve134", "").__enter__()


def test_a_device_that_another_program_has_is_not_said_to_be_had_by_the_command_itself(
    gve: Any,
) -> None:
    master, slave = pty.openpty()
    try:
        place = os.ttyname(slave)
        with serial_open(place):
            told = gve("position", "--port", place)
        assert told.status == 3
        assert f"{place}: another program has this line" in told.complaint
    finally:
        os.close(master)
        os.close(slave)


def serial_open(place: str) -> Any:
    import serial

    return serial.Serial(place, exclusive=True)


# ---- a halt that is ended ----


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_halt_that_a_signal_ends_is_shouted(
    start_gve: Callable[..., subprocess.Popen[str]],
    gve_line: FakeGveLine,
    number: signal.Signals,
) -> None:
    with gve_line.lock:
        gve_line.unit.mute = True
    process = start_gve("halt")
    gve_line.until(lambda unit: "H" in unit.done)
    process.send_signal(number)
    _, told = process.communicate(timeout=30)

    assert process.returncode == 3
    assert "STOP NOT CONFIRMED: the tool was ended before the unit had confirmed the stop" in told


def test_a_halt_that_is_ended_while_its_port_is_opened_is_shouted(gve: Any) -> None:
    from rkm04_tools.gve134 import client_base

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(client_base, "open_unit", interrupted)
        told = gve("halt", "--port", "socket://127.0.0.1:1")
    assert told.status == 3
    assert "STOP NOT CONFIRMED" in told.err


def interrupted(*_: Any) -> None:
    raise KeyboardInterrupt
