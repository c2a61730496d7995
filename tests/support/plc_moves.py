"""What tests of the PLC's blocks share: moves, and the numbers of errors."""

from __future__ import annotations

from typing import Any

from fake_positioning import CODES
from plc_cycle import Plc
from st_program import Instance

INIT, MODE, RESET, MODE_ABS, HOME, CAPTURE = (
    CODES[name]
    for name in ("POS_INIT", "POS_MODE", "POS_RESET", "POS_MODE_ABS", "POS_HOME", "POS_CAPTURE")
)
GO = {"Velocity": 50.0, "Acceleration": 500.0}
NOT_ONLINE, LOCKED, OUT_OF_RANGE, PREEMPTED = 0x8001, 0x8002, 0x8003, 0x8004


def feed(axis: Instance) -> int:
    high, low = axis["Out"][6:8]
    return int(high) << 16 | int(low)


def finish(plc: Plc, block: Instance) -> None:
    plc.until(lambda: not block["Busy"])


def moving(plc: Plc, **inputs: float) -> Instance:
    """A relative move that is under way."""
    values: dict[str, Any] = {"Distance": 100.0, **GO, **inputs}
    move = plc.start("MC_MoveRelative", **values)
    plc.until(lambda: plc.unit.axes[0].has("JEDE"))
    plc.run(5)
    return move
