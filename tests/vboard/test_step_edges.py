"""The step driver at its edges of time, on the slow bus: pin and count agree, all pulses are whole.

The image is that of a board with another main (images/take_back_main.c); the pulses are those that
the virtual board has seen at the pins. A write to the timer takes ten cycles to arrive.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from step_trials import Train

SHORT, LONG = "f405", "f407-discovery"
WIDTH_TICKS = {SHORT: 42, LONG: 210}
"""High and low alike."""
TICKS_PER_US = 84
ODD = ["--refill", "1", "--match-equal", "--requests-stay"]
FAST_BUS = ["--apb-wait", "3", "--pwm-at-once"]


HALTS = Train(trials=10_000, pace_ticks=5250, pulses=3, halt_ticks=16_000)
FAST = Train(trials=3000, pace_ticks=420, pulses=60, halt_ticks=30_000)


@pytest.mark.parametrize(
    ("name", "train", "options"),
    [
        (SHORT, replace(HALTS, trials=40_000), []),
        (SHORT, HALTS, ODD),
        (SHORT, HALTS, FAST_BUS),
        (SHORT, HALTS, ["--shared-bus"]),
        (LONG, HALTS, []),
        (SHORT, FAST, []),
        (SHORT, replace(FAST, pace_ticks=110, pulses=200, trials=1000), []),
        (SHORT, replace(FAST, together=4, lead_ticks=16_000, halt_ticks=40_000, trials=1000), []),
        (SHORT, replace(FAST, together=4, lead_ticks=16_000, halt_ticks=40_000, trials=1000), ODD),
        (
            SHORT,
            replace(FAST, together=4, lead_ticks=16_000, halt_ticks=40_000, trials=1000),
            ["--shared-bus"],
        ),
        (
            LONG,
            replace(
                FAST, pace_ticks=440, together=4, lead_ticks=16_000, halt_ticks=40_000, trials=1000
            ),
            [],
        ),
    ],
)
def test_pulses_that_are_taken_back_at_any_time_are_made_and_counted_or_neither(
    try_trains, name, train, options
):
    tried = try_trains(name, train, *options)

    all_pulses = train.trials * train.pulses * train.together
    assert tried.counted == tried.shown
    assert tried.warnings == tried.late == 0
    assert all_pulses / 5 < sum(tried.counted) < all_pulses * 3 / 4  # the rest was taken back
    assert tried.least_us("width_min") == pytest.approx(WIDTH_TICKS[name] / TICKS_PER_US)


@pytest.mark.parametrize(
    ("name", "options"), [(SHORT, []), (SHORT, ODD), (SHORT, FAST_BUS), (LONG, [])]
)
@pytest.mark.parametrize("pulses", [2, 40])
def test_pulses_that_are_laid_just_in_time_or_late_are_whole_and_none_is_lost(
    try_trains, name, pulses, options
):
    width = WIDTH_TICKS[name]
    pace = 2 * width + 16
    train = Train(trials=2000, lead_ticks=400, lead_varied=1000, pace_ticks=pace, pulses=pulses)
    tried = try_trains(name, train, *options)

    assert tried.counted == tried.shown == [train.trials * pulses // 4] * 4
    assert tried.least_us("width_min") == pytest.approx(width / TICKS_PER_US)
    assert tried.least_us("gap_min") >= width / TICKS_PER_US
    assert 0 < tried.late < train.trials * pulses


@pytest.mark.parametrize("options", [[], ODD, FAST_BUS])
def test_four_motors_that_are_late_together_lose_no_pulse(try_trains, options):
    tried = try_trains(
        SHORT, replace(FAST, lead_ticks=500, trials=300, halt_ticks=0, together=4), *options
    )

    assert tried.counted == tried.shown == [300 * FAST.pulses] * 4
    assert tried.late > 0
    assert tried.least_us("width_min") == pytest.approx(WIDTH_TICKS[SHORT] / TICKS_PER_US)
    assert tried.least_us("gap_min") >= WIDTH_TICKS[SHORT] / TICKS_PER_US
