"""The ENABLE outputs of the image: off until a motor moves, on in time, off when all have stood.

The board is the one with a pin for each driver. The times are those of its header; an EN pin that
is low lets current through its motor.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from board_talk import ask
from rkm04_tools import board, board_header
from virtual_board import READY_MS, TICKS_PER_MS, Modelled, VirtualBoard

NAME = "f407-discovery"
HEADER = board_header.read_board((board.BOARDS / NAME / "board.h").read_text())
IDLE_MS = int(HEADER.values["BOARD_ENABLE_IDLE_MS"].rstrip("U"))
READY_US = int(HEADER.values["BOARD_ENABLE_READY_US"].rstrip("U"))
MOTORS = range(1, 5)
SET_COMMAND = b"\x02"
MOVE = b"\\S2000V2000F20R"
FASTEST = b"\\S2000V16000A60000F200R"
"""The move whose first pulse follows its begin soonest."""


def tell(ms: float, motor: int, text: bytes) -> str:
    return ask(ms, SET_COMMAND + b"%d" % motor + text)


@pytest.fixture
def enabled(program: Path, tmp_path: Path) -> VirtualBoard:
    return VirtualBoard(program, board.build(NAME), tmp_path)


def switched(modelled: Modelled) -> list[tuple[float, int]]:
    """When the drivers go on and off; all of them do at once. They are off when power comes."""
    edges = [modelled.edges(f"m{motor}_en") for motor in MOTORS]
    assert [each[0] for each in edges] == [(0.0, 0)] * 4
    of_each = [each[1:] for each in edges]
    for other in of_each[1:]:
        assert [level for _, level in other] == [level for _, level in of_each[0]]
        for (ms, _), (first, _) in zip(other, of_each[0], strict=True):
            assert abs(ms - first) < 0.01
    return of_each[0]


def rises(modelled: Modelled) -> list[float]:
    """The rising edges of all STEP pins, ms."""
    edges = [modelled.edges(f"m{motor}_step") for motor in MOTORS]
    return sorted(ms for each in edges for ms, level in each if level)


def test_drivers_are_off_until_a_motor_moves(enabled):
    modelled = enabled.run(tell(READY_MS, 1, b"\\W10T3W10C3"), 0.2)

    assert switched(modelled) == []
    assert modelled.summary["motors"][0]["pulses"] == 0


@pytest.mark.parametrize("motor", MOTORS)
def test_drivers_are_on_for_as_long_as_they_need_before_the_first_pulse(enabled, motor):
    modelled = enabled.run(tell(READY_MS, motor, FASTEST), 0.2)

    ((on, level),) = switched(modelled)
    assert level == 1
    assert rises(modelled)[0] - on >= READY_US / 1000


def test_four_motors_that_begin_together_find_their_drivers_ready(enabled):
    line = "".join(tell(READY_MS + 40 * motor, motor, b"[" + FASTEST[1:]) for motor in MOTORS)
    modelled = enabled.run(line + tell(READY_MS + 200, 0, b"]"), 0.4)

    ((on, level),) = switched(modelled)
    first = rises(modelled)[:4]
    assert level == 1
    assert first[0] - on >= READY_US / 1000
    assert first[3] - first[0] < 1e-4


def test_drivers_go_off_when_no_motor_has_moved_for_the_idle_time(enabled):
    modelled = enabled.run(tell(READY_MS, 2, MOVE), (READY_MS + IDLE_MS + 500) / 1000)

    (_, on), (off_ms, off) = switched(modelled)
    last = rises(modelled)[-1]
    assert (on, off) == (1, 0)
    assert IDLE_MS <= off_ms - last < IDLE_MS + 3


def test_a_motor_that_stands_keeps_its_current_while_another_one_moves(enabled):
    slow = b"\\S1V1F%dR" % (IDLE_MS // 1000 + 5)
    modelled = enabled.run(
        tell(READY_MS, 2, MOVE) + tell(READY_MS + 50, 3, slow), (IDLE_MS + 4000) / 1000
    )

    assert [level for _, level in switched(modelled)] == [1]


def test_the_first_move_after_the_drivers_went_off_has_its_pulses_on_the_same_ticks(enabled):
    """As without ENABLE: from the arrival of the message to each pulse."""
    again = READY_MS + IDLE_MS + 1000
    line = tell(READY_MS, 1, FASTEST) + tell(again, 1, FASTEST)
    modelled = enabled.run(line, (again + 300) / 1000)

    (_, on), (_, off), (on_ms, again_on) = switched(modelled)
    ticks = modelled.steps.tick
    first, second = ticks[: len(ticks) // 2], ticks[len(ticks) // 2 :]
    assert (on, off, again_on) == (1, 0, 1)
    assert [t - second[0] for t in second] == [t - first[0] for t in first]
    assert second[0] / TICKS_PER_MS - on_ms >= READY_US / 1000


@pytest.mark.parametrize("options", [["--no-crystal"]])
def test_drivers_stay_off_without_the_crystal(enabled, options):
    modelled = enabled.run(tell(READY_MS, 1, MOVE), 0.2, "", *options)

    assert switched(modelled) == []


FAULTS: dict[str, Callable[[float], list[str]]] = {
    "fault": lambda ms: ["--fault", f"{ms}:jump=10000000"],
    "reset pin": lambda ms: ["--fault", f"{ms}:reset"],
    "main hangs": lambda ms: ["--fault", f"{ms}:hold=rkm04_poll"],
    "power": lambda ms: ["--fault", f"{ms}:power"],
    "crystal": lambda ms: ["--crystal-stops", f"{ms}"],
}


@pytest.mark.parametrize("kind", FAULTS)
def test_drivers_go_off_in_every_fault_and_stay_off_until_a_motor_is_told_to_move(enabled, kind):
    """A motor runs when the fault comes."""
    at = READY_MS + 50
    run = tell(READY_MS, 1, b"\\S2000V2000G+")
    again = at + 1500
    modelled = enabled.run(run + tell(again, 2, MOVE), (again + 100) / 1000, "", *FAULTS[kind](at))

    (_, on), (off_ms, off), *later = switched(modelled)
    reset_ms = modelled.summary["last_reset"]["microseconds"] / 1000
    assert rises(modelled)[0] < at
    assert (on, off) == (1, 0)
    assert off_ms <= reset_ms + 0.001
    assert [level for _, level in later] == ([] if kind == "crystal" else [1])
    assert all(ms > again for ms, _ in later)
