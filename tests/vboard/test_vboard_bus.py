"""The buses of the virtual board at 168 MHz: what an access costs, and when a write acts.

AN4031, table 4: an access to APB takes two clocks of that bus, and two of the processor first.
"""

from __future__ import annotations

import pytest

APB1_WAIT, APB2_WAIT = 8, 4
"""Two clocks of a bus at a quarter, and at half, of the processor's clock."""
LOAD, STORE, NOP, BARRIER = 2, 1, 1, 1
MATRIX = 2


def test_a_read_of_a_slow_bus_waits_for_two_of_its_clocks(run_image):
    result = run_image("bus").result

    assert result[0] == 100 * (LOAD + APB1_WAIT + NOP)
    assert result[4] == 100 * (LOAD + APB2_WAIT + NOP)
    assert result[6] == 100 * (LOAD + NOP)


def test_a_write_lets_the_program_go_on_and_the_next_access_waits_for_its_arrival(run_image):
    result = run_image("bus").result

    assert result[1] == 100 * (STORE + 8 * NOP)
    assert result[2] == STORE + APB1_WAIT + 98 * (MATRIX + APB1_WAIT)
    assert result[5] == STORE + APB2_WAIT + 98 * (MATRIX + APB2_WAIT)
    assert result[7] == 100 * STORE


def test_a_barrier_waits_until_a_write_has_arrived(run_image):
    assert run_image("bus").result[3] == 100 * (STORE + APB1_WAIT + BARRIER)


@pytest.mark.parametrize(("wait", "cycles"), [(0, 0), (3, 3), (8, 8)])
def test_the_option_says_what_an_access_at_a_quarter_of_the_clock_takes(run_image, wait, cycles):
    result = run_image("bus", "--apb-wait", str(wait)).result

    assert result[0] == 100 * (LOAD + cycles + NOP)
    assert result[4] == 100 * (LOAD + cycles // 2 + NOP)
    assert result[6] == 100 * (LOAD + NOP)


@pytest.mark.parametrize(("wait", "low"), [(0, 0), (3, 1), (8, 6)])
def test_a_write_to_a_slow_bus_acts_when_it_arrives(run_image, wait, low):
    result = run_image("arrival", "--apb-wait", str(wait)).result

    # The first look comes two cycles after the store, the others one by one.
    assert result[0] == low


def test_a_read_comes_after_the_write_before_it(run_image):
    assert run_image("arrival").result[1] == 1234


def test_a_fast_bus_is_not_held_up_by_a_write_on_its_way_to_a_slow_one(run_image):
    result = run_image("arrival").result

    assert result[2:4] == [0, 0]


def test_a_flag_that_is_cleared_at_the_end_of_a_handler_calls_it_once_more(run_image):
    run = run_image("arrival")

    assert run.result[4] == 2
    assert run.vector("TIM2")["count"] == 2


def test_a_return_right_after_a_write_is_warned_of_and_a_barrier_between_them_helps(run_image):
    bad, good = run_image("arrival"), run_image("arrival", defines=["BARRIER"])

    assert bad.summary["warnings"] == 2
    assert "838869" in bad.told
    assert good.summary["warnings"] == 0
    assert good.result[4] == 1
