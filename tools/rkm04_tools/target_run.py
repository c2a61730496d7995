"""Runs of a target image on the virtual board, for `bench --target stm32`.

Programs come by the line as in `sim --target stm32`: each is held by `[` until all have come, then
`]` releases them on the same tick.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rkm04_tools import board, virtual_board
from rkm04_tools.frame import Frame
from rkm04_tools.sim_board import ANSWER_MS, BYTE_MS, LATE, NODE, READY_MS, SET_COMMAND

STEP_VECTOR = "TIM2"


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
BESIDE = Model(2)


@dataclass(frozen=True)
class Line:
    """What the line sends, and when the programs are released, in ms."""

    lines: str
    released_ms: float


def programs(texts: Mapping[int, bytes]) -> Line:
    """Programs of some motors, released together."""
    at, come, lines = READY_MS, 0.0, ""
    for motor, text in [*((m, b"[" + t) for m, t in texts.items()), (0, b"]")]:
        data = Frame(NODE, 0, SET_COMMAND + b"%d" % motor + text).encode()
        lines += f"{at:.3f} {data.hex()}\n"
        come = at + len(data) * BYTE_MS
        at = come + ANSWER_MS
    return Line(lines, come)


@dataclass(frozen=True)
class Ran:
    """What a run told."""

    summary: dict[str, Any]
    steps_file: Path
    profile_file: Path

    @property
    def load(self) -> float:
        """Cycles not asleep, of all."""
        return float(self.summary["load"])

    @property
    def late(self) -> int:
        """Steps that came later than asked for."""
        return int(self.summary["watch"][LATE])

    @property
    def pulses(self) -> int:
        """Of all motors."""
        return sum(int(motor["pulses"]) for motor in self.summary["motors"])

    def vector(self, name: str = STEP_VECTOR) -> dict[str, Any]:
        """What an exception has cost; all 0 if it never came."""
        nothing = dict.fromkeys(("count", "cycles", "min", "median", "max", "latency_max"), 0)
        return next((v for v in self.summary["vectors"] if v["name"] == name), nothing)

    def ticks(self) -> dict[int, np.ndarray]:
        """The ticks of all pulses of each motor, from power-on."""
        found: dict[int, list[int]] = {}
        with self.steps_file.open() as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                found.setdefault(int(row["motor"]), []).append(int(row["tick"]))
        return {motor: np.array(ticks, dtype=np.int64) for motor, ticks in found.items()}


@dataclass(frozen=True)
class Rig:
    """The virtual board with an image."""

    program: Path
    elf: Path
    board: str
    folder: Path

    def run(
        self, seconds: float, line: str = "", inputs: str = "", *options: str, model: Model = GATE,
        steps: bool = False, profile: bool = False,
    ) -> Ran:  # fmt: skip
        """Run the image from power-on."""
        arguments = ["--elf", str(self.elf), "--for", f"{seconds:.9f}", *model.options]
        arguments += ["--watch", LATE, "--stack-limit", "stm32_stack_bottom"]
        texts = {"pins": virtual_board.board_pins(self.board), "line-script": line}
        for name, text in {**texts, "inputs": inputs}.items():
            if text:
                path = self.folder / name
                path.write_text(text)
                arguments += [f"--{name}", str(path)]
        steps_file, profile_file = self.folder / "steps.csv", self.folder / "profile.csv"
        arguments += ["--steps", str(steps_file)] if steps else []
        arguments += ["--profile", str(profile_file)] if profile else []
        summary = virtual_board.run(self.program, [*arguments, *options])
        return Ran(summary, steps_file, profile_file)


def rig(folder: Path, name: str = board.DEFAULT_BOARD) -> Rig:
    """The image of a board, built if need be."""
    program = virtual_board.program_path()
    image = board.build(name)
    return Rig(program, image.file("elf"), name, folder)
