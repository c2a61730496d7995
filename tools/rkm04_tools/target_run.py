"""Runs of target images on the virtual board, for `bench --target stm32`.

Two images: that of the board, whose programs come by the line as in `sim --target stm32`, and the
bench image, which is the same but for its main: that one takes its moves from a table
(hal/stm32/bench/bench_main.c), so that they may be faster than the language allows.
"""

from __future__ import annotations

import csv
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rkm04_tools import board, virtual_board
from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.frame import Frame
from rkm04_tools.sim_board import ANSWER_MS, BYTE_MS, LATE, NODE, READY_MS, SET_COMMAND

STEP_VECTOR = "TIM2"
MOTORS = range(1, 5)
TICKS_PER_MS = 84_000

STACK_BOTTOM = "stm32_stack_bottom"
TABLE, REPORT, DONE = "bench_table", "bench_report", "bench_done"
"""Symbols of the images."""

MOVES_BEGIN_MS = 3.0
"""The bench image is up by then, and no move of it has begun."""
BENCH_SECONDS_MAX = 2.0
"""No moves take one; at too high a rate the image resets itself again and again."""


@dataclass(frozen=True)
class Model:
    """The cycle model: cycles to refill the pipeline, and wait states of the flash."""

    refill: int
    wait_states: int = 5

    @property
    def name(self) -> str:
        """For heads of tables."""
        return f"P = {self.refill}"

    @property
    def options(self) -> list[str]:
        """For the virtual board."""
        return ["--refill", str(self.refill), "--wait-states", str(self.wait_states)]


GATE = Model(3)
"""What budgets and goals are held against."""
BESIDE = Model(2)
"""Nearer to published figures of such parts."""


@dataclass(frozen=True)
class Line:
    """What the line sends, and when the programs are released, in ms."""

    lines: str
    released_ms: float


def programs(texts: Mapping[int, bytes]) -> Line:
    """Programs of some motors: held by `[` until all have come, then released together."""
    at, come, lines = READY_MS, 0.0, ""
    for motor, text in [*((m, b"[" + t) for m, t in texts.items()), (0, b"]")]:
        data = Frame(NODE, 0, SET_COMMAND + b"%d" % motor + text).encode()
        lines += f"{at:.3f} {data.hex()}\n"
        come = at + len(data) * BYTE_MS
        at = come + ANSWER_MS
    return Line(lines, come)


@dataclass(frozen=True)
class Move:
    """A move of the bench image: steps, steps/s, steps/s^2."""

    steps: int
    start_speed: int
    speed: int
    accel: int
    delay_ticks: int = 0

    @property
    def packed(self) -> bytes:
        """As struct bench_move."""
        values = (self.steps, self.start_speed, self.speed, self.accel, self.delay_ticks)
        return struct.pack("<5I", *values)


@dataclass(frozen=True)
class Stop:
    """An edge at an input that stops the moves of the bench image; the pulses are kept."""

    number: int
    ms: float

    @property
    def guards(self) -> int:
        """As in struct bench_table."""
        return 1 << self.number - 1

    @property
    def inputs(self) -> str:
        """The script of the inputs."""
        return f"{self.ms:.6f},{self.number},1\n"


@dataclass(frozen=True)
class Ran:
    """What a run told."""

    summary: dict[str, Any]
    folder: Path

    @property
    def load(self) -> float:
        """Cycles not asleep, of all, in percent."""
        return 100 * float(self.summary["load"])

    @property
    def late(self) -> int:
        """Steps that came later than asked for."""
        return int(self.summary["watch"][LATE])

    @property
    def pulses(self) -> int:
        """Of all motors."""
        return sum(int(motor["pulses"]) for motor in self.summary["motors"])

    @property
    def positions(self) -> list[int]:
        """Of the drivers."""
        return [int(motor["position"]) for motor in self.summary["motors"]]

    @property
    def stack_used(self) -> int:
        """The deepest that the stack ever was, in bytes."""
        return int(self.summary["stack"]["used"])

    @property
    def step_cycles(self) -> float:
        """What a pulse costs the step interrupt."""
        return self.step_interrupt["cycles"] / self.pulses

    @property
    def step_interrupt(self) -> dict[str, int]:
        """How often it ran, its cycles (all, min, median, max), and how long it had to wait."""
        nothing = dict.fromkeys(("count", "cycles", "min", "median", "max", "latency_max"), 0)
        return next((v for v in self.summary["vectors"] if v["name"] == STEP_VECTOR), nothing)

    @property
    def shortest_us(self) -> float:
        """Of all pulses at STEP."""
        return min(float(motor["width_min"]) for motor in self.summary["motors"])

    @property
    def profile_file(self) -> Path:
        """Where the cycles went, if that was asked for."""
        return self.folder / "profile.csv"

    def ticks(self) -> dict[int, np.ndarray]:
        """The ticks of all pulses of each motor, from power-on, if they were asked for."""
        found: dict[int, list[int]] = {}
        with (self.folder / "steps.csv").open() as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                found.setdefault(int(row["motor"]), []).append(int(row["tick"]))
        return {motor: np.array(ticks, dtype=np.int64) for motor, ticks in found.items()}


@dataclass(frozen=True)
class Rig:
    """The virtual board with the images of a board in it, and the cycle model."""

    program: Path
    image: board.Image
    folder: Path
    model: Model = GATE

    @property
    def elf(self) -> Path:
        """The image of the board."""
        return self.image.file("elf")

    @property
    def bench_elf(self) -> Path:
        """The bench image."""
        return self.elf.with_name(f"{self.image.name}-bench.elf")

    @property
    def paths_elf(self) -> Path:
        """The bench image for paths."""
        return self.elf.with_name(f"{self.image.name}-paths.elf")

    def beside(self, name: str, model: Model) -> Rig:
        """The same in a folder of its own."""
        folder = self.folder / name
        folder.mkdir()
        return replace(self, folder=folder, model=model)

    def of(self, name: str) -> Rig:
        """The same with the images of another board, built if need be."""
        return replace(self, image=board.build(name, what=self.image.unit))

    def run(
        self, seconds: float, line: str = "", inputs: str = "", *options: str,
        steps: bool = False, profile: bool = False, flash: Path | None = None,
    ) -> Ran:  # fmt: skip
        """Run the image of the board from power-on."""
        files = {"line-script": line, "inputs": inputs}
        kept = ["--flash", str(flash)] if flash else []
        arguments = [*self._files(files, steps, profile), *kept, *options]
        return self._run(self.elf, seconds, arguments)

    def run_moves(
        self, moves: Sequence[Move], *options: str, line: str = "", stop_at_late: bool = False,
        stop: Stop | None = None,
    ) -> Ran:  # fmt: skip
        """Run the bench image to the end of its moves; those of motors 1, 2 and so on."""
        none = Move(0, 0, 0, 0)
        table = b"".join(move.packed for move in [*moves, *[none] * (len(MOTORS) - len(moves))])
        put = (table + struct.pack("<2I", stop_at_late, stop.guards if stop else 0)).hex()
        arguments = ["--set", f"{TABLE}={put}", "--end-at", DONE, "--watch", REPORT]
        files = {"line-script": line, "inputs": stop.inputs if stop else ""}
        arguments += [*self._files(files, steps=stop is not None), *options]
        return self._run(self.bench_elf, BENCH_SECONDS_MAX, arguments)

    def run_other(self, elf: Path, seconds: float, arguments: Sequence[str], line: str) -> Ran:
        """Run an image with a table of its own."""
        return self._run(elf, seconds, [*self._files({"line-script": line}), *arguments])

    def _files(
        self, texts: Mapping[str, str], steps: bool = False, profile: bool = False
    ) -> list[str]:
        arguments = []
        pins = virtual_board.board_pins(self.image.board, self.image.unit)
        for name, text in {**texts, "pins": pins}.items():
            if text:
                path = self.folder / name
                path.write_text(text)
                arguments += [f"--{name}", str(path)]
        arguments += ["--steps", str(self.folder / "steps.csv")] if steps else []
        return arguments + (["--profile", str(self.folder / "profile.csv")] if profile else [])

    def talk(self, seconds: float, *options: str, steps: bool = False) -> virtual_board.Talk:
        """Run the image of the board from power-on with a client in virtual time on its line."""
        files = self._files({}, steps)
        arguments = [*self._common(self.elf, seconds), *files, "--lockstep", *options]
        return virtual_board.Talk(self.program, arguments)

    def _common(self, elf: Path, seconds: float) -> list[str]:
        common = ["--elf", str(elf), "--for", f"{seconds:.9f}", *self.model.options]
        return [*common, "--watch", LATE, "--stack-limit", STACK_BOTTOM]

    def _run(self, elf: Path, seconds: float, arguments: Sequence[str]) -> Ran:
        return self.ran(virtual_board.run(self.program, [*self._common(elf, seconds), *arguments]))

    def ran(self, summary: dict[str, Any]) -> Ran:
        """What a run told; the image must have come through it."""
        ran = Ran(summary, self.folder)
        if ran.summary["resets"]["power"] != 1 or ran.summary["resets"]["watchdog"]:
            raise Failure("the image was reset during a run of the bench", NOT_SO)
        return ran


def ended_well(ran: Ran, moves: Sequence[Move]) -> bool:
    """Whether the moves of a bench image came to their ends: unit and drivers agree."""
    wanted = [move.steps for move in moves] + [0] * (len(MOTORS) - len(moves))
    _, *places, ended = ran.summary["watch"][REPORT]
    return ended == len(moves) and places == wanted and ran.positions == wanted


def ended_stopped(ran: Ran, motors: int) -> bool:
    """Whether moves of a bench image that were stopped came to an end: unit and drivers agree."""
    _, *places, ended = ran.summary["watch"][REPORT]
    return bool(ended == motors and places == ran.positions)


def rig(
    folder: Path,
    name: str = board.DEFAULT_BOARD,
    unit: str = board.UNIT,
    baud: int | None = None,
) -> Rig:
    """The images of a board, built if need be."""
    program = virtual_board.program_path()
    return Rig(program, board.build(name, what=unit, baud=baud), folder)
