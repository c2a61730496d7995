"""The step driver makes each edge at its tick, keeps the widths, and makes late ones good."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Callable

import pytest
from rkm04_tools import board
from step_rig import LOW, StepRig

START = 1000
SHORT, LONG = "rkm04-f405", "f407-discovery"
WIDTH = {SHORT: 42, LONG: 210}  # 0.5 us and 2.5 us, high and low alike
SLACK = 40  # a few looks at the counter

pytestmark = pytest.mark.skipif(
    not shutil.which(board.COMPILER),
    reason=f"{board.COMPILER} is not installed: run tools/setup test",
)

Make = Callable[..., StepRig]


@pytest.fixture(scope="module", params=[SHORT, LONG])
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def make(name: str) -> Make:
    image = board.build(name).file("elf")
    return lambda *arguments: StepRig(image, *arguments)


def test_an_armed_edge_comes_at_its_tick(make, name):
    rig = make()
    rig.call("hal_step_arm", 2, START + 5000)

    rig.run(10_000)

    assert rig.rises(2) == [START + 5000]
    assert rig.served == [2]
    assert WIDTH[name] <= rig.widths(2)[0] <= WIDTH[name] + SLACK


@pytest.mark.parametrize("delay", [0, 30, 100, 400])
def test_every_edge_of_a_train_comes_at_its_tick(make, name, delay):
    rig = make()
    ticks = [START + 3000 * i for i in range(1, 20)]
    rig.call("hal_step_arm", 0, ticks[0])
    rig.wanted[0] = ticks[1:]

    rig.run(70_000, delay)

    assert rig.rises(0) == ticks
    assert min(rig.widths(0)) >= WIDTH[name]
    assert rig.late == 0


def test_four_motors_share_the_timer(make, name):
    rig = make()
    ticks = {m: [START + (2000 + 37 * m) * i for i in range(1, 10)] for m in range(4)}
    for motor in range(4):
        rig.call("hal_step_arm", motor, ticks[motor][0])
        rig.wanted[motor] = ticks[motor][1:]

    rig.run(30_000)

    assert {m: rig.rises(m) for m in range(4)} == ticks
    assert min(min(rig.widths(m)) for m in range(4)) >= WIDTH[name]
    assert rig.late == 0


def test_edges_at_the_same_tick_all_come(make):
    rig = make()
    for motor in range(4):
        rig.call("hal_step_arm", motor, START + 5000)
        rig.wanted[motor] = [START + 6000]

    rig.run(10_000)

    assert all(rig.rises(motor) == [START + 5000, START + 6000] for motor in range(4))


def test_the_counter_may_wrap(make):
    rig = make((1 << 32) - 3000)
    rig.call("hal_step_arm", 1, 1000)
    rig.wanted[1] = [4000]

    rig.timer.advance(2900)
    for _ in range(8000):
        rig.timer.advance(1)
        if rig.timer.interrupts:
            rig.call("stm32_step_interrupt")

    assert rig.rises(1) == [1000, 4000]
    assert rig.late == 0


@pytest.mark.parametrize("behind", [0, 1, 500, 100_000])
def test_a_tick_that_is_past_is_made_good_at_once_and_counted(make, name, behind):
    rig = make()
    rig.call("hal_step_arm", 0, START + 200_000)
    rig.wanted[0] = [START + 200_000 - behind]

    rig.run(210_000)

    first, second = rig.rises(0)
    assert first == START + 200_000
    assert 2 * WIDTH[name] <= second - first <= 2 * WIDTH[name] + 2 * SLACK
    assert rig.late == 1


def test_a_first_tick_that_is_past_is_made_good_too(make):
    rig = make()
    rig.call("hal_step_arm", 3, START - 100)

    rig.run(2000)

    assert len(rig.rises(3)) == 1
    assert rig.late == 1


def test_the_pin_stays_low_long_enough_between_late_pulses(make, name):
    rig = make()
    rig.call("hal_step_arm", 0, START + 500)
    rig.wanted[0] = [START + 501] * 5

    rig.run(10_000)

    lows = [b - a for a, b in itertools.pairwise(tick for tick, _, _ in rig.timer.edges)][1::2]
    assert len(lows) == 5
    assert min(lows) >= WIDTH[name]


def test_a_channel_rests_behind_its_last_pulse(make):
    rig = make()
    rig.call("hal_step_arm", 0, START + 500)

    rig.run(5000)

    assert rig.timer.mode(0) == LOW
    assert not rig.timer.registers[0x0C]


def test_an_armed_edge_can_be_taken_back(make):
    rig = make()
    rig.call("hal_step_arm", 0, START + 5000)

    taken = rig.call("hal_step_disarm", 0)
    rig.run(10_000)

    assert taken
    assert rig.rises(0) == rig.served == []


@pytest.mark.parametrize("ahead", [-3, 0, 1, 2, 10, 24])
def test_an_edge_that_is_nearly_there_cannot_be_taken_back(make, ahead):
    rig = make()
    rig.call("hal_step_arm", 0, START + 5000)
    rig.timer.advance(START + 5000 - ahead - rig.timer.counter)

    taken = rig.call("hal_step_disarm", 0)
    rig.timer.advance(1)
    rig.run(2000)

    assert not taken
    assert rig.rises(0) == [START + 5000]
    assert rig.served == [0]


def test_a_channel_without_a_pulse_has_nothing_to_be_taken_back(make):
    assert not make().call("hal_step_disarm", 0)


def test_a_stale_match_is_no_pulse(make):
    rig = make()
    rig.call("hal_step_arm", 0, START + 5000)
    rig.call("hal_step_disarm", 0)
    rig.run(10_000)
    rig.call("hal_step_arm", 0, START + 20_000)

    rig.run(15_000)

    assert rig.rises(0) == [START + 20_000]
    assert rig.served == [0]


def test_disconnected_channels_keep_their_time_and_their_pins_low(make):
    rig = make()
    rig.call("hal_step_connect", 0)
    rig.timer.edges.clear()
    rig.call("hal_step_arm", 1, rig.timer.counter + 3000)
    rig.wanted[1] = [rig.timer.counter + 3000 * i for i in range(2, 6)]

    rig.run(30_000)

    assert rig.timer.edges == []
    assert rig.served == [1] * 5
    assert rig.late == 0


def test_a_train_may_be_disconnected_and_connected_again(make):
    rig = make()
    ticks = [START + 5000 * i for i in range(1, 10)]
    rig.call("hal_step_arm", 1, ticks[0])
    rig.wanted[1] = ticks[1:]

    rig.run(12_000)
    rig.call("hal_step_connect", 0)
    rig.run(15_000)
    rig.call("hal_step_connect", 1)
    rig.run(25_000)

    assert rig.rises(1) == [*ticks[:2], *ticks[5:]]
    assert rig.served == [1] * 9


def test_dir_waits_for_the_hold_time_of_the_last_pulse(make):
    rig = make()
    rig.call("hal_step_arm", 0, START + 500)
    rig.run(600)
    edge = rig.rises(0)[0]

    rig.call("hal_step_set_direction", 0, 1)

    assert rig.timer.counter >= edge + 2 * 420  # 5 us behind the edge, 5 us before the next


def test_a_step_interrupt_that_does_not_come_is_noticed(make):
    rig = make()
    rig.call("hal_step_arm", 0, START + 500)
    rig.timer.advance(500 + 5 * 84_000 - 10)
    before = rig.call("stm32_step_is_stuck")
    rig.timer.advance(100)

    assert not before & 1
    assert rig.call("stm32_step_is_stuck") & 1
