"""Tests of the judge: it passes lawful runs and finds each planted violation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from judge import Event, Limits, Steps, judge, read_steps, read_trace
from reference import TICK_HZ, Curve, endless, single

GAP = 10_000_000
"""Ticks between two moves of the run under test."""


def log(rows: Sequence[tuple[int, int, int]]) -> Steps:
    """Make a log of (tick, motor, position)."""
    table = np.array(sorted(rows), dtype=np.int64).reshape(-1, 3)
    return Steps(TICK_HZ, table[:, 0], table[:, 1], table[:, 2])


def pulses(curve: Curve, start: int, position: int, sign: int) -> list[tuple[int, int, int]]:
    """Pulses of motor 1 by the exact reference."""
    assert curve.last is not None
    ticks = curve.nearest_ticks(range(1, curve.last + 1))
    return [(start + t, 1, position + sign * k) for k, t in enumerate(ticks, 1)]


def lawful_run() -> tuple[Steps, list[Event]]:
    """Make 600 steps forward with S100 V9000 A50000, then 200 backward."""
    first = pulses(single(600, 100, 9000, 50_000), 1000, 0, 1)
    second_start = first[-1][0] + GAP
    second = pulses(single(200, 2000, 16_000, 60_000), second_start, 600, -1)
    trace = [
        Event(0, 1, "start", ""),
        Event(1000, 1, "move", "600"),
        Event(first[-1][0], 1, "done", "600"),
        Event(second_start, 1, "move", "-200"),
        Event(second[-1][0], 1, "done", "-200"),
        Event(second[-1][0], 1, "end", ""),
    ]
    return log(first + second), trace


def moved(steps: Steps, pulse: int, ticks: int) -> Steps:
    """Shift one pulse in time."""
    tick = steps.tick.copy()
    tick[pulse] += ticks
    return replace(steps, tick=tick)


def without(steps: Steps, pulse: int) -> Steps:
    """Lose one pulse."""
    columns = (steps.tick, steps.motor, steps.position)
    return Steps(TICK_HZ, *(np.delete(column, pulse) for column in columns))


def replaced(trace: Sequence[Event], index: int, event: Event) -> list[Event]:
    """Put another event in the place of one."""
    return [*trace[:index], event, *trace[index + 1 :]]


def assert_found(found: list[str], words: str) -> None:
    """One of the sentences must hold the words."""
    assert any(words in sentence for sentence in found), found


def test_a_lawful_run_passes() -> None:
    assert judge(*lawful_run()) == []


def test_an_empty_run_passes() -> None:
    assert judge(log([]), []) == []


@pytest.mark.parametrize(
    "curve",
    [
        single(3000, 1, 16_000, 60_000),
        single(20, 2000, 16_000, 60_000),
        single(1, 2000, 16_000, 60_000),
        single(50, 1, 1, 1),
        single(2500, 2000, 16_000, 60_000).speed_changed_at(900, 2500),
        single(2500, 2000, 16_000, 60_000).speed_changed_at(900, 1),
        single(250, 2000, 1, 60_000).speed_changed_at(90, 16_000),
    ],
)
def test_moves_at_the_limits_of_the_language_pass(curve: Curve) -> None:
    steps = log(pulses(curve, 7, 0, 1))
    last, end = len(steps.tick), int(steps.tick[-1])
    trace = [Event(7, 1, "move", str(last)), Event(end, 1, "done", str(last))]
    assert judge(steps, trace) == []


@pytest.mark.parametrize("k", [1, 2, 40, 800, 1500])
def test_a_stopped_run_without_end_passes(k: int) -> None:
    curve = endless(1999, 16_000, 59_999).stopped_at(k)
    steps = log(pulses(curve, 7, 0, 1))
    last, end = len(steps.tick), int(steps.tick[-1])
    trace = [
        Event(7, 1, "move", "0"),
        Event(end, 1, "stop", "K"),
        Event(end, 1, "done", str(last)),
    ]
    assert judge(steps, trace) == []


def one_move(curve: Curve, asked: int, *events: Event) -> tuple[Steps, list[Event]]:
    """Make a run of one move of motor 1 from tick 0 on, with further events at its end."""
    steps = log(pulses(curve, 0, 0, 1))
    done = Event(int(steps.tick[-1]), 1, "done", str(len(steps.tick)))
    return steps, [Event(0, 1, "move", str(asked)), *events, done]


def test_a_stop_just_short_of_the_last_step_of_its_ramp_passes() -> None:
    curve = endless(2000, 15_781, 60_000).stopped_at(3000)
    steps, trace = one_move(curve, 0, Event(9, 1, "stop", "N"))
    assert judge(steps, trace) == []


def test_a_drop_from_the_start_speed_between_two_pulses_passes() -> None:
    curve = single(6000, 2000, 15_781, 60_000).speed_changed_at(3000, 1)
    assert judge(*one_move(curve, 6000)) == []


@pytest.mark.parametrize("motor", [0, 1])
def test_a_stop_of_the_motor_or_of_the_unit_explains_a_short_move(motor: int) -> None:
    curve = single(500, 100, 1000, 2000).stopped_at(100)
    stop = Event(5, motor, "stop", "X")
    assert judge(*one_move(curve, 500, stop)) == []


def test_a_stop_before_or_after_a_move_does_not_explain_that_it_is_short() -> None:
    steps, trace = one_move(single(50, 100, 1000, 2000), 60)
    stop = Event(0, 1, "stop", "X")
    later = [replace(event, tick=event.tick + 1) for event in trace]
    after = replace(stop, tick=trace[-1].tick + 1)
    late = replace(steps, tick=steps.tick + 1)
    assert_found(judge(late, [stop, *later]), "ended at 50 with no stop")
    assert_found(judge(steps, [*trace, after]), "ended at 50 with no stop")


def test_the_top_speed_with_rounding_passes() -> None:
    steps, trace = one_move(single(9000, 2000, 16_000, 60_000), 9000)
    assert judge(moved(moved(steps, 4000, -1), 3999, 1), trace) == []


def test_a_lead_at_the_lowest_speed_passes() -> None:
    steps, trace = one_move(single(5, 1, 1, 1), 5)
    late = [trace[0], replace(trace[1], tick=trace[1].tick + 8400)]
    assert judge(replace(steps, tick=steps.tick + 8400), late) == []


def test_a_pulse_without_a_change_of_the_position_is_found() -> None:
    steps, trace = lawful_run()
    steps.position[300:600] -= 1
    assert_found(judge(steps, trace, counter_set=True), "does not change by one")


def test_a_run_that_is_over_inside_a_move_passes() -> None:
    steps, trace = lawful_run()
    assert judge(without(steps, -1), trace[:-2]) == []


def test_moves_that_join_without_a_gap_pass() -> None:
    first = pulses(single(50, 100, 1000, 2000), 0, 0, 1)
    border = first[-1][0]
    second = pulses(single(50, 100, 1000, 2000), border, 50, -1)
    trace = [
        Event(0, 1, "move", "50"),
        Event(border, 1, "done", "50"),
        Event(border, 1, "move", "-50"),
        Event(second[-1][0], 1, "done", "-50"),
    ]
    assert judge(log(first + second), trace) == []


def test_a_lost_pulse_is_found() -> None:
    steps, trace = lawful_run()
    found = judge(without(steps, 300), trace)
    assert_found(found, "made 599 pulses, its done says 600")
    assert_found(found, "does not change by one")


def test_a_pulse_lost_without_a_trace_is_found_by_the_speed() -> None:
    steps, trace = lawful_run()
    left = without(steps, 700)
    left.position[700:] += 1
    honest = replaced(trace, 3, replace(trace[3], value="-199"))
    honest = replaced(honest, 4, replace(honest[4], value="-199"))
    found = judge(left, honest)
    assert len(found) == 1
    assert_found(found, "changes its speed too fast")


@pytest.mark.parametrize("ticks", [-40, 40])
def test_a_pulse_off_its_place_is_found(ticks: int) -> None:
    steps, trace = lawful_run()
    assert_found(judge(moved(steps, 700, ticks), trace), "changes its speed too fast")


def test_two_pulses_too_close_are_found() -> None:
    steps, trace = lawful_run()
    found = judge(moved(steps, 700, -17_000), trace)
    assert_found(found, "faster than 16000 steps/s")


def test_pulses_of_two_moves_too_close_are_found() -> None:
    first = pulses(single(5, 100, 100, 1), 0, 0, 1)
    border = first[-1][0]
    second = [(border + 5000, 1, 6)]
    trace = [
        Event(0, 1, "move", "5"),
        Event(border, 1, "done", "5"),
        Event(border, 1, "move", "1"),
        Event(border + 5000, 1, "done", "1"),
    ]
    assert_found(judge(log(first + second), trace), "faster than 16000 steps/s")


def test_a_pulse_after_the_end_of_a_move_is_found() -> None:
    steps, trace = lawful_run()
    early = replace(trace[2], tick=trace[2].tick - 1)
    found = judge(steps, replaced(trace, 2, early))
    assert_found(found, "a pulse outside any move")
    assert_found(found, "made 599 pulses")


def test_a_pulse_before_any_move_is_found() -> None:
    steps, trace = lawful_run()
    late = replace(trace[1], tick=int(steps.tick[0]))
    assert_found(judge(steps, replaced(trace, 1, late)), "a pulse outside any move")


def test_pulses_of_a_motor_without_moves_are_found() -> None:
    assert_found(judge(log([(5, 3, 1)]), []), "motor 3: a pulse outside any move")


def test_a_wrong_count_is_found() -> None:
    steps, trace = lawful_run()
    wrong = replace(trace[2], value="601")
    assert_found(judge(steps, replaced(trace, 2, wrong)), "its done says 601")


def test_a_move_past_its_target_is_found() -> None:
    steps, trace = lawful_run()
    less = replace(trace[1], value="599")
    assert_found(judge(steps, replaced(trace, 1, less)), "made 600 pulses for 599 steps")


def test_a_move_that_ends_short_without_a_stop_is_found() -> None:
    steps, trace = lawful_run()
    more = replaced(trace, 1, replace(trace[1], value="700"))
    assert_found(judge(steps, more), "ended at 600 with no stop")
    stop = Event(2000, 1, "stop", "M")
    assert judge(steps, [*more[:2], stop, *more[2:]]) == []


def test_a_move_in_the_wrong_direction_is_found() -> None:
    steps, trace = lawful_run()
    wrong = replace(trace[1], value="-600")
    found = judge(steps, replaced(trace, 1, wrong))
    assert_found(found, "went the other way")
    assert_found(found, "steps back")


def test_a_position_that_jumps_between_moves_is_found_unless_it_was_set() -> None:
    steps, trace = lawful_run()
    position = steps.position.copy()
    position[600:] += 5000
    jumped = replace(steps, position=position)
    assert_found(judge(jumped, trace), "does not change by one")
    assert judge(jumped, trace, counter_set=True) == []


def test_a_position_that_jumps_inside_a_move_is_found_even_if_it_was_set() -> None:
    steps, trace = lawful_run()
    position = steps.position.copy()
    position[300:] += 1
    jumped = replace(steps, position=position)
    assert_found(judge(jumped, trace, counter_set=True), "does not change by one")


def test_a_gap_inside_a_move_is_found() -> None:
    steps, trace = lawful_run()
    pause = 2 * TICK_HZ
    tick = steps.tick + np.where(np.arange(len(steps.tick)) >= 300, pause, 0)
    later = [replace(e, tick=e.tick + (pause if e.tick > 1000 else 0)) for e in trace]
    assert_found(judge(replace(steps, tick=tick), later), "has a gap")


def test_a_move_that_does_not_set_out_is_found() -> None:
    steps, trace = lawful_run()
    tick = steps.tick + np.where(np.arange(len(steps.tick)) >= 600, TICK_HZ, 0)
    ends = [replace(event, tick=event.tick + TICK_HZ) for event in trace[4:]]
    found = judge(replace(steps, tick=tick), [*trace[:4], *ends])
    assert_found(found, "has a gap")


@pytest.mark.parametrize(("start", "count"), [(0, 300), (300, 300)])
def test_half_a_trapezoid_is_found(start: int, count: int) -> None:
    whole = single(600, 100, 9000, 50_000).nearest_ticks(range(start, start + count))
    ticks = [t - whole[0] + 100 for t in whole]
    steps = log([(t, 1, k) for k, t in enumerate(ticks, 1)])
    trace = [
        Event(0, 1, "move", str(count)),
        Event(ticks[-1], 1, "done", str(count)),
    ]
    assert_found(judge(steps, trace), "starts or ends too fast")


def test_tighter_limits_find_what_the_language_allows() -> None:
    steps, trace = lawful_run()
    found = judge(steps, trace, Limits(start_speed=2000, speed=3000, accel=60_000))
    assert_found(found, "faster than 3000 steps/s")
    found = judge(steps, trace, Limits(start_speed=100, accel=60_000))
    assert_found(found, "starts or ends too fast")
    found = judge(steps, trace, Limits(start_speed=2000, accel=20_000))
    assert_found(found, "changes its speed too fast")


def test_moves_that_overlap_or_never_began_are_found() -> None:
    twice = [Event(0, 2, "move", "0"), Event(1, 2, "move", "0")]
    assert_found(judge(log([]), twice), "no done of the move at 0")
    assert_found(judge(log([]), [Event(0, 2, "done", "0")]), "done without a move at 0")


def test_time_that_goes_back_is_found() -> None:
    steps, trace = lawful_run()
    assert_found(judge(steps, trace[::-1]), "events go back in time")
    back = moved(steps, 300, -1_000_000)
    assert_found(judge(back, trace), "pulses go back in time")


def test_a_motor_that_does_not_exist_is_found() -> None:
    assert_found(judge(log([(5, 5, 1)]), []), "pulses of motor 5")
    assert_found(judge(log([]), [Event(0, 9, "start", "")]), "events of motor 9")


def test_files_are_read_as_they_are_written(tmp_path: Path) -> None:
    steps_file, trace_file = tmp_path / "steps.csv", tmp_path / "trace.csv"
    steps_file.write_text("# tick_hz=84000000\ntick,motor,position\n5,1,1\n9,2,-1\n")
    trace_file.write_text("tick,motor,event,value\n0,1,start,\n3,0,error,no such label\n")
    steps = read_steps(steps_file)
    assert steps.tick_hz == TICK_HZ
    assert steps.tick.tolist() == [5, 9]
    assert steps.motor.tolist() == [1, 2]
    assert steps.position.tolist() == [1, -1]
    assert read_trace(trace_file) == [
        Event(0, 1, "start", ""),
        Event(3, 0, "error", "no such label"),
    ]


def test_a_steps_file_without_pulses_is_read(tmp_path: Path) -> None:
    path = tmp_path / "steps.csv"
    path.write_text("# tick_hz=84000000\ntick,motor,position\n")
    assert len(read_steps(path).tick) == 0


def test_files_of_another_kind_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.csv"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match="not a steps file"):
        read_steps(path)
    with pytest.raises(ValueError, match="not a trace file"):
        read_trace(path)
