"""The image of the board when its processor goes wrong: hung, astray, without its crystal.

Four motors run stored programs and hold two outputs each when the fault comes. Then the outputs
must be safe, the board must start again without starting the programs, tell why over the line, and
do as it is told.
"""

from __future__ import annotations

import random
from itertools import pairwise

import numpy as np
import pytest
from board_talk import ask, heard
from chance import SEED
from debug_info import offset
from rkm04_tools import board
from rkm04_tools.status import Status, parse_status
from stored import area, flash, record
from virtual_board import TICKS_PER_MS, Modelled, VirtualBoard

VERSION, GET_STATUS, SET_COMMAND = b"\x01", b"\xc8", b"\x021"
TOLD_VERSION = b"\x01\x10" + board.version().encode()
MOTORS = range(1, 5)
SPEED = 4000
PROGRAM = b"S2000V%dA40000T0%dT0%dF100000R"
FAULT_MS = 150.0
RESTART_MS = 60.0
"""From a reset until the unit answers, with room."""
TOLD_MS = 120.0
"""From the first question until the unit is told to move: the status takes 60 ms."""
CAUSE_POWER, CAUSE_WATCHDOG, CAUSE_FAULT = 0, 2, 3
HARD_FAULT, NMI, ASSERTION = 3, 2, 0
RECORD = ("magic", "cause", "exception", "status", "hard", "address", "pc", "count")
NO_CODE_THERE = 1 << 0
INSTRUCTION_BUS_ERROR, STACKING_ERROR, UNDEFINED = 1 << 8, 1 << 12, 1 << 16
FORCED = 1 << 30
SYSTICK, TIM2 = 15, 44
WATCHDOG_MS = {17000: 964.0, 32000: 512.0, 47000: 349.0}
"""512 periods of 32 clocks of its oscillator, whose rate is 17 to 47 kHz."""
MAIN_MS = 200.0
"""How long main may be silent before the watchdog is not fed any more."""


def run(
    unit: VirtualBoard,
    seconds: float,
    *options: str,
    ask_ms: float,
    fault: str = "",
    fault_ms: float = FAULT_MS,
) -> Modelled:
    """Run with stored programs and a fault; later ask for version and status, then send a move."""
    path = unit.folder / "flash"
    programs = [record(m, 1 + m, PROGRAM % (SPEED, m, 4 + m)) for m in MOTORS]
    path.write_bytes(flash(area(1, programs)))
    script = ask(ask_ms, VERSION) + ask(ask_ms + 30, GET_STATUS)
    script += ask(ask_ms + TOLD_MS, SET_COMMAND + b"\\S2000V2000F7R")
    faults = ["--fault", f"{fault_ms:.6f}:{fault}"] if fault else []
    watched = ["--watch", "stm32_fault_record", "--watch", "start_cause"]
    return unit.run(script, seconds, "", *faults, "--flash", str(path), *watched, *options)


def fault_record(modelled: Modelled) -> dict[str, int]:
    words = modelled.summary["watch"]["stm32_fault_record"]
    return dict(zip(RECORD, words, strict=True))


def reset_ms(modelled: Modelled) -> float:
    return float(modelled.summary["last_reset"]["microseconds"]) / 1000


def pulses(modelled: Modelled, begin_ms: float, end_ms: float) -> int:
    ticks = modelled.steps.tick / TICKS_PER_MS
    return int(((ticks >= begin_ms) & (ticks < end_ms)).sum())


def told_status(unit: VirtualBoard) -> Status:
    """The status, of the three answers there must be."""
    version, status, taken = (answer.message for answer in heard(unit.folder))
    assert (version, taken) == (TOLD_VERSION, SET_COMMAND + b"\0\0")
    return parse_status(status)


def assert_stands_until_told(
    unit: VirtualBoard, modelled: Modelled, told_ms: float, cause: str
) -> None:
    """Safe after the reset, no program by itself; tells why; then does what it is told."""
    assert pulses(modelled, 100, FAULT_MS) > 3 * 50 * SPEED // 1000, "the motors did not run"
    assert pulses(modelled, reset_ms(modelled), told_ms) == 0
    assert modelled.summary["outputs"] == 0
    status = told_status(unit)
    assert (status.cause, status.not_started, status.no_crystal) == (cause, True, False)
    assert pulses(modelled, told_ms, 1e9) == 7
    assert modelled.summary["resets"]["power"] == 1
    assert modelled.summary["lockups"] == 0


@pytest.mark.parametrize(
    ("fault", "silent_ms"),
    [
        ("hold=rkm04_poll", MAIN_MS),
        ("hold=stm32_tick_interrupt", 0.0),
        ("hold=stm32_step_interrupt", 0.0),
        (f"lose={SYSTICK}", 0.0),
        (f"lose={TIM2}", 5.0),
    ],
    ids=["main", "tick", "step", "tick never comes", "step never comes"],
)
def test_what_hangs_ends_in_a_watchdog_reset_after_which_nothing_starts_by_itself(
    unit, fault, silent_ms
):
    reset = FAULT_MS + silent_ms + WATCHDOG_MS[32000]
    told = reset + RESTART_MS + TOLD_MS

    modelled = run(unit, told / 1000 + 0.1, ask_ms=reset + RESTART_MS, fault=fault)

    assert modelled.summary["resets"] == {"power": 1, "software": 0, "watchdog": 1}
    assert reset - 3 < reset_ms(modelled) < reset + 3
    assert modelled.summary["watch"]["start_cause"] == CAUSE_WATCHDOG
    assert fault_record(modelled)["cause"] == CAUSE_WATCHDOG
    assert_stands_until_told(unit, modelled, told, "watchdog")


@pytest.mark.parametrize("lsi_hz", [17000, 47000])
def test_the_watchdog_resets_at_any_rate_of_its_oscillator(unit, lsi_hz):
    reset = FAULT_MS + WATCHDOG_MS[lsi_hz]

    modelled = run(
        unit, (reset + 5) / 1000, "--lsi", str(lsi_hz), ask_ms=5000, fault=f"lose={SYSTICK}"
    )

    assert modelled.summary["resets"]["watchdog"] == 1
    assert reset - 3 < reset_ms(modelled) < reset + 3


@pytest.mark.parametrize(
    ("fault", "exception", "status"),
    [
        ("jump=60000000", HARD_FAULT, INSTRUCTION_BUS_ERROR),
        ("jump=08040000", HARD_FAULT, UNDEFINED),
        ("jump=a5a5a5a4", HARD_FAULT, NO_CODE_THERE),
        ("sp=stm32_stack_bottom+8", HARD_FAULT, STACKING_ERROR),
        ("sp=10000000", HARD_FAULT, STACKING_ERROR),
        ("word=tick+{tick_isr:x}:70000001", HARD_FAULT, INSTRUCTION_BUS_ERROR),
        ("jump=__assert_func", ASSERTION, 0),
        ("jump=stm32_reset", ASSERTION, 0),
    ],
    ids=[
        "nowhere",
        "erased flash",
        "no code",
        "stack overflow",
        "no stack",
        "interrupt",
        "assert",
        "reset",
    ],
)
def test_what_goes_astray_is_caught_with_the_outputs_safe_and_the_cause_kept(
    unit, fault, exception, status
):
    told = FAULT_MS + RESTART_MS + TOLD_MS

    # What the tick calls is in the client, which its own data begin with.
    fault = fault.format(tick_isr=offset(unit.image.file("elf"), "hal_client", ("tick_isr",)))
    modelled = run(unit, told / 1000 + 0.1, ask_ms=FAULT_MS + RESTART_MS, fault=fault)

    kept = fault_record(modelled)
    assert modelled.summary["resets"] == {"power": 1, "software": 1, "watchdog": 0}
    assert reset_ms(modelled) < FAULT_MS + 2
    assert pulses(modelled, reset_ms(modelled) - 0.001, told) == 0
    assert modelled.summary["last_reset"]["steps"] == 0
    assert modelled.summary["last_reset"]["outputs"] == 0
    assert (kept["cause"], kept["exception"], kept["count"]) == (CAUSE_FAULT, exception, 1)
    assert kept["status"] & status == status
    assert kept["hard"] == (FORCED if status else 0)
    assert modelled.summary["watch"]["start_cause"] == CAUSE_FAULT
    assert_stands_until_told(unit, modelled, told, "fault")


@pytest.mark.parametrize(
    ("fault", "cause", "number", "restart_ms"),
    [
        ("jump=60000000", "fault", CAUSE_FAULT, RESTART_MS),
        (f"lose={SYSTICK}", "watchdog", CAUSE_WATCHDOG, 1000),
    ],
)
def test_the_cause_is_told_where_a_loader_has_used_the_memory_that_keeps_it(
    unit, fault, cause, number, restart_ms
):
    asked = FAULT_MS + restart_ms
    told = asked + TOLD_MS

    modelled = run(unit, told / 1000 + 0.1, "--loader-uses-ram", ask_ms=asked, fault=fault)

    assert modelled.summary["watch"]["start_cause"] == number
    assert_stands_until_told(unit, modelled, told, cause)


@pytest.mark.parametrize("stream", [2, 4, 0, 3])
@pytest.mark.parametrize("fault", ["dma={stream}", "slow={stream},200000"])
def test_a_step_output_that_fails_is_caught_with_the_outputs_safe_and_the_cause_kept(
    unit, fault, stream
):
    """An edge that comes to the compare register after its time is made a turn of it later."""
    told = FAULT_MS + RESTART_MS + TOLD_MS
    fault = fault.format(stream=stream)

    modelled = run(unit, told / 1000 + 0.1, ask_ms=FAULT_MS + RESTART_MS, fault=fault)

    kept = fault_record(modelled)
    assert modelled.summary["resets"] == {"power": 1, "software": 1, "watchdog": 0}
    assert reset_ms(modelled) < FAULT_MS + 2
    assert modelled.summary["last_reset"]["steps"] == 0
    assert modelled.summary["last_reset"]["outputs"] == 0
    assert (kept["cause"], kept["exception"], kept["count"]) == (CAUSE_FAULT, TIM2, 1)
    assert (kept["status"], kept["hard"]) == (0, 0)
    assert_stands_until_told(unit, modelled, told, "fault")


def test_an_edge_that_comes_late_to_its_register_but_before_its_time_moves_no_pulse(unit):
    trains = [
        run(unit, FAULT_MS / 1000 + 0.02, ask_ms=5000, fault=fault).steps
        for fault in ("", "slow=2,40000")
    ]

    assert np.array_equal(trains[0].tick, trains[1].tick)
    assert np.array_equal(trains[0].position, trains[1].position)


def assert_refuses_motion(
    unit: VirtualBoard, modelled: Modelled, from_ms: float, cause: str
) -> None:
    """No pulse, all LEDs blinking together, answers at the right rate that tell why."""
    assert pulses(modelled, from_ms, 1e9) == 0
    blinks = [ms for ms, _ in modelled.edges("m1_led") if ms > from_ms]
    assert len(blinks) > 2
    assert [round(b - a) for a, b in pairwise(blinks)] == [100] * (len(blinks) - 1)
    for motor in (2, 3, 4):
        assert [ms for ms, _ in modelled.edges(f"m{motor}_led") if ms > from_ms] == pytest.approx(
            blinks, abs=0.01
        )
    status = told_status(unit)
    assert (status.cause, status.no_crystal) == (cause, True)
    assert modelled.summary["line"]["unheard"] == 0
    assert modelled.summary["line"]["baud"] == pytest.approx(19200, rel=0.005)


def test_without_a_crystal_the_unit_answers_shows_it_and_does_not_move(unit):
    modelled = run(unit, 0.7, "--no-crystal", ask_ms=200)

    assert_refuses_motion(unit, modelled, 150, "power-on")
    assert pulses(modelled, 0, 1e9) == 0
    assert modelled.summary["resets"] == {"power": 1, "software": 0, "watchdog": 0}
    assert modelled.summary["watch"]["start_cause"] == CAUSE_POWER


def test_a_crystal_that_stops_is_a_fault_after_which_the_unit_does_not_move(unit):
    modelled = run(unit, 0.7, "--crystal-stops", str(FAULT_MS), ask_ms=300)

    kept = fault_record(modelled)
    assert pulses(modelled, 100, FAULT_MS) > 600
    assert modelled.summary["resets"] == {"power": 1, "software": 1, "watchdog": 0}
    assert reset_ms(modelled) < FAULT_MS + 0.1
    assert modelled.summary["last_reset"]["steps"] == 0
    assert modelled.summary["last_reset"]["outputs"] == 0
    assert (kept["cause"], kept["exception"]) == (CAUSE_FAULT, NMI)
    assert_refuses_motion(unit, modelled, FAULT_MS + 0.1, "fault")


@pytest.mark.parametrize("place", range(4))
def test_power_that_goes_in_a_move_leaves_nothing_but_the_stored_programs(unit, place):
    off = random.Random(f"{SEED} {place}").uniform(60, 160)

    modelled = run(unit, 2 * off / 1000, ask_ms=5000, fault="power", fault_ms=off)

    assert modelled.summary["resets"] == {"power": 2, "software": 0, "watchdog": 0}
    assert modelled.summary["last_reset"]["microseconds"] == pytest.approx(1000 * off, abs=2)
    assert modelled.late_steps == 0
    for motor in MOTORS:
        ticks = modelled.steps.tick[modelled.steps.motor == motor]
        before, again = (
            ticks[part] for part in (ticks < off * TICKS_PER_MS, ticks >= off * TICKS_PER_MS)
        )
        count = min(len(before), len(again))
        assert count > 50
        assert list(np.diff(before[:count])) == list(np.diff(again[:count]))
        assert abs(off - (again[0] - before[0]) / TICKS_PER_MS) < 1
