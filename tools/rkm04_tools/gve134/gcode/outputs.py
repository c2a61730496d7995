"""Spindle, tool, cooling and stops of a program: what M, S and T do."""

from __future__ import annotations

from dataclasses import dataclass

from rkm04_tools.gve134.gcode.axes import Mill, Spindle
from rkm04_tools.gve134.gcode.block import Block
from rkm04_tools.gve134.gcode.modal import Wrong
from rkm04_tools.gve134.gcode.writer import Writer

FORWARD, REVERSE, OFF = 3, 4, 5
MIST, FLOOD, COOLING_OFF = "mist", "flood", "cooling off"
PAUSES = (0, 1)


@dataclass(slots=True)
class Outputs:
    """As a program begins all is off."""

    mill: Mill
    writer: Writer
    dwelt_s: float = 0.0
    """So long the spindle was waited for."""
    stopped_by_change: bool = False
    """The spindle was on, and is off since a tool was put in."""
    _spindle: int = OFF
    _rpm: float | None = None
    _tool: float | None = None
    _flood: bool = False
    _mist: bool = False

    @property
    def is_turning(self) -> bool:
        """Whether the spindle is on."""
        return self._spindle != OFF

    def act(self, block: Block, comment: str) -> None:
        """Do what comes before the motion of a block: S, T, M6, then spindle, then cooling."""
        values, commands = block.values, block.commands
        if "S" in values:
            self._set_rpm(values["S"])
        if "T" in values:
            self._set_tool(values["T"])
        if "tool" in commands:
            self._change_tool(comment)
        if "spindle" in commands:
            self._turn(commands["spindle"])
        elif "S" in values and self.is_turning:
            self._turn(self._spindle)
        if commands.keys() & {MIST, FLOOD, COOLING_OFF}:
            self._cool(set(commands))

    def stop(self, stop: int, comment: str) -> bool:
        """Do what comes after the motion; whether the program ends."""
        if stop in PAUSES:
            self.writer.pause(comment or f"M{stop}")
            return False
        if self.is_turning:
            self._turn(OFF)
        if self._flood or self._mist:
            self._cool({COOLING_OFF})
        return True

    def _set_rpm(self, rpm: float) -> None:
        top = self._required("S").rpm
        if not 0 <= rpm <= top:
            raise Wrong("S", f"S{rpm:g}: the spindle turns with 0 to {top:g} turns a minute")
        self._rpm = rpm

    def _set_tool(self, tool: float) -> None:
        if tool < 0 or tool != int(tool):
            raise Wrong("T", "T takes the number of a tool, a whole one")
        self._tool = tool

    def _turn(self, command: int) -> None:
        spindle = self._required("spindle")
        if command == REVERSE and spindle.reverse_bit is None:
            raise Wrong("spindle", "M4: by the machine file the spindle turns one way only")
        if command != OFF and self._rpm is None:
            raise Wrong("spindle", f"M{command}: the spindle has no speed yet; write S")
        if {command, self._spindle} == {FORWARD, REVERSE}:
            self._turn(OFF)
            self._wait(spindle)
        permille = 0 if command == OFF else _permille(self._rpm or 0.0, spindle)
        self.writer.turn_spindle(permille, command == REVERSE)
        starts = command != OFF and self._spindle == OFF
        self._spindle, self.stopped_by_change = command, False
        if starts:
            self._wait(spindle)

    def _wait(self, spindle: Spindle) -> None:
        self.writer.wait(spindle.start_s)
        self.dwelt_s += spindle.start_s

    def _change_tool(self, comment: str) -> None:
        if self._tool is None:
            raise Wrong("tool", "M6: no tool has been chosen; write T")
        if self.is_turning:
            self._turn(OFF)
            self.stopped_by_change = True
        self.writer.pause(f"put in tool {self._tool:.0f}{f' ({comment})' if comment else ''}")

    def _cool(self, groups: set[str]) -> None:
        is_off = COOLING_OFF in groups
        if is_off and groups & {MIST, FLOOD}:
            raise Wrong(COOLING_OFF, "M9 stands beside M7 or M8; keep one of them")
        self._flood = not is_off and (self._flood or FLOOD in groups)
        self._mist = not is_off and (self._mist or MIST in groups)
        self.writer.cool(self._flood, self._mist)

    def _required(self, place: str) -> Spindle:
        if self.mill.spindle is None:
            raise Wrong(place, "the machine file tells of no spindle")
        return self.mill.spindle


def _permille(rpm: float, spindle: Spindle) -> int:
    return max(1, round(1000 * rpm / spindle.rpm)) if rpm else 0
