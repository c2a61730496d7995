"""The step driver makes each edge at its tick; no pulse is too short, nor too near the next."""

from __future__ import annotations

import pytest
from step_rig import DIER, LOW, MOTORS

START = 1000
SLACK = 40  # a few looks at the counter
HOLD_TICKS = SETUP_TICKS = 420  # of DIR, 5 us


def test_an_armed_edge_comes_at_its_tick(make_rig, width):
    rig = make_rig()
    rig.start(2, [START + 5000])

    rig.run(10_000)

    assert rig.rises(2) == [START + 5000]
    assert rig.pulses(2) == 1
    assert width <= rig.highs(2)[0] <= width + SLACK


@pytest.mark.parametrize("delay", [0, 30, 100, 400])
def test_every_edge_of_a_train_comes_at_its_tick(make_rig, delay):
    rig = make_rig()
    ticks = [START + 3000 * i for i in range(1, 20)]
    rig.start_steady(0, ticks[0], 3000, len(ticks))

    rig.run(70_000, delay)

    assert rig.rises(0) == ticks
    assert rig.pulses(0) == len(ticks)
    assert rig.late == 0


@pytest.mark.parametrize("delay", [0, 30, 100, 400])
def test_every_edge_comes_at_its_tick_where_each_is_a_segment(make_rig, delay):
    rig = make_rig()
    ticks = [START + 3000 * i for i in range(1, 20)]
    rig.start(0, ticks)

    rig.run(70_000, delay)

    assert rig.rises(0) == ticks
    assert rig.pulses(0) == len(ticks)
    assert rig.late == 0


def test_four_motors_share_the_timer(make_rig):
    rig = make_rig()
    ticks = {m: [START + (2000 + 37 * m) * i for i in range(1, 10)] for m in range(MOTORS)}
    for motor in range(MOTORS):
        rig.start(motor, ticks[motor])

    rig.run(30_000)

    assert {m: rig.rises(m) for m in range(MOTORS)} == ticks
    assert rig.late == 0


def test_edges_at_the_same_tick_all_come(make_rig):
    rig = make_rig()
    for motor in range(MOTORS):
        rig.start_steady(motor, START + 5000, 1000, 2)

    rig.run(10_000)

    assert all(rig.rises(motor) == [START + 5000, START + 6000] for motor in range(MOTORS))
    assert rig.late == 0


@pytest.mark.parametrize("delay", [0, 100])
def test_segments_of_four_motors_may_end_at_the_same_tick(make_rig, delay):
    rig = make_rig()
    ticks = [START + 2000 * i for i in range(1, 8)]
    for motor in range(MOTORS):
        rig.start(motor, ticks)

    rig.run(20_000, delay)

    assert all(rig.rises(motor) == ticks for motor in range(MOTORS))
    assert all(rig.pulses(motor) == len(ticks) for motor in range(MOTORS))
    assert rig.late == 0


def test_a_segment_may_end_where_others_go_on_and_one_motor_comes_to_rest(make_rig):
    rig = make_rig()
    ticks = [START + 2000 * i for i in range(1, 8)]
    rig.start(0, ticks)
    rig.start_steady(1, ticks[0], 2000, 7)
    rig.start(2, ticks[:4])
    rig.start_steady(3, ticks[0], 2000, 4)

    rig.run(20_000)

    assert [rig.rises(motor) for motor in range(MOTORS)] == [ticks, ticks, ticks[:4], ticks[:4]]
    assert rig.late == 0


def test_a_channel_rests_after_its_last_pulse(make_rig):
    rig = make_rig()
    rig.start(0, [START + 500])

    rig.run(5000)

    assert not rig.is_running(0)
    assert rig.timer.mode(0) == LOW
    assert not rig.timer.registers[DIER]


@pytest.mark.parametrize("steady", [False, True])
def test_main_is_told_of_the_end_of_a_move_and_not_of_the_pulses_before(make_rig, steady):
    rig = make_rig()
    if steady:
        rig.start_steady(0, START + 2000, 2000, 3)
    else:
        rig.start(0, [START + 2000])
        rig.run(1500)
    rig.take_event()

    rig.run(4500 if steady else 0)
    told_before = rig.take_event()
    rig.run(3000)

    assert not told_before
    assert rig.take_event()
    assert not rig.is_running(0)


def test_main_is_told_of_the_begin_of_a_segment(make_rig):
    rig = make_rig()
    rig.start(0, [START + 2000, START + 4000])
    rig.take_event()

    rig.run(3000)

    assert rig.take_event()
    rig.run(5000)


def test_a_rested_channel_goes_on_with_what_was_queued_late(make_rig):
    rig = make_rig()
    rig.start(1, [START + 500])
    rig.run(3000)
    rig.push(1, START + 5000)

    rig.go(1)
    rig.run(5000)

    assert rig.rises(1) == [START + 500, START + 5000]
    assert rig.pulses(1) == 2
    assert rig.late == 0


def test_a_channel_is_armed_while_its_last_pulse_is_high(make_rig, width):
    tried = 0
    for after in range(2, 3 * width, 7):
        rig = make_rig()
        rig.start(1, [START + 500])
        rig.run(500 + after)
        if rig.is_running(1):
            continue
        tried += 1
        rig.push(1, START + 3000)

        rig.go(1)
        rig.run(5000)

        assert rig.rises(1) == [START + 500, START + 3000], after
        assert rig.late == 0
    assert tried > 10


def test_dir_waits_for_the_hold_time_of_the_last_pulse(make_rig):
    rig = make_rig()
    rig.start(0, [START + 500])
    rig.run(600)
    edge = rig.rises(0)[0]

    rig.call("hal_step_set_direction", 0, 1)

    assert rig.timer.now >= edge + HOLD_TICKS + SETUP_TICKS


def test_a_step_interrupt_that_does_not_come_is_noticed(make_rig):
    rig = make_rig()
    rig.start(0, [START + 500])
    rig.call("hal_step_hold")
    rig.go_to(START + 500 + 5 * 84_000 - 10)
    before = rig.call("stm32_step_is_stuck")
    rig.go_to(START + 500 + 5 * 84_000 + 100)

    assert not before & 1
    assert rig.call("stm32_step_is_stuck") & 1
    rig.call("hal_step_release")
    rig.run(1000)
