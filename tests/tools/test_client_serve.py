"""The commands and the library against the virtual unit: the firmware itself, in real time."""

from __future__ import annotations

import re
import signal
import time

import pytest
from frames import frame
from noisy_line import NoisyLine
from rkm04_tools.line import Wait, open_line
from rkm04_tools.line_errors import LineError, UnitRefused, UnitRestarted
from rkm04_tools.messages import SET_COMMAND, request
from served import Served

LISTENING = re.compile(r"listening on (socket://127\.0\.0\.1:\d+)")
NODE = 3


@pytest.fixture
def serve(start):
    """Start virtual units; return their port."""
    processes = []

    def begin(*arguments: str) -> str:
        process = start("serve", "--tcp", "0", *arguments)
        processes.append(process)
        assert process.stdout is not None
        for line in process.stdout:
            if match := LISTENING.search(line):
                return match[1]
        _, err = process.communicate(timeout=10)
        if "invalid choice: 'serve'" in err:
            pytest.skip("this build has no rkm04 serve")
        raise AssertionError(err)

    yield begin
    for process in processes:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=10)


@pytest.fixture
def port(serve, monkeypatch):
    name = serve("--node", str(NODE), "--unpaced")
    monkeypatch.setenv("RKM04_PORT", name)
    monkeypatch.setenv("RKM04_NODE", str(NODE))
    return name


@pytest.fixture
def motor(port):
    with open_line(port) as line:
        yield line.unit(NODE).motor(2)


def waits_until(condition, seconds: float = 5.0) -> bool:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def test_a_program_is_sent_and_moves_the_motor(motor):
    motor.send("\\ S1000 V1000 F200 R")

    assert waits_until(lambda: motor.position() == 200)
    assert motor.program() == "S1000V1000F200R"
    assert motor.unit.positions() == [0, 200, 0, 0]


def test_a_move_is_told_stopped_and_resumed(motor):
    motor.send("\\ S100 V1000 A10000 F5000 R")
    assert motor.table()[-1].step == 5000
    assert motor.progress().command == 5

    motor.stop()
    assert waits_until(lambda: not motor.table())
    stopped = motor.position()
    motor.resume()
    motor.set_speed(16000)

    assert 0 < stopped < 5000
    assert waits_until(lambda: motor.position() == 5000)


@pytest.mark.parametrize("count", [300, 698, 699, 700])
def test_a_long_program_waits_until_all_of_it_is_there(motor, count):
    body = "J1" + "W1000" * (count - 4) + "@1=-77"
    overflow = motor.send("\\" + body + "H").overflow

    assert not overflow
    assert motor.program().strip("[]") == body + "H"
    assert waits_until(lambda: motor.position() != 0)


def test_a_long_program_with_brackets_of_its_own_stays_held_by_them(motor):
    motor.send("\\=5" + "W1" * 400 + "[=6]=7[=8")

    assert waits_until(lambda: motor.position() == 7)
    time.sleep(0.1)
    assert motor.position() == 7
    motor.command("]")
    assert waits_until(lambda: motor.position() == 8)


def test_a_long_program_follows_one_that_moves(motor):
    motor.send("\\ S100 V2000 A8000 G+")
    time.sleep(0.2)

    motor.send("\\=5[" + "W1" * 550)

    assert waits_until(lambda: motor.position() == 5)


@pytest.mark.parametrize(("seed", "echo"), [(1, False), (2, True)])
def test_on_a_bad_line_what_is_confirmed_was_done_once(port, seed, echo):
    steps = 25
    bad = NoisyLine(port, seed, probability=0.25, echo=echo)
    try:
        with open_line(bad.port) as line:
            for _ in range(steps):
                answer = line.request(NODE, request(SET_COMMAND, 2, b"F1R"), Wait(0.03, 30))
                assert answer == b"\x022\0\0"
    finally:
        bad.close()

    with open_line(port) as line:
        motor = line.unit(NODE).motor(2)
        assert waits_until(lambda: not motor.table())
        assert motor.position() == steps
    assert bad.harmed > 5


def test_a_line_that_only_harms_ends_in_a_typed_error(port):
    bad = NoisyLine(port, seed=3, probability=1.0, echo=True)
    try:
        with open_line(bad.port) as line:
            started = time.monotonic()
            with pytest.raises(LineError):
                line.unit(NODE).motor(1).position()
            assert time.monotonic() - started < 3
    finally:
        bad.close()


def test_every_exchange_gets_through_the_bad_line_of_a_unit(serve):
    port = serve("--node", str(NODE), "--unpaced", "--noise", "500", "--loss", "500")
    with open_line(port) as client:
        motor = client.unit(NODE).motor(2)
        program = ""
        for number in range(1, 51):
            motor.send(f"F{number}")
            program += f"F{number}"
            assert motor.program() == program


def position(port: str) -> int:
    with open_line(port) as line:
        return line.unit(NODE).motor(2).position()


def test_a_unit_that_restarts_after_an_execution_does_not_execute_again(serve):
    before, after = (serve("--node", str(NODE), "--unpaced") for _ in range(2))
    line = NoisyLine(before, seed=4, probability=0.0, echo=False)
    try:
        with open_line(line.port) as client:
            motor = client.unit(NODE).motor(2)
            motor.command("S1000 F1 R")
            line.restarted_as = after
            with pytest.raises(UnitRestarted) as restarted:
                motor.command("F1R")
            assert restarted.value.repeated
            assert motor.position() == 0
            motor.command("F1R")
            assert waits_until(lambda: motor.position() == 1)
    finally:
        line.close()

    assert position(before) == 2
    assert position(after) == 1


def test_what_the_unit_refuses_is_typed(motor):
    with pytest.raises(UnitRefused) as refused:
        motor.command("S100 V0")

    assert (refused.value.flag, refused.value.character) == (1, "V")


def test_a_request_and_its_answer_wait_for_nothing_on_their_way(motor):
    """Such as the 40 ms for which small packets are held together; the best, as others may run."""
    motor.position()
    times = []
    for _ in range(50):
        started = time.monotonic()
        motor.position()
        times.append(time.monotonic() - started)

    assert min(times) < 0.02


def test_the_commands_work_together(tool, port, write):
    path = write("\\ S1000 V1000 F100 R")

    assert tool("send", path).status == 0
    assert tool("store", path).out == f"unit {NODE}, motor 1: 4 commands stored\n"
    assert tool("program", "--motor", "1").out == "S1000V1000F100R\n"
    assert waits_until(
        lambda: tool("position", "--motor", "1", "--json").json["motors"][0]["position"] == 100
    )
    assert tool("watch", "--count", "1").status == 0
    assert tool("reset").status == 0
    assert tool("program", "--motor", "1").out == "\n"


def test_the_status_tells_inputs_states_and_what_came_damaged(tool, tmp_path):
    served = Served("--tcp", "0", "--control", "0", "--node", str(NODE), "--unpaced", cwd=tmp_path)
    try:
        served.control().order("6=1")
        with open_line(served.place) as line:
            unit = line.unit(NODE)
            unit.motor(4).command("T2 J9")
            damaged = bytearray(frame(NODE, 9, b"\x04\x30"))
            damaged[3] ^= 1
            line.transport.write(bytes(damaged))
            unit.motor(1).command("=-7 O1")

            assert waits_until(lambda: unit.status().motors[3].failed)
            status = unit.status()
    finally:
        served.end()

    assert status.inputs == (False,) * 5 + (True, False, False)
    assert status.outputs == (False, True) + (False,) * 6
    assert status.motors[0].waiting
    assert status.motors[0].position == -7
    assert status.motors[3].error == "label not found"
    assert status.line["fcs"] == 1
    assert status.line["frames"] >= 4
    assert (status.cause, status.late_steps) == ("power-on", 0)


def test_scan_finds_the_units_of_a_line(serve, tool):
    """A scan waits twice 45 ms for a unit: a busy machine may take longer, and needs another."""
    name = serve("--node", "2", "--node", "5")
    found: set[int] = set()

    def scan_finds_both() -> bool:
        found.update(unit["node"] for unit in tool("scan", "--port", name, "--json").json["units"])
        return found == {2, 5}

    assert waits_until(scan_finds_both)


def test_a_broadcast_starts_the_motors_of_all_units(serve):
    with open_line(serve("--node", "2", "--node", "5", "--unpaced")) as line:
        motors = [line.unit(node).motor(1) for node in (2, 5)]
        for motor in motors:
            motor.send("\\[=9")

        line.unit(0).motor(0).command("]")

        assert waits_until(lambda: [motor.position() for motor in motors] == [9, 9])
