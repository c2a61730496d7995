"""The step driver where a write of the compare value is not enough: wraps, late edges, changes."""

from __future__ import annotations

import itertools

import pytest
from step_rig import DIER, LOW, MOTORS, WRAP

START = 1000
HOLD_TICKS = SETUP_TICKS = 420  # of DIR, 5 us
SLACK = 40  # a few looks at the counter

AROUND_WRAP = [-300, -211, -210, -43, -42, -41, -1, 0, 1, 2, 42, 300]


# The counter's wrap


@pytest.mark.parametrize("edge", AROUND_WRAP)
@pytest.mark.parametrize("delay", [0, 100])
def test_edges_around_the_wrap_come_at_their_ticks(make_rig, edge, delay):
    ticks = [WRAP + edge + 3000 * i for i in range(-2, 3)]
    for steady in (False, True):
        rig = make_rig(WRAP - 10_000)
        if steady:
            rig.start_steady(1, ticks[0], 3000, 5)
        else:
            rig.start(1, ticks)

        rig.run(20_000, delay)

        assert rig.rises(1) == ticks
        assert rig.pulses(1) == 5
        assert rig.late == 0


@pytest.mark.parametrize("edge", AROUND_WRAP)
def test_a_first_edge_around_the_wrap_comes_at_its_tick(make_rig, edge):
    rig = make_rig(WRAP - 1000)
    rig.start(3, [WRAP + edge])

    rig.run(5000)

    assert rig.rises(3) == [WRAP + edge]
    assert rig.late == 0


@pytest.mark.parametrize("edge", AROUND_WRAP)
def test_edges_of_all_motors_around_the_wrap_come_at_their_ticks(make_rig, edge):
    rig = make_rig(WRAP - 10_000)
    ticks = [WRAP + edge + 1500 * i for i in range(-3, 4)]
    for motor in range(MOTORS):
        rig.start(motor, ticks)

    rig.run(20_000)

    assert all(rig.rises(motor) == ticks for motor in range(MOTORS))
    assert rig.late == 0


def test_the_counter_may_wrap_between_an_edge_and_its_late_interrupt(make_rig):
    for edge in range(-250, 0, 9):
        rig = make_rig(WRAP - 5000)
        ticks = [WRAP + edge, WRAP + edge + 3000]
        rig.start_steady(0, ticks[0], 3000, 2)

        rig.run(10_000, delay=300)

        assert rig.rises(0) == ticks
        assert rig.late == 0


# Late edges


@pytest.mark.parametrize("after", [0, 1, 500, 100_000])
def test_a_tick_that_is_past_is_made_good_at_once_and_counted(make_rig, width, after):
    rig = make_rig()
    rig.start(0, [START + 200_000, START + 200_000 - after])

    rig.run(210_000)

    first, second = rig.rises(0)
    assert first == START + 200_000
    assert 2 * width <= second - first <= 2 * width + 2 * SLACK
    assert rig.late == 1


def test_a_first_tick_that_is_past_is_made_good_too(make_rig):
    rig = make_rig()
    rig.start(3, [START - 100])

    rig.run(2000)

    assert len(rig.rises(3)) == 1
    assert rig.late == 1


def test_a_tick_that_is_past_is_made_good_across_the_wrap(make_rig, width):
    for back in range(0, 400, 7):
        rig = make_rig(WRAP - 2000)
        rig.start(0, [WRAP - back, WRAP - back - 1, WRAP + 5000])

        rig.run(10_000)

        first, second, third = rig.rises(0)
        assert (first, third) == (WRAP - back, WRAP + 5000)
        assert 2 * width <= second - first <= 2 * width + 2 * SLACK
        assert rig.late == 1


def test_late_pulses_one_after_the_other_are_all_made_good(make_rig):
    rig = make_rig()
    rig.start(0, [START + 500] + [START + 501] * 5)

    rig.run(10_000)

    assert len(rig.rises(0)) == 6
    assert rig.late == 5


@pytest.mark.parametrize("after", [0, 4, 8])
def test_an_edge_that_comes_soon_is_in_time_or_made_good_but_never_lost(make_rig, width, after):
    """However long the driver takes from its look at the counter to its write."""
    lates = []
    for gap in range(2 * width - 8, 2 * width + 100, 3):
        rig = make_rig()
        rig.timer.after = after
        rig.start(0, [START + 900, START + 900 + gap, START + 5000])

        rig.run(8000)

        first, second, third = rig.rises(0)
        assert (first, third) == (START + 900, START + 5000)
        assert second == first + gap or (rig.late == 1 and second > first + gap)
        lates.append(rig.late)
    assert lates == sorted(lates, reverse=True)
    assert (lates[0], lates[-1]) == (1, 0)


def test_a_late_train_catches_up_and_goes_on_at_its_ticks(make_rig):
    rig = make_rig()
    ticks = [START + 1000 * i for i in range(1, 20)]
    rig.start_steady(0, ticks[0], 1000, len(ticks))
    rig.run(3500)
    rig.go_to(START + 6300)

    rig.run(30_000)

    rises = rig.rises(0)
    assert len(rises) == len(ticks)
    assert rises[:4] == ticks[:4]
    assert rises[-10:] == ticks[-10:]
    assert rig.late == sum(a != b for a, b in zip(rises, ticks, strict=True)) > 0


@pytest.mark.parametrize("offset", range(-8, 9, 2))
def test_a_late_edge_may_come_together_with_those_of_other_motors(make_rig, offset):
    """The made-good edge of motor 0 falls among the edges of the others."""
    probe = make_rig()
    probe.start(0, [START + 500, START + 500])
    probe.run(2000)
    made_good = probe.rises(0)[1]
    rig = make_rig()
    rig.start(0, [START + 500, START + 500, START + 4000])
    others = [made_good + offset, made_good + offset + 2000]
    for motor in range(1, MOTORS):
        rig.start_steady(motor, others[0], 2000, 2)

    rig.run(8000)

    assert rig.rises(0) == [START + 500, made_good, START + 4000]
    assert all(rig.rises(motor) == others for motor in range(1, MOTORS))
    assert rig.late == 1


@pytest.mark.parametrize("edge", [0, 1, 2])
def test_an_edge_after_the_wrap_may_come_together_with_plain_ones(make_rig, edge):
    rig = make_rig(WRAP - 6000)
    ticks = [WRAP + edge + 3000 * i for i in range(-1, 3)]
    rig.start_steady(0, ticks[0], 3000, 4)
    rig.run(8000)  # motor 0 has been armed before the wrap, the others will be after it
    for motor in range(1, MOTORS):
        rig.start_steady(motor, ticks[2], 3000, 2)

    rig.run(10_000)

    assert rig.rises(0) == ticks
    assert all(rig.rises(motor) == ticks[2:] for motor in range(1, MOTORS))
    assert rig.late == 0


# Taking an edge back


def test_an_armed_edge_can_be_taken_back(make_rig):
    rig = make_rig()
    rig.start(0, [START + 5000])

    taken = rig.call("hal_step_disarm", 0)
    rig.run(10_000)

    assert taken
    assert rig.rises(0) == []
    assert not rig.timer.registers[DIER]


@pytest.mark.parametrize("ahead", [-3, 0, 1, 2, 10, 24, 30])
def test_an_edge_that_is_nearly_there_cannot_be_taken_back(make_rig, ahead):
    rig = make_rig()
    rig.start(0, [START + 5000])
    rig.call("hal_step_hold")
    rig.go_to(START + 5000 - ahead)

    taken = rig.call("hal_step_disarm", 0)
    rig.call("hal_step_release")
    rig.run(2000)

    assert not taken
    assert rig.rises(0) == [START + 5000]
    assert rig.pulses(0) == 1


def test_a_channel_without_a_pulse_has_nothing_to_be_taken_back(make_rig):
    assert not make_rig().call("hal_step_disarm", 0)


def test_a_stale_match_is_no_pulse(make_rig):
    rig = make_rig()
    rig.start(0, [START + 5000])
    rig.halt(0)
    rig.run(10_000)
    rig.start(0, [START + 20_000])

    rig.run(15_000)

    assert rig.rises(0) == [START + 20_000]
    assert rig.pulses(0) == 1


@pytest.mark.parametrize("wrap", [False, True])
def test_a_halt_at_any_tick_counts_what_the_pin_has_shown(make_rig, width, wrap):
    """Just before, at and after the match, and while the pulse lasts."""
    start = WRAP - 2020 if wrap else START
    counts = []
    for offset in itertools.chain(range(-36, 6), range(6, width + 60, 9)):
        rig = make_rig(start)
        rig.start_steady(2, start + 1000, 1000, 3)
        rig.run(1500)
        rig.go_to(start + 2000 + offset)

        rig.halt(2)
        rig.run(4000)

        assert not rig.is_running(2)
        assert len(rig.rises(2)) == rig.pulses(2), offset
        assert rig.timer.mode(2) == LOW
        counts.append(rig.pulses(2))
    assert counts == sorted(counts)
    assert (counts[0], counts[-1]) == (1, 2)


def test_a_halted_channel_starts_anew_at_any_time(make_rig, width):
    for offset in itertools.chain(range(-36, 6, 3), range(6, width + 60, 9)):
        rig = make_rig()
        rig.start_steady(2, START + 1000, 1000, 3)
        rig.run(1500)
        rig.go_to(START + 2000 + offset)
        rig.halt(2)
        if rig.is_running(2):
            rig.run(width + 10)

        rig.start(2, [START + 4000])
        rig.run(4000)

        assert rig.rises(2)[-1] == START + 4000
        assert rig.pulses(2) == 1
        assert rig.late == 0


# Disconnecting and connecting


def test_a_disconnected_channel_keeps_its_time_and_its_pin_low(make_rig):
    rig = make_rig()
    rig.call("hal_step_connect", 1, 0)
    now = rig.timer.now
    ticks = [now + 3000 * i for i in range(1, 6)]
    rig.start(1, ticks)
    rig.start_steady(2, ticks[0], 3000, len(ticks))

    rig.run(30_000)

    assert rig.rises(1) == []
    assert rig.pulses(1) == 5
    assert rig.rises(2) == ticks
    assert rig.late == 0


def test_pulses_reach_the_pin_again_when_it_is_connected_again(make_rig):
    rig = make_rig()
    rig.call("hal_step_connect", 1, 0)
    rig.start_steady(1, rig.timer.now + 3000, 3000, 3)
    rig.run(20_000)

    rig.call("hal_step_connect", 1, 1)
    ticks = [rig.timer.now + 3000 * i for i in range(1, 4)]
    rig.start_steady(1, ticks[0], 3000, 3)
    rig.run(20_000)

    assert rig.rises(1) == ticks
    assert rig.late == 0


@pytest.mark.parametrize("connected", [False, True])
def test_a_motor_may_be_switched_at_any_moment_of_the_edges_of_others(make_rig, width, connected):
    """The pulses of channels that share its registers are all made."""
    ticks = [START + 4000 * i for i in range(1, 6)]
    for offset in itertools.chain(
        range(-900, -840, 9), range(-36, 10, 3), range(10, width + 60, 23)
    ):
        rig = make_rig()
        rig.call("hal_step_connect", 1, 0 if connected else 1)
        rig.start_steady(0, ticks[0], 4000, len(ticks))
        rig.start(3, ticks)
        rig.run(ticks[2] + offset - rig.timer.now)

        rig.call("hal_step_connect", 1, int(connected))
        rig.run(20_000)

        assert rig.rises(0) == ticks, offset
        assert rig.rises(3) == ticks, offset
        assert rig.late == 0


def test_without_the_crystal_nothing_is_ever_connected(make_rig):
    rig = make_rig()
    rig.call("stm32_step_start", 0)
    rig.call("hal_step_connect", 1, 1)
    rig.start_steady(1, rig.timer.now + 3000, 3000, 3)

    rig.run(20_000)

    assert rig.rises(1) == []


# DIR


def test_dir_falls_after_the_hold_time_when_its_motor_is_disconnected(make_rig):
    rig = make_rig()
    rig.call("hal_step_set_direction", 1, 1)
    _, pin, _ = rig.pin_writes[-1]
    rig.start(0, [rig.timer.now + 500])
    rig.start(1, [rig.timer.now + 700], backward=True)
    rig.run(800)
    rig.pin_writes.clear()

    rig.call("hal_step_connect", 1, 0)

    ((tick, fallen, level),) = rig.pin_writes
    assert (fallen, level) == (pin, False)
    assert tick >= rig.rises(1)[0] + HOLD_TICKS


def test_dir_comes_back_the_set_up_time_before_a_connected_motor_can_move(make_rig):
    rig = make_rig()
    rig.call("hal_step_set_direction", 1, 1)
    _, pin, _ = rig.pin_writes[-1]
    rig.call("hal_step_connect", 1, 0)
    rig.pin_writes.clear()

    rig.call("hal_step_connect", 1, 1)

    ((tick, risen, level),) = rig.pin_writes
    assert (risen, level) == (pin, True)
    assert rig.timer.now >= tick + SETUP_TICKS


def test_dir_of_a_disconnected_motor_stays_at_0(make_rig):
    rig = make_rig()
    rig.call("hal_step_connect", 1, 0)

    rig.call("hal_step_set_direction", 1, 1)

    assert [level for _, _, level in rig.pin_writes] == [False, False]


def test_what_is_connected_already_is_left_alone(make_rig):
    rig = make_rig()
    before = rig.timer.now

    rig.call("hal_step_connect", 1, 1)

    assert rig.pin_writes == []
    assert rig.timer.now == before
