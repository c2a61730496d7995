"""The library and the unit's firmware together, through the frames of the line, in virtual time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from chance import SEED
from plc_cycle import Line, Plc
from real_positioning import RealUnit
from st_program import Blocks

GO: dict[str, Any] = {"Velocity": 80.0, "Acceleration": 2000.0}
STEP_UM = 10  # as delivered
FEED = 3000 << 16  # 50 mm/s
LINES = {
    "good": Line(delay=1),
    "jitter": Line(delay=1, jitter=9, spread=5),
    "lossy": Line(delay=1, jitter=5, lost_requests=0.2, lost_answers=0.2, patience=5000),
    "FC 16 and FC 3": Line(delay=1, split=True),
}


@pytest.fixture
def unit() -> Iterator[RealUnit]:
    made = RealUnit()
    yield made
    made.close()


@pytest.fixture(params=LINES)
def plc(request: pytest.FixtureRequest, unit: RealUnit, plc_blocks: Blocks) -> Plc:
    made = Plc(plc_blocks, unit, LINES[request.param], seed=SEED)
    made.until(lambda: made.axes[0]["Online"])
    return made


@pytest.fixture
def good(unit: RealUnit, plc_blocks: Blocks) -> Plc:
    """A PLC on a good line, whose axis 1 has power."""
    made = Plc(plc_blocks, unit, LINES["good"])
    made.power()
    return made


def finish(plc: Plc, *names: str, **inputs: Any) -> None:
    """One command after the other, each to its end."""
    for name in names:
        block = plc.start(name, **inputs)
        plc.until(lambda: not block["Busy"])  # noqa: B023
        assert block["Done"], (name, block["ErrorID"])


def rests(unit: RealUnit) -> Callable[[], bool]:
    """Whether no pulse has come since the last time that this was asked."""
    before = [-1]

    def ask() -> bool:
        pulses, before[0] = before[0], unit.pulses
        return pulses == unit.pulses

    return ask


def test_moves_are_made_once_and_exactly(plc) -> None:
    plc.power()
    for _ in range(5):
        finish(plc, "MC_MoveRelative", Distance=1.5, **GO)
        finish(plc, "MC_MoveRelative", Distance=-0.5, **GO)
    finish(plc, "MC_MoveAbsolute", Position=2.0, **GO)
    assert plc.unit.positions == [200, 0, 0, 0]
    assert plc.unit.pulses == 5 * (150 + 50) + 300


@pytest.mark.parametrize("draha", [10000, -2500])
def test_the_first_example_arrives_exactly(draha, plc) -> None:
    program = plc.add(
        "EXAMPLE_1", AXIS_4=plc.axes[3], POSUN=True, POV_I=True,
        zelana_draha=draha, zelana_strmost=500, zelana_rychlost=FEED,
    )  # fmt: skip
    plc.run(1)
    plc.until(lambda: not program["POSUN"])
    assert plc.unit.positions == [0, 0, 0, draha // STEP_UM]
    assert plc.unit.pulses == abs(draha) // STEP_UM


def test_the_second_example_stands_when_the_button_is_let_go(plc) -> None:
    program = plc.add("EXAMPLE_2", AXIS_X=plc.axes[0], ZRYCH_X=500, aktualni_rychlost=FEED)
    program["LIMIT_C"] = True
    plc.until(lambda: plc.unit.positions[0] > 1000)
    program["LIMIT_C"] = False
    plc.until(lambda: not program["MECH_POHYB_X"])
    stood = list(plc.unit.positions)
    plc.run(50)
    assert plc.unit.positions == stood
    assert plc.unit.pulses == stood[0]


def test_a_move_may_be_overtaken_halted_and_scaled(good) -> None:
    plc = good
    first = plc.start("MC_MoveRelative", Distance=1000.0, **GO)
    plc.until(lambda: plc.unit.positions[0] > 500)
    second = plc.start("MC_MoveAbsolute", Position=-3.0, **GO)
    plc.run(1)
    assert first["CommandAborted"]
    override = plc.add("MC_SetOverride", Enable=True, VelFactor=0.0)
    plc.run(50)
    plc.until(rests(plc.unit))
    assert second["Busy"]
    override["VelFactor"] = 2.0
    plc.until(lambda: second["Done"])
    assert plc.unit.positions[0] == -300
    third = plc.start("MC_MoveRelative", Distance=1000.0, **GO)
    plc.run(30)
    finish(plc, "MC_Halt")
    assert third["CommandAborted"]
    stood = plc.unit.pulses
    plc.run(30)
    assert plc.unit.pulses == stood


def test_homing_the_state_and_the_position(good) -> None:
    plc, reference = good, 3
    power = plc.called[0]
    position = plc.add("MC_ReadActualPosition", Enable=True)
    status = plc.add("MC_ReadStatus", Enable=True)
    power["Enable"] = False
    plc.until(lambda: not power["Busy"])
    plc.cut = True
    plc.run(20)
    plc.unit.write(148, reference)
    plc.cut = False
    power["Enable"] = True
    plc.until(lambda: power["Status"])
    plc.unit.set_input(reference, 0)
    home = plc.start("MC_Home", Position=7.0, Acceleration=500.0, HomingMethod=19)
    plc.until(lambda: status["Homing"])
    plc.until(lambda: plc.unit.positions[0] > 200)
    plc.unit.set_input(reference, 1)
    plc.run(60)
    plc.unit.set_input(reference, 0)
    plc.until(lambda: not home["Busy"])
    assert home["Done"], home["ErrorID"]
    assert (position["Position"], status["Standstill"]) == (7.0, True)
    finish(plc, "MC_SetPosition", Position=-1.0)
    plc.run(5)
    assert position["Position"] == -1.0


def test_refusals_of_the_unit_come_through(good) -> None:
    plc = good
    refusals: list[tuple[str, dict[str, Any], int]] = [
        ("POS_INIT", {"Space": 7}, 2),
        ("POS_MODE", {"Way": 1, "Accel": 0}, 6),
        ("POS_MODE", {"Way": -(2**31), "Accel": 1}, 5),
        ("MC_TouchProbe", {}, 12),
        ("MC_Home", {"Position": 0.0, "Acceleration": 1.0}, 12),
    ]
    for name, inputs, number in refusals:
        block = plc.start(name, **inputs)
        plc.until(lambda: not block["Busy"])  # noqa: B023
        assert (block["Error"], block["ErrorID"]) == (True, number), name
    finish(plc, "MC_Reset")
    finish(plc, "MC_MoveRelative", Distance=1.0, **GO)


def test_a_unit_that_restarts_under_way_moves_nothing_until_power_is_given_again(good) -> None:
    plc = good
    move = plc.start("MC_MoveRelative", Distance=1000.0, **GO)
    plc.until(lambda: plc.unit.positions[0] > 500)
    plc.unit.restart()
    stood = plc.unit.pulses
    plc.until(lambda: not move["Busy"])
    plc.run(100)
    assert (move["Error"], move["ErrorID"]) == (True, 3)
    finish(plc, "MC_Reset")
    refused = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    plc.until(lambda: not refused["Busy"])
    assert (refused["ErrorID"], plc.unit.pulses) == (3, stood)
    power = plc.called[0]
    assert not power["Status"]
    power["Enable"] = False
    plc.run(5)
    power["Enable"] = True
    plc.until(lambda: power["Status"])
    finish(plc, "MC_MoveRelative", Distance=1.0, **GO)
    assert plc.unit.pulses == stood + 100
