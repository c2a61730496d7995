"""A stream of DMA2 that fetches what USART1 receives, on the virtual board.

By RM0090: table 43 (requests), 10.3 and 10.5 (streams), 30.3.3 and 30.3.13 (errors, DMA), 30.4
(interrupts), 30.6 (flags). The image is written from the manual alone.
"""

from __future__ import annotations

import struct

import pytest

PINS = "line USART1\n"
FRAMING, NOISE, OVERRUN, RECEIVED = 2, 4, 8, 0x20
TE, HT, TC = 1 << 3, 1 << 4, 1 << 5
ITEMS = 8
NORMAL, STREAM_5, CHANNEL_5, ONCE, NO_STREAM, NO_DMAR, TO_CCM, BYTES, READS = range(9)
NDTR, FLAGS, ENABLED, INTERRUPTS, SEEN, STATUS, DATA, AFTER = range(8)


@pytest.fixture
def receive(run_image):
    """Run the image with bytes on the line."""

    def run(line: str, how: int = NORMAL):
        constant = ["--set", f"how={struct.pack('<I', how).hex()}"]
        return run_image(
            "receive_dma", *constant, "--baud", "115200", pins=PINS, line=f"2 {line}\n"
        )

    return run


def memory(run) -> list[int]:
    return list(run.result[8:16])


@pytest.mark.parametrize("how", [NORMAL, STREAM_5])
def test_what_comes_is_in_memory_without_any_code(receive, how):
    run = receive("11 22 33 44 55", how)

    assert memory(run) == [0x11, 0x22, 0x33, 0x44, 0x55, 0, 0, 0]
    assert run.result[NDTR] == ITEMS - 5
    assert run.result[FLAGS] == HT
    assert run.result[INTERRUPTS] == 0
    assert run.summary["line"]["overruns"] == 0


def test_a_circular_stream_goes_round(receive):
    run = receive("01 02 03 04 05 06 07 08 09 0A")

    assert memory(run) == [9, 10, 3, 4, 5, 6, 7, 8]
    assert run.result[NDTR : ENABLED + 1] == [ITEMS - 2, HT | TC, 1]


def test_one_that_is_not_ends_and_what_comes_then_is_not_fetched(receive):
    run = receive("01 02 03 04 05 06 07 08 09 0A", ONCE)

    assert memory(run) == list(range(1, 9))
    assert run.result[NDTR : ENABLED + 1] == [0, HT | TC, 0]
    assert run.result[STATUS] & (RECEIVED | OVERRUN) == RECEIVED | OVERRUN
    assert run.result[DATA] == 9


def test_a_byte_that_nobody_fetches_keeps_those_after_it_out(receive):
    run = receive("01 02 03", NO_STREAM)

    assert run.result[STATUS] & (RECEIVED | OVERRUN) == RECEIVED | OVERRUN
    assert run.result[DATA] == 1
    assert run.result[AFTER] & (RECEIVED | OVERRUN) == 0
    assert run.result[INTERRUPTS] == 1
    assert run.summary["line"]["overruns"] == 2


@pytest.mark.parametrize(("mark", "flag"), [("*", FRAMING), ("~", NOISE)])
def test_a_bad_byte_is_fetched_like_others_and_calls_an_interrupt(receive, mark, flag):
    run = receive(f"01 02{mark}")

    assert memory(run)[:2] == [1, 2]
    assert run.result[INTERRUPTS] == 1
    assert run.result[SEEN] & flag
    assert run.result[STATUS] & flag
    assert run.result[AFTER] & flag == 0


def test_a_read_of_the_status_and_the_streams_next_byte_end_an_error(receive):
    run = receive("01 02* 03")

    assert run.result[SEEN] & FRAMING
    assert run.result[STATUS] & FRAMING == 0


def test_the_program_ends_an_error_and_the_stream_goes_on(receive):
    run = receive("01 02* 03 04*", READS)

    assert memory(run)[:4] == [1, 2, 3, 4]
    assert run.result[INTERRUPTS] == 2
    assert run.result[STATUS] & FRAMING == 0


def test_errors_call_no_interrupt_where_nobody_is_asked_for_transfers(receive):
    run = receive("01*", NO_DMAR)

    assert run.result[INTERRUPTS] == 0
    assert run.result[STATUS] & FRAMING


def test_memory_that_the_controller_does_not_reach_ends_the_stream(receive):
    run = receive("01 02 03", TO_CCM)

    assert run.result[FLAGS] & TE
    assert run.result[ENABLED] == 0


@pytest.mark.parametrize(
    ("how", "complaint"),
    [
        (CHANNEL_5, "DMA2 stream 2: no request of this channel is modelled"),
        (BYTES, "a DMA stream's read of 40011004 (USART1+04): a byte access"),
    ],
)
def test_what_the_manual_forbids_ends_the_run(receive, how, complaint):
    run = receive("01", how)

    assert run.status == 1
    assert complaint in run.told
