"""`watch`: what the motors of a unit do, again and again until Ctrl-C."""

from __future__ import annotations

import json
import math
import sys
import time
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rkm04_tools.failure import DONE, Failure
from rkm04_tools.line import Motor, Unit
from rkm04_tools.line_errors import LineError, PortError, UnknownMessage
from rkm04_tools.messages import ALL_MOTORS, MOTORS, BreakPoint, Progress
from rkm04_tools.status import Status, levels_text
from rkm04_tools.table import table, thousands

ATTEMPTS = 2
LATE_LOOKS = 2
"""So many tell that the interval cannot be kept."""
Asked = tuple[Motor, float, int, tuple[BreakPoint, ...], Progress]
HEAD = ("motor", "position", "steps/s", "steps made", "of", "command")


@dataclass(frozen=True)
class Look:
    """What a motor does at a moment.

    `seconds` since the first look; `speed` in steps/s, the mean since the look before, None where
    there is none, or where the unit has restarted since; `steps` the length of the move in
    progress, None for none and for one without end.
    """

    motor: int
    seconds: float
    position: int
    speed: float | None
    progress: Progress
    steps: int | None

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        return {
            "motor": self.motor,
            "position": self.position,
            "speed": None if self.speed is None else round(self.speed, 1),
            "steps_made": self.progress.steps,
            "steps": self.steps,
            "command": self.progress.command,
        }

    def as_row(self) -> tuple[str, ...]:
        """For the table."""
        return (
            str(self.motor),
            thousands(self.position),
            "-" if self.speed is None else thousands(round(self.speed)),
            thousands(self.progress.steps),
            "-" if self.steps is None else thousands(self.steps),
            str(self.progress.command),
        )

    def as_text(self) -> str:
        """For a line."""
        end = "-" if self.steps is None else str(self.steps)
        speed = "-" if self.speed is None else f"{self.speed:+.0f}"
        return (
            f"{self.motor}: {self.position} {speed} steps/s, "
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


@dataclass(frozen=True)
class Seen:
    """A unit at a look. `restarted` since the look before; None: nobody knows."""

    looks: Sequence[Look]
    levels: Levels | None
    restarted: bool | None
    cause: str


class Watcher:
    """Looks at motors of a unit."""

    def __init__(self, unit: Unit, numbers: Sequence[int]) -> None:
        self._unit = unit
        self._numbers = numbers
        self._started = time.monotonic()
        self._before: dict[int, tuple[float, int]] = {}
        self._tells_status = True
        self._sessions: int | None = None
        self._frames = 0
        self._missed = 0

    def look(self) -> Seen:
        """Ask them all."""
        try:
            status, asked = self._asked()
        except LineError:
            self._missed += 1
            raise
        restarted = self._has_restarted(status)
        if restarted is not False:
            self._before.clear()
        looks = [self._look(*each) for each in asked]
        levels = Levels(status.inputs, status.outputs) if status else None
        return Seen(looks, levels, restarted, status.cause if status else "")

    def _asked(self) -> tuple[Status | None, list[Asked]]:
        """What all tell in one session: a look that a restart falls into is made once more.

        Not for ever, as another master on the line begins sessions, too.
        """
        sessions, node = self._unit.line.sessions, self._unit.node
        for _ in range(ATTEMPTS):
            status = self._status()
            session = sessions[node]
            asked = [self._ask(number) for number in self._numbers]
            if sessions[node] == session:
                break
        return status, asked

    def _status(self) -> Status | None:
        """Inputs, outputs and counts; None: the unit cannot tell, which is said once."""
        if not self._tells_status:
            return None
        try:
            return self._unit.status()
        except UnknownMessage:
            self._tells_status = False
            print(
                f"rkm04: unit {self._unit.node} does not know Get Status (message 200), "
                "it has other software: inputs and outputs are not shown",
                file=sys.stderr,
            )
            return None

    def _has_restarted(self, status: Status | None) -> bool | None:
        """Whether the unit has since the look before.

        A unit that has restarted refuses, and a session is begun. One is begun after each look that
        has failed, too; then the frames tell that the unit has counted since its start.
        """
        sessions, before = self._unit.line.sessions[self._unit.node], self._sessions
        frames, least = status.line["frames"] if status else 0, self._frames + self._requests
        missed, self._missed = self._missed, 0
        self._sessions, self._frames = sessions, frames
        if before is None:
            return False
        if sessions - before > missed:
            return True
        if not missed:
            return False
        return frames < least if status else None

    @property
    def _requests(self) -> int:
        """What a unit counts from one look to the next, at the least."""
        return 1 + 3 * len(self._numbers)

    def _ask(self, number: int) -> Asked:
        motor = self._unit.motor(number)
        position = motor.position()
        now = time.monotonic() - self._started
        return motor, now, position, motor.table(), motor.progress()

    def _look(
        self,
        motor: Motor,
        now: float,
        position: int,
        points: Sequence[BreakPoint],
        progress: Progress,
    ) -> Look:
        then, old = self._before.get(motor.number, (now, position))
        self._before[motor.number] = now, position
        speed = (position - old) / (now - then) if now > then else None
        steps = points[-1].step if points and points[-1].speed == 0 else None
        return Look(motor.number, now, position, speed, progress, steps)


@dataclass(frozen=True)
class Shown:
    """What was seen: for scripts, as a table that is redrawn, and as a line.

    `news` is told before it, in a line that stays.
    """

    answer: dict[str, Any]
    drawn: str
    line: str
    news: str = ""


class Screen:
    """Shows looks: redrawn on a terminal, else one line each."""

    def __init__(self, as_json: bool) -> None:
        self._as_json = as_json
        self._drawn = 0

    def show(self, seconds: float, shown: Shown) -> None:
        """Show what was seen."""
        news = f"{seconds:.1f} s  {shown.news}\n" if shown.news else ""
        if self._as_json:
            print(json.dumps({"seconds": round(seconds, 3), **shown.answer}), flush=True)
        elif sys.stdout.isatty():
            self._draw(news, shown.drawn)
        else:
            print(f"{news}{seconds:.1f} s  {shown.line}", flush=True)

    def show_error(self, seconds: float, error: LineError) -> None:
        """Say that nothing was seen, and why."""
        self.show(seconds, Shown({"error": str(error)}, str(error), str(error)))

    def _draw(self, news: str, text: str) -> None:
        up = f"\x1b[{self._drawn}A\r\x1b[J" if self._drawn else ""
        print(up + news + text, flush=True)
        self._drawn = text.count("\n") + 1


def run_watch(unit: Unit, options: Namespace) -> int:
    """Look at motors until Ctrl-C or as often as asked for."""
    numbers = list(MOTORS) if options.motor == ALL_MOTORS else [options.motor]
    watcher = Watcher(unit, numbers)
    return watch(options, lambda: _shown(watcher.look(), unit.node))


def _shown(seen: Seen, node: int) -> Shown:
    looks, levels = seen.looks, seen.levels
    answer: dict[str, Any] = {
        "restarted": seen.restarted, "motors": [look.as_json() for look in looks]
    }  # fmt: skip
    text = table([HEAD, *(look.as_row() for look in looks)], "rrrrrr")
    line = "  ".join(look.as_text() for look in looks)
    news = _news(seen, node)
    if not levels:
        return Shown(answer, text, line, news)
    told = levels.as_text()
    return Shown(answer | levels.as_json(), f"{text}\n{told}", f"{line}  {told}", news)


def _news(seen: Seen, node: int) -> str:
    """What is said of a restart; empty: there was none."""
    if seen.restarted is None:
        return f"unit {node} was away, and whether it has restarted is NOT KNOWN"
    if seen.restarted:
        return (
            f"unit {node} HAS RESTARTED ({seen.cause or 'it does not tell why'}): positions count "
            "anew, and stored programs may run by themselves"
        )
    return ""


def require_looks(options: Namespace) -> None:
    """Refuse times and counts that are none."""
    if not 0 < options.interval < 1e6:
        raise Failure(f"--interval {options.interval:g}: write seconds, more than 0")
    if options.count is not None and options.count < 1:
        raise Failure(f"--count {options.count}: write how often to look, 1 or more")


def watch(options: Namespace, look: Callable[[], Shown], tool: str = "rkm04") -> int:
    """Look until Ctrl-C or as often as asked for; a unit that is away for a while is waited for."""
    screen = Screen(options.json)
    started = time.monotonic()
    done, late = 0, 0
    try:
        while True:
            seconds, took = time.monotonic() - started, 0.0
            try:
                screen.show(seconds, look())
                took = time.monotonic() - started - seconds
            except PortError:
                raise
            except LineError as error:
                if done == 0:
                    raise
                screen.show_error(seconds, error)
            done += 1
            if done == options.count:
                return DONE
            if took > options.interval:
                late += 1  # one may be so for once, as it also begins a session
                if late == LATE_LOOKS:
                    _say_late(tool, took, options.interval)
            due = (time.monotonic() - started) // options.interval + 1
            time.sleep(max(0.0, started + due * options.interval - time.monotonic()))
    except KeyboardInterrupt:
        return DONE


def _say_late(tool: str, took: float, interval: float) -> None:
    print(
        f"{tool}: a look takes {took:.2f} s, more than --interval {interval:g}: looks come "
        f"every {math.ceil(took / interval) * interval:g} s, as long as they take so long",
        file=sys.stderr,
    )
