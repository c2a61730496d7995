"""`bench --target stm32`: its figures, and the budgets of the image that they must keep."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from rkm04_tools import (
    bench_target,
    board,
    profile,
    step_time,
    target_figures,
    target_paths,
    target_reactions,
    target_rows,
    target_run,
    virtual_board,
)
from rkm04_tools.target_rows import Row
from rkm04_tools.target_run import GATE, Move, Rig

ROOT = Path(__file__).resolve().parents[2]
Measured = Callable[[Callable[[Rig], dict[str, float]]], dict[str, float]]
BUILD = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")

on_target = pytest.mark.skipif(
    not (shutil.which(board.COMPILER) and (BUILD / "bin" / virtual_board.PROGRAM).is_file()),
    reason="the virtual board or the compiler for ARM is missing",
)


@pytest.fixture
def rig(tmp_path: Path) -> Rig:
    return target_run.rig(tmp_path)


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Measured:
    """The same figures are measured once."""
    rig = target_run.rig(tmp_path_factory.mktemp("measured"))
    return cache(lambda figures: figures(rig))


@on_target
@pytest.mark.parametrize(
    ("figures", "key", "budget"),
    [
        (target_figures.step_cycles, "lone_step", "lone_step_cycles"),
        (target_figures.step_cycles, "together_step", "together_step_cycles"),
        (target_figures.load_language, "load_16000", "load_16000_percent"),
        (target_paths.busy, "load_path_alike", "load_paths_percent"),
        (step_time.figures, "longest_ramps", "load_longest_percent"),
    ],
)
def test_the_image_keeps_its_budget_of_cycles(measured, figures, key, budget):
    assert measured(figures)[key] <= target_rows.budgets()[budget]


@on_target
def test_four_motors_due_at_once_have_their_turns_in_time(measured):
    figures = measured(step_time.figures)

    assert figures["longest_due"] <= step_time.left_us()


@on_target
def test_no_step_is_late_at_full_speed_of_the_language_with_the_line_flooded(measured):
    figures = measured(target_figures.load_language)

    assert figures["late_16000"] == 0
    assert figures["line_busy"] > 95


@on_target
def test_the_flood_leaves_room_for_every_answer(rig):
    lines = target_figures.flood(50, 2000)
    requests = lines.count("\n") - 1

    line = rig.run(2.1, lines).summary["line"]

    assert line["collisions"] == 0
    assert line["left"] == 0
    # A byte of the FCS may be an escaped one.
    answers = target_figures.OPENING_ANSWER_BYTES + requests * target_figures.ANSWER_BYTES
    assert 0 <= line["sent"] - answers < requests


@on_target
def test_moves_beyond_the_language_come_to_their_ends(rig):
    moves = target_figures.fast_moves(4, 50_000, 1_000_000, target_figures.APART_TICKS)

    ran = rig.run_moves(moves)

    assert ran.late == 0
    assert target_run.ended_well(ran, moves)
    assert ran.positions == [5000] * 4


@on_target
def test_no_step_of_a_path_is_late_and_its_time_is_that_of_the_curve(rig):
    course = target_paths.fast(target_paths.APART)

    ran, told = target_paths.whole(rig, "path", course)

    assert ran.late == told.late == 0
    assert told.added == course.vectors
    # 60 000 steps at 200 000 steps/s, and a ramp of 3 000 000 steps/s^2 more.
    assert target_paths.us(told.path) == pytest.approx(1e6 * (60_000 / 2e5 + 2e5 / 3e6), abs=1)


@on_target
def test_a_path_with_fewer_borders_costs_less(rig):
    many = target_paths.run(rig, target_paths.fast(target_paths.ALIKE))
    few = target_paths.run(rig, target_paths.fast(target_paths.ALIKE, target_paths.RARE))

    assert few.load < many.load
    assert few.positions == many.positions


@on_target
def test_a_hold_of_a_path_leaves_the_motors_where_the_group_says(rig):
    for act in (target_paths.Act.HOLD, target_paths.Act.INPUT):
        course = target_paths.fast(target_paths.APART, act=act)

        ran = target_paths.run(rig, course)

        told = target_paths.report(ran)
        assert told.positions == ran.positions != course.ends
        assert 0 < target_paths.us(told.effect) < 1000


@on_target
def test_a_path_whose_speeds_change_goes_on_to_its_end(rig):
    course = target_paths.fast(target_paths.APART, act=target_paths.Act.SPEED)

    _, told = target_paths.whole(rig, "path", course)

    assert target_paths.us(told.path) > 1e6 * (60_000 / 2e5 + 2e5 / 3e6)


@on_target
def test_a_motor_without_a_move_rests(rig):
    moves = [Move(0, 0, 0, 0), Move(100, 1000, 2000, 10_000)]

    assert rig.run_moves(moves).positions == [0, 100, 0, 0]


@on_target
def test_steps_that_come_too_fast_are_late_or_end_in_a_safe_stop(rig, monkeypatch):
    monkeypatch.setattr(target_run, "BENCH_SECONDS_MAX", 1.0)
    moves = target_figures.fast_moves(4, 800_000, 8_000_000, (0,) * 4)

    ran = rig.run_moves(moves, stop_at_late=True)

    assert ran.late > 0 or ran.summary["resets"]["software"] > 0
    assert not target_run.ended_well(ran, moves)


@on_target
def test_cycles_go_down_with_the_cycles_of_a_refill(rig, measured):
    dear = measured(target_figures.step_cycles)
    cheap = target_figures.step_cycles(rig.beside("cheap", target_run.BESIDE))

    assert cheap["lone_step"] < dear["lone_step"]
    assert cheap["fast_step"] < dear["fast_step"] < dear["together_step"] < dear["lone_step"]


@on_target
def test_a_guard_begins_the_ramp_after_its_edge(rig, monkeypatch):
    monkeypatch.setattr(target_reactions, "GUARD_ROUNDS", 3)

    reaction = target_reactions.guard(rig, 2000, 4)

    assert len(reaction.begins) == 3 * 4
    assert all(0 <= b < c for b, c in zip(reaction.begins, reaction.changes, strict=True))


@on_target
def test_an_input_stops_moves_at_200_000_steps_s_within_the_budget(rig, monkeypatch):
    monkeypatch.setattr(target_reactions, "FAST_RUNS", 8)

    figures = target_reactions.fast_stops(rig)

    assert 0 < figures["stop_fast_1"] < 100
    assert figures["stop_fast_1"] < figures["stop_fast_4"]
    assert figures["stop_fast_4"] <= target_rows.budgets()["stop_of_four_us"]
    assert figures["late_stops"] == 0


@on_target
def test_wide_pulses_of_four_motors_with_many_borders_are_whole_and_none_is_late(rig):
    figures = target_paths.wide(rig)

    for name in ("alike", "passing"):
        assert figures[f"late_wide_{name}"] == 0
        assert figures[f"load_wide_{name}"] <= 50
    assert figures["width_wide"] == pytest.approx(2.5, abs=0.01)


@on_target
def test_a_stored_program_makes_its_first_pulse_a_step_after_it_was_started(rig):
    milliseconds, stack = target_figures.first_pulse(rig, {1: target_figures.STARTED}, "flash")

    assert 0.4 < milliseconds < 1000
    assert stack > 500


@on_target
def test_the_profile_of_a_run_has_all_cycles_of_the_step_interrupt(rig):
    ran = target_figures.ramps(rig, 1, profile=True)

    found = profile.of_run(ran.profile_file, rig.elf, ran.pulses)

    assert found.cycles == ran.step_interrupt["cycles"]
    assert found.steps == 8000
    for sums in (found.by_function(), found.by_source()):
        assert sum(sums.values()) == found.cycles
    # Twelve cycles each, six where it follows another interrupt at once.
    assert 11 < found.by_function()["entry"] / ran.step_interrupt["count"] <= 12
    assert {"SR", "CNT"} <= set(found.by_register())
    assert 0 < found.waits < sum(found.by_register().values())


@on_target
def test_profile_prints_the_sums_and_writes_every_instruction(tool, tmp_path):
    listing = tmp_path / "listing.txt"

    result = tool("bench", "--target", "stm32", "--profile", listing)

    assert result.status == 0
    assert "== four motors, due at the same tick" in result.out
    assert "stm32_step_interrupt" in result.out
    assert listing.read_text().count("<stm32_step_interrupt>\n") == 2


def test_a_profile_of_the_host_is_refused(tool):
    result = tool("bench", "--profile", "x")

    assert result.status == 2
    assert "--target stm32" in result.complaint


@pytest.mark.parametrize("limit", [10_000, 10_001, 123_456, 199_999, 399_999, 400_000])
def test_the_highest_rate_is_found_to_a_percent(limit):
    found = target_figures.highest_rate(lambda speed: speed <= limit, 400_000)

    assert limit / 1.0101 <= found <= limit


def test_no_rate_is_told_where_none_holds():
    assert target_figures.highest_rate(lambda speed: False, 400_000) == 0


CRUISE = np.arange(0, 5250 * 10, 5250)


def test_a_ramp_begins_with_the_last_pulse_that_stands_where_it_would_have():
    ticks = np.append(CRUISE, [CRUISE[-1] + 5300, CRUISE[-1] + 10700])
    edge = int(CRUISE[-1]) - 840

    assert target_reactions.braking(ticks, edge, 5250) == (10.0, (840 + 5300) / 84)


def test_a_ramp_that_began_before_the_edge_took_no_time():
    ticks = np.append(CRUISE, CRUISE[-1] + 5300)

    begins, changes = target_reactions.braking(ticks, int(CRUISE[-1]) + 84, 5250)

    assert (begins, changes) == (0, 5216 / 84)


def test_an_edge_that_changes_nothing_is_an_error():
    with pytest.raises(ValueError, match="no pulse has changed"):
        target_reactions.braking(CRUISE, 0, 5250)


def stopped(cruise: int, ramp: int) -> np.ndarray:
    """Pulses of a cruise at 200 000 steps/s, and of a ramp down from the last of them."""
    move = target_reactions.FAST_MOVE
    root = np.sqrt(move.speed**2 - 2 * move.accel * np.arange(1.0, ramp + 1))
    down = (move.speed - root) / move.accel * target_reactions.TICK_HZ
    return np.append(np.arange(cruise) * 420, (cruise - 1) * 420 + np.rint(down).astype(np.int64))


@pytest.mark.parametrize(("edge", "begins"), [(99 * 420 - 840, 10), (99 * 420 + 84, 0)])
def test_where_a_flat_ramp_begins_is_told_by_the_number_of_its_pulses(edge, begins):
    ticks = stopped(100, 4999)

    assert target_reactions.begin_us(ticks, edge, late=0) == pytest.approx(begins, abs=0.01)


def test_a_late_pulse_does_not_hide_where_a_ramp_begins():
    ticks = stopped(100, 4999)
    ticks[99] += 300

    assert target_reactions.begin_us(ticks, 98 * 420, late=1) == pytest.approx(5, abs=0.01)
    with pytest.raises(ValueError, match="not those of a stop"):
        target_reactions.begin_us(ticks, 98 * 420, late=0)


@pytest.mark.parametrize(("cruise", "ramp"), [(100, 4998), (100, 5000), (1, 4998)])
def test_a_ramp_of_another_length_is_no_stop(cruise, ramp):
    with pytest.raises(ValueError, match=r"of a stop|for a stop"):
        target_reactions.begin_us(stopped(cruise, ramp), 0, late=3)


@pytest.mark.parametrize(("edge", "after"), [(5250, 0.0), (5249, 1 / 84), (0, 62.5)])
def test_a_limit_run_ends_with_the_last_pulse_after_the_edge(edge, after):
    assert target_reactions.halting(CRUISE[:2], edge, 50_000) == after


@pytest.mark.parametrize(
    ("measured", "goal", "at_most", "budget", "met"),
    [
        (1.0, 1.0, True, None, True),
        (1.1, 1.0, True, None, False),
        (1.0, 1.0, False, None, True),
        (0.9, 1.0, False, None, False),
        (1.1, None, True, 1.0, False),
        (1.0, 2.0, True, 0.9, False),
        (1.0, None, True, None, None),
    ],
)
def test_a_figure_is_met_within_its_goal_and_its_budget(measured, goal, at_most, budget, met):
    assert Row("key", "a figure", "cycles", measured, None, goal, at_most, budget).met is met


@on_target
def test_the_command_tells_every_figure_with_both_models(tool, monkeypatch):
    every = {goal.key: 1.0 for goal in bench_target.FIGURES}
    made = {"every": lambda rig: {k: v * rig.model.refill for k, v in every.items()}}
    reaction = target_reactions.Reaction("guard", 16_000, 1, [99.0, 100.5], [120.0, 150.0])
    monkeypatch.setattr(bench_target, "MEASURES", made)
    monkeypatch.setattr(target_reactions, "measure", lambda rig: [reaction])

    answer = tool("bench", "--target", "stm32", "--json").json
    printed = tool("bench", "--target", "stm32").out

    rows = {row["key"]: row for row in answer["figures"]}
    assert answer["models"]["measured"] == {"refill": GATE.refill, "wait_states": 5}
    assert (rows["lone_step"]["measured"], rows["lone_step"]["beside"]) == (3, 2)
    assert rows["flash"]["met"] is True
    assert [r["met"] for r in answer["reactions"]] == [False, False]
    assert answer["reactions"][0]["us_until_ramp"] == {"min": 99.0, "median": 99.75, "max": 100.5}
    assert all(row["figure"] in printed for row in answer["figures"])
    assert target_rows.NOTE in printed
