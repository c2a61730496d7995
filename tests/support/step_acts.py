"""The step driver of a board under a list of acts (tests/vboard/images/step_acts_main.c).

Ticks count from when TIM2 began to count; the board is told from where. The pulses are those that
the virtual board has seen at the pins.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

from reference import TICK_HZ
from rkm04_tools import board, virtual_board
from virtual_board import SIGNAL

MOTORS = range(4)
SHORT, LONG = "f405", "f407-discovery"  # boards of short and of long pulses
WIDTH = {SHORT: 42, LONG: 210}  # ticks, high and low alike
WRAP = 1 << 32
READY = 300_000
"""By this tick all is set up."""
QUANTA = 2 * TICK_HZ * TICK_HZ << 7  # of a step: firmware/engine/step/step_scale.h
ACTS, ACT, NOTE_WORDS = 1500, struct.Struct("<IIQII"), 9
READY_SEGMENTS = 30  # of the 32 that a channel has room for
ODD = ["--refill", "1", "--match-equal", "--requests-stay"]
FAST_BUS = ["--apb-wait", "3", "--pwm-at-once"]


class What(IntEnum):
    """As enum what."""

    (
        END,
        BEGIN,
        PUSH,
        RUN,
        HALT,
        REST,
        WAIT,
        HOLD,
        RELEASE,
        CONNECT,
        DIRECT,
        QUIET,
        NOTE,
        REPLACE,
        TURN,
        FREEZE,
        RECALL,
    ) = range(17)


@dataclass(frozen=True)
class Note:
    """As struct note."""

    tick: int
    running: int
    pulses: int
    told: int
    stuck: int
    asks: int
    streams: int
    marked: int
    waiting: int


@dataclass
class Shown:
    """A run: ticks of each motor's edges, and what main has noted."""

    rises: list[list[int]]
    falls: list[list[int]]
    directions: list[list[tuple[int, int]]]  # tick and level
    positions: list[int]
    late: int
    notes: list[Note]
    summary: dict[str, Any]

    @cached_property
    def widths(self) -> set[int]:
        """Of all pulses; each has an end."""
        pairs = [zip(*edges, strict=True) for edges in zip(self.rises, self.falls, strict=True)]
        return {fall - rise for each in pairs for rise, fall in each}

    @property
    def least_gap(self) -> int:
        gaps = [
            rise - fall
            for rises, falls in zip(self.rises, self.falls, strict=True)
            for fall, rise in zip(falls, rises[1:], strict=False)
        ]
        return min(gaps)


@dataclass
class Acts:
    """What main does, in order."""

    program: Path
    folder: Path
    board: str = SHORT
    start: int = 0  # where the counter of TIM2 begins
    half_period: bool = False
    rows: list[bytes] = field(default_factory=list)
    noted: int = 0

    def add(
        self, what: What, motor: int = 0, tick: int = 0, slope: int = 0, pace: int = 0,
        steps: int = 0, marked: bool = False,
    ) -> None:  # fmt: skip
        counter = (self.start + tick) % WRAP
        self.rows.append(ACT.pack(what | motor << 8 | marked << 16, counter, slope, pace, steps))

    def begin(self, motor: int, tick: int, backward: bool = False) -> None:
        self.add(What.BEGIN, motor, tick, steps=int(backward))

    def push(self, motor: int, tick: int, marked: bool = False) -> None:
        """A pulse that is a segment of its own."""
        self.add(What.PUSH, motor, tick, QUANTA // 1000, 1000, 1, marked)

    def push_train(self, motor: int, tick: int, slope: int, steps: int) -> list[int]:
        """Pulses at one speed, in quanta a tick; their ticks."""
        self.add(What.PUSH, motor, tick, slope, QUANTA // slope, steps)
        return [tick + (2 * i * QUANTA + slope) // (2 * slope) for i in range(steps)]

    def push_steady(self, motor: int, tick: int, pace: int, steps: int) -> list[int]:
        self.push_train(motor, tick, QUANTA // pace, steps)
        return [tick + pace * i for i in range(steps)]

    def run(self, motor: int) -> None:
        self.add(What.RUN, motor)

    def move(self, motor: int, *ticks: int, backward: bool = False) -> None:
        """Begin a move of some pulses that are segments of their own."""
        self.begin(motor, ticks[0] - 1000, backward)
        for tick in ticks:
            self.push(motor, tick)
        self.run(motor)

    def move_steady(self, motor: int, tick: int, pace: int, steps: int) -> list[int]:
        self.begin(motor, tick - 1000)
        ticks = self.push_steady(motor, tick, pace, steps)
        self.run(motor)
        return ticks

    def move_each(self, ticks: Mapping[int, Sequence[int]]) -> None:
        """Moves of some motors, in their order; each pulse is a segment of its own."""
        for motor, mine in ticks.items():
            self.begin(motor, mine[0] - 1000)
            for tick in mine[:READY_SEGMENTS]:
                self.push(motor, tick)
        for motor in ticks:
            self.run(motor)
        later = [(tick, motor) for motor, mine in ticks.items() for tick in mine[READY_SEGMENTS:]]
        for tick, motor in sorted(later):
            self.push(motor, tick)

    def wait(self, tick: int) -> None:
        self.add(What.WAIT, tick=tick)

    def rest(self, *motors: int) -> None:
        for motor in motors or MOTORS:
            self.add(What.REST, motor)

    def note(self, motor: int = 0) -> int:
        """The number of the note."""
        self.add(What.NOTE, motor)
        self.noted += 1
        return self.noted - 1

    def replace(self, motor: int, ahead: int, pace: int, steps: int) -> int:
        """The number of the note: `running` if it was in time, `pulses` up to the one before."""
        self.add(What.REPLACE, motor, ahead - self.start, QUANTA // pace, pace, steps)
        self.noted += 1
        return self.noted - 1

    def turn(self, motor: int, backward: bool) -> None:
        """The way of what is pushed from now on."""
        self.add(What.TURN, motor, steps=int(backward))

    def freeze(self, motor: int, back: int) -> int:
        """The number of the note: `running` if it was in time."""
        self.add(What.FREEZE, motor, steps=back)
        self.noted += 1
        return self.noted - 1

    def recall(
        self, motor: int, tick: int = 0, pace: int = 1, steps: int = 0, backward: bool = False
    ) -> list[int]:
        """Instead of what is frozen; the ticks."""
        self.add(What.RECALL, motor, tick, QUANTA // pace, pace, steps, backward)
        return [tick + pace * i for i in range(steps)]

    def show(self, *options: str) -> Shown:
        """Run it."""
        assert len(self.rows) < ACTS
        image = board.build(self.board, "step_acts_image", half_period=self.half_period)
        (self.folder / "pins").write_text(virtual_board.board_pins(self.board))
        elf = image.file("elf").with_name(f"{image.name}-step-acts.elf")
        acts = b"".join(self.rows).ljust(ACTS * ACT.size, b"\0").hex()
        arguments = ["--elf", str(elf), "--pins", str(self.folder / "pins"), "--for", "2"]
        arguments += ["--end-at", "acts_done", "--set", f"acts={acts}"]
        arguments += ["--steps", str(self.folder / "steps"), "--ticks", "timer"]
        arguments += ["--vcd", str(self.folder / "vcd"), "--timer-start", str(self.start)]
        arguments += ["--watch", "notes", "--watch", "stm32_late_steps", *options]
        summary = virtual_board.run(self.program, arguments)
        assert summary["ended"] == "reached", summary["error"]
        assert summary["warnings"] == 0
        return self._shown(summary)

    def _shown(self, summary: dict[str, Any]) -> Shown:
        rises: list[list[int]] = [[] for _ in MOTORS]
        positions = [0 for _ in MOTORS]
        rows = (self.folder / "steps").read_text().splitlines()[2:]
        for tick, motor, position in (map(int, row.split(",")) for row in rows):
            rises[motor - 1].append(tick)
            positions[motor - 1] = position
        falls, directions = self._levels(rises)
        words = summary["watch"]["notes"]
        notes = [Note(*words[i * NOTE_WORDS :][:NOTE_WORDS]) for i in range(self.noted)]
        late = summary["watch"]["stm32_late_steps"]
        return Shown(rises, falls, directions, positions, late, notes, summary)

    def _levels(
        self, rises: list[list[int]]
    ) -> tuple[list[list[int]], list[list[tuple[int, int]]]]:
        """From the waves, whose times are counted from power-on in ns."""
        text = (self.folder / "vcd").read_text()
        names = dict(SIGNAL.findall(text))
        changes: dict[str, list[tuple[float, int]]] = {name: [] for name in names.values()}
        now = 0.0
        for line in text.partition("$dumpvars")[2].partition("$end")[2].splitlines():
            if line[:1] == "#":
                now = int(line[1:]) * TICK_HZ / 1e9
            elif line[:1] in ("0", "1") and line[1:] in names:
                changes[names[line[1:]]].append((now, int(line[0])))
        falls, directions = [], []
        for motor in MOTORS:
            steps, ways = changes[f"m{motor + 1}_step"], changes[f"m{motor + 1}_dir"]
            first = next((at for at, level in steps if level), 0.0)
            since = first - rises[motor][0] if rises[motor] else 0.0
            falls.append([round(at - since) for at, level in steps if not level])
            directions.append([(round(at - since), level) for at, level in ways])
        return falls, directions


MakeActs = Callable[..., Acts]


def gaps(ticks: Sequence[int]) -> list[int]:
    """Between neighbours."""
    return [b - a for a, b in pairwise(ticks)]
