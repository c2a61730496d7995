"""The unit lets the line go within a character after its last stop bit, whatever else it does."""

from __future__ import annotations

import pytest
from board_talk import ask, heard
from virtual_board import BYTE_MS, VirtualBoard

VERSION, POSITIONS = b"\x01", b"\x040"
READY_MS = 30.0
CHARACTER_US = 1000 * BYTE_MS
"""The promise of firmware/rkm04/docs/line.md."""
APART_MS, PHASES = 60.05, 20
"""From one request to the next: each meets the unit's millisecond at another place."""
REACTION_US = 5.0
"""What the interrupt takes where nothing holds it off."""


def test_the_line_is_let_go_by_the_interrupt_and_not_when_main_or_the_clock_come_by(unit):
    script = "".join(ask(READY_MS + i * APART_MS, VERSION, number=i) for i in range(PHASES))

    modelled = unit.run(script, (READY_MS + PHASES * APART_MS) / 1000)

    assert len(heard(unit.folder)) == PHASES
    assert 0 < modelled.summary["line"]["release_max"] < REACTION_US


@pytest.mark.parametrize("stuck_ms", [15.0, 20.0, 25.0])
def test_the_line_is_let_go_in_time_while_main_is_stuck(unit: VirtualBoard, stuck_ms: float):
    at = READY_MS + stuck_ms  # in the middle of the answer, that has 51 bytes

    modelled = unit.run(ask(READY_MS, POSITIONS), 0.1, "", "--fault", f"{at:.3f}:hold=rkm04_poll")

    assert len(heard(unit.folder)) == 1
    assert heard(unit.folder)[0].ms < at < modelled.edges("de")[-1][0]
    assert 0 < modelled.summary["line"]["release_max"] < REACTION_US
