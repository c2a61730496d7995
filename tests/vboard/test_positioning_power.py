"""The positioning unit's image when its power fails: in a store at any word, in motion, for good.

RKM04_LONG=1 cuts at every operation of a store, else at some of them.
"""

from __future__ import annotations

import os
import shutil
import struct
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from judge import Steps
from pos_board import Made, read, run_image, sealed, write
from virtual_board import TICKS_PER_MS

ACCEL_1, FEED_4, CONDITION, UPTIME, STORE = 135, 436, 4, 8, 40
OLD, NEW = (1111, 2222), (3333, 4444)
"""Of axis 1 and axis 4: from one end of what is stored to the other."""
ERASE = ("--flash-erase", "0.5")
TAKE = write(100, [0x0101, 0])
MODE = write(100, [0x0202, 0, 1, 0x86A0, 500, 1, 1000, 0])
"""100 mm, 10 000 steps."""
LEVEL_3 = "0fffaae1"


@pytest.fixture
def run(program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Made]:
    """Run the image with what comes on the line."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    return partial(run_image, program, tmp_path)


def script(*frames: tuple[float, bytes]) -> str:
    return "".join(f"{at:.3f} {frame.hex()}\n" for at, frame in frames)


def settings(values: tuple[int, int], begin_ms: float) -> list[tuple[float, bytes]]:
    """Two settings written, and all stored."""
    return [
        (begin_ms, write(ACCEL_1, [values[0]])),
        (begin_ms + 20, write(FEED_4, [0, values[1]])),
        (begin_ms + 40, write(STORE, [1])),
    ]


def look(begin_ms: float) -> list[tuple[float, bytes]]:
    return [
        (begin_ms, read(ACCEL_1, 1)),
        (begin_ms + 20, read(FEED_4, 2)),
        (begin_ms + 40, read(CONDITION, 1)),
    ]


def told(*words: int) -> bytes:
    """The answer to a read."""
    return sealed(struct.pack(f">BBB{len(words)}H", 1, 3, 2 * len(words), *words))


def looked(values: tuple[int, int], condition: int = 0) -> bytes:
    return told(values[0]) + told(0, values[1]) + told(condition)


def refused(function: int, exception: int) -> bytes:
    return sealed(bytes([1, function | 0x80, exception]))


@pytest.fixture
def stored(run, tmp_path) -> Path:
    """A flash in which the old settings are stored."""
    path: Path = tmp_path / "stored"
    made = run(script(*settings(OLD, 50), *look(150)), 230, *ERASE, "--flash", str(path))
    assert made.said.endswith(looked(OLD))
    return path


def store_new(run, tmp_path: Path, stored: Path, *more: str) -> Made:
    flash = tmp_path / "flash"
    shutil.copy(stored, flash)
    made: Made = run(
        script(*settings(NEW, 50), *look(200)), 290, *ERASE, "--flash", str(flash), *more
    )
    return made


def test_a_store_that_takes_longer_than_an_answer_may_is_told_by_the_condition(run):
    made = run(script(*settings(NEW, 50), *look(3000)), 3080, "--slow-flash")

    assert sealed(struct.pack(">BBHH", 1, 16, STORE, 1)) not in made.said
    assert made.said.endswith(looked(NEW))


def test_a_cut_in_any_operation_of_a_store_leaves_all_old_settings_or_all_new_ones(
    run, tmp_path, stored
):
    whole = store_new(run, tmp_path, stored)
    count = whole.summary["flash"]["operations"]
    assert whole.said.endswith(looked(NEW))
    assert count > 70
    step = 1 if os.environ.get("RKM04_LONG") else 13
    found = set()
    for operation in {*range(1, count, step), count - 1, count}:
        for leaves in ("half", "all") if operation >= count - 1 else ("7",):
            cut = ("--power-cut", f"{operation}:{leaves}", "--power-back")
            made = store_new(run, tmp_path, stored, *cut)
            assert made.summary["resets"]["power"] == 2
            is_new = made.said.endswith(looked(NEW))
            assert is_new or made.said.endswith(looked(OLD)), cut
            found.add(is_new)
    assert found == {False, True}


def ticks(steps: Steps) -> list[int]:
    return [int(tick) for tick in steps.tick[steps.motor == 1]]


def test_a_supply_that_falls_in_motion_disturbs_no_pulse_and_stops_a_store(run):
    still_frames = [(50.0, TAKE), (70.0, MODE)]
    still = run(script(*still_frames), 600, "--supply", "3.3")
    later = [(250.0, write(100, [0x0303])), (400.0, write(STORE, [1])), (550.0, write(STORE, [1]))]
    low = "3.3,100:3.3,120:2.8,160:2.8,170:3.3,380:3.3,390:2.8,500:2.8,510:3.3"
    frames = [*still_frames, (300.0, write(ACCEL_1, [7])), *later]
    fallen = run(script(*sorted(frames)), 1000, *ERASE, "--supply", low)
    until = 240 * TICKS_PER_MS

    made, undisturbed = ticks(fallen.steps), ticks(still.steps)
    assert len(made) > 100
    assert [t for t in made if t < until] == [t for t in undisturbed if t < until]
    assert fallen.summary["watch"]["stm32_late_steps"] == 0
    assert refused(16, 4) in fallen.said
    assert fallen.said.endswith(sealed(struct.pack(">BBHH", 1, 16, 40, 1)))


def test_power_that_goes_in_motion_comes_back_to_an_axis_that_nothing_moves(run):
    supply = "3.3,150:3.3,170:0,190:3.3"
    frames = [(50.0, TAKE), (70.0, MODE), (300.0, MODE), (340.0, MODE), (380.0, read(UPTIME, 2))]
    frames += [(420.0, read(110, 4))]
    made = run(
        script(*frames), 480, "--supply", supply, "--option-bytes", LEVEL_3, "--thresholds", "high"
    )
    pulses = ticks(made.steps)

    assert any(t < 150 * TICKS_PER_MS for t in pulses)
    assert not any(t > 175 * TICKS_PER_MS for t in pulses)
    assert made.said.endswith(told(0x0004, 3, 0x0202, 3))
    (uptime,) = struct.unpack(">I", made.said[-13 - 9 :][3:7])
    assert uptime < 230
