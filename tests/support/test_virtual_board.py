"""What every run of the virtual board is judged by, beside the judge of pulses."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from virtual_board import PIN_TIMES_US, pin_times_too_short


def summary(times: Mapping[str, float | None], resets: int = 1) -> dict[str, object]:
    motor = {"motor": 1, "pulses": 3, **PIN_TIMES_US, **times}
    starts = {"resets": {"power": 1, "watchdog": resets - 1}, "pin_resets": 0}
    return {**starts, "supply": {"brown_outs": 0}, "motors": [motor]}


def test_times_as_the_drivers_need_them_pass() -> None:
    assert pin_times_too_short(summary({})) == []
    assert pin_times_too_short(summary({"dir_setup_min": None})) == []


@pytest.mark.parametrize("name", PIN_TIMES_US)
def test_a_pin_that_moves_too_soon_is_found(name: str) -> None:
    [found] = pin_times_too_short(summary({name: PIN_TIMES_US[name] - 0.01}))

    assert name in found


def test_a_reset_may_cut_a_pulse_short() -> None:
    assert pin_times_too_short(summary({"width_min": 0.1}, resets=2)) == []
