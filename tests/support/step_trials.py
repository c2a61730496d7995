"""Trains of pulses that a step driver makes or takes back (images/take_back_main.c)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

from rkm04_tools import board, virtual_board
from step_acts import Shown

SECONDS_MAX = 20.0
HOLD_TICKS = SETUP_TICKS = 420
"""Of DIR, 5 us."""


@dataclass(frozen=True)
class Train:
    """What is tried; as struct take_back_setting."""

    trials: int
    seed: int = 20261123
    lead_ticks: int = 2000
    lead_varied: int = 256
    pace_ticks: int = 420
    pulses: int = 1
    halt_ticks: int = 0
    together: int = 1


@dataclass
class Tried:
    """What the pins have shown, and what the channels have counted."""

    motors: list[dict[str, Any]]
    counted: list[int]
    late: int
    warnings: int

    @property
    def shown(self) -> list[int]:
        return [motor["pulses"] for motor in self.motors]

    def least_us(self, name: str) -> float:
        return float(min(motor[name] for motor in self.motors))


TryTrains = Callable[..., Tried]


def try_trains(
    program: Path, folder: Path, name: str, train: Train, *options: str, half_period: bool = False
) -> Tried:
    """Run trains of one kind on a board."""
    image = board.build(name, "take_back_image", half_period=half_period)
    (folder / "pins").write_text(virtual_board.board_pins(name))
    elf = image.file("elf").with_name(f"{image.name}-take-back.elf")
    setting = struct.pack("<8I", *astuple(train)).hex()
    arguments = ["--elf", str(elf), "--pins", str(folder / "pins"), "--for", str(SECONDS_MAX)]
    arguments += ["--end-at", "take_back_done", "--set", f"take_back_setting={setting}"]
    arguments += ["--watch", "take_back_report", "--watch", "stm32_late_steps", *options]
    summary = virtual_board.run(program, arguments)
    assert summary["ended"] == "reached", summary["error"]
    watch = summary["watch"]
    return Tried(
        summary["motors"], watch["take_back_report"], watch["stm32_late_steps"], summary["warnings"]
    )


def assert_turns(shown: Shown, motor: int) -> None:
    """Each turn of DIR has its times, from the rising edge before it to the one after it."""
    for at, _ in shown.directions[motor]:
        before = [tick for tick in shown.rises[motor] if tick <= at]
        after = [tick for tick in shown.rises[motor] if tick > at]
        assert not before or at - before[-1] >= HOLD_TICKS
        assert after[0] - at >= SETUP_TICKS
