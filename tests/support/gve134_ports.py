"""Ways to a FakeGve: in virtual time with noise from a seed, or a thread on TCP or a pty."""

from __future__ import annotations

import contextlib
import heapq
import os
import pty
import random
import socket
import threading
import time
import tty
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from fake_gve134 import FakeGve
from fake_gve134_receiver import checksum


@dataclass
class VirtualPort:
    """A port whose other end is a unit in virtual time: nothing here waits.

    Each piece of bytes, in either direction, comes to harm with a probability.
    """

    unit: FakeGve
    latency_s: float = 0.016
    probability: float = 0.0
    seed: int = 0
    name: str = "virtual"
    harmed: int = 0
    written: list[bytes] = field(default_factory=list)
    abandoned: bool = False
    now: float = 0.0

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)
        self._order = 0
        self._to_unit: list[tuple[float, int, bytes]] = []
        self._to_host: list[tuple[float, int, bytes]] = []

    def clock(self) -> float:
        return self.now

    def write(self, data: bytes) -> None:
        self.written.append(data)
        self._put(self._to_unit, data)

    def read(self, seconds: float) -> bytes:
        end = self.now + seconds
        while True:
            if self._to_host and self._to_host[0][0] <= self.now:
                return heapq.heappop(self._to_host)[2]
            due = min(self._next(), end)
            self._pass(due)
            if due >= end and not (self._to_host and self._to_host[0][0] <= self.now):
                return b""

    def close(self) -> None:
        pass

    def take_back(self) -> None:
        pass

    def abandon(self) -> None:
        self.abandoned = True

    def _next(self) -> float:
        dues = [queue[0][0] for queue in (self._to_unit, self._to_host) if queue]
        return min([*dues, self.unit.wake()])

    def _pass(self, to: float) -> None:
        self.now = max(self.now, to)
        self.unit.advance(self.now)
        while self._to_unit and self._to_unit[0][0] <= self.now:
            self.unit.take(heapq.heappop(self._to_unit)[2])
        if self.unit.out:
            self._put(self._to_host, bytes(self.unit.out))
            self.unit.out.clear()

    def _put(self, queue: list[tuple[float, int, bytes]], data: bytes) -> None:
        self._order += 1
        heapq.heappush(queue, (self.now + self.latency_s, self._order, self._harm(data)))

    def _harm(self, data: bytes) -> bytes:
        if not data or self._random.random() >= self.probability:
            return data
        self.harmed += 1
        harm = self._random.choice([self._lose, self._flip, self._cut, self._drop, self._insert])
        return harm(data)

    def _lose(self, data: bytes) -> bytes:
        return b""

    def _flip(self, data: bytes) -> bytes:
        place = self._random.randrange(len(data))
        bit = 1 << self._random.randrange(8)
        return data[:place] + bytes([data[place] ^ bit]) + data[place + 1 :]

    def _cut(self, data: bytes) -> bytes:
        return data[: self._random.randrange(len(data))]

    def _drop(self, data: bytes) -> bytes:
        place = self._random.randrange(len(data))
        return data[:place] + data[place + 1 :]

    def _insert(self, data: bytes) -> bytes:
        """Not of 0, which no sum sees: a unit refuses it as wrong syntax."""
        place = self._random.randrange(len(data) + 1)
        return data[:place] + bytes([self._random.randint(1, 255)]) + data[place:]


class Ends(VirtualPort):
    """A port that can be told to lose or change what is written, or to say something else."""

    def __init__(self, unit: FakeGve) -> None:
        super().__init__(unit)
        self.requests: deque[Callable[[bytes], bytes]] = deque()
        self.before: Callable[[bytes], None] = lambda data: None

    def write(self, data: bytes) -> None:
        self.before(data)
        self.written.append(data)
        self._put(self._to_unit, self.requests.popleft()(data) if self.requests else data)

    def say(self, data: bytes, after_s: float = 0.0) -> None:
        self._order += 1
        self._to_host.append((self.now + after_s, self._order, data))
        self._to_host.sort()


def answer_of(text: str) -> bytes:
    """An answer with its checksum."""
    start = f"{text},".encode()
    return start + checksum(start) + b"\r"


class FakeGveLine:
    """A unit served in real time by a thread of its own, on TCP or on a pty.

    `garbage` goes back instead of any answer. What the test does to the unit it does in `lock`.
    """

    def __init__(self, unit: FakeGve, on_pty: bool = False) -> None:
        self.unit = unit
        self.garbage = b""
        self.echo = False
        self.lock = threading.Lock()
        self.begin = time.monotonic()
        self._ended = threading.Event()
        if on_pty:
            self._master, self._slave = pty.openpty()
            tty.setraw(self._master)
            os.set_blocking(self._master, False)
            self.port = os.ttyname(self._slave)
            self._thread = threading.Thread(target=self._serve_pty)
        else:
            self._listener = socket.create_server(("127.0.0.1", 0))
            self._listener.settimeout(0.01)
            self.port = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"
            self._thread = threading.Thread(target=self._serve_tcp)
        self._thread.start()

    def close(self) -> None:
        self._ended.set()
        self._thread.join()

    def until(self, reached: Callable[[FakeGve], bool], seconds: float = 10.0) -> None:
        """Wait for the unit to get into a state."""
        end = time.monotonic() + seconds
        while True:
            with self.lock:
                if reached(self.unit):
                    return
            assert time.monotonic() < end
            time.sleep(0.002)

    def _serve_pty(self) -> None:
        def read() -> bytes:
            try:
                return os.read(self._master, 4096)
            except BlockingIOError:
                time.sleep(0.001)
                return b""

        def write(data: bytes) -> None:
            with contextlib.suppress(BlockingIOError):
                os.write(self._master, data)

        while not self._ended.is_set():
            self._handle(read(), write)
        os.close(self._master)
        os.close(self._slave)

    def _serve_tcp(self) -> None:
        with self._listener:
            while not self._ended.is_set():
                try:
                    connection, _ = self._listener.accept()
                except TimeoutError:
                    self._handle(b"", lambda data: None)
                    continue
                with connection, contextlib.suppress(OSError):
                    self._serve(connection)

    def _serve(self, connection: socket.socket) -> None:
        connection.settimeout(0.001)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        while not self._ended.is_set():
            try:
                data = connection.recv(4096)
            except TimeoutError:
                data = b""
            else:
                if not data:
                    return
            self._handle(data, connection.sendall)

    def _handle(self, data: bytes, write: Callable[[bytes], object]) -> None:
        with self.lock:
            self.unit.advance(time.monotonic() - self.begin)
            self.unit.take(data)
            out = bytes(self.unit.out)
            self.unit.out.clear()
        if self.echo and data:
            write(data)
        if self.garbage and data:
            write(self.garbage)
        elif out:
            write(out)
