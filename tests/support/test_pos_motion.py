"""The exact motion of the model of the positioning unit, held against numbers of the contract."""

from __future__ import annotations

import numpy as np
import pytest
from exact import Fraction
from hypothesis import given
from hypothesis import strategies as st
from pos_curve import BITS, Curve, Order, started
from pos_words import ACCEL_MAX, FEED_UNITS, MS, SPEED_MAX, SPEED_UNITS, Settings
from reference import TICK_HZ

DELIVERED = Settings()
EXAMPLE = Order(DELIVERED.speed(1000 * FEED_UNITS), 0, DELIVERED.accel(500), 1000)
SPEEDS = st.integers(1, SPEED_MAX) | st.integers(1, 2000)
ORDERS = st.builds(
    Order,
    SPEEDS,
    st.just(0) | SPEEDS,
    st.integers(1, ACCEL_MAX) | st.integers(1, 10**6),
    st.integers(1, 3000),
)


def nearest(curve: Curve, pulse: int) -> int:
    return (curve.time_of(pulse) + (1 << BITS - 1)) >> BITS


def test_speed_and_acceleration_are_rounded_once() -> None:
    assert DELIVERED.speed(1000 * FEED_UNITS) == 426_667
    assert DELIVERED.accel(500) == 50_000 * 128
    assert Settings(steps=1, micrometres=10_000).speed(1) == 1
    assert Settings(steps=1, micrometres=10_000).accel(1) == 13
    assert Settings(steps=500, micrometres=1).speed(2**32 - 1) == SPEED_MAX
    assert Settings(steps=500, micrometres=1).accel(65_535) == ACCEL_MAX
    assert Settings(highest_feed=7).speed(1000) == Settings().speed(7)
    assert Settings(highest_accel=7).accel(1000) == Settings().accel(7)
    assert (DELIVERED.speed(0), DELIVERED.accel(0)) == (0, 0)


def test_pulses_of_the_example_are_those_of_the_contract() -> None:
    curve = started(0, 0, EXAMPLE)
    expected = {1: 531_263, 2: 751_319, 28: 2_811_200, 999: 52_668_700, 1000: 53_199_963}
    assert {pulse: nearest(curve, pulse) for pulse in expected} == expected
    assert curve.count == 1000
    assert curve.reaches


def test_positions_of_the_example_are_those_of_the_frames() -> None:
    curve = started(0, 0, EXAMPLE)
    made = [int(curve.place_at(ms * MS << BITS)) for ms in (300, 400)]
    assert [DELIVERED.micrometres * steps for steps in made] == [4720, 6380]


@given(ORDERS)
def test_many_pulses_at_once_are_where_each_is(order: Order) -> None:
    curve = started(0, 5, order)
    ticks = curve.ticks(1, order.end, 0)
    for pulse in {1, 2, order.end // 2 + 1, order.end}:
        exact = curve.time_of(min(pulse, order.end)) / (1 << BITS)
        assert ticks[min(pulse, order.end) - 1] == pytest.approx(exact, rel=1e-13, abs=1e-4)
    assert np.all(np.diff(ticks) > 0)


@given(ORDERS, st.integers(0, SPEED_MAX), st.data())
def test_squares_at_whole_steps_stay_whole(order: Order, speed: int, data: st.DataObject) -> None:
    curve = started(0, 0, order)
    place = data.draw(st.integers(1, order.end))
    changed = curve.changed(
        Fraction(place), Order(speed, order.start_speed, order.accel, order.end)
    )
    for pulse in range(1, changed.count + 1):
        leg = changed.leg_at(pulse)
        assert leg is not None
        square2 = leg.square2_at(pulse)
        assert square2.denominator == 1
        assert square2 % 2 == 0
    if speed:
        assert changed.reaches


@given(ORDERS, st.data())
def test_an_axis_goes_on_from_where_it_stood(order: Order, data: st.DataObject) -> None:
    place = data.draw(st.integers(1, order.end))
    hold = Order(0, order.start_speed, order.accel, order.end)
    held = started(0, 0, order).changed(Fraction(place), hold)
    assert place <= held.rest <= order.end
    again = started(held.rest, held.rest_time, order)
    assert again.reaches
    assert again.next == held.count + 1


def test_an_axis_on_its_final_ramp_keeps_it() -> None:
    curve = started(0, 0, EXAMPLE)
    held = curve.changed(Fraction(980), Order(0, 0, EXAMPLE.accel, 1000))
    assert held.reaches
    assert nearest(held, 1000) == nearest(curve, 1000)
    faster = curve.changed(Fraction(980), Order(SPEED_MAX, 0, EXAMPLE.accel, 1000))
    assert nearest(faster, 1000) == nearest(curve, 1000)


def test_a_hold_stands_between_steps() -> None:
    held = started(0, 0, EXAMPLE).changed(Fraction(400), Order(0, 0, EXAMPLE.accel, 1000))
    way = Fraction(426_667**2, 1024 * EXAMPLE.accel)
    assert held.rest == 400 + way
    assert held.count == 427
    speed = Fraction(426_667, SPEED_UNITS)
    standing = held.time_of(400) / (1 << BITS) + speed / 50_000 * TICK_HZ
    assert held.rest_time / (1 << BITS) == pytest.approx(float(standing), abs=1e-3)


def test_speeds_up_to_the_start_speed_are_taken_at_once() -> None:
    start = 100 * SPEED_UNITS
    slow = started(0, 0, Order(50 * SPEED_UNITS, start, 128 * 1000, 10))
    assert [leg.sign for leg in slow.legs] == [0]
    assert nearest(slow, 1) == TICK_HZ // 50
    faster = slow.changed(Fraction(5), Order(start, start, 128 * 1000, 10))
    assert nearest(faster, 6) - nearest(faster, 5) == TICK_HZ // 100
    stopped = faster.changed(Fraction(7), Order(0, start, 128 * 1000, 10))
    assert stopped.rest == 7
