"""`watch`: what the motors of a unit do, again and again until Ctrl-C."""

from __future__ import annotations

import json
import sys
import time
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rkm04_tools.failure import DONE, Failure
from rkm04_tools.line import Unit
from rkm04_tools.line_errors import LineError, PortError, UnknownMessage
from rkm04_tools.messages import ALL_MOTORS, MOTORS, Progress
from rkm04_tools.status import levels_text
from rkm04_tools.table import table, thousands

HEAD = ("motor", "position", "steps/s", "steps made", "of", "command")


@dataclass(frozen=True)
class Look:
    """What a motor does at a moment.

    `seconds` since the first look; `speed` in steps/s, the mean since the look before (0 in the
    first one); `steps` the length of the move in progress, None for none and for one without end.
    """

    motor: int
    seconds: float
    position: int
    speed: float
    progress: Progress
    steps: int | None

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        return {
            "motor": self.motor,
            "position": self.position,
            "speed": round(self.speed, 1),
            "steps_made": self.progress.steps,
            "steps": self.steps,
            "command": self.progress.command,
        }

    def as_row(self) -> tuple[str, ...]:
        """For the table."""
        return (
            str(self.motor),
            thousands(self.position),
            thousands(round(self.speed)),
            thousands(self.progress.steps),
            "-" if self.steps is None else thousands(self.steps),
            str(self.progress.command),
        )

    def as_text(self) -> str:
        """For a line."""
        end = "-" if self.steps is None else str(self.steps)
        return (
            f"{self.motor}: {self.position} {self.speed:+.0f} steps/s, "
            f"step {self.progress.steps} of {end}, command {self.progress.command}"
        )


@dataclass(frozen=True)
class Levels:
    """Inputs and outputs at a moment, BI1 and BO1 first."""

    inputs: tuple[bool, ...]
    outputs: tuple[bool, ...]

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        return {
            "inputs": [int(level) for level in self.inputs],
            "outputs": [int(level) for level in self.outputs],
        }

    def as_text(self) -> str:
        """The numbers of those that are 1."""
        return f"BI {levels_text(self.inputs)}  BO {levels_text(self.outputs)}"


class Watcher:
    """Looks at motors of a unit."""

    def __init__(self, unit: Unit, numbers: Sequence[int]) -> None:
        self._unit = unit
        self._numbers = numbers
        self._started = time.monotonic()
        self._before: dict[int, tuple[float, int]] = {}
        self._tells_levels = True

    def look(self) -> list[Look]:
        """Ask them all."""
        return [self._look_at(number) for number in self._numbers]

    def levels(self) -> Levels | None:
        """Ask for inputs and outputs; None: the unit cannot tell, which is said once."""
        if not self._tells_levels:
            return None
        try:
            status = self._unit.status()
        except UnknownMessage:
            self._tells_levels = False
            print(
                f"rkm04: unit {self._unit.node} does not know Get Status (message 200), "
                "it has other software: inputs and outputs are not shown",
                file=sys.stderr,
            )
            return None
        return Levels(status.inputs, status.outputs)

    def _look_at(self, number: int) -> Look:
        motor = self._unit.motor(number)
        position = motor.position()
        now = time.monotonic() - self._started
        then, old = self._before.get(number, (now, position))
        self._before[number] = now, position
        speed = (position - old) / (now - then) if now > then else 0.0
        points = motor.table()
        steps = points[-1].step if points and points[-1].speed == 0 else None
        return Look(number, now, position, speed, motor.progress(), steps)


@dataclass(frozen=True)
class Shown:
    """What was seen: for scripts, as a table that is redrawn, and as a line."""

    answer: dict[str, Any]
    drawn: str
    line: str


class Screen:
    """Shows looks: redrawn on a terminal, else one line each."""

    def __init__(self, as_json: bool) -> None:
        self._as_json = as_json
        self._drawn = 0

    def show(self, seconds: float, shown: Shown) -> None:
        """Show what was seen."""
        if self._as_json:
            print(json.dumps({"seconds": round(seconds, 3), **shown.answer}), flush=True)
        elif sys.stdout.isatty():
            self._draw(shown.drawn)
        else:
            print(f"{seconds:.1f} s  {shown.line}", flush=True)

    def show_error(self, seconds: float, error: LineError) -> None:
        """Say that nothing was seen, and why."""
        self.show(seconds, Shown({"error": str(error)}, str(error), str(error)))

    def _draw(self, text: str) -> None:
        up = f"\x1b[{self._drawn}A\r\x1b[J" if self._drawn else ""
        print(up + text, flush=True)
        self._drawn = text.count("\n") + 1


def run_watch(unit: Unit, options: Namespace) -> int:
    """Look at motors until Ctrl-C or as often as asked for."""
    numbers = list(MOTORS) if options.motor == ALL_MOTORS else [options.motor]
    watcher = Watcher(unit, numbers)
    return watch(options, lambda: _shown(watcher.look(), watcher.levels()))


def _shown(looks: Sequence[Look], levels: Levels | None) -> Shown:
    answer: dict[str, Any] = {"motors": [look.as_json() for look in looks]}
    text = table([HEAD, *(look.as_row() for look in looks)], "rrrrrr")
    line = "  ".join(look.as_text() for look in looks)
    if not levels:
        return Shown(answer, text, line)
    told = levels.as_text()
    return Shown(answer | levels.as_json(), f"{text}\n{told}", f"{line}  {told}")


def require_looks(options: Namespace) -> None:
    """Refuse times and counts that are none."""
    if not 0 < options.interval < 1e6:
        raise Failure(f"--interval {options.interval:g}: write seconds, more than 0")
    if options.count is not None and options.count < 1:
        raise Failure(f"--count {options.count}: write how often to look, 1 or more")


def watch(options: Namespace, look: Callable[[], Shown]) -> int:
    """Look until Ctrl-C or as often as asked for; a unit that is away for a while is waited for."""
    screen = Screen(options.json)
    started = time.monotonic()
    done = 0
    try:
        while True:
            seconds = time.monotonic() - started
            try:
                screen.show(seconds, look())
            except PortError:
                raise
            except LineError as error:
                if done == 0:
                    raise
                screen.show_error(seconds, error)
            done += 1
            if done == options.count:
                return DONE
            due = (time.monotonic() - started) // options.interval + 1
            time.sleep(max(0.0, started + due * options.interval - time.monotonic()))
    except KeyboardInterrupt:
        return DONE
