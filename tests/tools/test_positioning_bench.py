"""`positioning bench`: its figures of the image, and the budget that it must keep."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from rkm04_tools import board, target_rows, target_run, virtual_board
from rkm04_tools.positioning import frames
from rkm04_tools.positioning.bench import line, loads, reactions, target
from rkm04_tools.positioning.bench.line import Asked, Said
from rkm04_tools.target_run import Rig

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
TICKS_PER_S = 84_000_000

on_target = pytest.mark.skipif(
    not (shutil.which(board.COMPILER) and (BUILD / "bin" / virtual_board.PROGRAM).is_file()),
    reason="the virtual board or the compiler for ARM is missing",
)


@pytest.fixture
def rig(tmp_path: Path) -> Rig:
    return target_run.rig(tmp_path, unit=target.UNIT)


@on_target
def test_feeds_at_full_speed_are_answered_and_make_no_pulse_late(rig):
    figures = loads.measure(rig, "here", loads.FULL, cycles=12)

    assert figures["late_here"] == figures["unanswered_here"] == 0
    assert 0 < figures["answer_here"] < 20
    assert 10 < figures["load_here"] <= target_rows.budgets(target.UNIT)["load_feeds_percent"]


@on_target
def test_a_request_changes_pulses_after_it_has_come(rig, monkeypatch):
    monkeypatch.setattr(reactions, "ROUNDS", 2)

    figures = reactions.alone(rig)

    assert figures["late_alone"] == 0
    assert 100 < figures["begins_alone"] < figures["changes_alone"] < 5000


@on_target
def test_a_measure_begins_after_its_request_has_come(rig, monkeypatch):
    monkeypatch.setattr(reactions, "STARTS", 2)

    figures = reactions.start(rig)

    assert figures["late_start"] == 0
    assert 100 < figures["begins_start"] < 5000


@on_target
def test_a_request_changes_a_slow_cruise_between_two_pulses(rig, monkeypatch):
    monkeypatch.setattr(reactions, "SLOW_ROUNDS", 1)

    figures = reactions.slow(rig)

    assert figures["late_slow"] == 0
    assert 0 < figures["begins_slow"] < 20


@on_target
def test_a_request_at_the_delivered_rate_changes_pulses_after_it_has_come(rig, monkeypatch):
    monkeypatch.setattr(reactions, "DELIVERED_ROUNDS", 2)

    figures = reactions.delivered(rig)

    assert figures["late_delivered"] == 0
    assert 100 < figures["begins_delivered"] < figures["changes_delivered"] < 5000


@on_target
def test_a_limit_input_changes_pulses_after_its_edge(rig, monkeypatch):
    monkeypatch.setattr(reactions, "LIMIT_ROUNDS", 2)

    figures = reactions.limit(rig)

    assert figures["late_limit"] == 0
    assert 0 < figures["begins_limit"] < figures["changes_limit"] < 5000


def test_a_request_has_come_when_the_silence_of_its_rate_is_over():
    text = frames.read(0, 1)

    assert Asked(10.0, text).come_ms == pytest.approx(10 + 8 * 11 / 115.2 + 1.75)
    assert Asked(10.0, text, 19_200).come_ms == pytest.approx(10 + (8 + 3.5) * 11 / 19.2)


@pytest.mark.parametrize("part", [0.01, 0.3, 0.6, 0.97])
def test_the_end_of_a_slow_cruise_is_found_from_the_pulses(part):
    last, slow = 10.0, reactions.SLOW_STEPS_PER_S
    changed = last + part / slow
    left = reactions._until_pulse(1 - part)
    ticks = np.array([last - 1 / slow, last, changed + left]) * TICKS_PER_S

    found = reactions.effect_ms(ticks, 1000 * last + 1)

    assert found == pytest.approx(1000 * changed, abs=0.001)


def test_frames_have_the_sum_of_the_contract():
    assert frames.write(0x64, [0x0101])[:3] == bytes([1, 16, 0])
    assert frames.sealed(bytes.fromhex("03 00 00 00 01")) == bytes.fromhex("010300000001840A")


def test_a_request_without_its_answer_is_counted():
    asked = [Asked(15.0 * i, frames.read(0, 1)) for i in range(4)]
    answer = frames.sealed(bytes([3, 2, 0, 1]))
    said = [
        Said(asked[0].end_ms + 3, answer),
        Said(asked[1].end_ms + 3, answer[:-1] + b"?"),
        Said(asked[3].end_ms + 4, answer),
    ]

    assert line.unanswered(asked, said) == 2
    assert line.longest_ms(asked[:1], said) == pytest.approx(3)


def test_a_pause_ends_an_answer(tmp_path):
    (tmp_path / "log").write_text("10.0 01\n10.1 03\n12.0 01\n")

    assert line.said_in(tmp_path / "log") == [Said(10.0, b"\x01\x03"), Said(12.0, b"\x01")]


@on_target
def test_the_command_tells_every_figure_of_the_image_with_both_models(positioning, monkeypatch):
    every = {goal.key: 1.0 for goal in target.FIGURES}
    made = {"all": lambda rig: {k: v * rig.model.refill for k, v in every.items()}}
    monkeypatch.setattr(target, "MEASURES", made)

    answer = positioning("bench", "--target", "stm32", "--json").json
    printed = positioning("bench", "--target", "stm32").out

    rows = {row["key"]: row for row in answer["figures"]}
    assert (rows["load_full"]["measured"], rows["load_full"]["beside"]) == (3, 2)
    assert rows["begins_slow"]["met"] is False
    assert rows["flash"]["met"] is True
    assert all(row["figure"] in printed for row in answer["figures"])
    assert target_rows.NOTE in printed
