"""What a part measures of itself on the virtual board: its supply, and its low-speed oscillator."""

from __future__ import annotations

from itertools import pairwise

import pytest

TICK_HZ = 84_000_000
FLAG, OVER = 1 << 4, 1 << 12
"""CC4IF and CC4OF."""
CYCLES_OF_TURN = 40
"""A turn of a loop that waits for a flag, on the bus."""


def intervals(run) -> list[int]:
    return [b - a for a, b in pairwise(run.result[:9])]


@pytest.mark.parametrize(
    ("defines", "periods"),
    [([], 1), (["EDGES=1"], 1), (["EDGES=5"], 0.5), (["PRESCALER=1"], 2), (["PRESCALER=3"], 8)],
)
@pytest.mark.parametrize("hertz", [17_000, 32_000, 47_000])
def test_edges_of_the_oscillator_are_captured_on_their_ticks(run_image, defines, periods, hertz):
    run = run_image("capture", "--lsi", str(hertz), defines=defines)

    assert intervals(run) == pytest.approx([TICK_HZ * periods / hertz] * 8, abs=1)


def test_rising_and_falling_edges_lie_half_a_period_apart(run_image):
    rising = run_image("capture").result[0]
    falling = run_image("capture", defines=["EDGES=1"]).result[0]

    assert abs(rising - falling) == pytest.approx(TICK_HZ / 64_000, abs=1)


def test_a_flag_comes_with_a_capture_and_goes_when_it_is_read(run_image):
    run = run_image("capture")

    assert run.result[10] == 0  # the oscillator was off
    assert run.result[11] & FLAG == 0
    assert run.result[12] == FLAG | OVER  # captures that nobody has read
    assert run.result[13] == OVER
    assert run.result[14] == 0  # the channel was off


@pytest.mark.parametrize(
    ("define", "complaint"),
    [
        ("MODE_WHILE_ON", "CCxS is written while the channel is on"),
        ("WRITE_CAPTURE", "the register of an input can only be read"),
        ("RESERVED_EDGE", "CCxNP without CCxP is reserved"),
        ("EDGE_OF_OUTPUT", "CCxNP must be kept cleared for an output"),
        ("OTHER_INPUT", "capture of a trigger"),
        ("FILTER", "or by a filter"),
        ("OTHER_OSCILLATOR", "write to 40000c50 (TIM5+50)"),
    ],
)
def test_what_a_captured_channel_must_not_be_asked_for_ends_the_run(run_image, define, complaint):
    run = run_image("capture", defines=[define])

    assert run.status == 1
    assert complaint in run.told


@pytest.mark.parametrize("volts", [3.0, 3.3, 3.55])
def test_the_reference_tells_the_supply(run_image, volts):
    run = run_image("adc", "--supply", str(volts))

    assert run.result[1] == 1502
    assert 3.3 * run.result[1] / run.result[0] == pytest.approx(volts, rel=1 / 1500)


def test_a_conversion_takes_the_sampling_and_twelve_clocks_more(run_image):
    run = run_image("adc")

    assert run.result[2] == 0
    assert run.result[3] == 0x10  # STRT
    assert run.result[4] == pytest.approx((480 + 12) * 8, abs=2 * CYCLES_OF_TURN)
    assert run.result[5] == 0x10  # EOC has gone with the reading
    assert run.result[6] == 0


@pytest.mark.parametrize(
    ("define", "complaint"),
    [
        ("WITHOUT_REFERENCE", "or without it (RM0090 13.10, DS8626)"),
        ("REFERENCE_TOO_SOON", "less than 10 us after TSVREFE"),
        ("TOO_SOON", "less than 3 us after ADON"),
        ("OFF", "or while it is off"),
        ("WHILE_RUNNING", "while one runs"),
        ("CHANNEL=3", "a channel other than 17 is not modelled"),
        ("DIVIDE=0", "its clock is not from 0.6 to 36 MHz"),
        ("SAMPLING=5", "sampled for less than 10 us"),
        ("INTERRUPT", "write to 40012004 (ADC1+04)"),
        ("HALF_WORD", "written as words"),
    ],
)
def test_what_the_converter_must_not_be_asked_for_ends_the_run(run_image, define, complaint):
    run = run_image("adc", defines=[define])

    assert run.status == 1
    assert complaint in run.told
