"""The programs of a machine: checked by the firmware's parser and against the machine's limits."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import host
from rkm04_tools.check import Checked, Diagnostic, check_source, show, show_all
from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.machine.machine import Machine, Motor
from rkm04_tools.source import Source

SPEEDS = {"SPEED": "V", "START_SPEED": "S"}
MOVES = {"MOVE", "APPEND_SECTION", "GO_TO", "GO_HOME", "RUN_FORWARD", "RUN_BACKWARD"}
START_STEPS_PER_S = 1000
"""V after `\\`, as the language has it."""
NO_PROGRAM = "W1"


@dataclass(frozen=True)
class MotorProgram:
    """The program of a motor, what the parser said of it, and where it exceeds the limits."""

    motor: Motor
    checked: Checked
    exceeding: list[Diagnostic]

    @property
    def is_good(self) -> bool:
        """Whether it may go to a unit."""
        return self.checked.is_good and not self.exceeding

    @property
    def commands(self) -> int:
        """How many the memory keeps."""
        return len(host.stored(self.checked.parsed.commands))

    def show(self) -> None:
        """Tell on standard error what there is to say about it."""
        show_all(self.checked, sys.stderr)
        for each in self.exceeding:
            show(self.checked.source, each, sys.stderr)


def programs_of(machine: Machine) -> list[MotorProgram]:
    """Those of the motors that have one. Comments alone are none."""
    found = (_checked(motor, machine.source(motor)) for motor in machine.motors)
    return [each for each in found if each.checked.parsed.commands or not each.checked.is_good]


def good_programs(machine: Machine) -> Mapping[int, MotorProgram] | None:
    """The programs by motor, or None if one of them is wrong; all that is wrong has been told."""
    found = programs_of(machine)
    for each in found:
        each.show()
    if not all(each.is_good for each in found):
        return None
    if not found:
        raise Failure(f"{machine.file}: no motor has a program; nothing to be done", NOT_SO)
    return {each.motor.number: each for each in found}


def require_inputs(machine: Machine) -> None:
    """Let the simulator judge what the inputs do."""
    if not machine.inputs.strip():
        return
    with TemporaryDirectory(prefix="rkm04-") as folder:
        program, inputs = Path(folder) / "a.rks", Path(folder) / "inputs.csv"
        program.write_text(NO_PROGRAM, encoding="ascii")
        inputs.write_text(machine.inputs, encoding="utf-8", newline="")
        try:
            host.simulate(["--for", "0.001", "--motor", f"1={program}", "--inputs", str(inputs)])
        except Failure as failure:
            words = str(failure).replace(str(inputs), f"{machine.file}: inputs")
            raise Failure(words, NOT_SO) from None


def _checked(motor: Motor, source: Source) -> MotorProgram:
    checked = check_source(source)
    return MotorProgram(motor, checked, _exceeding(motor, checked) if checked.is_good else [])


def _exceeding(motor: Motor, checked: Checked) -> list[Diagnostic]:
    """Speeds beyond what the machine allows."""
    limit = motor.speed_max_steps_per_s
    if limit is None:
        return []
    found = []
    has_start_speed = False
    for each in checked.parsed.commands:
        has_start_speed = each.opcode == "RESET" or (has_start_speed and each.opcode != "SPEED")
        text = each.text
        speed = each.value if each.opcode in SPEEDS else 0
        if has_start_speed and each.opcode in MOVES:
            text, speed = f"{text}, with V{START_STEPS_PER_S} from the start,", START_STEPS_PER_S
        if speed > limit:
            words = f"{text} is above the limit of {motor.title}: {limit} steps/s"
            place = checked.source.place(each.offset)
            found.append(Diagnostic(place, "error", "speed-limit", words))
    return found
