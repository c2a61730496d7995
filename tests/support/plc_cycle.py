"""A PLC in virtual time: cycles that jitter, a Modbus master whose requests and answers get lost.

Blocks of Structured Text are called once in a cycle, in the order in which they were added. The
master has one request on the line at a time; it takes Out as it is at the end of a cycle, and what
it has read stands in In from the start of the next one. With `split` it writes (FC 16) and reads
(FC 3) in turn, else both in one (FC 23).
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fake_positioning import FakeUnit
from st_program import Blocks, Instance

AXES = 4
TIMEOUT_MS = 60
ENDS = ("Done", "CommandAborted", "Error")


@dataclass(frozen=True)
class Line:
    """What the line does: times in ms, losses as a part of 1."""

    cycle: int = 10
    jitter: int = 0
    delay: int = 5  # of a request, and again of its answer
    spread: int = 0  # up to which either delay grows
    lost_requests: float = 0.0
    lost_answers: float = 0.0
    split: bool = False
    patience: int = 400  # without an answer, after which the unit is not Online


class Plc:
    """The PLC, its line and the unit."""

    def __init__(self, blocks: Blocks, unit: Any = None, line: Line = Line(), seed: int = 0):
        self.blocks = blocks
        self.unit = unit or FakeUnit()
        self.line = line
        self.chance = random.Random(seed)
        self.axes = [blocks.make("POS_AXIS") for _ in range(AXES)]
        self.called: list[Instance] = []
        self.executes: dict[int, bool] = {}
        self.now = 0
        self.next_cycle = 0
        self.cycles = 0
        self.cut = False  # the cable
        self.events: list[tuple[int, Callable[[], None]]] = []
        self.request_ends: int | None = None  # when the answer is no more waited for
        self.reads = False  # of a split master: what comes next
        self.answer: list[int] | None = None
        self.captured: list[list[int]] | None = None
        self.heard = -self.line.patience

    def add(self, name: str, axis: int = 1, **inputs: Any) -> Instance:
        """A block or program that is called in each cycle from here on."""
        block: Instance = self.blocks.make(name)
        if "AXIS" in block.types:
            inputs["Axis"] = self.axes[axis - 1]
        for key, value in inputs.items():
            block[key] = value
        self.called.append(block)
        return block

    def power(self, axis: int = 1) -> Instance:
        """Waits for the unit, then has MC_Power take an axis."""
        block = self.add("MC_Power", axis)
        self.until(lambda: self.axes[axis - 1]["Online"])
        block["Enable"] = True
        self.until(lambda: block["Status"])
        return block

    def start(self, name: str, axis: int = 1, **inputs: Any) -> Instance:
        """Adds a block, and calls it once with the rising edge of Execute."""
        block = self.add(name, axis, Execute=True, **inputs)
        self.run(1)
        return block

    def restart(self) -> None:
        """The PLC starts again: its variables are forgotten, its program stays."""
        self.axes = [self.blocks.make("POS_AXIS") for _ in range(AXES)]
        self.called, self.executes, self.answer = [], {}, None
        self.heard = -self.line.patience

    def run(self, cycles: int) -> None:
        last = self.cycles + cycles
        while self.cycles < last:
            self.millisecond()

    def until(self, condition: Callable[[], Any], cycles: int = 3000) -> None:
        """Goes on until the condition holds at the end of a cycle."""
        for _ in range(cycles):
            self.run(1)
            if condition():
                return
        raise AssertionError("it does not come")

    def millisecond(self) -> None:
        self.now += 1
        self.unit.step()
        due = [event for event in self.events if event[0] <= self.now]
        self.events = [event for event in self.events if event[0] > self.now]
        for _, act in due:
            act()
        if self.request_ends is not None and self.now >= self.request_ends:
            self.request_ends = None
        if self.now >= self.next_cycle:
            self.cycle()
            late = self.chance.randint(-self.line.jitter, self.line.jitter)
            self.next_cycle = self.now + max(1, self.line.cycle + late)

    def cycle(self) -> None:
        self.cycles += 1
        for number, axis in enumerate(self.axes):
            axis["Online"] = self.now - self.heard < self.line.patience
            if self.answer is not None:
                axis["In"][:8] = self.answer[8 * number : 8 * number + 8]
                if self.captured is not None:
                    axis["In"][14:16] = self.captured[number]
        for block in self.called:
            block.run()
            self.judge(block)
        if self.request_ends is None:
            self.send()

    def judge(self, block: Instance) -> None:
        """From a rising edge on, one of the outputs is TRUE; in its call that is Busy."""
        if "EXECUTE" not in block.types:
            return
        rises = block["Execute"] and not self.executes.get(id(block), False)
        self.executes[id(block)] = block["Execute"]
        ends = [block[name] for name in ENDS if name.upper() in block.types]
        assert not rises or block["Busy"]
        if block["Execute"]:
            assert [block["Busy"], *ends].count(True) == 1
        else:
            assert [block["Busy"], *ends].count(True) <= 1
        assert block["Error"] == (block["ErrorID"] != 0)

    def send(self) -> None:
        """A request goes out; whether it comes and is answered is a matter of chance."""
        out = [word for axis in self.axes for word in axis["Out"]]
        asks = not self.line.split or self.reads
        writes = not self.line.split or not self.reads
        self.reads = not self.reads
        self.request_ends = self.now + TIMEOUT_MS
        if self.cut or self.chance.random() < self.line.lost_requests:
            return
        arrival = self.now + self.delay()
        self.events.append((arrival, lambda: self.serve(out if writes else None, asks)))

    def delay(self) -> int:
        return self.line.delay + self.chance.randint(0, self.line.spread)

    def serve(self, out: list[int] | None, asks: bool) -> None:
        """The request begins to reach the unit; an answer may get lost on its way."""
        is_lost = self.chance.random() < self.line.lost_answers

        def tell(answer: list[int] | None, captured: list[list[int]] | None) -> None:
            if not self.cut and not is_lost:
                event = (self.now + self.delay(), lambda: self.take(answer, captured))
                self.events.append(event)

        self.unit.ask(out, asks, tell)

    def take(self, answer: list[int] | None, captured: list[list[int]] | None) -> None:
        self.request_ends = None
        self.heard = self.now
        if answer is not None:
            self.answer, self.captured = answer, captured
