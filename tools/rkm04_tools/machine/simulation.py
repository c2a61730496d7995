"""A machine on the simulated unit: its programs and inputs, and where a motor leaves its limits."""

from __future__ import annotations

import sys
from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.check import Checked
from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.machine.machine import Machine, Motor, read_machine
from rkm04_tools.machine.programs import good_programs, require_inputs
from rkm04_tools.record import read_extremes
from rkm04_tools.source import MACHINE_SUFFIX
from rkm04_tools.table import thousands

INPUTS_FILE = "machine.csv"


@dataclass(frozen=True)
class Simulated:
    """A machine to be simulated, and its programs by motor."""

    machine: Machine
    programs: dict[int, Checked]

    @property
    def has_limits(self) -> bool:
        """Whether there are positions that no motor must pass."""
        return any(_limits(motor) != (None, None) for motor in self.machine.motors)

    def inputs(self, folder: Path) -> Path | None:
        """What its inputs do, as a file; None: nothing."""
        if not self.machine.inputs.strip():
            return None
        path = folder / INPUTS_FILE
        path.write_text(self.machine.inputs, encoding="utf-8", newline="")
        return path

    def judge(self, steps: Path) -> int:
        """Tell which motors have left their limits; the exit status."""
        told = [
            words
            for number, extremes in sorted(read_extremes(steps).items())
            for words in _beyond(self.machine.motors[number - 1], *extremes)
        ]
        for words in told:
            print(f"{self.machine.file}: {words}", file=sys.stderr)
        return NOT_SO if told else DONE


def is_machine(name: str | None) -> bool:
    """Whether a name is that of a machine file."""
    return name is not None and Path(name).suffix == MACHINE_SUFFIX


def read_simulated(options: Namespace) -> Simulated | None:
    """The machine that is named in place of a program; None if one of its programs is wrong."""
    if options.motor:
        raise Failure(f"{options.file}: has the programs of all motors; leave --motor out")
    machine = read_machine(options.file)
    require_inputs(machine)
    programs = good_programs(machine)
    if programs is None:
        return None
    return Simulated(machine, {number: each.checked for number, each in programs.items()})


def _limits(motor: Motor) -> tuple[int | None, int | None]:
    return motor.position_min_steps, motor.position_max_steps


def _beyond(motor: Motor, lowest: int, highest: int) -> list[str]:
    low, high = _limits(motor)
    found = []
    if low is not None and lowest < low:
        found.append(f"goes down to {_told(motor, lowest)}, below its limit of {_told(motor, low)}")
    if high is not None and highest > high:
        found.append(f"goes up to {_told(motor, highest)}, above its limit of {_told(motor, high)}")
    return [f"{motor.title} {each}" for each in found]


def _told(motor: Motor, steps: int) -> str:
    """A position in steps, and in the unit of the motor if it has one."""
    told = f"{thousands(steps)} steps"
    if motor.steps_per_unit is None:
        return told
    return f"{told} ({steps / motor.steps_per_unit:.4g} {motor.unit})"
