"""Blocks that wait for each other, begin anew, or whose unit has gone away."""

from __future__ import annotations

from plc_moves import GO, INIT, LOCKED, MODE, NOT_ONLINE, OUT_OF_RANGE, feed, finish, moving


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
    finish(plc, reset)
    finish(plc, stop)
    assert (reset["Done"], stop["Done"]) == (True, True)
    assert plc.unit.axes[0].executed == [INIT, MODE, INIT]


def test_reset_does_not_take_the_axis_while_stop_holds_it(plc) -> None:
    moving(plc, Acceleration=50.0)
    plc.run(60)
    plc.unit.axes[0].fault(7)
    plc.run(5)
    reset = plc.start("MC_Reset")
    stop = plc.start("MC_Stop")
    plc.until(lambda: stop["Done"])
    plc.unit.axes[0].fault(7)
    again = plc.start("MC_Reset")
    plc.run(1)
    assert (reset["Done"], again["ErrorID"]) == (True, LOCKED)


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
