"""The machine file of a page: as the user has it, and what it says."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.gve134.gcode.axes import Mill, mill_of
from rkm04_tools.machine.machine import Machine, bytes_of, parse_machine
from rkm04_tools.source import named


@dataclass(frozen=True)
class MachineFile:
    """A machine file without errors."""

    name: str
    text: str
    mill: Mill


def machine_file(name: str, data: bytes) -> MachineFile:
    """Check a machine file that a page has brought."""
    mill = mill_of(Machine(name, parse_machine(data, name)))
    return MachineFile(Path(name).name, data.decode("utf-8-sig"), mill)


def read_machine_file(name: str) -> MachineFile:
    """Read one that is named by option or environment."""
    path = named(name)
    return machine_file(str(path), bytes_of(path))
