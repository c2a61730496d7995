"""GVE134 on the virtual board makes the pulses of the simulator, tick for tick.

Paths come as packets, so that all vectors of one are there when it begins, on the board as in the
simulator. Times count from the first pulse of each path. RKM04_LONG=1 tries more paths.
"""

from __future__ import annotations

import os
import random
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from judge import Steps, read_steps
from reference import TICK_HZ
from rkm04_tools import board
from rkm04_tools.gve134 import host as gve134_host
from rkm04_tools.gve134 import sim_board
from rkm04_tools.sim_board import READY_MS
from rkm04_tools.source import Source
from rkm04_tools.target_run import Rig
from virtual_board import Modelled, of_motor

UNIT = "gve134"
BAUD = 115_200
BYTE_MS = 10_000 / BAUD
SECONDS = 60.0
SETTLE_SECONDS = 0.03
MOTORS = range(1, 5)
SEEDS = range(24 if os.environ.get("RKM04_LONG") else 6)
HALVES = 2


@dataclass(frozen=True)
class Path134:
    """What is sent before a packet, and the packet's vectors."""

    modal: list[str]
    vectors: list[str]

    @property
    def text(self) -> str:
        """The file."""
        packet = ["*S", *self.vectors, f"*E{len(self.vectors)}"]
        return "".join(f"{line}\n" for line in [*self.modal, *packet])


@pytest.fixture
def play(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., tuple[sim_board.Played, Modelled, Steps]]:
    """Play a path on both."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))

    def both(path: Path134, half_period: bool = False) -> tuple[sim_board.Played, Modelled, Steps]:
        image = board.build(board.DEFAULT_BOARD, what=UNIT, half_period=half_period)
        file, simulated = tmp_path / "p.gve", tmp_path / "s.csv"
        file.write_text(path.text)
        command = [gve134_host.program_path(), "sim", file, "--steps", simulated]
        subprocess.run(list(map(str, command)), check=True, capture_output=True)
        steps = read_steps(simulated)
        path_seconds = float(steps.tick.max() - steps.tick.min()) / TICK_HZ
        rig, log = Rig(program, image, tmp_path), tmp_path / "log.txt"
        # At its end the unit tells where the axes have come to rest.
        text = f"{path.text};@wait {path_seconds + SETTLE_SECONDS:.3f}\nP4\n"
        source = Source("p.gve", text)
        played = sim_board.play(rig, source, BAUD, SECONDS, None, "--line-log", str(log))
        modelled = Modelled(played.ran.summary, read_steps(tmp_path / "steps.csv"), tmp_path)
        return played, modelled, steps

    return both


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


@pytest.mark.parametrize("seed", SEEDS)
def test_a_path_on_the_board_is_that_of_the_simulator(play, seed):
    path = random_path(seed)
    played, modelled, simulated = play(path)
    told = sim_board.course(played)
    (said,) = told["answers"]
    ends = [int(way) for way in said["answer"].split(",")[1:]]

    assert (told["ended"], told["refused"], told["vectors"]) == ("idle", 0, len(path.vectors))
    assert ends == [
        sum(int(vector[1:].split(",")[motor]) for vector in path.vectors) for motor in range(4)
    ]
    same(modelled, simulated)
    for motor in modelled.summary["motors"]:
        assert motor["pulses"] == 0 or motor["width_min"] == pytest.approx(2.5, abs=0.001)


@pytest.mark.parametrize("seed", SEEDS[:HALVES])
def test_pulses_of_half_a_period_are_at_the_same_ticks_and_turn_as_the_others(play, seed):
    _, modelled, simulated = play(random_path(seed), half_period=True)

    same(modelled, simulated)
    assert all(
        motor["width_min"] >= 2.499 for motor in modelled.summary["motors"] if motor["pulses"]
    )


def test_the_unit_answers_within_a_millisecond(play):
    _, modelled, _ = play(Path134(["V1000"], ["C10,0,0,0"]))
    rows = [row.split() for row in (modelled.folder / "log.txt").read_text().splitlines()]
    asked = READY_MS + len("!0V1000\r") * BYTE_MS

    assert float(rows[0][0]) - asked < 1.0
