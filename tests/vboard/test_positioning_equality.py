"""The positioning unit on the virtual board: the pulses of the simulator, tick for tick; its line.

Measures of four axes come in one request, so that they begin on one tick, on the board as in the
simulator. Times count from the first pulse of each round.
"""

from __future__ import annotations

import random
import struct
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from judge import Steps, read_steps
from pos_board import Made, read, run_image, sealed, write
from rkm04_tools import host
from virtual_board import TICKS_PER_MS, of_motor

AXES = range(1, 5)
BYTE_MS = 11 / 19.2
BEGIN_MS = 50.0
TAKE, MODE = 1, 2
FULL_OUT = 600
FORMATS = ("8E1", "8O1", "8N1", "8N2")


@dataclass(frozen=True)
class Measure:
    """What one axis is told."""

    len_um: int
    accel: int
    feed: int

    def words(self, number: int, code: int) -> list[int]:
        """Of the full image: INSTRUCTION, SPACE, LEN, ACCEL, CONTROL, FEED."""
        way, feed = self.len_um & 0xFFFFFFFF, self.feed
        instruction = number * 256 + code
        return [instruction, 0, way >> 16, way & 0xFFFF, self.accel, 1, feed >> 16, feed & 0xFFFF]


Round = list[Measure]


def duration_ms(measure: Measure) -> float:
    """At most: the way at the feed, or the highest speed that the ramps reach, and the ramps."""
    way_mm: float = abs(measure.len_um) / 1000
    mm_s: float = min(measure.feed / 65536 / 60, max(1e-3, (way_mm * measure.accel) ** 0.5))
    return 1000 * (way_mm / mm_s + mm_s / measure.accel) + 50


def random_round(chance: random.Random) -> Round:
    return [
        Measure(
            chance.randint(-6000, 6000),
            chance.choice([20, 500, 5000, 65535]),
            chance.randint(200 << 16, chance.choice([1000, 20000, 65535]) << 16),
        )
        for _ in AXES
    ]


@dataclass(frozen=True)
class Script:
    """The same for both: lines of the board's line, lines of the simulator's script, the end."""

    line: str
    csv: str
    end_ms: float
    begins_ms: list[float]


def script_of(rounds: list[Round]) -> Script:
    now, line, rows, begins = BEGIN_MS, [], [], []
    for index, measures in enumerate(rounds):
        for code in (TAKE, MODE):
            words = [word for measure in measures for word in measure.words(index + 1, code)]
            line.append(f"{now:.3f} {write(FULL_OUT, words).hex()}\n")
            now += 77 * BYTE_MS + 40
        begins.append(now - 45)
        for axis, measure in zip(AXES, measures, strict=True):
            rows.append(f"{now:.3f},{axis},POS_INIT\n")
            rows.append(f"{now:.3f},{axis},POS_MODE,{measure.len_um},{measure.accel}\n")
            rows.append(f"{now:.3f},{axis},POS_CONTROL,{measure.feed},1\n")
        now += max(map(duration_ms, measures))
    rows.sort(key=lambda row: float(row.split(",")[0]))
    return Script("".join(line), "".join(rows), now, begins)


@pytest.fixture
def run(program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Made]:
    """Run the image with what comes on the line."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    return partial(run_image, program, tmp_path)


def simulated(folder: Path, csv: str) -> Steps:
    (folder / "script.csv").write_text(csv)
    command = [host.program_path().with_name("positioning-host"), "sim", folder / "script.csv"]
    command += ["--steps", folder / "sim.csv", "--for", "100000"]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return read_steps(folder / "sim.csv")


def rounds_of(steps: Steps, ends: list[float]) -> list[dict[int, np.ndarray]]:
    """Of each round the ticks of each axis, from its first pulse on; `ends`: ms, of all but one."""
    ticks = {axis: of_motor(steps, axis)[0] for axis in AXES}
    base = 0 if not len(steps.tick) else int(steps.tick.min())
    borders = [-(10**18), *(int(end * TICKS_PER_MS) for end in ends), 10**18]
    found = []
    for low, high in pairwise(borders):
        part = {axis: at[(at + base >= low) & (at + base < high)] for axis, at in ticks.items()}
        first = min((int(at.min()) for at in part.values() if len(at)), default=0)
        found.append({axis: at - first for axis, at in part.items()})
    return found


@pytest.mark.parametrize("seed", range(4))
def test_measures_on_the_board_are_those_of_the_simulator(run, tmp_path, seed):
    chance = random.Random(seed)
    rounds = [random_round(chance) for _ in range(3)]
    script = script_of(rounds)
    made = run(script.line, script.end_ms + 50)
    steps = simulated(tmp_path, script.csv)

    for axis, way in zip(AXES, zip(*rounds, strict=True), strict=True):
        total = sum(measure.len_um for measure in way)
        assert made.summary["motors"][axis - 1]["position"] == round(total / 10 + 1e-9)
    borders = script.begins_ms[1:]
    for real, wanted in zip(rounds_of(made.steps, borders), rounds_of(steps, borders), strict=True):
        for axis in AXES:
            assert np.array_equal(real[axis], wanted[axis])
    assert made.summary["watch"]["stm32_late_steps"] == 0
    assert made.said.count(write(FULL_OUT, [0] * 32)[:6]) == 6


@pytest.mark.parametrize("number", range(4))
def test_the_stored_rate_and_format_count_from_the_next_start_on(run, tmp_path, number):
    flash = ("--flash", str(tmp_path / "flash.bin"))
    asks = [write(31, [1152, number]), write(40, [1]), read(31, 2)]
    times_ms = (50, 150, 3500)  # an erase of the flash takes a second or two
    line = "".join(f"{at} {ask.hex()}\n" for at, ask in zip(times_ms, asks, strict=True))
    first = run(line, 3600, *flash)
    again = run(
        f"50 {read(31, 2).hex()}\n", 200, *flash, "--baud", "115200", line_format=FORMATS[number]
    )
    answer = sealed(struct.pack(">BBBHH", 1, 3, 4, 1152, number))

    assert first.said.endswith(answer)
    assert again.said == answer
    assert again.summary["line"]["unheard"] == 0


def test_a_wrong_parity_is_a_broken_frame(run):
    wrong = read(0, 1).hex()
    line = f"50 {wrong[:6]}!{wrong[6:]}\n100 {read(14, 2).hex()}\n"
    made = run(line, 200)

    assert made.said == sealed(struct.pack(">BBBI", 1, 3, 4, 1))


@pytest.mark.parametrize("other", ["8O1", "8N1"])
def test_a_master_with_another_format_is_not_answered(run, other):
    made = run(f"50 {read(0, 1).hex()}\n", 150, line_format=other)

    assert made.said == b""


FULL_SPEED = 60_000
"""mm/min, which is 100 000 steps/s as delivered."""


def feeds(chance: random.Random) -> bytes:
    """A request of the fast image (function 23) with another feed for each axis."""
    words = []
    for _ in AXES:
        words += [1, chance.randint(FULL_SPEED // 2, FULL_SPEED), 0]
    head = struct.pack(">BBHHHHB", 1, 23, 520, 16, 500, len(words), 2 * len(words))
    return sealed(head + struct.pack(f">{len(words)}H", *words))


def test_new_feeds_for_four_fast_axes_every_15_ms_make_no_pulse_late(run, tmp_path):
    chance = random.Random(1)
    flash = ("--flash", str(tmp_path / "flash.bin"))
    run(f"50 {write(31, [1152, 0]).hex()}\n150 {write(40, [1]).hex()}\n", 3500, *flash)
    far = Measure(2**31 - 1, 20_000, FULL_SPEED << 16)
    begin = [
        write(FULL_OUT, [word for _ in AXES for word in far.words(code, code)])
        for code in (TAKE, MODE)
    ]
    asks = [(50.0, begin[0]), (65.0, begin[1])]
    asks += [(185.0 + 15 * index, feeds(chance)) for index in range(88)]
    line = "".join(f"{at:.3f} {ask.hex()}\n" for at, ask in asks)
    made = run(line, 1600, *flash, "--baud", "115200", "--measure-from", "200")

    assert made.summary["watch"]["stm32_late_steps"] == 0
    assert made.said.count(bytes([1, 23, 32])) == 88
    assert made.summary["load"] <= 0.5
    assert min(motor["pulses"] for motor in made.summary["motors"]) > 100_000
