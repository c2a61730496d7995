"""Units on a line of their own, with faults on order: the other end for tests of the client.

Framing is that of `frames`, the second implementation, not the client's. A unit answers by the
rules of firmware/rkm04/docs/line.md, in memory only: it moves nothing.
"""

from __future__ import annotations

import contextlib
import os
import pty
import socket
import threading
import time
import tty
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from frames import FLAG, fcs16, frame, unescape
from statuses import GET_STATUS, Vector

VERSION = b"01.02,06.03.2009"
ANSWER, REFUSED = 0x80, 0x40
MOVING, RUNNING, WAITING, STOPPED, FAILED, ENDED = (1 << bit for bit in range(6))

Fault = Callable[[bytes], bytes]
"""Makes what goes back to the master out of the answer's bytes."""


def lost(answer: bytes) -> bytes:
    """Nothing arrives."""
    return b""


def damaged(answer: bytes) -> bytes:
    """A bit is wrong."""
    return answer[:-4] + bytes([answer[-4] ^ 1]) + answer[-3:]


def cut_off(answer: bytes) -> bytes:
    """The end is missing."""
    return answer[:-3]


def noisy(answer: bytes) -> bytes:
    """Noise stands before and after it."""
    return b"\x00\x55\x7e\xff\x7d\x7d" + answer + b"\x80\x01"


def mixed(answer: bytes) -> bytes:
    """Two units talk at once: bits of both."""
    return bytes(a | b for a, b in zip(answer, answer[1:] + b"\x10", strict=True))


def twice(answer: bytes) -> bytes:
    """Two units answer one after the other."""
    return answer + answer


@dataclass
class FakeUnit:
    """A unit; `done` are the messages that it has executed, one entry for each time."""

    node: int = 1
    done: list[bytes] = field(default_factory=list)
    programs: dict[int, bytes] = field(default_factory=lambda: dict.fromkeys(range(1, 5), b""))
    positions: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    answers: dict[bytes, bytes] = field(default_factory=dict)
    """Answers that are not to be the usual ones, by request."""
    flag: bytes = b"\0\0"
    status: bytes | None = None
    """The answer to Get Status, if not that of `states`; empty: a unit that does not know it."""
    states: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    """What the motors do, as Get Status tells it; K, C75 and a hold at the beginning change it.

    V alone changes the table of one that moves.
    """
    errors: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    waits: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    tables: dict[int, bytes] = field(default_factory=dict)
    last: tuple[int, bytes, bytes] = (0, b"", b"")
    in_session: bool = False
    frames: int = 0
    """What it has counted since its start."""

    def restart(self) -> None:
        """Forget the line, as a start does."""
        self.last = (0, b"", b"")
        self.in_session = False
        self.frames = 0

    def take(self, number: int, message: bytes) -> bytes:
        """Answer a request, or a repeat of the last one; empty: refused."""
        self.frames += 1
        self.in_session = self.in_session or (number != 0 and message[0] == 1)
        if number and not self.in_session:
            return b""
        if number and self.last[:2] == (number, message):
            return self.last[2]
        answer = self.execute(message)
        self.last = (number, message, answer)
        return answer

    def execute(self, message: bytes) -> bytes:
        self.done.append(message)
        if message in self.answers:
            return self.answers[message]
        kind, motors = message[0], message[1:2]
        if kind == GET_STATUS and self.status != b"":
            told = Vector("", motors=self.states, errors=self.errors, waits=self.waits,
                          line_counts=[self.frames] + [0] * 11)  # fmt: skip
            return self.status or told.whole
        if kind == 1:
            return bytes([1, len(VERSION)]) + VERSION
        if not 2 <= kind <= 7:
            return bytes([255, kind, 0, 0])
        numbers = range(1, 5) if motors == b"0" else [int(motors)]
        if kind == 2:
            for number in numbers:
                self.store(number, message[2:])
            return message[:2] + self.flag
        if kind == 3:
            return message[:2] + b"\0"
        if kind == 4:
            texts = [b"%10d" % self.positions[number - 1] for number in numbers]
            return message[:2] + b"".join(bytes([len(text)]) + text for text in texts)
        if kind == 5:
            return message[:2] + self.programs[int(motors)]
        if kind == 6:
            return message[:2] + self.tables.get(int(motors), b"  0;[]")
        return message[:2] + b"   247; 3"

    def store(self, motor: int, text: bytes) -> None:
        state = self.states[motor - 1]
        if text == b"K" and state & RUNNING:
            self.states[motor - 1] = state & MOVING | STOPPED
        if text == b"C75" and state & STOPPED:
            self.states[motor - 1] = state & MOVING | RUNNING
        if text in (b"K", b"C75"):
            return
        if text.startswith(b"V") and text[1:].isdigit() and state & MOVING and state & RUNNING:
            self.tables[motor] = b"  2;[(1;100),(%d;%s)]" % (len(self.done), text[1:])
            return
        if text == b"\\[":
            self.states[motor - 1] = RUNNING | WAITING
        _, reset, rest = text.rpartition(b"\\")
        self.programs[motor] = rest if reset else self.programs[motor] + text


class FakeLine:
    """A line with units, served by a thread of its own on TCP or on a pty.

    `faults` are used up one by one, one for each answer; `lost_requests` counts down. `flood` goes
    back without end instead of any answer.
    """

    def __init__(
        self, *units: FakeUnit, on_pty: bool = False, echo: bool = False, port: int = 0
    ) -> None:
        self.units = {unit.node: unit for unit in units}
        self.faults: deque[Fault] = deque()
        self.lost_requests = 0
        self.requests: list[tuple[int, int, bytes]] = []
        self.frame_bytes: list[int] = []
        self.echo = echo
        self.flood = b""
        self.delay_seconds = 0.0
        self._ended = threading.Event()
        self._read: Callable[[], bytes]
        self._write: Callable[[bytes], object]
        if on_pty:
            self._open_pty()
        else:
            self._listener = socket.create_server(("127.0.0.1", port))
            self._listener.settimeout(0.01)
            self.port = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"
            self._thread = threading.Thread(target=self._serve_tcp)
        self._thread.start()

    def close(self) -> None:
        self._ended.set()
        self._thread.join()

    def _open_pty(self) -> None:
        master, self._slave = pty.openpty()
        tty.setraw(master)
        os.set_blocking(master, False)
        self.port = os.ttyname(self._slave)
        self._thread = threading.Thread(target=self._serve_pty, args=[master])

    def _serve_pty(self, master: int) -> None:
        def read() -> bytes:
            try:
                return os.read(master, 4096)
            except BlockingIOError:
                time.sleep(0.001)
                return b""

        def write(data: bytes) -> None:
            # What nobody reads is lost, as on a line.
            with contextlib.suppress(BlockingIOError):
                os.write(master, data)

        self._read, self._write = read, write
        for came in self._until_the_end():
            self._handle(came)
        os.close(master)
        os.close(self._slave)

    def _serve_tcp(self) -> None:
        with self._listener:
            while not self._ended.is_set():
                try:
                    connection, _ = self._listener.accept()
                except TimeoutError:
                    continue
                with connection:
                    self._serve(connection)

    def _serve(self, connection: socket.socket) -> None:
        connection.settimeout(0.005)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        closed = False

        def read() -> bytes:
            nonlocal closed
            try:
                data = connection.recv(4096)
            except TimeoutError:
                return b""
            except OSError:
                data = b""
            closed = not data
            return data

        self._read, self._write = read, connection.sendall
        try:
            for came in self._until_the_end():
                self._handle(came)
                if closed:
                    return
        except OSError:  # the other side has gone
            return

    def _until_the_end(self) -> Iterator[bytes]:
        """Bodies between flags as they come; empty when nothing has come."""
        buffer = b""
        while not self._ended.is_set():
            came = self._read()
            if self.echo and came:
                self._write(came)
            if self.flood:
                self._write(self.flood)
            *bodies, buffer = (buffer + came).split(bytes([FLAG]))
            yield from bodies
            yield b""

    def _handle(self, body: bytes) -> None:
        content = unescape(body)
        if len(content) < 5 or fcs16(content[:-2]).to_bytes(2, "little") != content[-2:]:
            return
        address, number, message = content[0], content[1], content[2:-2]
        self.requests.append((address, number, message))
        self.frame_bytes.append(len(body) + 2)
        if self.lost_requests:
            self.lost_requests -= 1
        elif address == 0:
            for unit in self.units.values():
                unit.execute(message)
        elif address in self.units and not self.flood:
            taken = self.units[address].take(number, message)
            back = address | ANSWER if taken else address | ANSWER | REFUSED
            answer = frame(back, number, taken or b"\1")
            fault = self.faults.popleft() if self.faults else bytes
            time.sleep(self.delay_seconds)
            self._write(fault(answer))
