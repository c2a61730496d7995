"""A GVE134 unit in virtual time, for a host on a line that loses and changes bytes.

All that comes to the unit is kept, as it came, with all that the unit did: a session that can be
held against the model.
"""

from __future__ import annotations

import random

from gve_course import MS
from gve_line import Byte
from gve_probe import Probe, Reader, begin_of, lines_of
from gve_record import BYTE_TICKS, Done, Edge, Session

FAR = 2**63 - 1


class Live:
    """A unit just switched on, and the line to it.

    `harm` is the chance of a byte to be lost, and as large again to be changed, each way.
    """

    def __init__(self, probe: Probe, seed: int, harm: float) -> None:
        """Switch the unit on."""
        self.harm = harm
        self.harmed = [0, 0]
        """Bytes that came to harm, to the unit and from it."""
        self._random = random.Random(seed)
        self._probe = probe
        self._reader = Reader(FAR)
        self._to_come = begin_of(Session(()))
        self._heard: list[Byte] = []
        self._edges: list[Edge] = []
        self._free_tick = 0

    @property
    def now(self) -> int:
        """The tick that it is."""
        return self._reader.tick

    def set_input(self, number: int, level: int, after: int = 0) -> None:
        """Give an input another level, now or some ticks later."""
        edge = Edge(self.now + after + 1, number, level)
        self._edges.append(edge)
        self._to_come += lines_of([edge], [])

    def send(self, data: bytes) -> None:
        """Put bytes on the line, one after the other."""
        tick = max(self.now, self._free_tick)
        passed = []
        for value in data:
            tick += BYTE_TICKS
            passed += [Byte(tick, each) for each in self._pass(value, 0)]
        self._free_tick = tick
        self._heard += passed
        self._to_come += lines_of([], passed)

    def receive(self, ticks: int) -> bytes:
        """Wait so long after what was sent, or for a CR; what has come."""
        until = max(self.now, self._free_tick) + ticks
        came = b""
        while self.now < until and b"\r" not in came:
            self._probe.tell([*self._to_come, f"go {until}"], self._reader)
            self._to_come = []
            for _, value in self._reader.sent:
                came += bytes(self._pass(value, 1))
            self._reader.sent.clear()
        return came

    def _pass(self, value: int, way: int) -> list[int]:
        """What becomes of a byte."""
        chance = self._random.random()
        if chance >= 2 * self.harm:
            return [value]
        self.harmed[way] += 1
        return [] if chance < self.harm else [value ^ self._random.randint(1, 255)]

    def session(self) -> Session:
        """All that came to the unit; `done` is what it did."""
        self.receive(10 * MS)
        self.done.motors.end = self.now
        edges = sorted(self._edges, key=lambda edge: edge.tick)
        return Session(tuple(self._heard), tuple(edges), self.now)

    @property
    def done(self) -> Done:
        """What the unit did."""
        return self._reader.done
