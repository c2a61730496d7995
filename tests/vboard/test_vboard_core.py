"""The processor of the virtual board: cycles, exceptions, faults, SysTick."""

from __future__ import annotations

import pytest

IACCVIOL, IBUSERR, UNDEFINSTR, INVSTATE, INVPC = 1 << 0, 1 << 8, 1 << 16, 1 << 17, 1 << 18
FORCED = 1 << 30

# Sequences of images/costs.c with the cycles of each in RAM, by the Cortex-M4 manual, section 3.3.
COSTS_IN_RAM = {
    "alu": 100,
    "wide alu": 100,
    "multiply": 100,
    "loads, pipelined": 101,
    "loads, alone": 300,
    "loads that wait for their address": 200,
    "stores": 100,
    "loads of three": 400,
    "doubles": 300,
    "branches": 400,
    "branches not taken": 101,
    "skipped in IT": 201,
    "two skipped in IT": 301,
    "short divisions": 200,
    "long divisions": 1204,
}


def test_instructions_in_ram_cost_what_the_manual_says(run_image):
    result = run_image("costs").result

    assert dict(zip(COSTS_IN_RAM, result[0:30:2], strict=True)) == COSTS_IN_RAM


def test_a_refill_of_two_makes_branches_cheaper(run_image):
    result = run_image("costs", "--refill", "2").result

    assert result[18] == 300


def test_code_in_ram_may_wait_for_the_bus_of_its_data(run_image):
    plain = run_image("costs").result
    shared = run_image("costs", "--shared-bus").result

    kept = dict(zip(COSTS_IN_RAM, plain[0:30:2], strict=True))
    for name, cycles in zip(COSTS_IN_RAM, shared[0:30:2], strict=True):
        slowed = name.startswith(("loads", "stores", "doubles")) or name == "branches"
        assert cycles - kept[name] == pytest.approx(100 if slowed else 0, abs=1), name
    assert shared[1:30:2] == plain[1:30:2]


def test_sram_may_be_at_address_0_until_the_next_reset(run_image):
    result = run_image("low").result

    assert result[0:4] == [1, 3, 1, 77]  # the flash; mode; SRAM read and written
    assert result[11] == 1  # the flash again


def test_code_in_sram_costs_the_same_at_address_0(run_image):
    result = run_image("low").result

    assert result[4:7] == result[7:10]


def test_code_at_address_0_waits_for_its_literals_alone(run_image):
    plain, shared = run_image("low").result, run_image("low", "--shared-bus").result

    more = [there - here for here, there in zip(plain[4:10], shared[4:10], strict=True)]
    assert more == [pytest.approx(cycles, abs=2) for cycles in (100, 101, 101, 0, 100, 0)]


def test_sram2_is_not_at_address_0(run_image):
    assert run_image("low", defines=["PAST"]).summary["faults"]["count"] == 1


@pytest.mark.parametrize("mode", [1, 2])
def test_another_memory_at_address_0_is_not_modelled(run_image, mode):
    assert "SYSCFG" in run_image("low", defines=[f"MODE={mode}"]).told


def test_the_core_coupled_memory_has_a_clock(run_image):
    run = run_image("low", defines=["NO_CCM"])

    assert run.summary["watch"]["result"][12] == 5
    assert run.summary["faults"]["count"] == 1


def test_flash_costs_its_wait_states_at_branches_and_where_the_prefetch_is_too_slow(run_image):
    result = run_image("costs").result
    in_flash = dict(zip(COSTS_IN_RAM, result[1:30:2], strict=True))

    assert in_flash["branches"] == 100 * (1 + 3 + 5)
    # 400 bytes are 25 lines of 4 cycles; each takes 6 to read.
    assert in_flash["wide alu"] == pytest.approx(150, abs=3)
    assert in_flash["alu"] == 100


def test_the_accelerator_makes_repeated_branches_cheap(run_image):
    plain = run_image("costs").result
    cached = run_image("costs", "--art").result

    assert cached[19] < plain[19]
    assert cached[18] == plain[18]


def test_interrupts_nest_by_priority_and_follow_one_another(run_image):
    result = run_image("exceptions").result

    assert result[0] == 0x1324
    assert result[8] == 16 + 6  # IPSR
    assert result[9] == 1 << 6  # active


def test_basepri_masks_its_priority_and_all_below(run_image):
    result = run_image("exceptions").result

    assert result[1] == 0
    assert result[2] == 0x3
    assert result[3] == 0x34


def test_primask_keeps_an_interrupt_pending_until_it_is_taken_back(run_image):
    result = run_image("exceptions").result

    assert result[4] == 0
    assert result[5] == 1 << 7
    assert result[6] == 0


def test_a_disabled_interrupt_is_not_taken(run_image):
    assert run_image("exceptions").result[7] == 0


def test_entry_return_and_tail_chain_cost_12_10_and_6_cycles(run_image):
    result = run_image("tail_chain").result

    assert result[0] == 12 + 1 + 10
    assert result[1] == 6 + 1


def test_the_statistics_count_each_vector(run_image):
    run = run_image("tail_chain")

    assert run.vector("22")["count"] == 2
    assert run.vector("22")["max"] == 12 + 1 + 10
    assert run.vector("23")["min"] == 6 + 1 + 10
    assert run.vector("23")["latency_max"] == 12 + 1 + 6
    assert run.summary["tail_chains"] == 1


def test_faults_without_a_handler_of_their_own_become_hard_faults(run_image):
    result = run_image("faults").result

    bus, undefined, no_coprocessor = 0x8200, 0x10000, 0x80000
    forced = 1 << 30
    assert result[0:12] == [
        3, bus, forced, 3, bus, forced, 3, undefined, forced, 3, no_coprocessor, forced,
    ]  # fmt: skip


def test_enabled_faults_go_to_their_handlers(run_image):
    result = run_image("faults").result

    assert result[12:24] == [5, 0x8200, 0, 5, 0x8200, 0, 6, 0x10000, 0, 6, 0x80000, 0]
    assert result[24] == 0xA0000010  # BFAR


def go_astray(run_image, place: int) -> tuple[list[int], list[int], list[int]]:
    """What the fault in main and that in a handler have told, and who went on after them."""
    result = run_image("astray", defines=[f"PLACE={place:#x}"]).result
    return result[0:4], result[8:12], result[16:19]


@pytest.mark.parametrize(
    ("place", "cfsr"),
    [
        (0x00000000, INVSTATE),
        (0x00000100, INVSTATE),
        (0x20000100, INVSTATE),
        (0x08040001, UNDEFINSTR),
        (0x10000001, IBUSERR),
        (0x60000001, IBUSERR),
        (0x40000001, IACCVIOL),
        (0xA5A5A5A5, IACCVIOL),
        (0xE000ED01, IACCVIOL),
    ],
)
def test_garbage_that_is_popped_as_the_program_counter_is_a_fault(run_image, place, cfsr):
    in_main, in_handler, went_on = go_astray(run_image, place)

    assert in_main == in_handler == [3, cfsr, FORCED, place & ~1]
    assert went_on == [1, 1, 1]


@pytest.mark.parametrize("place", [0xF0000001, 0xFFFFFF01, 0xFFFFFFF7, 0xFFFFFFFF])
def test_what_is_no_return_of_an_exception_is_a_fault_of_its_own_in_a_handler(run_image, place):
    in_main, in_handler, _ = go_astray(run_image, place)

    assert in_main == [3, IACCVIOL, FORCED, place & ~1]
    assert in_handler[:3] == [3, INVPC, FORCED]


@pytest.mark.parametrize("place", [0xFFFFFFF1, 0xFFFFFFF9, 0xFFFFFFFD])
def test_the_return_of_an_exception_is_no_place_for_main(run_image, place):
    run = run_image("astray", defines=[f"PLACE={place:#x}"])

    assert run.summary["watch"]["result"][:4] == [3, IACCVIOL, FORCED, place & ~1]


def test_svc_is_taken_at_once_and_returns_after_it(run_image):
    assert run_image("faults").result[25] == 77


def test_floating_point_runs_once_it_is_enabled(run_image):
    result = run_image("faults").result

    assert result[27] == result[26] == 8


def test_floating_point_registers_are_stacked_when_they_are_in_use(run_image):
    result = run_image("floats").result

    assert result[0] in (32, 36)
    assert result[1:3] == [1111, 2222]
    assert result[3] in (104, 108)


def test_a_handler_runs_on_the_main_stack_and_returns_to_the_process_stack(run_image):
    result = run_image("process_stack").result

    assert result[0] == 1
    assert result[2] == result[1]


def test_a_line_that_is_still_high_at_the_return_interrupts_again(run_image):
    result = run_image("level").result

    assert result[0] == 1
    assert result[1] == 1 + 3


def test_a_stack_below_the_ram_ends_in_a_hard_fault_for_stacking(run_image):
    result = run_image("stack_overflow").result

    assert result[0] == 1 << 12
    assert result[1] == 1 << 30


def test_a_fault_in_the_handler_of_faults_ends_the_run_without_a_watchdog(run_image):
    run = run_image("lockup")

    assert run.status == 1
    assert "lockup" in run.told


def test_a_fault_in_the_handler_of_faults_is_ended_by_the_watchdog(run_image):
    run = run_image("lockup", defines=["WITH_WATCHDOG"])

    assert run.summary["lockups"] == 1
    assert run.summary["resets"]["watchdog"] == 1


def test_systick_has_a_period_of_its_value_plus_one(run_image):
    result = run_image("systick").result

    assert result[0] == 1000
    assert result[1] == 6000
    assert result[3] == pytest.approx(8000, abs=20)


def test_reading_the_control_of_systick_clears_its_flag(run_image):
    assert run_image("systick").result[2] == 0


def test_sleeping_is_no_load(run_image):
    summary = run_image("systick").summary

    assert summary["asleep_cycles"] > 6000
    assert summary["load"] == pytest.approx(
        1 - summary["asleep_cycles"] / summary["cycles"], abs=1e-5
    )


def test_interrupts_at_any_place_leave_the_program_what_it_computes(run_image):
    result = run_image("disturbed").result

    assert result[2:4] == result[0:2]
    assert result[4] > 1000


def test_a_wait_for_an_event_ends_at_once_if_there_was_one_and_else_at_the_next(run_image):
    result = run_image("sleep").result

    assert result[0] == 1
    assert 900 < result[1] < 1200


def test_with_sleep_on_exit_only_handlers_run(run_image):
    assert run_image("sleep").result[2] == 10


def test_a_masked_interrupt_wakes_and_is_taken_when_it_is_unmasked(run_image):
    result = run_image("sleep").result

    assert result[3:5] == [0, 1]


def test_within_a_group_the_lower_priority_value_goes_first_and_nothing_nests(run_image):
    result = run_image("groups").result

    assert result[0] == 0x1243
    assert result[1] == 0xFA050500


def test_sleep_costs_no_time_of_the_host(run_image):
    run = run_image("idle", seconds=60)

    assert run.summary["watch"]["result"][0] == pytest.approx(60_000, abs=3)
    assert run.summary["load"] < 0.001
    assert run.summary["real_microseconds"] < 10_000_000
