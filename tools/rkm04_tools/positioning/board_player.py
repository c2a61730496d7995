"""Plays a script to the image of a board as a master does: a request at the time of its line, the
next one when it is answered.

Nothing else is sent before the axes should stand, and then no sooner than WATCHDOG lets it be: what
is not in the script must not keep it quiet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.positioning.board_script import READ, SETTING, Line, Request, requests_of
from rkm04_tools.positioning.frames import (
    FRAME_BYTES_MAX,
    Answer,
    answer_of,
    byte_ms,
    gap_ms,
    is_whole,
    read,
)
from rkm04_tools.positioning.state import IN_NUMBERS, AxisState, axis_state
from rkm04_tools.positioning.table import AXES, images, registers
from rkm04_tools.target_run import TICKS_PER_MS
from rkm04_tools.virtual_board import Talk

OUT_OF_RANGE = 3
"""The exception of a value that no request can have."""
ANSWER_MS = 2100.0
"""So long the unit may take for the answer to STORE."""
REST_MS = 10.0
"""Between two looks whether the axes stand, where there is no WATCHDOG."""
NOT_SHOWN = ("axis", "done", "result")


class Player:
    """Sends a script from `talk.ms` on. `behind_ms`: how late a line has gone out, at most;
    `axes`: what the last look at them has found."""

    def __init__(self, talk: Talk, name: str, lines: Sequence[Line], baud: int) -> None:
        self.talk = talk
        self.told: list[dict[str, Any]] = []
        self.executed = 0
        self.behind_ms = 0.0
        self.axes: list[AxisState] = []
        self._name = name
        self._requests = requests_of(lines)
        self._rest_ms = REST_MS + _watchdog_ms(lines)
        self._baud = baud
        self._begun_ms = self._free_ms = talk.ms

    def play(self, seconds: float, rests_seconds: float) -> bool:
        """Until all lines have been answered and the axes stand, which is not looked at before
        `rests_seconds`. False: not in that time."""
        end_ms = self._begun_ms + 1000 * seconds
        late_ms = 0.0
        for request in self._requests:
            due_ms = self._begun_ms + request.line.ms
            begin_ms = max(due_ms, self._free_ms)
            if begin_ms >= end_ms:
                self._wait(end_ms)
                self._look()
                return False
            self._wait(begin_ms)
            self.behind_ms = max(self.behind_ms, begin_ms - due_ms)
            self._perform(request)
            late_ms = self.talk.ms - due_ms
        rests_ms = self._begun_ms + 1000 * rests_seconds + late_ms
        self._wait(min(max(rests_ms, self.talk.ms + self._rest_ms), end_ms))
        return self._rests(end_ms)

    def _rests(self, end_ms: float) -> bool:
        """Seen twice, as an axis that turns round stands for a moment."""
        before, looked_ms = self._look(), self.talk.ms
        while looked_ms + self._rest_ms <= end_ms:
            self._wait(looked_ms + self._rest_ms)
            now, looked_ms = self._look(), self.talk.ms
            if now == before and not any(axis.moves for axis in now):
                return True
            before = now
        return False

    def _look(self) -> list[AxisState]:
        image = images()["FULL_IN"]
        count = len(image.numbers)
        words = self._ask(read(image.first, count * AXES), "the last look at the axes").words
        each = (words[count * axis : count * (axis + 1)] for axis in range(AXES))
        self.axes = [axis_state(n, image.numbers, own) for n, own in enumerate(each, 1)]
        return self.axes

    def _perform(self, request: Request) -> None:
        self.executed += len(request.lines)
        line = request.line
        what = f"line {line.number}, {line.word},"
        if not request.frame:
            self._tell(line, OUT_OF_RANGE)
            return
        answer = self._ask(request.frame, what, may_refuse=line.word == SETTING)
        if answer.exception:
            self._tell(line, answer.exception)
        elif line.word == READ:
            self._tell(line, 0, axis_state(line.axis, IN_NUMBERS, answer.words))
        elif request.instruction:
            done, result = answer.words
            if done != request.instruction:
                raise self._failure(what, "executed")
            if result:
                self._tell(line, result)

    def _tell(self, line: Line, result: int, state: AxisState | None = None) -> None:
        """In the words of the simulator's summary."""
        tick = round((self.talk.ms - self._begun_ms) * TICKS_PER_MS)
        told = {"line": line.number, "axis": line.axis, "instruction": line.word}
        told |= {"result": result, "tick": tick}
        self.told.append(told | (shown(state) if state else {}))

    # ---- the line ----

    def _ask(self, frame: bytes, what: str, may_refuse: bool = False) -> Answer:
        self._wait(self._free_ms)
        self.talk.say(frame)
        bytes_ms = (len(frame) + FRAME_BYTES_MAX) * byte_ms(self._baud)
        end_ms = self.talk.ms + bytes_ms + gap_ms(self._baud) + ANSWER_MS
        heard = b""
        while not is_whole(heard):
            if self.talk.ms >= end_ms:
                raise self._failure(what, "answered")
            heard += self.talk.until(end_ms)
        self._free_ms = self.talk.ms + gap_ms(self._baud)
        answer = answer_of(frame, heard)
        if answer is None or (answer.exception and not may_refuse):
            raise self._failure(what, "answered as it should be")
        return answer

    def _wait(self, until_ms: float) -> None:
        while self.talk.ms < until_ms:
            self.talk.until(until_ms)

    def _failure(self, what: str, deed: str) -> Failure:
        return Failure(f"{self._name}: {what} was not {deed} by the image of the board", NOT_SO)


def _watchdog_ms(lines: Sequence[Line]) -> int:
    """The longest WATCHDOG that a script sets."""
    row = registers()["WATCHDOG"]
    values = [line.values for line in lines if line.word == SETTING]
    return max((ms for number, ms in values if number == row.number and row.takes(ms)), default=0)


def shown(state: AxisState) -> dict[str, int]:
    """What an axis tells, by the names of the simulator's summary."""
    return {name: value for name, value in asdict(state).items() if name not in NOT_SHOWN}
