"""What each block does on a line that loses nothing."""

from __future__ import annotations

import math

import pytest
from plc_moves import (
    GO,
    HOME,
    INIT,
    LOCKED,
    MODE,
    MODE_ABS,
    NOT_ONLINE,
    OUT_OF_RANGE,
    PREEMPTED,
    RESET,
    feed,
    finish,
    moving,
)
from st_program import Instance


def test_a_rising_edge_takes_the_inputs_and_sets_busy_in_the_same_call(plc) -> None:
    move = plc.start("MC_MoveRelative", Distance=7.0, **GO)
    assert move["Busy"]
    move["Distance"] = 99.0
    finish(plc, move)
    assert move["Done"]
    assert plc.unit.axes[0].position == 7000


def test_done_stays_until_execute_falls(plc) -> None:
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    plc.run(10)
    assert move["Done"]
    move["Execute"] = False
    plc.run(1)
    assert not move["Done"]


def test_a_falling_edge_before_the_end_stops_nothing_and_done_is_true_for_one_call(plc) -> None:
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    move["Execute"] = False
    finish(plc, move)
    assert move["Done"]
    assert plc.unit.axes[0].position == 1000
    plc.run(1)
    assert not move["Done"]


def test_a_rising_edge_while_busy_begins_anew(plc) -> None:
    move = moving(plc)
    move["Execute"] = False
    plc.run(1)
    move.call(Execute=True, Distance=-3.0)
    before = plc.unit.axes[0].position
    assert 0 < before < 100000
    finish(plc, move)
    assert move["Done"]
    assert plc.unit.axes[0].executed == [INIT, MODE, INIT, MODE]
    assert before - 3000 < plc.unit.axes[0].position < 100000


def test_an_absolute_move_goes_to_its_position(plc) -> None:
    for position in (12.5, -3.25, -3.25):
        move = plc.start("MC_MoveAbsolute", Position=position, **GO)
        finish(plc, move)
        assert move["Done"]
        assert plc.unit.axes[0].position == position * 1000


def test_moves_one_after_the_other_need_no_stop_between(plc) -> None:
    for _ in range(3):
        finish(plc, plc.start("MC_MoveRelative", Distance=1.0, **GO))
    assert plc.unit.axes[0].executed == [INIT, MODE, MODE, MODE]


def test_a_move_that_overtakes_another_aborts_it_and_starts_from_a_stand(plc) -> None:
    first = moving(plc)
    second = plc.start("MC_MoveAbsolute", Position=0.0, **GO)
    plc.run(1)
    assert first["CommandAborted"]
    assert not first["Busy"]
    finish(plc, second)
    assert second["Done"]
    assert plc.unit.axes[0].position == 0
    assert plc.unit.axes[0].executed == [INIT, MODE, INIT, MODE_ABS]


def test_halt_stops_a_move_and_is_done_when_the_axis_stands(plc) -> None:
    move = moving(plc)
    halt = plc.start("MC_Halt")
    plc.run(1)
    assert (move["CommandAborted"], halt["Busy"]) == (True, True)
    finish(plc, halt)
    assert halt["Done"]
    assert not plc.unit.axes[0].has("JEDE")
    assert plc.unit.axes[0].position < 100000


def test_a_move_may_overtake_halt(plc) -> None:
    moving(plc)
    halt = plc.start("MC_Halt")
    move = plc.start("MC_MoveAbsolute", Position=1.0, **GO)
    plc.run(1)
    assert halt["CommandAborted"]
    finish(plc, move)
    assert plc.unit.axes[0].position == 1000


def test_stop_locks_until_it_stands_and_execute_is_false(plc) -> None:
    moving(plc)
    stop = plc.start("MC_Stop")
    for name, inputs in [("MC_MoveRelative", {"Distance": 1.0, **GO}), ("MC_Halt", {})]:
        refused = plc.start(name, **inputs)
        plc.run(1)
        assert (refused["Error"], refused["ErrorID"]) == (True, LOCKED)
    assert stop["Busy"]
    finish(plc, stop)
    refused = plc.start("POS_MODE", Way=1000, Accel=500)
    plc.run(1)
    assert (stop["Done"], refused["ErrorID"]) == (True, LOCKED)
    stop["Execute"] = False
    plc.run(1)
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert move["Done"]


def test_stop_that_loses_execute_early_locks_until_it_stands(plc) -> None:
    moving(plc, Acceleration=50.0)
    stop = plc.start("MC_Stop")
    stop["Execute"] = False
    refused = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    plc.run(1)
    assert refused["ErrorID"] == LOCKED
    finish(plc, stop)
    assert stop["Done"]
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert move["Done"]


def test_power_off_is_possible_while_stop_holds_the_axis(plc) -> None:
    power = plc.called[0]
    moving(plc)
    stop = plc.start("MC_Stop")
    power["Enable"] = False
    plc.until(lambda: not power["Busy"])
    assert not power["Status"]
    assert stop["CommandAborted"]
    assert plc.unit.axes[0].executed[-1] == RESET


@pytest.mark.parametrize("name", ["MC_Halt", "MC_Stop", "MC_Reset"])
def test_no_block_but_power_gives_power(name, make_plc) -> None:
    plc = make_plc()
    power = plc.add("MC_Power")
    plc.run(10)
    finish(plc, plc.start("MC_MoveRelative", Distance=1.0, **GO))
    block = plc.start(name)
    finish(plc, block)
    assert (block["Done"], plc.unit.axes[0].has("ERR")) == (True, False)
    block["Execute"] = False
    plc.run(10)
    assert not power["Status"]
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert move["ErrorID"] == 3
    assert plc.unit.axes[0].way_made == 0


def test_power_that_falls_with_a_stop_stays_off(plc) -> None:
    power = plc.called[0]
    moving(plc)
    power["Enable"] = False
    finish(plc, plc.start("MC_Stop"))
    plc.run(50)
    assert (power["Status"], power["Busy"]) == (False, False)
    assert not plc.unit.axes[0].has("JEDE")


def test_power_that_rises_while_stop_holds_the_axis_comes_when_it_is_let_go(make_plc) -> None:
    plc = make_plc()
    power = plc.add("MC_Power")
    plc.run(10)
    stop = plc.start("MC_Stop")
    power["Enable"] = True
    plc.run(50)
    assert (power["Busy"], power["Error"], power["Status"]) == (True, False, False)
    stop["Execute"] = False
    plc.until(lambda: power["Status"])
    assert plc.unit.axes[0].executed == [RESET, INIT]


def test_power_gives_its_instructions_at_the_edges_only(plc) -> None:
    power = plc.called[0]
    plc.run(50)
    assert plc.unit.axes[0].executed == [INIT]
    power["Enable"] = False
    plc.until(lambda: not power["Busy"])
    plc.run(50)
    assert plc.unit.axes[0].executed == [INIT, RESET]
    assert not plc.unit.axes[0].has("DISP")


def test_power_that_falls_without_a_line_resets_when_it_is_back(plc) -> None:
    power = plc.called[0]
    plc.cut = True
    plc.until(lambda: not plc.axes[0]["Online"])
    power["Enable"] = False
    plc.run(20)
    assert (power["Busy"], power["Status"]) == (True, False)
    plc.cut = False
    plc.until(lambda: not power["Busy"])
    assert plc.unit.axes[0].executed == [INIT, RESET]


def test_a_move_without_power_is_refused_with_the_number_of_the_unit(make_plc) -> None:
    plc = make_plc()
    plc.run(10)
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert (move["Error"], move["ErrorID"]) == (True, 3)
    assert plc.unit.axes[0].way_made == 0


@pytest.mark.parametrize("name", ["POS_INIT", "POS_RESET", "MC_Halt", "MC_Stop", "MC_TouchProbe"])
def test_a_block_that_is_not_online_says_so(name, make_plc) -> None:
    plc = make_plc()
    plc.cut = True
    block = plc.start(name)
    assert block["Busy"]
    plc.run(1)
    assert (block["Error"], block["ErrorID"]) == (True, NOT_ONLINE)
    plc.cut = False
    plc.run(30)
    assert plc.unit.axes[0].executed == []


@pytest.mark.parametrize(
    "inputs",
    [
        {"Distance": 2147483.648}, {"Distance": -2147483.648}, {"Distance": math.nan},
        {"Velocity": 0.0}, {"Velocity": -1.0}, {"Velocity": 1093.0}, {"Velocity": math.inf},
        {"Acceleration": 0.9}, {"Acceleration": 65535.1}, {"Acceleration": math.nan},
    ],
)  # fmt: skip
def test_an_input_out_of_its_range_is_refused_and_disturbs_nothing(inputs, plc) -> None:
    move = moving(plc)
    bad = plc.start("MC_MoveRelative", **{"Distance": 1.0, **GO, **inputs})
    plc.run(1)
    assert (bad["Error"], bad["ErrorID"]) == (True, OUT_OF_RANGE)
    assert move["Busy"]
    finish(plc, move)
    assert move["Done"]
    assert plc.unit.axes[0].position == 100000


@pytest.mark.parametrize(
    "inputs",
    [
        {"Distance": 2147483.647}, {"Distance": -2147483.647}, {"Velocity": 1092.26},
        {"Velocity": 1e-9}, {"Acceleration": 1.0}, {"Acceleration": 65535.0},
    ],
)  # fmt: skip
def test_an_input_at_its_limit_is_taken(inputs, plc) -> None:
    move = plc.start("MC_MoveRelative", **{"Distance": 1.0, **GO, **inputs})
    plc.until(lambda: feed(plc.axes[0]) > 0, cycles=5)
    plc.run(10)
    assert not move["Error"]
    assert plc.unit.axes[0].executed == [INIT, MODE]


@pytest.mark.parametrize("method", [19, 21])
def test_homing_is_done_at_the_reference_and_stops_what_moves(method, plc) -> None:
    move = moving(plc)
    home = plc.start("MC_Home", Position=5.0, Acceleration=100.0, HomingMethod=method)
    plc.run(1)
    assert move["CommandAborted"]
    finish(plc, home)
    assert home["Done"]
    assert plc.unit.axes[0].written[1] == method
    assert (plc.unit.axes[0].position, plc.unit.axes[0].referenced) == (5000, True)
    assert plc.unit.axes[0].executed == [INIT, MODE, INIT, HOME]


def test_homing_by_another_method_is_refused(plc) -> None:
    home = plc.start("MC_Home", Position=5.0, Acceleration=100.0, HomingMethod=37)
    plc.run(1)
    assert home["ErrorID"] == OUT_OF_RANGE


def test_set_position_moves_nothing(plc) -> None:
    block = plc.start("MC_SetPosition", Position=-7.5)
    finish(plc, block)
    assert block["Done"]
    assert (plc.unit.axes[0].position, plc.unit.axes[0].way_made) == (-7500, 0)


def test_a_probe_is_done_at_the_edge_and_leaves_the_move_alone(plc) -> None:
    move = moving(plc)
    probe = plc.start("MC_TouchProbe")
    plc.run(10)
    assert (probe["Busy"], move["Busy"]) == (True, True)
    plc.unit.axes[0].capture()
    at = int(plc.unit.axes[0].position) / 1000
    finish(plc, probe)
    assert probe["Done"]
    assert probe["RecordedPosition"] == at
    finish(plc, move)
    assert move["Done"]
    assert probe["RecordedPosition"] == at


def test_a_second_probe_aborts_the_first(plc) -> None:
    first = plc.start("MC_TouchProbe")
    second = plc.start("MC_TouchProbe")
    plc.run(1)
    assert (first["CommandAborted"], second["Busy"]) == (True, True)


def test_the_count_of_captures_may_turn_over(plc) -> None:
    plc.unit.axes[0].captures = 65535
    plc.run(5)
    probe = plc.start("MC_TouchProbe")
    plc.run(10)
    plc.unit.axes[0].capture()
    finish(plc, probe)
    assert probe["Done"]


def test_the_override_scales_a_move_under_way_and_0_holds_it(plc) -> None:
    move = moving(plc)
    override = plc.add("MC_SetOverride", Enable=True, VelFactor=0.5)
    plc.run(20)
    assert override["Enabled"]
    assert plc.unit.axes[0].speed == pytest.approx(25.0, abs=0.01)
    override["VelFactor"] = 0.0
    plc.until(lambda: not plc.unit.axes[0].has("JEDE"))
    held = plc.unit.axes[0].position
    plc.run(20)
    assert (plc.unit.axes[0].position, move["Busy"]) == (held, True)
    override["VelFactor"] = 2.0
    finish(plc, move)
    assert move["Done"]
    assert plc.unit.axes[0].position == 100000


@pytest.mark.parametrize("factor", [-0.1, 2.01, math.nan])
def test_an_override_out_of_its_range_changes_nothing(factor, plc) -> None:
    override = plc.add("MC_SetOverride", Enable=True, VelFactor=factor)
    plc.run(1)
    assert (override["Enabled"], override["ErrorID"]) == (False, OUT_OF_RANGE)
    assert plc.axes[0]["Override"] == 1.0


def test_no_override_asks_for_more_than_the_highest_feed(plc) -> None:
    plc.add("MC_SetOverride", Enable=True, VelFactor=2.0)
    plc.start("MC_MoveRelative", Distance=1.0, Velocity=1000.0, Acceleration=1.0)
    plc.run(5)
    assert feed(plc.axes[0]) == 0xFFFFFFFF


@pytest.mark.parametrize("number", [7, 8, 10, 11])
def test_a_fault_ends_a_move_with_its_number_and_reset_clears_it(number, plc) -> None:
    move = moving(plc)
    error = plc.add("MC_ReadAxisError", Enable=True)
    plc.unit.axes[0].fault(number)
    finish(plc, move)
    assert (move["Error"], move["ErrorID"]) == (True, number)
    plc.until(lambda: error["AxisErrorID"] == number)
    again = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, again)
    assert again["ErrorID"] in (4, 15)
    reset = plc.start("MC_Reset")
    finish(plc, reset)
    assert reset["Done"]
    assert (error["AxisErrorID"], plc.unit.axes[0].has("JEDE")) == (0, False)


def test_reset_without_an_error_is_done_and_disturbs_no_move(plc) -> None:
    move = moving(plc)
    reset = plc.start("MC_Reset")
    plc.run(1)
    assert (reset["Done"], move["Busy"]) == (True, True)
    assert plc.unit.axes[0].executed == [INIT, MODE]


def test_an_old_refusal_does_not_fail_a_good_move(plc) -> None:
    refused = plc.start("POS_MODE", Way=1, Accel=0)
    finish(plc, refused)
    assert refused["ErrorID"] == 6
    move = plc.start("MC_MoveRelative", Distance=1.0, **GO)
    finish(plc, move)
    assert (move["Done"], plc.unit.axes[0].has("ERR")) == (True, True)


def state(block: Instance) -> str:
    names = [name for name in block.types if name in STATES]
    (one,) = [name for name in names if block[name]]
    return one


STATES = {
    "ERRORSTOP", "DISABLED", "STOPPING", "HOMING", "STANDSTILL", "DISCRETEMOTION",
    "CONTINUOUSMOTION", "SYNCHRONIZEDMOTION",
}  # fmt: skip


def test_the_state_is_told(plc) -> None:
    power, status = plc.called[0], plc.add("MC_ReadStatus", Enable=True)
    plc.run(1)
    assert state(status) == "STANDSTILL"
    moving(plc)
    assert state(status) == "DISCRETEMOTION"
    stop = plc.start("MC_Stop")
    plc.run(1)
    assert state(status) == "STOPPING"
    finish(plc, stop)
    stop["Execute"] = False
    plc.run(2)
    assert state(status) == "STANDSTILL"
    plc.start("MC_Home", Position=0.0, Acceleration=100.0)
    plc.until(lambda: status["Homing"])
    plc.until(lambda: status["Standstill"])
    plc.unit.axes[0].fault(7)
    plc.until(lambda: status["ErrorStop"])
    assert state(status) == "ERRORSTOP"
    power["Enable"] = False
    plc.until(lambda: status["Disabled"])
    assert state(status) == "DISABLED"
    plc.cut = True
    plc.until(lambda: not status["Valid"])
    assert (status["Disabled"], status["ErrorID"]) == (False, NOT_ONLINE)


def test_the_position_is_read_with_its_sign(plc) -> None:
    position = plc.add("MC_ReadActualPosition", Enable=True)
    finish(plc, plc.start("MC_MoveAbsolute", Position=-123.456, **GO))
    assert (position["Valid"], position["Position"]) == (True, -123.456)


def test_another_block_that_takes_the_axis_first_is_told_to_a_pos_block(plc) -> None:
    plc.run(5)
    first = plc.add("POS_INIT", Execute=True)
    mode = plc.add("POS_MODE", Execute=True, Way=1000, Accel=500)
    halt = plc.start("MC_Halt")
    finish(plc, halt)
    assert (first["Done"], halt["Done"], mode["ErrorID"]) == (True, True, PREEMPTED)
    assert plc.unit.axes[0].executed == [INIT, INIT, INIT]


def test_control_leaves_the_permit_alone_when_nil(plc) -> None:
    control = plc.add("POS_CONTROL", Feed=5 << 16, Mp=False)
    plc.run(1)
    assert (plc.axes[0]["Out"][5], feed(plc.axes[0])) == (0, 5 << 16)
    control.call(Mp=True, Nil=True)
    assert plc.axes[0]["Out"][5] == 0
    control.call(Nil=False)
    assert plc.axes[0]["Out"][5] == 1


def test_control_writes_nothing_while_stop_holds_the_axis(plc) -> None:
    stop = plc.start("MC_Stop")
    control = plc.add("POS_CONTROL", Feed=5 << 16)
    plc.run(1)
    assert (control["Err"], control["ErrorID"], feed(plc.axes[0])) == (True, LOCKED, 0)
    finish(plc, stop)


def test_axes_move_side_by_side(plc) -> None:
    moves = []
    for axis in (2, 3, 4):
        plc.power(axis)
        moves.append(plc.add("MC_MoveRelative", axis, Execute=True, Distance=float(axis), **GO))
    plc.until(lambda: all(move["Done"] for move in moves))
    assert [axis.position for axis in plc.unit.axes] == [0, 2000, 3000, 4000]
