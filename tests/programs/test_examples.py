"""The nine example programs of the manual make the moves that the manual describes."""

from __future__ import annotations

import pytest
from judge import Limits
from reference import TICK_HZ, Section, plan, single

MS = TICK_HZ // 1000
AT_ONCE_MS = pytest.approx(0.05, abs=0.05)
"""A move that is due at once begins within 100 us."""

SLOW = Limits(start_speed=100, speed=1000, accel=2000)


def test_example_1_goes_forward_back_and_home(run_program):
    run = run_program("1-three-moves", limits=SLOW)

    run.expect_moves(5000, -2000, -3000)
    assert run.pauses_ms() == [AT_ONCE_MS, AT_ONCE_MS]
    assert run.motor["position"] == 0
    assert run.motor["state"] == "idle"
    for index, steps in enumerate((5000, 2000, 3000)):
        run.expect_curve(index, single(steps, 100, 1000, 2000))


def test_example_1_ends_by_itself_after_the_time_its_moves_take(run_program):
    run = run_program("1-three-moves")

    ideal = sum(float(single(n, 100, 1000, 2000).tick(n)) for n in (5000, 2000, 3000)) / TICK_HZ
    assert run.summary["ended"] == "idle"
    assert run.summary["seconds"] == pytest.approx(ideal, abs=0.001)


def test_example_2_goes_to_and_fro_for_ever(run_program):
    run = run_program("2-back-and-forth", seconds=20, limits=SLOW)

    run.expect_moves(*[1000, -1000] * 4)
    assert run.pauses_ms() == [500, 1000] * 3 + [500]
    assert run.summary["ended"] == "time"
    for index in range(8):
        run.expect_curve(index, single(1000, 100, 800, 2000))


def test_example_2_repeats_to_the_tick(run_program):
    run = run_program("2-back-and-forth", seconds=20)

    passes = [run.moves[index].start for index in (0, 2, 4, 6)]
    assert passes[3] - passes[2] == passes[2] - passes[1] == passes[1] - passes[0]
    assert len({tuple(run.pulses(move)) for move in run.moves}) == 1


def test_example_3_goes_forward_while_input_5_is_0(run_program):
    run = run_program("3-branch", seconds=10)

    run.expect_moves(*[2000] * 5)
    assert run.pauses_ms() == [600] * 4
    for index in range(5):
        run.expect_curve(index, single(2000, 200, 2000, 5000))


def test_example_3_goes_backward_while_input_5_is_1(run_program):
    run = run_program("3-branch", "3-branch", seconds=10)

    # A pass takes 1.924 s: input 5 is 1 when the third and the fourth begin, at 3.8 and 5.8 s.
    run.expect_moves(2000, 2000, -2000, -2000, 2000)
    assert run.pauses_ms() == [600] * 4
    for index in range(5):
        run.expect_curve(index, single(2000, 200, 2000, 5000))


def test_example_4_runs_its_loop_three_times(run_program):
    run = run_program("4-loop", limits=Limits(start_speed=100, speed=600, accel=2000))

    run.expect_moves(1000, 500, -500, 500, -500, 500, -500, -1000)
    assert run.pauses_ms() == [AT_ONCE_MS, 200, 1000, 200, 1000, 200, 1000]
    assert run.motor["position"] == 0
    assert run.motor["pulses"] == 5000
    for index, steps in enumerate((1000, 500, 500, 500, 500, 500, 500, 1000)):
        run.expect_curve(index, single(steps, 100, 600, 2000))


def test_example_4_has_a_period_of_two_moves_and_two_waits(run_program):
    run = run_program("4-loop")

    # 500 steps take 2·250 ms on the ramps, of 87.5 steps each, and 325/600 s between them.
    move = 500 * MS + 325 * TICK_HZ // 600
    period = 2 * move + 1200 * MS
    starts = [run.moves[index].start for index in (1, 3, 5)]
    assert [starts[1] - starts[0], starts[2] - starts[1]] == [period, period]


def test_example_5_waits_for_input_2_for_ever_if_it_stays_0(run_program):
    run = run_program("5-wait-for-inputs", limits=SLOW)

    run.expect_moves(5000)
    assert run.summary["ended"] == "time"
    assert run.motor["state"] == "wait_level"
    assert run.motor["position"] == 5000


def test_example_5_goes_on_when_its_inputs_let_it(run_program):
    run = run_program("5-wait-for-inputs", "5-wait-for-inputs", limits=SLOW)

    run.expect_moves(5000, -6000, 3000, -2000)
    second, third = run.moves[1].start, run.moves[2].start
    assert 0 <= second - 7000 * MS <= MS
    assert 0 <= third - 15000 * MS <= MS
    assert run.motor["position"] == 0
    for index, steps in enumerate((5000, 6000, 3000, 2000)):
        run.expect_curve(index, single(steps, 100, 1000, 2000))


def test_example_6_makes_whole_moves_if_no_guard_acts(run_program):
    run = run_program("6-guards", "6-guards-quiet", limits=SLOW)

    run.expect_moves(5000, -4000, 500)
    assert run.pauses_ms() == [200, 300]
    assert run.motor["position"] == 1500
    run.expect_curve(0, single(5000, 100, 1000, 2000))
    run.expect_curve(1, single(4000, 100, 600, 2000))
    run.expect_curve(2, single(500, 100, 600, 2000))


def test_example_6_stops_each_guarded_move_down_its_ramp_and_goes_on(run_program):
    run = run_program("6-guards", "6-guards", limits=SLOW)

    assert [move.steps for move in run.moves] == [5000, -4000, 500]
    assert run.values("stop") == [("stop", "M"), ("stop", "N")]
    run.expect_stopped(0, single(5000, 100, 1000, 2000), 2500 * MS)
    run.expect_stopped(1, single(4000, 100, 600, 2000), 6000 * MS + MS // 4)
    run.expect_curve(2, single(500, 100, 600, 2000))
    assert run.pauses_ms() == [200, 300]
    assert run.motor["position"] == sum(move.made for move in run.moves)


def test_example_6_makes_no_step_against_a_guard_that_has_its_level_already(run_program):
    run = run_program("6-guards", limits=SLOW)

    assert [move.made for move in run.moves] == [5000, 0, 500]
    assert run.values("stop") == [("stop", "N")]
    assert run.pauses_ms() == [200, 300]
    assert run.motor["position"] == 5500


def test_example_7_goes_to_and_fro_while_input_4_is_0(run_program):
    run = run_program("7-total-stop", seconds=25, limits=SLOW)

    run.expect_moves(5000, -5000, 5000, -5000)
    assert run.pauses_ms() == [600, 1000, 600]
    for index in range(4):
        run.expect_curve(index, single(5000, 100, 1000, 2000))


def test_example_7_stops_down_the_ramp_and_ends_when_input_4_becomes_1(run_program):
    run = run_program("7-total-stop", "7-total-stop", limits=SLOW)

    assert [move.steps for move in run.moves] == [5000, -5000]
    assert run.values("stop", "end") == [("stop", "X"), ("end", "0")]
    run.expect_stopped(1, single(5000, 100, 1000, 2000), 9000 * MS)
    assert run.motor["state"] == "ended"
    assert run.summary["ended"] == "idle"


def test_example_8_takes_turns_and_shows_whose_it_is(run_program):
    run = run_program("8-subroutine", seconds=20, limits=SLOW)

    run.expect_moves(-2500, 2500, 2500, -2500, -2500, 2500)
    assert run.pauses_ms() == [500, AT_ONCE_MS, 500, AT_ONCE_MS, 500]
    backward = [("out", "5"), ("out", "-5"), ("var", "81")]
    forward = [("out", "2"), ("out", "-2"), ("var", "-81")]
    assert run.values("out", "var") == [*backward, *forward, *backward, ("out", "2")]
    for index in range(6):
        run.expect_curve(index, single(2500, 100, 1000, 2000))


def test_example_8_has_one_output_on_while_its_moves_run(run_program):
    run = run_program("8-subroutine", seconds=20)

    on, off = run.ticks("out", 5)[0], run.ticks("out", -5)[0]
    assert on <= run.moves[0].start
    assert 0 <= off - run.moves[1].end <= MS


COMPOUND = plan(
    [
        Section(2000, 500, 2000),
        Section(2000, 2000, 2000),
        Section(5000, 500, 2000),
        Section(5000, 3000, 1000),
        Section(2000, 1500, 1000),
        Section(2000, 500, 1000),
    ],
    100,
)


def test_example_9_runs_six_sections_as_one_move(run_program):
    run = run_program("9-compound", limits=Limits(start_speed=100, speed=3000, accel=2000))

    run.expect_moves(18000)
    run.expect_curve(0, COMPOUND)
    assert run.motor["position"] == 18000


def test_example_9_peaks_at_2500_in_its_fourth_section(run_program):
    run = run_program("9-compound")

    assert run.motor["peak_speed"] == pytest.approx(2500, abs=0.5)


def test_example_9_sets_output_5_when_its_last_section_begins(run_program):
    run = run_program("9-compound")

    assert run.values("out") == [("out", "5"), ("out", "-5")]
    on, off = run.ticks("out", 5)[0], run.ticks("out", -5)[0]
    assert 0 <= on - run.moves[0].start - float(COMPOUND.tick(16000)) <= MS
    assert off - run.moves[0].end == 500 * MS
