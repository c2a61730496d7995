"""The step driver at its edges of time, on the slow bus: pin and count agree, all pulses are whole.

The image is that of a board with another main (images/disarm_main.c); the pulses are those that the
virtual board has seen at the pins. A write to the timer takes ten cycles to arrive.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from rkm04_tools import board, virtual_board

SHORT, LONG = "f405", "f407-discovery"
WIDTH_US = {SHORT: 0.5, LONG: 2.5}
"""High and low alike."""
SEED = 20261122
SECONDS_MAX = 20.0
HALTS = (0, 0)
FOLLOWS = {SHORT: (400, 100), LONG: (570, 440)}
"""Ticks: the least lead of a first edge, and from that to a second one; both vary by 256."""


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


@pytest.fixture
def try_edges(program: Path, tmp_path: Path):
    """Run so many trials of one kind on a board."""

    def run(name: str, trials: int, kind: tuple[int, int], *options: str) -> Tried:
        image = board.build(name, "disarm_image")
        (tmp_path / "pins").write_text(virtual_board.board_pins(name))
        elf = image.file("elf").with_name(f"{image.name}-disarm.elf")
        setting = struct.pack("<4I", trials, SEED, *kind).hex()
        arguments = ["--elf", str(elf), "--pins", str(tmp_path / "pins"), "--for", str(SECONDS_MAX)]
        arguments += ["--end-at", "disarm_done", "--set", f"disarm_setting={setting}"]
        arguments += ["--watch", "disarm_report", "--watch", "stm32_late_steps", *options]
        summary = virtual_board.run(program, arguments)
        assert summary["ended"] == "reached", summary["error"]
        watch = summary["watch"]
        return Tried(
            summary["motors"],
            watch["disarm_report"],
            watch["stm32_late_steps"],
            summary["warnings"],
        )

    return run


@pytest.mark.parametrize(
    ("name", "trials", "options"),
    [
        (SHORT, 100_000, []),
        (SHORT, 10_000, ["--refill", "1", "--match-equal"]),
        (SHORT, 10_000, ["--apb-wait", "3", "--pwm-at-once"]),
        (LONG, 10_000, []),
    ],
)
def test_an_edge_that_is_taken_back_at_any_time_is_made_and_counted_or_neither(
    try_edges, name, trials, options
):
    tried = try_edges(name, trials, HALTS, *options)

    assert tried.counted == tried.shown
    assert tried.warnings == 0
    assert trials / 4 < sum(tried.counted) < trials * 3 / 4  # the rest was taken back
    assert tried.least_us("width_min") >= WIDTH_US[name]


@pytest.mark.parametrize(
    ("name", "options"),
    [
        (SHORT, []),
        (SHORT, ["--refill", "1", "--match-equal"]),
        (SHORT, ["--apb-wait", "3", "--pwm-at-once"]),
        (LONG, []),
    ],
)
def test_edges_that_are_armed_just_in_time_or_late_are_whole_and_none_is_lost(
    try_edges, name, options
):
    trials = 5000
    tried = try_edges(name, trials, FOLLOWS[name], *options)

    assert tried.counted == tried.shown == [2 * trials // 4] * 4
    assert tried.least_us("width_min") >= WIDTH_US[name]
    assert tried.least_us("gap_min") >= WIDTH_US[name]
    assert trials / 10 < tried.late < 2 * trials * 9 / 10
