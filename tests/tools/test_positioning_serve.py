"""`positioning serve`: RTU on TCP and a pty at the rate of the settings, and Modbus TCP."""

from __future__ import annotations

import os
import select
import signal
import socket
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from pymodbus.client import ModbusTcpClient
from pymodbus.framer import FramerRTU
from rkm04_tools.failure import Failure
from served import PATIENCE_SECONDS, POSITIONING_COMMAND, Served, connect, refusal

START_SECONDS = 0.1  # in which a unit is ready to answer
RATE, STORE, UPTIME = 31, 40, 8
IDENTIFY = bytes([0x2B, 0x0E, 1, 0])

Serve = Callable[..., Served]
Meet = Callable[[Served], "Tcp"]
Pdu = bytes


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """Start units that end with the test."""
    started: list[Served] = []

    def start(*arguments: str | Path, place: tuple[str, ...] = ("--tcp", "0")) -> Served:
        served = Served(*place, *arguments, cwd=tmp_path, command=POSITIONING_COMMAND)
        started.append(served)
        time.sleep(START_SECONDS)
        return served

    yield start
    for served in started:
        assert served.end() == (0, "")


@pytest.fixture
def tcp(serve: Serve) -> Callable[..., Served]:
    """Start a unit with Modbus TCP."""

    def start(*arguments: str) -> Served:
        return serve(*arguments, place=("--modbus-tcp", "0"))

    return start


@pytest.fixture
def meet() -> Iterator[Callable[[Served], Tcp]]:
    """Connect clients of Modbus TCP that let go at the end of the test."""
    clients: list[Tcp] = []

    def connect_to(served: Served) -> Tcp:
        clients.append(Tcp(served))
        return clients[-1]

    yield connect_to
    for client in clients:
        client.socket.close()


def rtu(pdu: Pdu, unit: int = 1) -> bytes:
    frame = bytes([unit]) + pdu
    return frame + FramerRTU.compute_CRC(frame).to_bytes(2, "big")


class Line:
    """A client of RTU, on a file descriptor."""

    def __init__(self, fd: int) -> None:
        self.fd = fd

    def ask(self, pdu: Pdu, unit: int = 1, seconds: float = PATIENCE_SECONDS) -> bytes:
        """The frame that comes, whole by its CRC; empty if none does."""
        os.write(self.fd, rtu(pdu, unit))
        heard = b""
        while select.select([self.fd], [], [], seconds)[0]:
            heard += os.read(self.fd, 4096)
            if len(heard) >= 5 and rtu(heard[1:-2], heard[0]) == heard:
                return heard
        return heard


class Tcp:
    """A client of Modbus TCP that sends what it is told."""

    def __init__(self, served: Served) -> None:
        self.socket = connect(served.place.replace("modbus://", "socket://"))
        self.number = 0

    def send(self, pdu: Pdu, unit: int = 1) -> None:
        self.number += 1
        length = (len(pdu) + 1).to_bytes(2, "big")
        self.socket.sendall(self.number.to_bytes(2, "big") + b"\0\0" + length + bytes([unit]) + pdu)

    def hear(self) -> tuple[int, int, bytes]:
        """Number, unit and PDU of the next answer."""
        head = self._read(7)
        return (
            int.from_bytes(head[:2], "big"), head[6],
            self._read(int.from_bytes(head[4:6], "big") - 1),
        )  # fmt: skip

    def ask(self, pdu: Pdu, unit: int = 1) -> bytes:
        self.send(pdu, unit)
        number, told, answer = self.hear()
        assert (number, told) == (self.number, unit)
        return answer

    def _read(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            assert part
            data += part
        return data


def read(first: int, count: int, function: int = 3) -> Pdu:
    return bytes([function]) + first.to_bytes(2, "big") + count.to_bytes(2, "big")


def write(place: int, value: int) -> Pdu:
    return b"\6" + place.to_bytes(2, "big") + value.to_bytes(2, "big")


# ---- RTU ----------------------------------------------------------------------------------------


def test_a_unit_answers_on_tcp(serve: Serve):
    with connect(serve().place) as connection:
        assert Line(connection.fileno()).ask(read(0, 2)).hex() == "01030400010100aa63"


def test_a_unit_answers_on_a_pty(serve: Serve, tmp_path: Path):
    served = serve(place=("--pty", str(tmp_path / "unit")))
    fd = os.open(served.place, os.O_RDWR | os.O_NOCTTY)
    try:
        assert Line(fd).ask(read(0, 1)).hex() == "0103020001" + "7984"
    finally:
        os.close(fd)


def test_the_line_has_the_stored_rate_from_the_next_start_on(serve: Serve, tmp_path: Path):
    flash = tmp_path / "unit.flash"
    seconds = []
    for rate in (96, 1152):
        for _ in range(2):  # what is stored counts from the next start on
            served = serve("--flash", flash)
            with connect(served.place) as connection:
                line = Line(connection.fileno())
                begin = time.monotonic()
                assert len(line.ask(read(500, 12))) == 29
                seconds.append(time.monotonic() - begin)
                for pdu in (write(RATE, rate), write(STORE, 1)):
                    assert line.ask(pdu)[1:-2] == pdu
            served.end()

    at_19200, at_9600, again, at_115200 = seconds
    assert at_9600 > 37 * 11 / 9600
    assert at_19200 > 37 * 11 / 19200
    assert again > 37 * 11 / 9600
    assert at_115200 > 37 * 11 / 115200


def test_settings_and_positions_of_a_restarted_unit(serve: Serve, tmp_path: Path):
    flash = tmp_path / "unit.flash"
    for value, stored in ((500, True), (600, False), (500, False)):
        served = serve("--flash", flash)
        with connect(served.place) as connection:
            line = Line(connection.fileno())
            assert int.from_bytes(line.ask(read(30, 1))[3:5], "big") == (0 if stored else 500)
            line.ask(write(30, value))
            if stored:
                line.ask(write(STORE, 1))
        served.end()


@pytest.mark.parametrize(
    ("arguments", "wrong"),
    [
        (["--modbus-tcp", "x"], "--modbus-tcp x: write a port"),
        (["--modbus-tcp", "1", "--pty", "a"], "not allowed with"),
        (["--modbus-tcp", "0", "--noise", "x"], "--noise"),
        (["--node", "17"], "--node"),
    ],
)
def test_wrong_usage_is_one_line(arguments: list[str], wrong: str):
    status, complaint = refusal(*arguments, command=POSITIONING_COMMAND)

    assert status != 0
    assert wrong in complaint


# ---- Modbus TCP ---------------------------------------------------------------------------------


def test_a_common_client_of_modbus_tcp_moves_an_axis(tcp: Serve):
    host, _, port = tcp().place.removeprefix("modbus://").rpartition(":")
    client = ModbusTcpClient(host, port=int(port))
    try:
        assert client.connect()
        client.write_register(100, 0x0101)
        client.write_registers(100, [0x0202, 0, 0, 1000, 500, 1, 1000, 0])
        end = time.monotonic() + PATIENCE_SECONDS
        while client.read_input_registers(110, count=8).registers[0] != 0x0803:
            assert time.monotonic() < end
        assert client.read_input_registers(116, count=2).registers == [0, 1000]
    finally:
        client.close()


@pytest.mark.parametrize(
    ("pdu", "answer"),
    [
        (read(0, 2), "030400010100"),
        (read(0, 2, function=4), "040400010100"),
        (write(102, 0), "8602"),
        (b"\1\0\0\0\1", "8101"),
        (b"\x63\1\2", "e301"),
        (read(0, 126), "8303"),
        (IDENTIFY, f"2b0e0181000003000d{b'open firmware'.hex()}0104504f5334020530312e3030"),
        (bytes.fromhex("1700000001006600020400010002"), "1702" + "0001"),
        (bytes.fromhex("10006600020400010002"), "1000660002"),
    ],
)  # fmt: skip
def test_every_function_and_exception_comes_back_as_it_is(
    tcp: Serve, meet: Meet, pdu: Pdu, answer: str
):
    assert meet(tcp()).ask(pdu).hex() == answer


def test_a_unit_that_is_not_there_is_exception_0b(tcp: Serve, meet: Meet):
    client = meet(tcp())

    assert client.ask(read(0, 1), unit=7).hex() == "830b"
    assert client.ask(read(0, 1)).hex() == "03020001"


def test_a_broadcast_is_done_and_not_answered(tcp: Serve, meet: Meet):
    client = meet(tcp())

    client.send(write(101, 5), unit=0)
    assert client.ask(read(101, 1)).hex() == "03020005"


def test_the_answers_of_clients_are_their_own(tcp: Serve, meet: Meet):
    served = tcp()
    clients = [meet(served) for _ in range(4)]

    def work(client: Tcp, axis: int) -> None:
        for value in range(20):
            client.ask(write(100 * axis + 1, value))
            assert client.ask(read(100 * axis + 1, 1)) == bytes([3, 2, 0, value])

    with ThreadPoolExecutor() as pool:
        list(pool.map(work, clients, range(1, 5)))


def test_requests_sent_together_are_answered_in_their_order(tcp: Serve, meet: Meet):
    client = meet(tcp())
    for value in range(5):
        client.send(write(101, value))

    assert [client.hear()[0] for _ in range(5)] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize(
    "data", ["00010001000601030000000a", "000100000001 01", "0001000000ff01030000000a"]
)
def test_what_is_no_modbus_tcp_ends_the_connection(tcp: Serve, meet: Meet, data: str):
    served = tcp()
    client = meet(served)
    client.socket.sendall(bytes.fromhex(data))

    assert client.socket.recv(100) == b""
    assert meet(served).ask(read(0, 1)).hex() == "03020001"


def test_on_a_bad_line_what_comes_is_right_or_0b(tcp: Serve, meet: Meet):
    client = meet(tcp("--noise", "5000", "--loss", "5000"))

    answers = {client.ask(read(0, 2)).hex() for _ in range(20)}
    assert answers <= {"030400010100", "830b"}
    assert "030400010100" in answers


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_all(tcp: Serve, meet: Meet, number: int):
    served = tcp()
    client = meet(served)

    assert served.end(number) == (0, "")
    assert client.socket.recv(10) == b""


def test_orders_on_standard_input_are_done_beside_it(tcp: Serve, meet: Meet):
    served = tcp()
    assert served.process.stdin is not None
    served.process.stdin.write("3=1\n")
    served.process.stdin.flush()

    assert served.line() == {"ok": True}
    assert meet(served).ask(read(5, 1)).hex() == "03020004"


def test_a_port_that_is_taken_is_told():
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        status, complaint = refusal("--modbus-tcp", str(port), command=POSITIONING_COMMAND)

    assert status == Failure("").status
    assert "name another port" in complaint


@pytest.mark.skipif(sys.platform != "linux", reason="looks for the unit in /proc")
def test_a_unit_that_ends_by_itself_is_told(tmp_path: Path):
    gateway = Served("--modbus-tcp", "0", cwd=tmp_path, command=POSITIONING_COMMAND).process
    children = Path(f"/proc/{gateway.pid}/task/{gateway.pid}/children").read_text()
    os.kill(int(children.split()[0]), signal.SIGKILL)

    _, complaint = gateway.communicate(timeout=15)
    assert gateway.returncode == 1
    assert "the virtual unit has ended by itself" in complaint
