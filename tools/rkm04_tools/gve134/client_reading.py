"""The commands that only read: position, status, watch."""

from __future__ import annotations

import time
from argparse import Namespace
from dataclasses import dataclass
from typing import Any

from rkm04_tools.client_base import tell
from rkm04_tools.gve134.client_base import unit_of
from rkm04_tools.gve134.state import AXES, INTERRUPTS, Flags, Positions, positions_text
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.table import table, thousands
from rkm04_tools.watch import Shown, require_looks, watch


def run_position(options: Namespace) -> int:
    """Print the positions."""
    with unit_of(options) as unit:
        positions = unit.positions(options.latched)
    rows = [
        ("axis", "position"),
        *((a, thousands(p)) for a, p in zip(AXES, positions, strict=True)),
    ]
    return tell(options, dict(zip(AXES, positions, strict=True)), table(rows, "lr"))


def run_status(options: Namespace) -> int:
    """Print what the unit tells of itself."""
    with unit_of(options) as unit:
        status = unit.status()
        positions, version = unit.positions(), unit.link.version
    answer = {
        "version": version,
        **status.as_json(),
        "positions": dict(zip(AXES, positions, strict=True)),
    }
    text = (
        f"{'unit':<14}{version}\n{status.as_text()}\n{'positions':<14}{positions_text(positions)}"
    )
    return tell(options, answer, text)


def run_watch(options: Namespace) -> int:
    """Look until Ctrl-C or as often as asked for; a unit that is away is waited for."""
    require_looks(options)
    with unit_of(options) as unit:
        return watch(options, Watcher(unit).look, "gve134")


@dataclass
class Watcher:
    """Looks at a unit, and tells the speeds since the look before."""

    unit: Unit
    before: tuple[float, Positions] | None = None

    def look(self) -> Shown:
        """Ask for positions, state and inputs."""
        now, positions = time.monotonic(), self.unit.positions()
        flags = self.unit.flags()
        inputs = [int(self.unit.order(port).values, 16) for port in ("I1", "I2")]
        then, old = self.before or (now, positions)
        self.before = now, positions
        passed = now - then
        speeds = [
            round((at - was) / passed) if passed else 0
            for at, was in zip(positions, old, strict=True)
        ]
        bits = inputs[0] | inputs[1] << 8
        closed = [name for n, name in INTERRUPTS.items() if not bits >> n & 1]
        return _shown(positions, speeds, flags, closed)


def _shown(positions: Positions, speeds: list[int], flags: Flags, closed: list[str]) -> Shown:
    axes = list(zip(AXES, positions, speeds, strict=True))
    rows = [("axis", "position", "pulses/s")]
    rows += [(axis, thousands(at), thousands(speed)) for axis, at, speed in axes]
    inputs = f"inputs at 0: {', '.join(closed) or 'none'}"
    line = "  ".join(f"{axis} {at} ({speed:+d}/s)" for axis, at, speed in axes)
    answer: dict[str, Any] = {
        "positions": dict(zip(AXES, positions, strict=True)),
        "speeds": dict(zip(AXES, speeds, strict=True)),
        "state": flags.text,
        "flags": f"{flags.bits:02X}",
        "inputs_at_0": closed,
    }
    table_text = f"{table(rows, 'lrr')}\n{flags.text}\n{inputs}"
    return Shown(answer, table_text, f"{line}  {flags.text}; {inputs}")
