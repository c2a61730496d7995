"""Ports that bytes go through: serial devices and ptys by pyserial, and TCP as socket://HOST:PORT.

TCP has a class of its own: it says more about errors than pyserial's, and closes without a pause.
Nothing here waits longer than it is told to.
"""

from __future__ import annotations

import errno
import os
import re
import socket
import struct
import time
from contextlib import suppress
from typing import Protocol

import serial
from serial.tools import list_ports

from rkm04_tools.failure import Failure
from rkm04_tools.line_errors import PortBusy, PortError, PortForbidden, PortLost, PortMissing

BAUD = 19_200
BITS_PER_BYTE = 10
CONNECT_SECONDS = 3.0
WRITE_SECONDS = 5.0
SLICE_SECONDS = 0.005
"""How long one call of pyserial waits for a byte."""
CHUNK_BYTES = 4096

ADDRESS = re.compile(r"(\[[^\]]+\]|[^:/\[\]]+):(\d{1,5})/?")


def seconds_on_line(count: int, baud: int = BAUD) -> float:
    """The time that bytes take at the speed of the line."""
    return count * BITS_PER_BYTE / baud


class Transport(Protocol):
    """An open port."""

    name: str

    def read(self, seconds: float) -> bytes:
        """Return what is there; wait for a first byte until the time is over, then return none."""

    def write(self, data: bytes) -> None:
        """Send bytes."""

    def close(self) -> None:
        """Give the port back; may be called again."""


class Port(Transport, Protocol):
    """An open port that was opened here."""

    def take_back(self) -> None:
        """Let nothing of what was sent go out any more that still waits; the port stays open."""

    def abandon(self) -> None:
        """Close the port, and let nothing of what was sent go out any more that still waits."""


def open_transport(
    name: str, baud: int = BAUD, form: str = "8N1", scheme: str = "socket://"
) -> Port:
    """Open a port by its name: a device, a pty or socket://HOST:PORT.

    `form`: the bits, parity and stop bits of a serial device. `scheme`: what addresses begin with.
    """
    if name.startswith(scheme):
        match = ADDRESS.fullmatch(name.removeprefix(scheme))
        if not match or not 0 < int(match[2]) < 65_536:
            raise Failure(f"{name}: write {scheme}HOST:PORT, as in {scheme}127.0.0.1:5000")
        return SocketTransport(name, match[1].strip("[]"), int(match[2]))
    return SerialTransport(name, baud, form)


class SocketTransport:
    """A TCP connection, to a virtual unit or to a converter."""

    def __init__(self, name: str, host: str, port: int) -> None:
        self.name = name
        self._place = host, port
        self._socket = self._connected()

    def _connected(self) -> socket.socket:
        try:
            found = socket.create_connection(self._place, CONNECT_SECONDS)
            found.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except (OSError, UnicodeError) as error:
            raise _connecting_failed(self.name, error) from None
        return found

    def read(self, seconds: float) -> bytes:
        """Return what is there, see Transport."""
        self._socket.settimeout(max(seconds, 1e-6))
        try:
            data = self._socket.recv(CHUNK_BYTES)
        except (TimeoutError, BlockingIOError):
            return b""
        except OSError as error:
            raise _lost(self.name, error) from None
        if not data:
            raise PortLost(
                f"{self.name}: the other end has closed the connection; "
                "does it serve another program already, or has it ended?"
            )
        return data

    def write(self, data: bytes) -> None:
        """Send bytes."""
        self._socket.settimeout(WRITE_SECONDS)
        try:
            self._socket.sendall(data)
        except OSError as error:
            raise _lost(self.name, error) from None

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def abandon(self) -> None:
        """Close the connection, see Port: without a time to linger the system drops the rest."""
        with suppress(OSError):
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self._socket.close()

    def take_back(self) -> None:
        """Connect anew, see Port."""
        self.abandon()
        self._socket = self._connected()


class SerialTransport:
    """A serial device, a pty, or another URL that pyserial knows."""

    def __init__(self, name: str, baud: int = BAUD, form: str = "8N1") -> None:
        self.name = name
        try:
            self._port = serial.serial_for_url(
                name,
                baudrate=baud,
                parity=form[1],
                stopbits=int(form[2]),
                timeout=SLICE_SECONDS,
                write_timeout=WRITE_SECONDS,
                exclusive=True,
            )
        except (OSError, ValueError) as error:
            raise _opening_failed(name, error) from None

    def read(self, seconds: float) -> bytes:
        """Return what is there, see Transport."""
        end = time.monotonic() + seconds
        try:
            while True:
                waiting = self._port.in_waiting
                if not waiting and time.monotonic() >= end:
                    return b""
                data = bytes(self._port.read(max(1, min(waiting, CHUNK_BYTES))))
                if data:
                    return data
        except OSError as error:
            raise _lost(self.name, error) from None

    def write(self, data: bytes) -> None:
        """Send bytes."""
        try:
            self._port.write(data)
        except OSError as error:
            raise _lost(self.name, error) from None

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def abandon(self) -> None:
        """Close the port, see Port."""
        with suppress(OSError):
            self._port.reset_output_buffer()
        self._port.close()

    def take_back(self) -> None:
        """See Port."""
        try:
            self._port.reset_output_buffer()
        except OSError as error:
            raise _lost(self.name, error) from None


def _connecting_failed(name: str, error: Exception) -> PortError:
    if isinstance(error, ConnectionRefusedError):
        return PortMissing(f"{name}: nobody listens there; start the unit, or check the port")
    if isinstance(error, TimeoutError):
        return PortMissing(f"{name}: no connection in {CONNECT_SECONDS:.0f} s; check the address")
    if isinstance(error, UnicodeError | socket.gaierror):
        return PortMissing(f"{name}: no such host; check its name")
    return PortMissing(f"{name}: {_reason(error)}; check the address and the network")


def _opening_failed(name: str, error: OSError | ValueError) -> PortError:
    """Sort out pyserial's errors, whose cause is in `errno` or, on Windows, in the text only."""
    code, text = getattr(error, "errno", None), str(error)
    if code in (errno.ENOENT, errno.ENXIO, errno.ENODEV) or "FileNotFoundError" in text:
        return PortMissing(f"{name}: no such port; {_ports_there_are()}")
    if code == errno.EBUSY or "exclusively lock" in text or "PermissionError" in text:
        return PortBusy(f"{name}: another program has this port open; end it and try again")
    if code in (errno.EACCES, errno.EPERM):
        return PortForbidden(
            f"{name}: no permission; join the group that owns it "
            "(sudo usermod -aG dialout $USER) and log in again"
        )
    if "could not configure" in text.lower():
        return PortError(f"{name}: not a serial port; {_ports_there_are()}")
    return PortError(f"{name}: cannot be opened ({_reason(error)}); {_ports_there_are()}")


def _ports_there_are() -> str:
    names = sorted(port.device for port in list_ports.comports())
    return (
        f"there are {', '.join(names)}" if names else "no serial port was found: is it plugged in?"
    )


def _lost(name: str, error: OSError) -> PortLost:
    return PortLost(f"{name}: the port was lost ({_reason(error)}); check the cable and try again")


def _reason(error: Exception) -> str:
    code = getattr(error, "errno", None)
    return (os.strerror(code) if code else str(error)).lower()
