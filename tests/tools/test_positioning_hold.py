"""`positioning hold`, and Ctrl-C in a move, where the axis does not stay held."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from pos_cycles import cycles
from rkm04_tools.positioning.line_errors import NotHeld
from rkm04_tools.positioning.state import AxisState
from rkm04_tools.positioning.unit import open_unit
from served import Served

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_SECONDS = 15.0
Tool = Callable[..., Any]
Serve = Callable[..., Served]


@pytest.mark.parametrize("seconds", [0.02, 0.2])
def test_a_hold_that_a_plc_undoes_is_shouted_at_once(
    positioning: Tool, pos_serve: Serve, seconds: float
):
    place = pos_serve(place="--modbus-tcp", speed="1").place
    with open_unit(place) as unit:
        unit.axis(1).init()
        unit.axis(1).mode(1000.0, 500)
    with cycles(place, seconds):
        time.sleep(0.5)
        result = positioning("hold", "--port", place)

    assert (result.status, result.out) == (1, "")
    assert result.err.startswith("STOP NOT CONFIRMED: axis 1 IS NOT HELD: another master")
    assert "USE THE EMERGENCY STOP" in result.err
    with open_unit(place) as unit:
        assert unit.axis(1).read().way_left_um > 500_000


def test_ctrl_c_in_a_move_that_a_plc_lets_go_on_is_shouted(pos_serve: Serve, tmp_path: Path):
    served = pos_serve(place="--modbus-tcp", speed="1")
    command = [sys.executable, "-P", "-m", "rkm04_tools.positioning", "move", "1000"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
    process = subprocess.Popen(
        [*command, "--feed", "3000", "--port", served.place],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path, env=environment,
    )  # fmt: skip
    try:
        served.control().wait_for("moves", lambda state: state["moving"][0])
        with cycles(served.place):
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=PATIENCE_SECONDS)
    finally:
        process.kill()
        process.communicate()

    assert (process.returncode, out) == (1, "")
    assert "STOP NOT CONFIRMED: axis 1 IS NOT HELD: another master" in err
    assert "it stands" not in err


def test_an_axis_that_does_not_get_slower_is_not_held(
    pos_serve: Serve, monkeypatch: pytest.MonkeyPatch
):
    with open_unit(pos_serve(speed="1").place) as unit:
        axis = unit.axis(1)
        axis.init()
        axis.mode(1000.0, 500)
        axis.control(feed=3000, permitted=True)
        time.sleep(0.5)
        moving: AxisState = axis.read()
        steps = count()
        monkeypatch.setattr(axis, "read", lambda: replace(moving, position_steps=next(steps)))

        with pytest.raises(NotHeld, match="MP is 0, and it does not brake"):
            axis.hold()


def test_a_hold_of_an_axis_that_brakes_slowly_is_waited_for(pos_serve: Serve):
    with open_unit(pos_serve(speed="1").place) as unit:
        axis = unit.axis(1)
        axis.init()
        axis.mode(1000.0, 5)
        axis.control(feed=1500, permitted=True)
        time.sleep(4)
        speed = axis.read().speed
        begun = time.monotonic()

        assert axis.hold().state == "READY"
        assert time.monotonic() - begun > speed / 65_536 / 60 / 5 / 2


def test_a_step_that_takes_long_at_the_end_of_a_brake_is_waited_for(pos_serve: Serve):
    with open_unit(pos_serve(speed="1").place) as unit:
        unit.set_many({"STEPS": 1, "MICROMETRES": 10_000}, 1)
        axis = unit.axis(1)
        axis.init()
        axis.mode(1000.0, 1)
        axis.control(feed=400, permitted=True)
        time.sleep(5)

        assert axis.hold().state == "READY"
