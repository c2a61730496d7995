"""Lost requests, a cut line, restarts: nothing is done twice, nothing moves by itself."""

from __future__ import annotations

import random
from typing import Any

import pytest
from chance import SEED
from fake_positioning import CODES, FakeUnit
from plc_cycle import Line, Plc
from st_program import Instance

GO: dict[str, Any] = {"Velocity": 50.0, "Acceleration": 500.0}
INIT, MODE = CODES["POS_INIT"], CODES["POS_MODE"]
NOT_ONLINE, NO_DISP = 0x8001, 3
LINES: dict[str, dict[str, Any]] = {
    "good": {},
    "jitter": {"jitter": 9, "spread": 20},
    "slow PLC": {"cycle": 100, "jitter": 50},
    "quick PLC": {"cycle": 1},
    "lossy": {
        "jitter": 5,
        "spread": 20,
        "lost_requests": 0.2,
        "lost_answers": 0.2,
        "patience": 5000,
    },
    "FC 16 and FC 3": {"split": True, "jitter": 5},
    "FC 16 and FC 3, lossy": {
        "split": True,
        "lost_requests": 0.2,
        "lost_answers": 0.2,
        "patience": 5000,
    },
}


@pytest.fixture(params=LINES)
def line_plc(request, make_plc) -> Plc:
    made: Plc = make_plc(seed=SEED, **LINES[request.param])
    made.power()
    return made


def test_every_move_is_made_once_whatever_the_line_loses(line_plc) -> None:
    plc = line_plc
    move = plc.add("MC_MoveRelative", Distance=0.1, **GO)
    for _ in range(30):
        move["Execute"] = True
        plc.until(lambda: not move["Busy"])
        assert move["Done"]
        move["Execute"] = False
        plc.run(1)
    assert plc.unit.axes[0].position == pytest.approx(3000)
    assert plc.unit.axes[0].executed == [INIT] + [MODE] * 30


def test_more_instructions_than_numbers_are_each_executed_once(plc) -> None:
    init = plc.add("POS_INIT")
    for _ in range(300):
        init["Execute"] = True
        plc.until(lambda: init["Done"])
        init["Execute"] = False
        plc.run(1)
    assert plc.unit.axes[0].executed == [INIT] * 301


def test_a_plc_that_starts_again_sends_0_first_and_repeats_nothing(make_plc) -> None:
    plc = make_plc()
    plc.power()
    plc.start("MC_MoveRelative", Distance=100.0, **GO)
    plc.until(lambda: plc.unit.axes[0].has("JEDE"))
    done = plc.unit.axes[0].done
    plc.restart()
    plc.run(30)
    assert done != 0
    assert plc.unit.axes[0].done == 0
    assert not plc.unit.axes[0].has("JEDE")
    made = plc.unit.axes[0].way_made
    plc.run(30)
    assert plc.unit.axes[0].way_made == made
    plc.power()
    move = plc.start("MC_MoveAbsolute", Position=0.0, **GO)
    plc.until(lambda: move["Done"])
    assert plc.unit.axes[0].position == 0


def test_a_plc_that_starts_with_the_number_that_the_unit_has_still_gives_its_instruction(
    make_plc,
) -> None:
    plc = make_plc()
    plc.unit.axes[0].done = 1 << 8 | INIT
    plc.power()
    assert plc.unit.axes[0].executed == [INIT]


def test_a_unit_that_restarts_moves_nothing_and_the_move_ends_with_an_error(plc) -> None:
    power = plc.called[0]
    move = plc.start("MC_MoveRelative", Distance=100.0, **GO)
    plc.until(lambda: plc.unit.axes[0].has("JEDE"))
    plc.run(10)
    made = plc.unit.axes[0].way_made
    plc.unit.restart()
    plc.until(lambda: not move["Busy"])
    assert (move["Error"], move["ErrorID"]) == (True, NO_DISP)
    plc.run(100)
    assert plc.unit.axes[0].way_made == made
    assert plc.unit.axes[0].executed == []
    assert not power["Status"]


@pytest.mark.parametrize("cycle", range(12))
def test_a_unit_that_restarts_at_any_cycle_of_a_start_moves_nothing_by_itself(
    cycle, make_plc
) -> None:
    """Until MC_Power and the move are begun again."""
    plc = make_plc()
    power = plc.power()
    plc.run(5)
    move = plc.start("MC_MoveRelative", Distance=100.0, **GO)
    plc.run(cycle)
    plc.unit.restart()
    made = plc.unit.axes[0].way_made
    plc.run(3)
    allowed = plc.unit.axes[0].executed
    plc.run(100)
    assert plc.unit.axes[0].way_made == made
    assert plc.unit.axes[0].executed == allowed
    assert not plc.unit.axes[0].has("DISP")
    assert (move["Error"], power["Status"]) == (True, False)


def test_a_line_that_is_cut_ends_a_move_with_an_error_and_takes_its_instruction_back(plc) -> None:
    plc.run(5)
    plc.cut = True
    move = plc.start("MC_MoveRelative", Distance=100.0, **GO)
    plc.until(lambda: not move["Busy"])
    assert (move["Error"], move["ErrorID"]) == (True, NOT_ONLINE)
    plc.cut = False
    plc.run(100)
    assert plc.unit.axes[0].executed == [INIT]
    assert plc.unit.axes[0].way_made == 0


def test_an_instruction_is_taken_back_even_if_its_block_has_lost_the_axis(plc) -> None:
    plc.run(5)
    plc.cut = True
    move = plc.start("MC_MoveRelative", Distance=100.0, **GO)
    halt = plc.start("MC_Halt")
    plc.until(lambda: not halt["Busy"])
    assert (move["CommandAborted"], halt["ErrorID"]) == (True, NOT_ONLINE)
    plc.cut = False
    plc.run(100)
    assert plc.unit.axes[0].executed == [INIT]


def test_an_axis_under_way_is_held_when_the_line_is_back(plc) -> None:
    move = plc.start("MC_MoveRelative", Distance=1000.0, **GO)
    plc.until(lambda: plc.unit.axes[0].has("JEDE"))
    plc.cut = True
    plc.until(lambda: not move["Busy"])
    assert move["ErrorID"] == NOT_ONLINE
    assert plc.unit.axes[0].has("JEDE")
    plc.cut = False
    plc.until(lambda: not plc.unit.axes[0].has("JEDE"))
    held = plc.unit.axes[0].position
    plc.run(50)
    assert plc.unit.axes[0].position == held < 1000000
    halt = plc.start("MC_Halt")
    plc.until(lambda: halt["Done"])


def test_random_orders_on_a_bad_line_keep_every_rule(plc_blocks) -> None:
    """Edges at random; the PLC checks the outputs in every call, and these laws hold after it."""
    for session in range(6):
        chance = random.Random(f"{SEED} {session}")
        line = Line(
            cycle=chance.choice([1, 5, 10, 50]), jitter=chance.choice([0, 8]), spread=15,
            lost_requests=chance.choice([0, 0.1, 0.4]), lost_answers=chance.choice([0, 0.1, 0.4]),
            split=chance.random() < 0.3, patience=5000,
        )  # fmt: skip
        plc = Plc(plc_blocks, FakeUnit(), line, seed=session)
        plc.power()
        names = [
            "MC_MoveRelative", "MC_MoveAbsolute", "MC_Halt", "MC_Stop", "MC_Home",
            "MC_SetPosition", "MC_TouchProbe", "MC_Reset",
        ]  # fmt: skip
        blocks = [plc.add(name) for name in names]
        for block in blocks[:2]:
            block["Velocity"], block["Acceleration"] = 50.0, 500.0
        blocks[4]["Acceleration"] = 100.0
        for _ in range(80):
            block = chance.choice(blocks)
            if "DISTANCE" in block.types:
                block["Distance"] = chance.randint(-9, 9) / 4
            elif "POSITION" in block.types:
                block["Position"] = chance.randint(-9, 9) / 4
            block["Execute"] = not block["Execute"]
            plc.run(chance.choice([1, 1, 2, 5, 30]))
            if chance.random() < 0.05:
                plc.unit.axes[0].fault(chance.choice([7, 8, 10, 11]))
            plc.unit.axes[0].capture()
        settle(plc, blocks)


def settle(plc: Plc, blocks: list[Instance]) -> None:
    """All commands come to an end, and then nothing moves, nothing is held and a move is made."""
    for block in blocks:
        block["Execute"] = False
    late = plc.now + 10000
    while any(block["Busy"] for block in blocks) and plc.now < late:
        plc.run(1)
        plc.unit.axes[0].capture()
    assert not any(block["Busy"] for block in blocks)
    plc.until(lambda: not plc.unit.axes[0].has("JEDE"))
    told = plc.now + 1000
    plc.until(lambda: plc.now > told)
    assert plc.axes[0]["Lock"] == 0
    reset = plc.start("MC_Reset")
    plc.until(lambda: not reset["Busy"])
    move = plc.start("MC_MoveAbsolute", Position=5.0, **GO)
    plc.until(lambda: not move["Busy"])
    assert move["Done"], hex(move["ErrorID"])
    assert plc.unit.axes[0].position == pytest.approx(5000)
