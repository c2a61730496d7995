"""Blocks that wait for each other, begin anew, or whose unit has gone away."""

from __future__ import annotations

import pytest
from plc_cycle import Plc
from plc_moves import GO, INIT, LOCKED, MODE, NOT_ONLINE, OUT_OF_RANGE, feed, finish, moving

FAULT_STANDS = 15


def test_a_move_that_is_over_asks_for_no_feed(plc) -> None:
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    plc.until(lambda: feed(plc.axes[0]) > 0)
    finish(plc, move)
    assert feed(plc.axes[0]) == 0


def test_a_move_that_begins_anew_with_a_bad_input_is_held(plc) -> None:
    move = moving(plc)
    move["Execute"] = False
    plc.run(1)
    move["Execute"], move["Velocity"] = True, -1.0
    plc.run(1)
    finish(plc, move)
    assert move["ErrorID"] == OUT_OF_RANGE
    plc.until(lambda: not plc.unit.axes[0].has("JEDE"))
    assert plc.unit.axes[0].position < 100000


def test_reset_leaves_the_axis_to_a_stop_that_comes_while_it_waits(plc) -> None:
    moving(plc, Acceleration=50.0)
    plc.run(60)
    plc.unit.axes[0].fault(7)
    plc.run(5)
    reset = plc.start("MC_Reset")
    plc.run(1)
    assert reset["Busy"]
    stop = plc.start("MC_Stop")
    finish(plc, stop)
    assert (reset["Busy"], stop["Done"]) == (True, True)
    assert plc.unit.axes[0].executed == [INIT, MODE]
    stop["Execute"] = False
    finish(plc, reset)
    assert reset["Done"]
    assert plc.unit.axes[0].executed == [INIT, MODE, INIT]


def test_reset_does_not_take_the_axis_while_stop_holds_it(plc) -> None:
    moving(plc, Acceleration=50.0)
    plc.run(60)
    plc.unit.axes[0].fault(7)
    plc.run(5)
    reset = plc.start("MC_Reset")
    stop = plc.start("MC_Stop")
    plc.until(lambda: stop["Done"])
    again = plc.start("MC_Reset")
    plc.run(50)
    assert (reset["Busy"], again["ErrorID"]) == (True, LOCKED)
    assert plc.unit.axes[0].executed == [INIT, MODE]


@pytest.mark.parametrize("name", ["MC_Halt", "MC_Stop"])
def test_a_stop_sees_the_axis_stand_after_a_fault_and_leaves_the_fault_to_reset(name, plc) -> None:
    status = plc.add("MC_ReadStatus", Enable=True)
    finish_with_fault(plc)
    assert plc.unit.axes[0].has("JEDE")
    stop = plc.start(name)
    finish(plc, stop)
    assert (stop["Done"], plc.unit.axes[0].has("JEDE")) == (True, False)
    stop["Execute"] = False
    plc.run(10)
    assert status["ErrorStop"]
    refused = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, refused)
    assert refused["ErrorID"] == FAULT_STANDS
    reset = plc.start("MC_Reset")
    finish(plc, reset)
    assert (reset["Done"], status["ErrorStop"]) == (True, False)


def finish_with_fault(plc: Plc) -> None:
    """A move that is ended by a fault, and brakes yet."""
    move = moving(plc, Acceleration=50.0)
    plc.run(60)
    plc.unit.axes[0].fault(7)
    finish(plc, move)


def test_reset_waits_until_the_axis_stands(plc) -> None:
    moving(plc, Acceleration=50.0)
    plc.run(60)
    plc.unit.axes[0].fault(7)
    plc.run(5)
    reset = plc.start("MC_Reset")
    plc.until(lambda: not plc.unit.axes[0].has("JEDE"))
    assert plc.unit.axes[0].executed == [INIT, MODE]
    finish(plc, reset)
    assert plc.unit.axes[0].executed == [INIT, MODE, INIT]


def test_stop_holds_the_axis_even_when_it_is_not_online(plc) -> None:
    plc.cut = True
    plc.until(lambda: not plc.axes[0]["Online"])
    stop = plc.start("MC_Stop")
    plc.run(1)
    assert stop["ErrorID"] == NOT_ONLINE
    plc.cut = False
    plc.until(lambda: plc.axes[0]["Online"])
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert move["ErrorID"] == LOCKED
    stop["Execute"] = False
    plc.run(1)
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert move["Done"]


def test_a_probe_whose_unit_has_restarted_is_aborted(plc) -> None:
    plc.unit.axes[0].captures = 7
    probe = plc.start("MC_TouchProbe")
    plc.run(10)
    plc.unit.restart()
    finish(plc, probe)
    assert probe["CommandAborted"]
