"""STEP pins that an interrupt writes: no pulse is early, lost or surplus, and how late they are.

The board is the one whose header has class 2. Widths and gaps are at least what its page says; a
pulse later than 4 us counts as late.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from board_talk import ask, heard
from rkm04_tools import board
from rkm04_tools.status import parse_status
from step_acts import FAST_BUS, MOTORS, ODD, READY, Acts, What
from step_trials import Train, assert_turns
from virtual_board import (
    READY_MS,
    TICKS_PER_MS,
    Message,
    Modelled,
    Simulated,
    VirtualBoard,
    of_motor,
    script,
    together,
)

NAME = "skr-pro-1.2"
WIDTH, LATE_MAX = 210, 336  # ticks: 2.5 us, 4 us
HOLD_TICKS = SETUP_TICKS = 420
ALONE = 100
"""At most, of one motor alone, ticks."""
MEDIAN = 60
TOGETHER = 252
"""And of four whose pulses fall together, line and inputs busy."""
AFTER_TURN = 840
"""And of four that turn one soon after the other: 10 us."""
WORST = "stm32_step_worst_ticks"


@pytest.fixture
def unit(program: Path, tmp_path: Path) -> VirtualBoard:
    return VirtualBoard(program, board.build(NAME), tmp_path)


def shown_late(ticks: list[int], rises: list[int]) -> list[int]:
    assert len(rises) == len(ticks)
    return [rise - tick for tick, rise in zip(ticks, rises, strict=True)]


@pytest.mark.parametrize("pace", [700, 1000, 5250, 84_000, 900_000])
@pytest.mark.parametrize("options", [[], ODD, FAST_BUS])
def test_one_motor_is_half_a_microsecond_late_at_any_rate(make_acts, pace, options):
    acts: Acts = make_acts(NAME)
    ticks = acts.move_steady(1, READY + 30_000, pace, 60)
    acts.rest()

    shown = acts.show(*options)

    late = shown_late(ticks, shown.rises[1])
    assert min(late) >= 0
    assert max(late) <= ALONE
    assert sorted(late)[len(late) // 2] <= MEDIAN
    assert min(shown.widths) >= WIDTH
    assert shown.late == 0
    assert [len(shown.rises[m]) for m in MOTORS] == [0, 60, 0, 0]


@pytest.mark.parametrize("start", [0, (1 << 32) - READY - 60_000])
def test_four_motors_due_together_come_one_after_the_other(make_acts, start):
    acts: Acts = make_acts(NAME, start)
    acts.wait(READY)
    ticks = {motor: [READY + 40_000 + 1750 * i for i in range(25)] for motor in MOTORS}
    acts.move_each(ticks)
    acts.rest()

    shown = acts.show()

    late = [late for m in MOTORS for late in shown_late(ticks[m], shown.rises[m])]
    assert min(late) >= 0
    assert max(late) <= LATE_MAX
    assert min(shown.widths) >= WIDTH
    assert shown.least_gap >= WIDTH
    assert shown.late == 0


def test_a_pulse_laid_too_late_comes_at_once_whole_and_is_counted(make_acts):
    acts: Acts = make_acts(NAME)
    acts.wait(READY)
    acts.move(0, READY - 50_000, READY - 49_000, READY + 60_000)
    acts.rest()

    shown = acts.show()

    rises = shown.rises[0]
    assert len(rises) == 3
    assert rises[0] < READY + 20_000
    assert rises[1] - rises[0] >= 2 * WIDTH
    assert READY + 60_000 <= rises[2] <= READY + 60_000 + ALONE
    assert min(shown.widths) >= WIDTH
    assert shown.late == 2


@pytest.mark.parametrize("options", [[], ODD])
@pytest.mark.parametrize(
    "train",
    [
        Train(trials=6000, pace_ticks=5250, pulses=3, halt_ticks=16_000),
        Train(trials=1000, pace_ticks=1200, pulses=40, halt_ticks=40_000),
        Train(trials=400, pace_ticks=5250, pulses=20, halt_ticks=90_000, lead_ticks=16_000,
              together=4),
    ],
)  # fmt: skip
def test_pulses_that_are_taken_back_at_any_time_are_made_and_counted_or_neither(
    try_trains,
    train,
    options,
):
    tried = try_trains(NAME, train, *options)

    all_pulses = train.trials * train.pulses * train.together
    assert tried.counted == tried.shown
    assert tried.warnings == tried.late == 0
    assert all_pulses / 5 < sum(tried.counted) < all_pulses * 4 / 5
    assert tried.least_us("width_min") >= 2.5


@pytest.mark.parametrize("lead", [400, 1500])
def test_pulses_that_are_laid_just_in_time_or_late_are_whole_and_none_is_lost(
    try_trains,
    lead,
):
    train = Train(trials=1000, lead_ticks=lead, lead_varied=1000, pace_ticks=1000, pulses=4)
    tried = try_trains(NAME, train)

    assert tried.counted == tried.shown == [1000] * 4
    assert tried.least_us("width_min") >= 2.5
    assert tried.least_us("gap_min") >= 2.5


def test_dir_stands_still_after_the_last_pulse_and_before_the_next(make_acts):
    acts: Acts = make_acts(NAME)
    tick = READY + 10_000
    acts.move(0, tick)
    for number in range(1, 8):
        acts.rest(0)
        acts.begin(0, 0, backward=number % 2 != 0)
        acts.push(0, tick + 1 + number)
        acts.run(0)
    acts.rest()

    shown = acts.show()

    rises, turns = shown.rises[0], [at for at, _ in shown.directions[0]]
    assert len(rises) == 8
    assert len(turns) == 7
    for before, turn, after in zip(rises, turns, rises[1:], strict=False):
        assert turn - before >= HOLD_TICKS
        assert after - turn >= SETUP_TICKS


@pytest.mark.parametrize("crystal", [True, False])
def test_a_motor_without_its_pins_shows_nothing(make_acts, crystal):
    acts: Acts = make_acts(NAME)
    acts.wait(READY)
    if crystal:
        acts.add(What.CONNECT, 1, steps=0)
    acts.move(1, *[READY + 20_000 + 3000 * i for i in range(5)], backward=True)
    acts.rest()

    shown = acts.show(*([] if crystal else ["--no-crystal"]))

    assert shown.rises == shown.falls == [[], [], [], []]
    assert shown.directions == [[], [], [], []]
    assert shown.late == 0


RAMPS = {
    1: b"S500V16000A60000F3000RDRD",
    2: b"S2000V16000A60000F4000RDR",
    3: b"S100V12345A35000F2500RW3DR",
    4: b"S2000V16000A60000F4000RDR",
}


@pytest.fixture
def ramps(unit: VirtualBoard) -> tuple[Simulated, Modelled]:
    """Four motors at the highest rate, beside a line that is always busy and inputs that change."""
    sent = script(together(RAMPS))
    begin = sent.come_ms[-1]
    flood = "".join(ask(begin + 3 + 55 * i, b"\xc8") for i in range(20))
    inputs = "".join(f"{begin + 1 + 0.3 * i:.3f},{i % 8 + 1},{i // 8 % 2}\n" for i in range(3000))
    simulated = unit.simulate(RAMPS, 5)
    modelled = unit.run(sent.lines + flood, begin / 1000 + 1.6, inputs, "--watch", WORST)
    return simulated, modelled


def test_ramps_of_four_motors_have_the_simulators_pulses_within_the_class(ramps):
    simulated, modelled = ramps

    offsets = {
        motor: of_motor(modelled.steps, motor)[0] - of_motor(simulated.steps, motor)[0]
        for motor in RAMPS
    }
    least = min(int(each.min()) for each in offsets.values())
    latest = max(int(each.max()) for each in offsets.values()) - least
    assert latest <= TOGETHER
    assert 0 < modelled.summary["watch"][WORST] <= TOGETHER
    assert modelled.late_steps == 0
    for motor in RAMPS:
        assert list(of_motor(modelled.steps, motor)[1]) == list(of_motor(simulated.steps, motor)[1])


def test_storing_programs_while_motors_move_delays_no_edge(unit):
    lines = script([Message(1, b"S2000V12000A60000F30000R"), Message(2, b"S100V900F900R")]).lines
    stored = ask(READY_MS + 150, b"\x032")

    modelled = unit.run(lines + stored, 3.0, "", "--watch", WORST)

    assert modelled.summary["motors"][0]["pulses"] == 30_000
    assert modelled.late_steps == 0
    assert modelled.summary["watch"][WORST] <= TOGETHER


def test_a_start_by_a_loader_is_a_start_as_any_other(unit):
    lines = script([Message(1, b"F50R")]).lines
    plain = unit.run(lines, 0.8)

    left = unit.run(lines, 0.8, "", "--left-by-loader")

    assert left.summary["motors"][0]["pulses"] == plain.summary["motors"][0]["pulses"] == 50


def test_priorities_that_a_loader_has_put_into_groups_hold_no_edge_off(unit):
    program = b"S2000V12000A60000F4000R"
    lines = script([Message(motor, program) for motor in (1, 3, 4)]).lines

    left = unit.run(lines, 0.7, "", "--watch", WORST, "--left-by-loader")

    assert [left.summary["motors"][i]["pulses"] for i in (0, 2, 3)] == [4000, 4000, 4000]
    assert left.late_steps == 0
    assert left.summary["watch"][WORST] <= TOGETHER


def test_what_hangs_the_edges_ends_in_a_watchdog_reset(unit):
    lines = script([Message(1, b"S500V2000G+")]).lines
    hang = READY_MS + 100

    modelled = unit.run(
        lines, (hang + 1500) / 1000, "", "--fault", f"{hang}:hold=stm32_step_refill_interrupt"
    )

    assert modelled.summary["resets"]["watchdog"] == 1
    last = modelled.steps.tick.max() / TICKS_PER_MS
    assert last < hang + 60


@pytest.mark.parametrize(("motors", "pace"), [(1, 600), (4, 840)])
def test_the_highest_rates_of_the_page_are_made_without_a_late_pulse(make_acts, motors, pace):
    acts: Acts = make_acts(NAME)
    acts.wait(READY)
    ticks = {}
    for motor in range(motors):
        acts.begin(motor, READY + 59_000)
        ticks[motor] = acts.push_steady(motor, READY + 60_000, pace, 300)
    for motor in range(motors):
        acts.run(motor)
    acts.rest()

    shown = acts.show()

    late = [late for m in ticks for late in shown_late(ticks[m], shown.rises[m])]
    assert shown.late == 0
    assert 0 <= min(late) <= max(late) <= TOGETHER
    assert min(shown.widths) >= WIDTH
    assert shown.least_gap >= WIDTH


def test_more_than_the_class_can_do_is_counted_and_loses_no_pulse(make_acts):
    acts: Acts = make_acts(NAME)
    acts.wait(READY)
    for motor in MOTORS:
        acts.begin(motor, READY + 59_000)
        acts.push_steady(motor, READY + 60_000, 500, 60)
    for motor in MOTORS:
        acts.run(motor)
    acts.rest()

    shown = acts.show()

    assert [len(rises) for rises in shown.rises] == [60] * 4
    assert shown.late > 0
    assert min(shown.widths) >= WIDTH
    assert shown.least_gap >= WIDTH


def test_the_status_tells_the_class(unit):
    modelled = unit.run(ask(READY_MS, b"\xc8"), (READY_MS + 80) / 1000)

    (answer,) = heard(modelled.folder)
    assert parse_status(answer.message).untimed


def zigzag(acts: Acts, motor: int, tick: int, pieces: int, gap: int) -> list[int]:
    """Pieces of seven pulses, every other one backward, `gap` ticks apart; their ticks."""
    ticks: list[int] = []
    acts.begin(motor, tick - 1000)
    for number in range(pieces):
        acts.turn(motor, number % 2 != 0)
        ticks += acts.push_steady(motor, tick, 1750, 7)
        tick = ticks[-1] + gap
    return ticks


@pytest.mark.parametrize(("motors", "gap"), [(1, 18 * 84), (4, 42_000), (4, 900_000)])
def test_dir_turns_between_pulses_and_has_its_times(make_acts, motors, gap):
    acts: Acts = make_acts(NAME)
    ticks = [zigzag(acts, motor, READY + 60_000 + 437 * motor, 6, gap) for motor in range(motors)]
    for motor in range(motors):
        acts.run(motor)
    acts.rest()

    shown = acts.show()

    late = [late for m in range(motors) for late in shown_late(ticks[m], shown.rises[m])]
    assert 0 <= min(late) <= max(late) <= AFTER_TURN
    assert shown.positions == [0, 0, 0, 0]
    for motor in range(motors):
        assert len(shown.directions[motor]) == 5
        assert_turns(shown, motor)


@pytest.mark.parametrize("stays", [3, 7, 9])
def test_what_is_recalled_over_a_turn_gives_way_to_what_comes_instead(make_acts, stays):
    acts: Acts = make_acts(NAME)
    tick = READY + 60_000
    acts.wait(READY)
    ticks = zigzag(acts, 2, tick, 2, 3000)
    acts.run(2)
    acts.wait(ticks[stays - 1] - 20_000)
    acts.freeze(2, 14 - stays)
    new = acts.recall(2, ticks[stays - 1] + 3000, 3000, 4)
    acts.rest()

    shown = acts.show()

    late = shown_late(ticks[:stays] + new, shown.rises[2])
    assert 0 <= min(late) <= max(late) <= LATE_MAX
    assert shown.positions[2] == min(stays, 7) - max(stays - 7, 0) + 4
    assert_turns(shown, 2)
