"""Pins captured by timers of the virtual board, and the wires that lead to them.

The widths and periods are those that the image asks of TIM5 (RM0090 18.3.6, PWM input mode).
"""

from __future__ import annotations

import subprocess
from itertools import pairwise

import pytest

PERIOD, WIDTH, PULSES = 8400, 210, 6
"""Ticks of 84 MHz."""
TIMERS = [([], "PB6", 1), (["BY_TIM1"], "PA8", 2)]
"""TIM4 on APB1 counts like TIM5, TIM1 on APB2 twice as fast."""


def captured(run) -> tuple[list[int], list[int]]:
    """Intervals between rising edges, and widths."""
    words = run.result[: 2 * run.result[12]]
    rises, falls = words[::2], words[1::2]
    return (
        [(b - a) % 65536 for a, b in pairwise(rises)],
        [(b - a) % 65536 for a, b in zip(rises, falls, strict=True)],
    )


@pytest.mark.parametrize(("defines", "pin", "scale"), TIMERS)
def test_both_edges_of_a_pin_are_captured_on_their_ticks(run_image, defines, pin, scale):
    run = run_image("capture_pin", "--wire", f"PA0={pin}", defines=defines)

    assert captured(run) == ([PERIOD * scale] * (PULSES - 1), [WIDTH * scale] * PULSES)


@pytest.mark.parametrize(("defines", "pin", "scale"), TIMERS)
def test_a_capture_is_flagged_until_it_is_read_and_one_over_it_too(run_image, defines, pin, scale):
    run = run_image("capture_pin", "--wire", f"PA0={pin}", defines=defines)

    assert run.result[13] == 0
    assert run.result[14] == 0x606  # CC1IF, CC2IF, CC1OF, CC2OF


def test_a_prescaler_counts_edges_of_its_channel_only(run_image):
    run = run_image("capture_pin", "--wire", "PA0=PB6", defines=["PRESCALER=1"])

    rises = run.result[2:12:2]  # at the first fall there has been no capture yet
    assert [(b - a) % 65536 for a, b in pairwise(rises)] == [0, 2 * PERIOD] * 2


@pytest.mark.parametrize(
    ("defines", "wire"),
    [([], "PA1=PB6"), ([], "PA0=PB7"), (["OTHER_FUNCTION"], "PA0=PB6"), (["BY_TIM1"], "PA0=PB6")],
)
def test_what_does_not_come_to_the_pin_and_its_function_is_not_captured(run_image, defines, wire):
    assert run_image("capture_pin", "--wire", wire, defines=defines).result[12] == 0


def test_without_a_wire_nothing_comes(run_image):
    assert run_image("capture_pin").result[12] == 0


@pytest.mark.parametrize(("defines", "pin", "scale"), TIMERS)
def test_a_wire_may_be_late_with_rising_edges(run_image, defines, pin, scale):
    run = run_image("capture_pin", "--wire", f"PA0={pin}:late=500", defines=defines)

    intervals, widths = captured(run)
    assert intervals == pytest.approx([PERIOD * scale] * (PULSES - 1), abs=1)
    assert widths == pytest.approx([(WIDTH - 42) * scale] * PULSES, abs=1)


def test_a_pulse_narrower_than_the_wire_is_late_does_not_come(run_image):
    assert run_image("capture_pin", "--wire", "PA0=PB6:late=2600").result[12] == 0


def test_a_wire_may_lose_pulses(run_image):
    run = run_image("capture_pin", "--wire", "PA0=PB6:loses=3")

    intervals, widths = captured(run)
    assert sorted(intervals) == [PERIOD] * 3 + [2 * PERIOD] * 2
    assert widths == [WIDTH] * PULSES


def test_the_last_wire_to_a_pin_counts(run_image):
    run = run_image("capture_pin", "--wire", "PA1=PB6", "--wire", "PA0=PB6")

    assert run.result[12] == PULSES
    assert run_image("capture_pin", "--wire", "PA0=PB6", "--wire", "none=PB6").result[12] == 0


def test_a_reset_of_tim1_clears_what_it_was_told(run_image):
    run = run_image("capture_pin", "--wire", "PA0=PA8", defines=["BY_TIM1"])

    assert run.result[15] == 0


@pytest.mark.parametrize(
    ("define", "complaint"),
    [
        ("OUTPUT", "outputs of TIM1 are not modelled"),
        ("INTERRUPT", "interrupts or DMA of TIM1"),
        ("SLAVE", "slave mode"),
    ],
)
def test_what_is_not_modelled_of_tim1_ends_the_run(run_image, define, complaint):
    run = run_image("capture_pin", defines=["BY_TIM1", define])

    assert run.status == 1
    assert complaint in run.told


@pytest.mark.parametrize(
    "wire", ["PA0", "PA0=", "=PB6", "PA0=PB66", "PZ0=PB6", "PA0=PB6:late=", "PA0=PB6:late=x",
             "PA0=PB6:loses=0", "PA0=PB6:slow=1", "none=", "none=PB6:late=1"],
)  # fmt: skip
def test_a_wire_that_makes_no_sense_is_refused(program, build_image, wire):
    command = [program, "--elf", build_image("capture_pin"), "--wire", wire]
    done = subprocess.run(command, capture_output=True, text=True, check=False)

    assert done.returncode == 2
    assert f"--wire {wire}: not two pins" in done.stderr
