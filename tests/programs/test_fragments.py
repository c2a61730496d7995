"""The fragments of sections 4.6 and 7 of the manual do what it says beside them."""

from __future__ import annotations

import pytest
from judge import Limits
from reference import TICK_HZ, endless, limit_run, single

MS = TICK_HZ // 1000
DEFAULTS = Limits(start_speed=100, speed=1000, accel=2000)
"""S, V and A after a reset; no fragment changes S or A."""


def test_the_loop_makes_three_moves_with_pauses_and_b300_none(run_program):
    run = run_program("fragment-4.6-loop", limits=Limits(start_speed=100, speed=3000, accel=2000))

    run.expect_moves(1000, 1000, 1000)
    assert run.pauses_ms() == [200, 200]
    for index in range(3):
        run.expect_curve(index, single(1000, 100, 3000, 2000))


def test_the_loop_takes_equal_times_to_the_tick(run_program):
    run = run_program("fragment-4.6-loop")

    starts = [move.start for move in run.moves]
    assert starts[2] - starts[1] == starts[1] - starts[0]
    assert run.pulses(run.moves[0]) == run.pulses(run.moves[1]) == run.pulses(run.moves[2])


def test_the_guarded_run_stops_down_its_ramp_when_input_5_becomes_1(run_program):
    name = "fragment-7-guarded-run"
    run = run_program(name, name, limits=DEFAULTS)

    assert [move.steps for move in run.moves] == [0]
    assert run.values("stop", "end") == [("stop", "M"), ("end", "0")]
    run.expect_stopped(0, endless(100, 1000, 2000), 2000 * MS)


def test_the_guarded_run_goes_on_for_ever_if_input_5_stays_0(run_program):
    run = run_program("fragment-7-guarded-run", seconds=5, limits=DEFAULTS)

    assert run.moves == []
    assert run.motor["state"] == "moving"
    assert run.motor["pulses"] == endless(100, 1000, 2000).pulses_before(5 * TICK_HZ)


def test_the_total_stop_ends_move_and_program(run_program):
    name = "fragment-7-total-stop"
    run = run_program(name, name, limits=DEFAULTS)

    run.expect_stopped(0, single(1000, 100, 1000, 2000), 700 * MS)
    assert run.values("stop", "end") == [("stop", "X"), ("end", "0")]
    assert run.motor["state"] == "ended"


def test_without_the_total_stop_the_move_is_whole(run_program):
    run = run_program("fragment-7-total-stop", limits=DEFAULTS)

    run.expect_moves(1000)
    run.expect_curve(0, single(1000, 100, 1000, 2000))
    assert run.motor["state"] == "idle"


@pytest.mark.parametrize(("way", "sign"), [("forward", 1), ("backward", -1)])
def test_a_limit_run_ends_with_the_last_pulse_before_its_input(run_program, way, sign):
    name = f"fragment-7-limit-{way}"
    run = run_program(name, name, limits=Limits(start_speed=100, speed=100, accel=2000))

    # At 100 steps/s pulse 123 is due at 1230 ms, and the input comes at 1234.5 ms.
    assert [move.made for move in run.moves] == [123 * sign]
    run.expect_curve(0, limit_run(100))
    assert run.motor["position"] == 123 * sign
    assert run.motor["state"] == "idle"


@pytest.mark.parametrize("way", ["forward", "backward"])
def test_a_limit_run_goes_on_for_ever_if_its_input_stays_0(run_program, way):
    run = run_program(f"fragment-7-limit-{way}", seconds=5, limits=DEFAULTS)

    assert run.moves == []
    assert run.motor["state"] == "moving"
    assert run.motor["pulses"] == limit_run(100).pulses_before(5 * TICK_HZ)


def test_what_stands_after_the_bracket_runs_when_it_is_closed(run_program):
    run = run_program("fragment-7-hold", limits=DEFAULTS)

    run.expect_moves(1000)
    run.expect_curve(0, single(1000, 100, 1000, 2000))


def test_the_total_stop_inside_the_brackets_ends_the_move(run_program):
    run = run_program("fragment-7-hold", "fragment-7-hold", limits=DEFAULTS)

    run.expect_stopped(0, single(1000, 100, 1000, 2000), 700 * MS)
    assert run.motor["state"] == "ended"
