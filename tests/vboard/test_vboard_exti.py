"""External interrupts of the virtual board: images/exti.c, by RM0090 chapters 9.2 and 12."""

from __future__ import annotations

import pytest


def test_a_line_triggers_on_the_edges_that_are_selected(run_image):
    result = run_image("exti").result

    assert result[1:3] == [1, 1]  # rising: at the rising edge only
    assert result[3:5] == [1, 2]  # falling
    assert result[5] == 4  # both


def test_the_pending_register_names_the_line(run_image):
    assert run_image("exti").result[6] == 1 << 5


def test_pins_of_other_ports_and_numbers_do_nothing(run_image):
    result = run_image("exti").result

    assert result[0] == 0  # all lines to port A, after reset
    assert result[7] == result[5]


def test_an_edge_on_a_masked_line_waits_for_the_mask(run_image):
    result = run_image("exti").result

    assert result[8:10] == [0, 1 << 5]
    assert result[11:13] == [1, 0]


def test_with_the_mask_in_front_an_edge_on_a_masked_line_is_lost(run_image):
    result = run_image("exti", "--exti-mask-first").result

    assert result[8:13] == [0, 0, 0, 0, 0]
    assert result[5] == 4


def test_only_a_one_in_its_place_clears_a_pending_bit(run_image):
    result = run_image("exti").result

    assert result[10] == 1 << 5
    assert result[21] == 0


def test_each_line_has_the_vector_of_the_manual(run_image):
    result = run_image("exti").result

    assert result[13] == 16 + 6
    assert result[14] == 0x17_18_19_1A  # lines 1 to 4
    assert result[15] == 0x27_27_38_38  # lines 5, 9: interrupt 23; lines 10, 15: interrupt 40


def test_software_makes_a_request_where_the_line_is_not_masked(run_image):
    assert run_image("exti").result[16:19] == [0, 1, 0]


def test_a_line_follows_its_port_and_the_mode_of_the_pin(run_image):
    assert run_image("exti").result[19:21] == [1, 2]


@pytest.mark.parametrize(
    ("define", "complaint"),
    [
        ("LINE_17", "only lines 0 to 15, those of the pins, and 16"),
        ("PORT_9", "SYSCFG_EXTICR: port 9 of line 0 does not exist"),
        ("EVENTS", "EXTI_EMR: events are not modelled"),
        ("NO_REGISTER", "read of 40013c18 (EXTI+18)"),
    ],
)
def test_what_is_not_modelled_is_told(run_image, define, complaint):
    run = run_image("exti", defines=[define])

    assert run.status == 1
    assert complaint in run.told
