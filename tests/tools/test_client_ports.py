"""A port that cannot be used is an error that says why and what to do, and never a traceback."""

from __future__ import annotations

import os
import pty
import socket
import time

import pytest
import serial
from rkm04_tools.failure import Failure
from rkm04_tools.line import open_line
from rkm04_tools.line_errors import (
    PortBusy,
    PortError,
    PortForbidden,
    PortLost,
    PortMissing,
)


@pytest.fixture
def terminal():
    """A pty's name."""
    master, slave = pty.openpty()
    yield os.ttyname(slave)
    for end in (master, slave):
        os.close(end)


def fails_with(error: type[PortError], port: str, words: str) -> None:
    with pytest.raises(error, match=words) as raised:
        open_line(port)
    assert str(raised.value).startswith(f"{port}: ")
    assert raised.value.status == 3


def test_a_port_that_there_is_not():
    fails_with(PortMissing, "/dev/ttyNOSUCH7", "no such port; (there are /dev|no serial port)")


def test_a_port_that_another_program_has_open(terminal):
    with open_line(terminal):
        fails_with(PortBusy, terminal, "another program has this port open")


def test_a_file_is_no_port(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("hello")

    fails_with(PortError, str(path), "not a serial port")


@pytest.mark.parametrize(
    ("error", "kind", "words"),
    [
        (serial.SerialException(13, "could not open port"), PortForbidden, "dialout"),
        (serial.SerialException(16, "could not open port"), PortBusy, "another program"),
        (serial.SerialException("could not open port 'COM9': FileNotFoundError(2, 'x', None, 2)"),
         PortMissing, "no such port"),
        (serial.SerialException("could not open port 'COM9': PermissionError(13, 'x', None, 5)"),
         PortBusy, "another program"),
        (serial.SerialException(5, "odd"), PortError, "cannot be opened"),
        (ValueError("invalid URL"), PortError, "invalid url"),
    ],
)  # fmt: skip
def test_what_pyserial_says_on_any_system_is_sorted_out(monkeypatch, error, kind, words):
    def refuse(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(serial, "serial_for_url", refuse)

    fails_with(kind, "COM9", words)


def test_a_device_that_is_unplugged():
    master, slave = pty.openpty()
    with open_line(os.ttyname(slave)) as line:
        os.close(master)

        with pytest.raises(PortLost, match="check the cable"):
            line.unit(1).version()
    os.close(slave)


def test_nobody_listens():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]

    fails_with(PortMissing, f"socket://127.0.0.1:{port}", "nobody listens there")


def test_no_such_host(monkeypatch):
    def look_up(*_: object, **__: object) -> None:
        raise socket.gaierror(-2, "Name or service not known")

    monkeypatch.setattr(socket, "getaddrinfo", look_up)

    fails_with(PortMissing, "socket://nowhere:5000", "no such host")


def test_a_host_that_keeps_silent(monkeypatch):
    def wait(*_: object, **__: object) -> None:
        raise TimeoutError

    monkeypatch.setattr(socket, "create_connection", wait)

    fails_with(PortMissing, "socket://nowhere:5000", "no connection in 3 s")


def test_a_connection_that_the_other_end_closes():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        line = open_line(f"socket://127.0.0.1:{listener.getsockname()[1]}")
        listener.accept()[0].close()

        with line, pytest.raises(PortLost):
            line.unit(1).version()


def test_a_host_that_accepts_and_says_nothing_is_given_up():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        started = time.monotonic()
        with (
            open_line(f"socket://127.0.0.1:{listener.getsockname()[1]}") as line,
            pytest.raises(Failure, match="does not answer"),
        ):
            line.unit(1).version()

    assert time.monotonic() - started < 1.5


@pytest.mark.parametrize(
    "port",
    ["socket://", "socket://host", "socket://host:0", "socket://host:65536", "socket://:5", "socket://h:5/x"],
)  # fmt: skip
def test_an_address_of_the_wrong_form_is_wrong_usage(port):
    with pytest.raises(Failure, match="socket://HOST:PORT") as raised:
        open_line(port)
    assert raised.value.status == 2


def test_an_address_may_be_one_of_ipv6():
    try:
        listener = socket.create_server(("::1", 0), family=socket.AF_INET6)
    except OSError:
        pytest.skip("this machine has no IPv6")
    with listener, open_line(f"socket://[::1]:{listener.getsockname()[1]}") as line:
        assert line.transport.name.startswith("socket://[::1]:")
