"""A bad line between a client on a pty and a unit on TCP: noise, loss and echo, from a seed."""

from __future__ import annotations

import contextlib
import os
import pty
import random
import select
import threading
import tty

from served import connect

POLL_SECONDS = 0.01


class NoisyLine:
    """Passes bytes on in both directions; each piece comes to harm with a probability.

    `restarted_as`: another unit takes the first one's place when that has begun its next answer,
    which is lost, as if the unit had started anew after what it has executed.
    """

    def __init__(self, host_and_port: str, seed: int, probability: float, echo: bool) -> None:
        self._unit = connect(host_and_port)
        self._master, self._slave = pty.openpty()
        tty.setraw(self._master)
        self.port = os.ttyname(self._slave)
        self.harmed = 0
        self.restarted_as: str | None = None
        self._random = random.Random(seed)
        self._probability = probability
        self._echo = echo
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def close(self) -> None:
        self._ended.set()
        self._thread.join()
        self._unit.close()
        os.close(self._master)
        os.close(self._slave)

    def _run(self) -> None:
        while not self._ended.is_set():
            ready, _, _ = select.select([self._unit.fileno(), self._master], [], [], POLL_SECONDS)
            if self._master in ready:
                data = os.read(self._master, 4096)
                if self._echo:
                    os.write(self._master, data)
                self._unit.sendall(self._harm(data))
            if self._unit.fileno() in ready:
                with contextlib.suppress(ConnectionError):
                    self._hear(self._unit.recv(4096))

    def _hear(self, data: bytes) -> None:
        if self.restarted_as:
            self._unit.close()
            self._unit = connect(self.restarted_as)
            self.restarted_as = None
            return
        os.write(self._master, self._harm(data))

    def _harm(self, data: bytes) -> bytes:
        if self._random.random() >= self._probability:
            return data
        self.harmed += 1
        harm = self._random.choice([self._lose, self._flip, self._cut, self._insert])
        return harm(data)

    def _lose(self, data: bytes) -> bytes:
        return b""

    def _flip(self, data: bytes) -> bytes:
        changed = bytearray(data)
        for _ in range(self._random.randint(1, 3)):
            changed[self._random.randrange(len(data))] ^= 1 << self._random.randrange(8)
        return bytes(changed)

    def _cut(self, data: bytes) -> bytes:
        return data[: self._random.randrange(len(data))]

    def _insert(self, data: bytes) -> bytes:
        place = self._random.randrange(len(data) + 1)
        noise = self._random.randbytes(self._random.randint(1, 20))
        return data[:place] + noise + data[place:]
