"""Edges at the inputs have interrupts of their own: soon where it is quiet, bounded where not."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from rkm04_tools.target_reactions import braking
from rkm04_tools.target_run import programs
from virtual_board import TICKS_PER_MS, Modelled, VirtualBoard

SPEED, INTERVAL = 16_000, 5250
PROGRAM = b"S500V16000A60000M03F9000R"
GUARD, OTHER = 3, 5
CRUISE_MS = 300.0
"""From the release on; the ramp is over by then."""
HOLD_MS = 0.05
WATCHDOG_MS = 400.0
"""It has reset the chip by then if nobody feeds it, with the fastest oscillator."""
REACTION_US = 5.0
"""What an edge may come before the pulse from which on it acts."""

Edge = tuple[float, int, int]


def run(
    unit: VirtualBoard, edges: Sequence[Edge], end_ms: float, options: Sequence[str] = ()
) -> Modelled:
    line = programs({1: PROGRAM})
    inputs = "".join(f"{ms:.6f},{number},{level}\n" for ms, number, level in edges)
    return unit.run(line.lines, end_ms / 1000, inputs, *options)


@pytest.fixture
def pulse_ms(unit: VirtualBoard) -> float:
    """A pulse in the cruise."""
    at = programs({1: PROGRAM}).released_ms + CRUISE_MS
    ticks = run(unit, [], at + 1).steps.tick
    return float(ticks[ticks > at * TICKS_PER_MS][0]) / TICKS_PER_MS


def reaction(unit: VirtualBoard, edges: Sequence[Edge], options: Sequence[str] = ()) -> float:
    """From the last edge to the pulse at which the ramp begins, in us."""
    last = edges[-1][0]
    ticks = run(unit, edges, last + 10, options).steps.tick
    return braking(ticks, round(last * TICKS_PER_MS), INTERVAL)[0]


def interrupts(modelled: Modelled) -> int:
    """How many there were of edges."""
    vectors = modelled.summary["vectors"]
    return sum(v["count"] for v in vectors if v["name"].startswith("EXTI"))


@pytest.mark.parametrize("options", [[], ["--exti-mask-first"]], ids=["mask after", "in front"])
@pytest.mark.parametrize("before_us", [REACTION_US, 20.0, 60.0])
def test_a_guard_acts_from_the_next_pulse_on(unit, pulse_ms, before_us, options):
    edge = (pulse_ms - before_us / 1000, GUARD, 1)

    assert reaction(unit, [edge], options) == pytest.approx(before_us, abs=0.02)


@pytest.mark.parametrize("options", [[], ["--exti-mask-first"]], ids=["mask after", "in front"])
@pytest.mark.parametrize("apart_us", [0.05, 0.3, 1.0, 10.0, 49.0, 51.0])
def test_an_edge_shortly_after_another_waits_for_the_end_of_the_hold(
    unit, pulse_ms, apart_us, options
):
    """The second one comes 2 us after a pulse: it acts at the latest at the next but one."""
    second = pulse_ms + 0.002
    edges = [(second - apart_us / 1000, OTHER, 1), (second, GUARD, 1)]

    taken = reaction(unit, edges, options)

    assert taken <= 1000 * HOLD_MS + INTERVAL * 1000 / TICKS_PER_MS
    if apart_us > 1000 * HOLD_MS:
        assert taken == pytest.approx(INTERVAL * 1000 / TICKS_PER_MS - 2, abs=0.02)


def test_what_a_look_has_seen_holds_nothing_up_again(unit, pulse_ms):
    last = pulse_ms - 0.01
    edges = [(last - 0.06, OTHER, 1), (last - 0.05, OTHER, 0), (last, GUARD, 1)]

    assert reaction(unit, edges) == pytest.approx(10, abs=0.02)


def test_edges_at_the_same_moment_are_one_interrupt(unit, pulse_ms):
    edges = [(pulse_ms + 0.03, number, 1) for number in (1, 2, 4, 5, 6, 7, 8)]

    assert interrupts(run(unit, edges, pulse_ms + 1)) == 1


@pytest.mark.parametrize("options", [[], ["--exti-mask-first"]], ids=["mask after", "in front"])
@pytest.mark.parametrize("apart_us", [2.0, 10.0, 37.0, 50.0])
def test_however_many_edges_there_are_one_hold_has_one_interrupt(unit, pulse_ms, apart_us, options):
    count = round(20_000 / apart_us)
    edges = [(pulse_ms + i * apart_us / 1000, OTHER, (i + 1) % 2) for i in range(count)]

    modelled = run(unit, edges, edges[-1][0] + 1, options)

    assert 100 < interrupts(modelled) <= 20 / HOLD_MS + 1
    assert modelled.late_steps == 0


def test_milliseconds_pass_while_edges_hold_the_clock_up(unit, pulse_ms):
    """They have the watchdog fed."""
    edges = [(pulse_ms + i * 0.02, OTHER, (i + 1) % 2) for i in range(round(WATCHDOG_MS / 0.02))]

    modelled = run(unit, edges, edges[-1][0], ["--lsi", "47000"])

    assert interrupts(modelled) > WATCHDOG_MS / HOLD_MS / 2
    assert modelled.summary["resets"]["watchdog"] == 0


def test_an_edge_does_not_wait_until_all_stops_of_another_are_planned(unit, pulse_ms):
    """Motors 1 to 3 stop at one input, and motor 4 at another a little later."""
    line = programs(dict.fromkeys((1, 2, 3), PROGRAM) | {4: PROGRAM.replace(b"M03", b"M05")})
    at = line.released_ms + CRUISE_MS
    inputs = f"{at:.6f},{GUARD},1\n{at + 0.02:.6f},{OTHER},1\n"
    edge = round((at + 0.02) * TICKS_PER_MS)

    steps = unit.run(line.lines, at / 1000 + 0.01, inputs).steps

    taken, _ = braking(steps.tick[steps.motor == 4], edge, INTERVAL)
    assert taken <= 1000 * HOLD_MS + INTERVAL * 1000 / TICKS_PER_MS
