"""GVE134 on the virtual board makes the pulses of the simulator, tick for tick.

Paths come as packets, so that all vectors of one are there when it begins, on the board as in the
simulator. Times count from the first pulse of each path.
"""

from __future__ import annotations

import random
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from judge import Steps, read_steps
from rkm04_tools import board, virtual_board
from rkm04_tools.gve134 import host as gve134_host
from virtual_board import TICKS_PER_MS, Modelled, of_motor

UNIT = "gve134"
BEGIN_MS = 50.0
SETTLE_MS = 30.0
BYTE_MS = 10 / 115.2
MOTORS = range(1, 5)


@dataclass(frozen=True)
class Path134:
    """What is sent before a packet, and the packet's vectors."""

    modal: list[str]
    vectors: list[str]

    @property
    def lines(self) -> list[str]:
        return [*self.modal, "*S", *self.vectors, f"*E{len(self.vectors)}"]


@pytest.fixture
def play(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., tuple[Modelled, Steps]]:
    """Play a path on both."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    image = board.build(board.DEFAULT_BOARD, what=UNIT)

    def both(path: Path134) -> tuple[Modelled, Steps]:
        file, simulated, modelled = (tmp_path / name for name in ("p.gve", "s.csv", "board.csv"))
        file.write_text("".join(f"{line}\n" for line in path.lines))
        command = [gve134_host.program_path(), "sim", file, "--steps", simulated]
        subprocess.run(list(map(str, command)), check=True, capture_output=True)
        steps = read_steps(simulated)
        path_ms = float(steps.tick.max() - steps.tick.min()) / TICKS_PER_MS
        data = "".join(f"!0{line}\r" for line in path.lines) + "!0P4\r"
        wait = BEGIN_MS + len(data) * BYTE_MS + SETTLE_MS + path_ms
        asks = f"{BEGIN_MS} {data[:-5].encode().hex()}\n{wait:.3f} {data[-5:].encode().hex()}\n"
        for name, text in (("line", asks), ("pins", virtual_board.board_pins(image.board, UNIT))):
            (tmp_path / name).write_text(text)
        options = ["--elf", str(image.file("elf")), "--pins", str(tmp_path / "pins")]
        options += ["--line-script", str(tmp_path / "line"), "--baud", "115200"]
        options += ["--line-log", str(tmp_path / "log.txt"), "--steps", str(modelled)]
        options += ["--vcd", str(tmp_path / "board.vcd"), "--watch", "stm32_late_steps"]
        options += ["--stack-limit", "stm32_stack_bottom", "--for", f"{(wait + 20) / 1000:.6f}"]
        summary = virtual_board.run(program, options)
        return Modelled(summary, read_steps(modelled), tmp_path), steps

    return both


def answers(modelled: Modelled) -> list[str]:
    rows = (modelled.folder / "log.txt").read_text().split()[1::2]
    return bytes(int(byte, 16) for byte in rows).decode().rstrip("\r").split("\r")


def random_path(seed: int) -> Path134:
    """A packet of short and long vectors, sharp corners, single axes and standing ones."""
    chance = random.Random(seed)
    top = chance.choice([2_000, 20_000, 100_000, 200_000])
    modal = [f"A{chance.choice([50, 200, 2000])}", f"V{top}", f"${chance.choice([1, 512])}"]
    modal += [chance.choice(["VK", "VN"]), f"B{chance.choice([1000, 5000, 200_000])}"]
    if chance.random() < 0.5:
        modal.append(f"VJ{top // 4},{top // 3},{top // 2},{top}")
    reach = chance.choice([60, 400, 3000])
    vectors = []
    for _ in range(chance.randint(3, 40)):
        way = [chance.randint(-reach, reach) * chance.choice([0, 1, 1]) for _ in MOTORS]
        vectors.append("C" + ",".join(map(str, way if any(way) else [1, 0, 0, 0])))
    return Path134(modal, vectors)


def same(modelled: Modelled, simulated: Steps) -> None:
    for motor in MOTORS:
        ticks, places = of_motor(simulated, motor)
        real, made = of_motor(modelled.steps, motor)
        assert len(real) == len(ticks)
        assert np.array_equal(real, ticks)
        assert np.array_equal(np.diff(made), np.diff(places))
    assert modelled.late_steps == 0


@pytest.mark.parametrize("seed", range(10))
def test_a_path_on_the_board_is_that_of_the_simulator(play, seed):
    path = random_path(seed)
    modelled, simulated = play(path)
    said = answers(modelled)
    ends = [int(way) for way in said[-1].split(",")[1:]]

    assert said[:-1] == ["0"] * len(path.modal) + [f"0,{len(path.vectors)}"]
    assert ends == [
        sum(int(vector[1:].split(",")[motor]) for vector in path.vectors) for motor in range(4)
    ]
    same(modelled, simulated)
    for motor in modelled.summary["motors"]:
        assert motor["pulses"] == 0 or motor["width_min"] == pytest.approx(2.5, abs=0.001)


def test_the_unit_answers_within_a_millisecond(play):
    modelled, _ = play(Path134(["V1000"], ["C10,0,0,0"]))
    rows = [row.split() for row in (modelled.folder / "log.txt").read_text().splitlines()]
    asked = BEGIN_MS + len("!0V1000\r") * BYTE_MS

    assert float(rows[0][0]) - asked < 1.0
