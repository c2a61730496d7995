"""The model of the positioning unit against units that are right, and others that are wrong.

A unit that is wrong is the model itself with one slip planted, which makes pulses and registers;
the right model has to notice.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pos_axis
import pos_change
import pos_read
import pos_target
import pytest
from exact import Fraction
from pos_axis import Axis
from pos_bits import Bits
from pos_curve import Order
from pos_model import Done, compare, imagine, judge
from pos_motion import Motion, Train
from pos_run import run_session
from pos_session import Act, Edge, Session, Setting
from pos_sessions import session
from pos_target import Origin, Seat
from pos_words import FEED_UNITS, MS, Code, Mismatch, Settings, Unsure

Plant = Callable[[pytest.MonkeyPatch], None]
SEEDS = range(10, 30)
UNSURE_MAX = 0
WRONG_SEEDS = 300
RARE = {"limits do not count": 99, "remainders are dropped": 14, "homing is not told": 72}
"""Slips that show in few sessions, and one in which they do."""
TRIED = Session(
    (
        Act(10 * MS, 1, Code.POS_INIT, (0,)),
        Act(12 * MS, 1, Code.POS_MODE, (10_000, 500)),
        Act(14 * MS, 1, Code.POS_CONTROL, (1000 * FEED_UNITS, 1)),
        Act(300 * MS, 1, Code.POS_CONTROL, (500 * FEED_UNITS, 1)),
        Act(400 * MS, 1, Code.POS_CONTROL, (0, 1)),
        Act(600 * MS, 1, Code.POS_CONTROL, (1500 * FEED_UNITS, 1)),
    ),
    end=1000 * MS,
)


def test_the_model_agrees_with_all_that_it_can_imagine() -> None:
    unsure = 0
    for seed in SEEDS:
        spoken = session(seed)
        try:
            compare(spoken, imagine(spoken, seed))
        except Unsure:
            unsure += 1
    assert unsure <= UNSURE_MAX


def test_feeds_and_a_hold_leave_the_measure_as_it_is() -> None:
    for seed in range(10):
        done = imagine(TRIED, seed)
        assert len(done.trains[0].ticks) == 1000
        assert judge(TRIED, done) == []


@pytest.mark.parametrize("pulse", [0, 1, 200, 450, 470, 500, 540])
def test_a_pulse_that_is_beside_its_time_is_told(pulse: int) -> None:
    done = imagine(TRIED, 3)
    for off in (-4, 4):
        ticks = list(done.trains[0].ticks)
        ticks[pulse] += off
        wrong = Done([Train(ticks, done.trains[0].signs), Train(), Train(), Train()])
        (told,) = judge(TRIED, wrong)
        assert "beside its time" in told


def test_pulses_too_many_too_few_or_turned_round_are_told() -> None:
    train = imagine(TRIED, 3).trains[0]
    cases = {
        "does not come": Train(train.ticks[:-1], train.signs[:-1]),
        "at rest": Train([*train.ticks, 990 * MS], [*train.signs, 1]),
        "direction": Train(train.ticks, [*train.signs[:-1], -1]),
    }
    for what, wrong in cases.items():
        (told,) = judge(TRIED, Done([wrong, Train(), Train(), Train()]))
        assert what in told


def test_a_start_may_come_a_millisecond_after_it_is_permitted_also_where_a_stand_is_not_told() -> (
    None
):
    """The axis is between two pulses that are far apart when it is told to stop."""
    given = Session(
        (
            Setting(5 * MS, 130, 2),
            Setting(5 * MS, 132, 5),
            Setting(5 * MS, 138, 412_877),
            Act(6 * MS, 1, Code.POS_INIT, (0,)),
            Act(10 * MS, 1, Code.POS_MODE, (5379, 911)),
            Act(10 * MS, 1, Code.POS_CONTROL, (511_181, 1)),
            Act(27 * MS, 1, Code.POS_INIT, (0,)),
            Act(27 * MS, 1, Code.POS_MODE, (-711, 76)),
            Act(29 * MS + MS // 2, 1, Code.POS_CONTROL, (2052 * FEED_UNITS, 1)),
        ),
        end=60 * MS,
    )
    spoken, done = run_session(given)
    assert judge(spoken, done) == []
    train = done.trains[0]
    late = Done([Train([tick + MS for tick in train.ticks], train.signs), *done.trains[1:]])
    assert "beside its time" in judge(spoken, late)[0]


def test_a_limit_need_not_wait_for_the_pulse_that_a_hold_waits_for() -> None:
    """The hold comes on a ramp; at the limit the speed is constant, and the next pulse is far."""
    spoken, done = run_session(
        Session(
            (
                Setting(5 * MS, 130, 1),
                Setting(5 * MS, 132, 1000),
                Setting(5 * MS, 146, 1),
                Act(6 * MS, 1, Code.POS_INIT, (0,)),
                Act(7 * MS, 1, Code.POS_MODE, (-10_000, 1091)),
                Act(7 * MS, 1, Code.POS_CONTROL, (65_535 * FEED_UNITS, 1)),
                Act(54 * MS, 1, Code.POS_CONTROL, (1320 * FEED_UNITS, 1)),
                Act(94 * MS, 1, Code.POS_CONTROL, (1320 * FEED_UNITS, 0)),
            ),
            edges=(Edge(113 * MS, 1, 1),),
            end=300 * MS,
        )
    )
    assert judge(spoken, done) == []
    *before, last = done.trains[0].ticks
    for off in (-MS, MS):
        train = Train([*before, last + off], done.trains[0].signs)
        assert "beside its time" in judge(spoken, Done([train, *done.trains[1:]]))[0]


def noticed(plant: Plant, first: int) -> bool:
    """Whether the right model notices what the wrong one imagines, in one of many sessions."""
    for seed in range(first, first + WRONG_SEEDS):
        spoken = session(seed)
        with pytest.MonkeyPatch.context() as patch:
            plant(patch)
            try:
                done = imagine(spoken, seed)
            except Unsure:
                continue
        try:
            compare(spoken, done)
        except Mismatch:
            return True
        except Unsure:
            continue
    return False


def changes(owner: Any, name: str, make: Callable[[Any], Any]) -> Plant:
    """Plants another function, made of the right one."""

    def plant(patch: pytest.MonkeyPatch) -> None:
        right = owner.__dict__[name] if isinstance(owner, type) else getattr(owner, name)
        patch.setattr(owner, name, make(right))

    return plant


def more(right: Any) -> Any:
    """A result that is 1 too large."""
    return lambda *given: right(*given) + 1 if right(*given) else 0


def on_whole_steps(right: Any) -> Any:
    return lambda x, *others: right(Fraction(math.floor(x)), *others)


def without_slack(right: Any) -> Any:
    return lambda seat, step: step - seat.step


def late_by(ticks: int) -> Callable[[Any], Any]:
    return lambda right: (
        lambda motion, tick, order, late=0, **more: right(motion, tick + ticks, order, 0, **more)
    )


def hard_stop(right: Any) -> Any:
    def change(motion: Motion, tick: int, order: Order, late: int, *, anew: bool = True) -> Any:
        harder = order if order.speed else replace(order, accel=2 * order.accel)
        return right(motion, tick, harder, late, anew=anew)

    return change


SLIPS: dict[str, Plant] = {
    "halves go down": changes(pos_target, "half_up", lambda _: lambda v: math.ceil(v - 0.5)),
    "remainders are dropped": changes(
        Origin, "given_up", lambda _: lambda o, s, step: reset(o, step)
    ),
    "V is 1/256 step/s more": changes(Settings, "speed", more),
    "a is 1/128 step/s² more": changes(Settings, "accel", more),
    "it goes on from a whole step": changes(pos_change, "started", on_whole_steps),
    "backlash is not taken up": changes(Seat, "pulses_to", without_slack),
    "a change is 4 ms late": changes(Motion, "change", late_by(4 * MS)),
    "a stop is twice as hard": changes(Motion, "change", hard_stop),
    "limits do not count": changes(Axis, "blocked", lambda _: lambda axis, sign: False),
    "software limits do not count": changes(Axis, "_inside", lambda _: lambda axis, step: step),
    "nothing is refused": changes(pos_axis, "refusal", lambda _: lambda axis, act: 0),
    "the position is a step late": changes(Seat, "moved", lambda r: lambda s, n: r(s, n - (n > 0))),
    "MP is not told": changes(Bits, "control", lambda _: property(lambda bits: 8 * bits.cont)),
    "the direction is not told": changes(
        Bits, "status", lambda r: property(lambda bits: r.fget(bits) & ~0x0200)
    ),
    "homing is not told": changes(pos_read, "flags", lambda r: lambda *a: r(*a) & ~0x0040),
}


def reset(origin: Origin, step: int) -> None:
    """Make the present step the base, always."""
    origin.base, origin.way = step, 0


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_noticed(slip: str) -> None:
    assert noticed(SLIPS[slip], RARE.get(slip, 0))
