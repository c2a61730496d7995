"""`gve134 bench`: its figures, the budget of the image, and the line at its full rate."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from rkm04_tools import board, target_rows, target_run, virtual_board
from rkm04_tools.gve134.bench import answering, host_figures, saturated, streaming, target
from rkm04_tools.gve134.bench.converter import FRAME_MS, Converter
from rkm04_tools.target_run import Rig

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
UNIT = target.UNIT

on_target = pytest.mark.skipif(
    not (shutil.which(board.COMPILER) and (BUILD / "bin" / virtual_board.PROGRAM).is_file()),
    reason="the virtual board or the compiler for ARM is missing",
)


@pytest.fixture
def fast(tmp_path: Path) -> Rig:
    """The image at the highest rate of the line."""
    return target_run.rig(tmp_path, unit=UNIT, baud=saturated.BAUD)


@pytest.fixture
def usual(tmp_path: Path) -> Rig:
    return target_run.rig(tmp_path, unit=UNIT)


@on_target
@pytest.mark.parametrize("steps", [saturated.ALIKE, saturated.APART])
def test_at_full_speed_with_the_line_saturated_nothing_is_late_or_lost(fast, steps):
    figures = saturated.measure(fast, "here", steps, 0.15)

    assert figures["late_here"] == 0
    assert figures["lost_here"] == 0
    assert figures["width_here"] == pytest.approx(2.5, abs=0.1)
    assert figures["load_here"] <= target_rows.budgets(UNIT)["load_saturated_percent"]


def test_the_flood_leaves_no_pause_and_has_a_vector_for_each_that_is_made():
    flood = saturated.flood("C100,0,0,0", 1.0)

    assert len(flood.data) >= saturated.BAUD / 10
    assert flood.vectors == pytest.approx(saturated.VECTORS_PER_SECOND, abs=saturated.PACKET)
    assert flood.data.endswith(b"\r")


@on_target
def test_send_keeps_the_queue_filled_over_a_slow_converter(usual):
    course = streaming.Course(115_200, 16.0, 300, 300)

    streamed = streaming.stream(usual, course)

    assert streamed.least >= 64
    assert streamed.made == pytest.approx(300, abs=0.1)
    assert (streamed.ran.late, streamed.repairs) == (0, 0)


def test_the_queue_counts_what_was_taken_less_what_was_made():
    done_ms = np.arange(10.0, 310.0)
    taken = [(0.0, 0), (5.0, 60), (30.0, 130), (80.0, 180), (120.0, 200)]

    # 109 after the third, 61 before the fourth and 71 before the last.
    assert streaming.least_in_queue(taken, done_ms) == 130 - 70


def test_a_queue_that_was_never_filled_holds_nothing():
    assert streaming.least_in_queue([(0.0, 0), (5.0, 60)], np.arange(10.0, 70.0)) == 0


class Echo:
    """A talk whose unit says what it has heard, a byte a millisecond later."""

    def __init__(self) -> None:
        self.ms = 0.0
        self.said: list[tuple[float, bytes]] = []

    def say(self, data: bytes) -> None:
        self.said += [(self.ms + 1 + i, data[i : i + 1]) for i in range(len(data))]

    def until(self, ms: float) -> bytes:
        if self.said and self.said[0][0] <= ms:
            self.ms, data = self.said.pop(0)
            return data
        self.ms = ms
        return b""


def test_a_converter_hands_on_together_what_came_in_its_latency():
    port = Converter(Echo(), 2.0)  # type: ignore[arg-type]
    port.write(b"abcd")

    assert port.read(0.0) == b""
    assert port.read(1.0) == b"abc"
    assert port.seconds() == pytest.approx((FRAME_MS + 1 + 2) / 1000)
    assert port.read(1.0) == b"d"
    assert port.read(0.005) == b""


@on_target
def test_commands_are_answered_within_a_millisecond_at_rest(usual):
    asked = answering.texts(("V", "PF", "?", "SR"))

    assert 0 < answering.longest_ms(usual, [], asked, answering.APART_MS) < 1


@on_target
def test_the_unit_is_ready_within_a_tenth_of_a_second(usual):
    assert 1 < answering.ready_ms(usual) < 100


@on_target
def test_the_command_tells_every_figure_of_the_image_with_both_models(gve134, monkeypatch):
    every = {goal.key: 1.0 for goal in target.FIGURES}
    made = {"all": (115_200, lambda rig: {k: v * rig.model.refill for k, v in every.items()})}
    monkeypatch.setattr(target, "MEASURES", made)

    answer = gve134("bench", "--target", "stm32", "--json").json
    printed = gve134("bench", "--target", "stm32").out

    rows = {row["key"]: row for row in answer["figures"]}
    assert (rows["answer_rest"]["measured"], rows["answer_rest"]["beside"]) == (3, 2)
    assert rows["answer_rest"]["met"] is False
    assert rows["flash"]["met"] is True
    assert all(row["figure"] in printed for row in answer["figures"])
    assert target_rows.NOTE in printed


def test_the_command_tells_the_figures_of_the_host(gve134, monkeypatch):
    for name in ("VECTORS", "SIMULATED", "GCODE_BYTES"):
        monkeypatch.setattr(host_figures, name, 2000)

    answer = gve134("bench", "--json").json

    assert len(answer["figures"]) == 3
    assert all(row["measured"] > 0 for row in answer["figures"])
    assert gve134("bench").out.count("\n") == 4


def test_the_program_of_the_bench_is_turned_without_a_problem(gve134, tmp_path):
    (tmp_path / "a.nc").write_text(host_figures.gcode_text(3000))

    result = gve134("gcode", tmp_path / "a.nc", "--machine", host_figures.MILL, "--check")

    assert (result.status, result.err) == (0, "")
