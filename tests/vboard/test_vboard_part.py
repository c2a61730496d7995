"""Clocks, ports, watchdog and the loud errors of the virtual board."""

from __future__ import annotations

import pytest

PINS = "bi1 PC0\nbi2 PC1 low  # opto-isolated\nm1_led PA0\n"


def test_the_clock_tree_runs_from_the_crystal_at_168_mhz(run_image):
    run = run_image("clock")

    assert run.result[1] == 0x83  # RCC_CR after reset: HSI on and ready, trimmed to 16
    assert run.result[2] == 0x0E000000
    assert run.result[0] == 1
    assert run.result[3] == pytest.approx(32000, rel=0.01)  # 2 ms at 16 MHz
    assert run.result[4] & 0xF == 0xA
    assert run.summary["hclk_hz"] == 168_000_000


def test_without_a_crystal_it_never_gets_ready(run_image):
    run = run_image("clock", "--no-crystal")

    assert run.result[0] == 0
    assert run.summary["hclk_hz"] == 16_000_000


def test_another_crystal_gives_another_clock(run_image):
    run = run_image("clock", "--crystal", "7.5")

    assert run.summary["hclk_hz"] == 157_500_000


def test_a_crystal_too_fast_for_its_dividers_is_told(run_image):
    run = run_image("clock", "--crystal", "25")

    assert run.status == 1
    assert "the PLL compares at 3125000 Hz" in run.told


def test_an_access_to_a_peripheral_without_clock_names_address_place_and_function(run_image):
    run = run_image("unclocked")

    assert run.status == 1
    assert run.summary["ended"] == "error"
    assert "write to 40000028 (TIM2+28): its clock is not enabled" in run.told
    assert "in main" in run.told
    assert run.told.count("\n") == 1


def test_an_access_to_a_peripheral_that_is_held_in_reset_is_told(run_image):
    run = run_image("unclocked", defines=["HELD"])

    assert "write to 40000028 (TIM2+28): RCC holds it in reset" in run.told
    assert run.told.count("\n") == 1


def test_an_access_to_a_register_that_does_not_exist_is_told(run_image):
    run = run_image("unknown")

    assert run.status == 1
    assert "read of 40020040 (GPIOA+40)" in run.told


def test_too_few_wait_states_are_told(run_image):
    run = run_image("too_fast")

    assert run.status == 1
    assert "the flash has 4 wait states and needs 5 at 168 MHz" in run.told


def test_pins_follow_mode_output_pull_and_what_is_outside(run_image):
    run = run_image("ports", pins=PINS, inputs="2.5,1,1\n1,2,1\n2,2,0\n2.4,2,1\n")

    assert run.result[0] == 0xA8000000
    assert run.result[1:3] == [5, 5]
    assert run.result[3:5] == [8, 0]
    assert run.result[5] == 0
    assert run.result[6] == 0
    assert run.result[7] == pytest.approx(2500, abs=50)
    assert run.result[8] == 0
    assert "m1_led" in (run.folder / "wave.vcd").read_text()


def test_a_stuck_pin_stays_where_it_is(run_image):
    run = run_image("ports", "--stuck", "PC0=1", pins=PINS)

    assert run.result[7] <= 2


def test_a_step_pin_that_is_stuck_before_power_comes_is_one_pulse_at_its_begin(run_image):
    run = run_image("ports", "--stuck", "PA1=1", pins="m1_step PA1\n")

    assert run.status == 0
    assert run.summary["motors"][0]["pulses"] == 1


def test_the_watchdog_resets_a_program_that_does_not_feed_it(run_image):
    run = run_image("watchdog", "--watch", "flags")
    flags = run.summary["watch"]["flags"]

    assert run.summary["resets"] == {"power": 1, "software": 1, "watchdog": 1}
    assert flags[0:6] == [0x0E000000, 0, 0x24000000, 0, 0x14000000, 0]
    # Five periods until the values are taken over, 20 times 5 ms fed, then 80 periods of 125 us.
    assert run.summary["microseconds"] == pytest.approx(156 + 100_000 + 10_000 + 50, abs=60)


def test_a_slow_oscillator_makes_the_watchdog_slow(run_image):
    run = run_image("watchdog", "--lsi", "17000")

    assert run.summary["microseconds"] == pytest.approx(100_000 + 10_000 * 32 / 17, rel=0.01)


def test_the_clock_security_system_goes_back_to_the_internal_oscillator(run_image):
    run = run_image("crystal_stops", "--crystal-stops", "10")

    assert run.result[0] == 1  # NMI with CSSF
    assert run.result[1] == 0  # SWS: HSI
    assert run.summary["hclk_hz"] == 16_000_000


def test_without_the_clock_security_system_the_processor_stands(run_image):
    run = run_image("crystal_stops", "--crystal-stops", "10", defines=["WITHOUT_CSS"])

    assert run.status == 1
    assert "the crystal has stopped" in run.told
