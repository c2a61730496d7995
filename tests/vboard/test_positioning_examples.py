"""The manual's two examples in Structured Text, and the unit's image on the virtual board.

A modelled PLC runs them with the unit in virtual time. The board gets the same requests at the same
times, and makes the same pulses.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from checks.plc import LIBRARY
from judge import Steps, read_steps
from plc_cycle import Line, Plc
from pos_board import Made, run_image, write
from real_positioning import RATE, RATE_115200, STORE, RealUnit
from st_program import Blocks

BEGIN_MS = 50
STORE_MS = 3500  # an erase of the flash takes a second or two
STEP_UM = 10  # as delivered
FEED = 3000 << 16  # 5000 steps/s
RAMP_PULSES = 250  # at 500 mm/s2
MOVED_PULSES = 5
"""In 1 ms, in which a pass begins."""


class RecordedUnit(RealUnit):
    """What was sent to it, and when."""

    def __init__(self, steps: Path) -> None:
        self.ms = 0
        self.sent: list[tuple[int, bytes]] = []
        super().__init__(str(steps))
        self.begin_ms = self.ms
        self.sent.clear()

    def run(self, ms: int) -> None:
        super().run(ms)
        self.ms += ms

    def put_frame(self, frame: bytes) -> None:
        self.sent.append((self.ms, frame))
        super().put_frame(frame)

    def line(self) -> str:
        """As the virtual board takes it."""
        rows = [f"{BEGIN_MS + at - self.begin_ms} {frame.hex()}\n" for at, frame in self.sent]
        return "".join(rows)


@pytest.fixture(scope="module")
def stored(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The flash of a unit whose line has 115 200 Bd."""
    folder = tmp_path_factory.mktemp("stored")
    settings = ((50, RATE, RATE_115200), (150, STORE, 1))
    line = "".join(f"{at} {write(row, [value]).hex()}\n" for at, row, value in settings)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RKM04_BUILD", str(program.parents[1]))
        run_image(program, folder, line, STORE_MS, "--flash", str(folder / "flash.bin"))
    return folder / "flash.bin"


@pytest.fixture
def board(
    program: Path, stored: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Made]:
    """Run the image with what comes on the line."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    flash = shutil.copy(stored, tmp_path)
    more = ("--flash", str(flash), "--baud", "115200")
    return lambda line, ms: run_image(program, tmp_path, line, ms, *more)


@pytest.fixture(scope="module")
def blocks() -> Blocks:
    """The blocks of the library."""
    return Blocks(LIBRARY.read_text(encoding="utf-8"))


@pytest.fixture
def plc(board: Callable[..., Made], blocks: Blocks, tmp_path: Path) -> Iterator[Plc]:
    unit = RecordedUnit(tmp_path / "unit.csv")
    made = Plc(blocks, unit, Line())
    made.until(lambda: made.axes[0]["Online"])
    yield made
    unit.close()


def both(plc: Plc, board: Callable[..., Made], folder: Path) -> tuple[Steps, Steps]:
    """The steps of the unit, and those of the board; all answered, none late."""
    unit = plc.unit
    assert isinstance(unit, RecordedUnit)
    plc.run(10)
    made = board(unit.line(), BEGIN_MS + unit.ms - unit.begin_ms + 50)
    unit.close()
    assert made.summary["watch"]["stm32_late_steps"] == 0
    assert made.said.count(bytes([1, 23, 64])) == len(unit.sent)
    return read_steps(folder / "unit.csv"), made.steps


def ticks_of(steps: Steps, axis: int) -> np.ndarray:
    """From the first pulse on."""
    assert set(steps.motor) == {axis}
    ticks: np.ndarray = steps.tick - steps.tick[0]
    return ticks


@pytest.mark.parametrize("way_um", [10000, -2500])
def test_the_first_example(plc, board, tmp_path, way_um):
    program = plc.add(
        "EXAMPLE_1", AXIS_4=plc.axes[3], POSUN=True, POV_I=True,
        zelana_draha=way_um, zelana_strmost=500, zelana_rychlost=FEED,
    )  # fmt: skip
    plc.run(1)
    plc.until(lambda: not program["POSUN"])
    unit, made = both(plc, board, tmp_path)

    assert len(unit.tick) == abs(way_um) // STEP_UM
    assert np.array_equal(ticks_of(unit, 4), ticks_of(made, 4))
    assert made.position[-1] == unit.position[-1] == way_um // STEP_UM


def test_the_second_example(plc, board, tmp_path):
    program = plc.add("EXAMPLE_2", AXIS_X=plc.axes[0], ZRYCH_X=500, aktualni_rychlost=FEED)
    program["LIMIT_C"] = True
    plc.until(lambda: plc.unit.positions[0] > 1000)
    program["LIMIT_C"] = False
    plc.until(lambda: not program["MECH_POHYB_X"])
    unit, made = both(plc, board, tmp_path)

    wanted, found = ticks_of(unit, 1), ticks_of(made, 1)
    assert abs(len(found) - len(wanted)) <= MOVED_PULSES
    begun = min(len(found), len(wanted)) - RAMP_PULSES - MOVED_PULSES
    assert np.array_equal(found[:begun], wanted[:begun])
    ends = [at[-RAMP_PULSES:] - at[-1] for at in (wanted, found)]
    assert np.max(np.abs(ends[0] - ends[1])) <= 1
