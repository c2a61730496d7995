"""DMA1 of the virtual board and the timers' requests to it, by RM0090 chapters 10 and 18.

The images are written from the manual alone; the sections are named with what is expected.
"""

from __future__ import annotations

import struct

import pytest

PINS = "m1_step PA0\nm2_step PA1\nm3_step PA2\nm4_step PA3\n"
FE, TE, HT, TC = 1, 1 << 3, 1 << 4, 1 << 5
FAR = 0xF0000000
READS, WRITES = "FLOOD=1", "FLOOD=2"
TICK_US = 1 / 84

APB = 8
"""Two clocks of a bus at a quarter of the processor's clock."""
START, NEXT, LOAD = 3, 2, 4
"""Cycles before them: address, matrix, getting into step (AN4031); the latter two of an access that
has waited; and those of a load from SRAM."""


def word(name: str, value: int) -> list[str]:
    """The option that gives a constant of an image its value."""
    return ["--set", f"{name}={struct.pack('<I', value).hex()}"]


def words(name: str, values: tuple[int, ...]) -> list[str]:
    """The option that gives an array of an image its values."""
    return ["--set", f"{name}={struct.pack(f'<{len(values)}I', *values).hex()}"]


# --- edges ---


def test_a_ring_of_edges_makes_exact_pulses_with_the_rings_interrupts(run_image):
    run = run_image("dma_ring", "--ticks", "timer", pins=PINS)
    motor = run.summary["motors"][0]

    assert [tick for tick, _, _ in run.steps] == [1000 + 84 * i for i in range(40)]
    assert motor["width_min"] == motor["gap_min"] == pytest.approx(42 * TICK_US, abs=1e-5)
    assert motor["step"] == 0
    assert run.result[0:3] == [10, 10, HT | TC]  # 80 transfers by rings of 8; no error


def test_a_circular_stream_reloads_its_number_and_stays_enabled(run_image):
    result = run_image("dma_ring", pins=PINS).result

    assert result[3:6] == [8, 1, FAR]  # 10.3.8


def test_a_stream_that_is_led_astray_stops_by_itself(run_image):
    whole = run_image("dma_ring", pins=PINS)
    fault_ms = whole.summary["microseconds"] / 1000 - 0.02
    run = run_image("dma_ring", "--fault", f"{fault_ms:.4f}:dma=5", pins=PINS)

    assert run.result[4] == 0  # 10.3.18
    assert 20 < run.summary["motors"][0]["pulses"] < 25  # of 40


def test_a_request_that_finds_the_fifo_empty_waits_and_tells(run_image):
    whole = run_image("dma_ring", pins=PINS)
    fault_ms = whole.summary["microseconds"] / 1000 - 0.02
    run = run_image("dma_ring", "--fault", f"{fault_ms:.4f}:slow=5,90", pins=PINS)

    assert run.steps == whole.steps
    assert (whole.result[2], run.result[2]) == (HT | TC, HT | TC | FE)  # 10.3.18


def late(run_image, count: int, distance: int, *options: str, defines: tuple[str, ...] = ()):
    """Transfers that were not made, by channel."""
    arguments = [*word("channels", count), *word("distance", distance), *options]
    run = run_image("dma_together", *arguments, pins=PINS, defines=defines)
    return run.result[0:count]


def least_distance(count: int, wait: int = APB) -> int:
    """Ticks of two cycles: the last of `count` writes arrives before the counter has the value.

    A stream must have its next word, too, when it is asked again: loads follow each other.
    """
    arrival = count * (START + wait)
    return max(arrival // 2 + 1, -(-(START + wait + LOAD) // 2), count * LOAD // 2)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_streams_that_are_asked_on_one_tick_are_served_one_after_the_other(run_image, count):
    least = least_distance(count)

    assert least == [8, 12, 17, 23][count - 1]
    assert late(run_image, count, least) == [0] * count
    assert 0 < max(late(run_image, count, least - 1)) < 32


@pytest.mark.parametrize("wait", [0, 3])
def test_the_time_of_a_transfer_is_that_of_the_bus(run_image, wait):
    least = least_distance(4, wait)
    option = ["--apb-wait", str(wait)]

    assert late(run_image, 4, least, *option) == [0] * 4
    assert max(late(run_image, 4, least - 1, *option)) > 0


@pytest.mark.parametrize("count", [1, 2, 3, 4])
@pytest.mark.parametrize("flood", [READS, WRITES])
def test_a_processor_that_always_wants_the_bus_gets_it_between_two_transfers(
    run_image, count, flood
):
    # RM0090 2.1, round robin: each transfer waits for one access of the processor.
    least = count * 2 * (NEXT + APB) // 2

    assert late(run_image, count, least, defines=(flood,)) == [0] * count
    assert max(late(run_image, count, least - 1, defines=(flood,))) > 0


def test_four_channels_at_the_least_width_of_a_pulse_are_in_time(run_image):
    for defines in ((), (READS,), (WRITES,)):
        run = run_image("dma_together", pins=PINS, defines=defines)
        assert run.result[0:4] == [0] * 4
        assert [motor["pulses"] for motor in run.summary["motors"]] == [17] * 4
        assert {m["width_min"] for m in run.summary["motors"]} == {0.5}


@pytest.mark.parametrize("start", [0, 500])
def test_the_steps_may_be_those_of_timer_5(run_image, start):
    options = ["--step-timer", "TIM5", "--ticks", "timer", "--timer-start", str(start)]
    run = run_image("dma_together", *options, pins=PINS)

    ticks = [tick for tick, motor, _ in run.steps if motor == 4]
    assert ticks == [2000 - start + 84 * i for i in range(17)]


def test_the_summary_counts_transfers_and_the_longest_wait(run_image):
    dma = run_image("dma_together", pins=PINS).summary["dma"]
    waits = {each["stream"]: each["wait_max"] for each in dma["streams"]}

    # 10.3.4: of the same priority the stream of the lower number comes first.
    assert waits == {s: START + APB + i * (START + APB) for i, s in enumerate([0, 1, 2, 4])}
    assert {each["transfers"] for each in dma["streams"]} == {32}
    assert dma["lost"] == 0


def test_a_value_that_the_counter_has_passed_matches_after_its_turn(run_image):
    run = run_image("dma_past", "--ticks", "timer", pins=PINS)

    assert run.result[0] == 0
    assert [tick for tick, _, _ in run.steps] == [500, 1400]  # and down at 600 and 1450


def test_a_channel_keeps_its_level_when_its_mode_changes_and_toggles_from_there(run_image):
    result = run_image("dma_toggle").result

    assert result[0:2] == [0, 1]
    assert result[2:4] == [1, 1]  # frozen
    assert result[4:6] == [1, 0]
    assert result[6:8] == [1, 1]  # forced high
    assert result[8:10] == [1, 0]
    assert result[10:13] == [0, 0, 1]  # forced low


# --- what is in the FIFO, NDTR, stopping ---


def test_the_word_in_the_fifo_is_beyond_recall_and_the_next_one_is_not(run_image):
    result = run_image("dma_prefetch").result

    assert result[2] == 10  # 10.3.6: the first is loaded when the stream is enabled
    assert result[4] == 21  # and the next one after each transfer
    assert result[5] == 31


def test_the_number_counts_what_has_arrived_at_the_peripheral(run_image):
    result = run_image("dma_prefetch").result

    assert result[0:2] == [4, 4]  # 10.3.2: decremented after loading and storing
    assert result[3] == 3
    assert result[6] == 1
    assert result[7] == HT


def test_a_stopped_stream_tells_its_end_and_what_is_left_and_forgets_its_fifo(run_image):
    result = run_image("dma_prefetch").result

    assert result[8] == 1  # 10.3.17: not effective at once
    assert result[9] == HT | TC  # 10.3.14
    assert result[10:12] == [1, 31]


def test_a_stream_that_is_enabled_again_loads_anew_and_serves_the_request_that_waited(run_image):
    result = run_image("dma_prefetch").result

    assert result[12] == 41
    assert result[13:15] == [0, 0]
    assert result[15] == FE | HT | TC  # 10.3.18: it was asked before it had a word
    assert result[16:19] == [1, 42, HT | TC]  # 10.5.6: reloaded with what was written


def test_a_transfer_that_is_on_its_way_ends_before_its_stream_stops(run_image):
    result = run_image("dma_stop").result

    assert result[0] > 0  # EN was still read as 1
    assert result[1:4] == [TC, 3, 10]


def test_a_reset_leaves_the_values_of_the_manual(run_image):
    result = run_image("dma_reset").result

    assert result[0] == 0  # 10.5
    assert result[1] != 0
    assert result[2] == 0  # 7.3.5: AHB1RSTR


# --- flags and interrupts ---


def test_a_word_that_the_memory_port_cannot_reach_is_a_transfer_error_at_each_vector(run_image):
    result = run_image("dma_flags").result

    assert result[0:5] == [TE] * 5  # CCM RAM: RM0090 2.3.1
    assert result[6:8] == [TE] * 2
    assert result[8] == 0  # and the streams have disabled themselves


def test_each_stream_has_the_vector_of_the_manual(run_image):
    run = run_image("dma_flags")

    for stream in range(8):
        number = 16 + (11 + stream if stream < 7 else 47)
        assert run.vector(str(number))["name"] == f"DMA1_Stream{stream}"


def test_half_and_whole_are_told_and_the_stream_ends_if_it_is_not_circular(run_image):
    result = run_image("dma_flags").result

    assert result[9] == HT << 8 | HT | TC  # of three: after none, one, two, three
    assert result[10:13] == [0, 0, 3]  # a request after that changes nothing


def test_a_circular_stream_goes_round(run_image):
    result = run_image("dma_flags").result

    assert result[13:17] == [HT | TC, 2, 1, 1]


def test_a_request_before_the_first_word_is_a_fifo_error_that_loses_nothing(run_image):
    result = run_image("dma_flags").result

    assert result[17] == FE | HT | TC  # 10.3.18, with its interrupt
    assert result[18] == 4


def test_a_peripheral_that_is_not_on_apb1_is_a_transfer_error(run_image):
    result = run_image("dma_flags").result

    assert result[20:24] == [1, 0, TE, 2]  # 10.3.1, figure of the two controllers


def test_an_interrupt_that_is_enabled_while_its_flag_is_set_comes_at_once(run_image):
    assert run_image("dma_flags").result[24] == HT | TC


# --- priorities, sizes, requests ---


def test_the_priority_level_counts_first_and_then_the_lower_number(run_image):
    # The one that is served later is seen.
    assert run_image("dma_order").result[0:4] == [5, 1, 5, 5]


def test_direct_mode_looks_at_the_peripherals_size_alone(run_image):
    result = run_image("dma_sizes").result

    half, shift = 1, 13
    assert result[0] >> shift & 3 == half  # 10.5.5: forced by hardware
    assert result[0] & (0xF << 21 | 1 << 15) == 0
    assert result[1:4] == [1, 2, 3]


def test_the_fifo_takes_words_apart_and_is_refilled_from_its_threshold_on(run_image):
    result = run_image("dma_sizes").result
    values = [each >> 8 for each in result[6:18]]
    levels = [each & 7 for each in result[6:18]]

    assert result[4:6] == [4, 5]  # 10.5.10: empty, full
    assert values == [1, 2, 3, 4, 5, 6, 7, 8, 0x99, 0xAA, 11, 12]
    # Seven half-words of eight, ..., four (a half): full again. The last two words, then none.
    assert levels == [3, 3, 2, 5, 3, 3, 2, 2, 1, 1, 0, 4]
    assert result[18] == HT | TC


def test_a_timer_asks_by_the_events_that_are_enabled(run_image):
    result = run_image("dma_requests").result

    assert result[0:4] == [0, 0, 1, 0]  # 18.3.8, 18.4.4, 18.4.6
    assert result[4:6] == [0, 1]  # 18.4.2: CCDS
    assert result[6:9] == [1, 0, 1]  # UDE, and URS (18.4.1)
    assert result[9] == 1  # 18.3.7: also where the output is forced


def test_a_request_waits_for_its_stream_loses_a_second_one_and_goes_with_its_enable(run_image):
    run = run_image("dma_requests")

    assert run.result[10:12] == [1, 0]
    assert run.summary["dma"]["lost"] == 1


def test_a_request_may_outlast_its_enable(run_image):
    assert run_image("dma_requests", "--requests-stay").result[10:12] == [1, 1]


def test_two_requests_of_one_channel_are_ored(run_image):
    assert run_image("dma_requests").result[12] == 1  # 10.3.3: TIM2_CH4 at the stream of TIM2_CH2


def test_a_request_that_reaches_two_enabled_streams_ends_the_run(run_image):
    run = run_image("dma_requests", defines=["TWICE"])

    assert run.status == 1
    assert "a request reaches stream 7 and one before it, both enabled" in run.told


def test_a_read_of_the_processor_waits_for_a_transfer(run_image):
    result = run_image("dma_bus").result

    store, nops, load = 1, 12, 2
    asked = store + APB  # after the store has begun
    arrives = asked + START + APB
    assert result[1] - result[0] == arrives + NEXT - (store + nops + load)
    assert result[2] == 1


# --- what is forbidden ---

RESERVED = "bits that are reserved"
WHILE_ENABLED = "while EN is 1"
FORBIDDEN = {
    1: "(DMA1+14): not a word",
    2: "(DMA1+00): not a word",
    3: "(DMA1+00): no register that is modelled and can be written",
    4: "(DMA1+08): no register that is modelled",
    5: f"(DMA1+08): it sets {RESERVED}",
    6: f"(DMA1+88): it sets {RESERVED}",
    7: f"(DMA1+8c): it sets {RESERVED}",
    8: f"(DMA1+9c): it sets {RESERVED}",
    9: "(DMA1+d0): no register that is modelled",
    10: "(DMA1+00): its clock is not enabled",
    20: f"stream 5: NDTR or an address is written {WHILE_ENABLED}",
    21: f"stream 5: NDTR or an address is written {WHILE_ENABLED}",
    22: f"stream 5: NDTR or an address is written {WHILE_ENABLED}",
    23: f"stream 5: CR is configured {WHILE_ENABLED}",
    24: f"stream 5: FCR is configured {WHILE_ENABLED}",
    25: "stream 5: EN is set before it has been read as 0",
    27: "stream 5: it was stopped before its end and NDTR not written since",
    28: "stream 5: its flags must be cleared before EN is set",
    29: f"stream 5: NDTR or an address is written {WHILE_ENABLED}",
    41: "from memory to memory only DMA2 can carry",
    42: "DIR is reserved",
    43: "only SDIO can be the flow controller",
    44: "double buffers are not modelled",
    45: "a size is reserved",
    46: "no request of this channel is modelled",
    60: "bursts are not modelled",
    61: "the last transfer would be incomplete",
    62: "an address is not aligned",
    63: "from peripheral to memory only direct mode is modelled",
    80: "a DMA stream's write to 40000034 (TIM2+34): a byte access",
    81: "a DMA stream's write to 40000034 (TIM2+34): a half of a register of 32 bits",
    82: "a DMA stream's write to 40006000: no peripheral that is modelled",
    83: "a DMA stream's write to 40000834 (TIM4+34): its clock is not enabled",
}
ALLOWED = [0, 11, 26, 40, 47, 48]


@pytest.mark.parametrize("number", FORBIDDEN)
def test_what_the_manual_forbids_is_told_with_its_place(run_image, number):
    run = run_image("dma_forbidden", *word("which", number))

    assert run.status == 1
    assert FORBIDDEN[number] in run.told
    assert run.told.count("\n") == 1


@pytest.mark.parametrize("number", ALLOWED)
def test_what_is_allowed_beside_it_passes_without_a_word(run_image, number):
    run = run_image("dma_forbidden", *word("which", number))

    assert run.result[0] == 1
    assert run.told == ""


# --- laid ahead ---


@pytest.mark.parametrize(
    ("whole", "part"),
    [
        ((210, 210, 210, 210), (0, 0, 0, 0)),  # 400 000 pulses/s, all on the same ticks
        ((210, 211, 213, 217), (1, 250, 500, 999)),  # they meet in every order
        ((84, 2100, 420, 8400), (0, 7, 0, 900)),  # one makes 1 000 000 pulses/s
    ],
)
def test_pulses_of_four_motors_that_are_laid_ahead_come_on_their_ticks(run_image, whole, part):
    numbers = [("whole", whole), ("part", part)]
    options = [each for name, four in numbers for each in words(name, four)]
    run = run_image(
        "dma_refill", *options, "--step-timer", "TIM5", "--ticks", "timer", pins=PINS,
    )  # fmt: skip

    assert run.result[0] > 190  # refills
    assert run.summary["dma"]["lost"] == 0
    for motor in range(4):
        made = [tick for tick, number, _ in run.steps if number == motor + 1]
        assert made == [
            20000 + k * whole[motor] + k * part[motor] // 1000 for k in range(len(made))
        ]
        assert made[-1] > 84 * 5000 - 9000
        assert run.summary["motors"][motor]["width_min"] == pytest.approx(42 * TICK_US, abs=1e-5)
