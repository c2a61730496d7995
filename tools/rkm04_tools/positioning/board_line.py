"""The line of the positioning unit's image on the virtual board, at any rate that it has."""

from __future__ import annotations

from pathlib import Path

from rkm04_tools.positioning.frames import write
from rkm04_tools.positioning.table import registers
from rkm04_tools.target_run import Rig

DELIVERED_BAUD = 19_200
FORMAT = ("--format", "8E1")
RATE_BD = 100
BEGIN_MS, STORE_MS, STORED_MS = 50.0, 80.0, 200.0
QUICK_FLASH = ("--flash-erase", "1")
"""What is stored is the same; it is there sooner."""


def stored(rig: Rig, baud: int) -> Path:
    """A flash in which the line has this rate; the image does not know it from elsewhere."""
    path = rig.folder / f"flash-{baud}.bin"
    if not path.exists():
        number = {name: registers()[name].number for name in ("RATE", "STORE")}
        asks = [
            (BEGIN_MS, write(number["RATE"], [baud // RATE_BD])),
            (STORE_MS, write(number["STORE"], [1])),
        ]
        line = "".join(f"{ms:.6f} {data.hex()}\n" for ms, data in asks)
        rig.run(STORED_MS / 1000, line, "", *FORMAT, *QUICK_FLASH, flash=path)
    return path


def options(rig: Rig, baud: int) -> list[str]:
    """What the virtual board is told for a line of this rate."""
    told = ["--baud", str(baud), *FORMAT]
    return told if baud == DELIVERED_BAUD else [*told, "--flash", str(stored(rig, baud))]
