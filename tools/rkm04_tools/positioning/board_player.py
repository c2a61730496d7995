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
from rkm04_tools.positioning.frames import NODE, gap_ms
from rkm04_tools.positioning.master import NS_PER_MS, End, Master
from rkm04_tools.positioning.modbus import REFUSED, read_request, words_in
from rkm04_tools.positioning.state import IN_NUMBERS, AxisState, axis_state
from rkm04_tools.positioning.table import AXES, images, registers
from rkm04_tools.target_run import TICKS_PER_MS
from rkm04_tools.virtual_board import Talk

OUT_OF_RANGE = 3
"""The exception of a value that no request can have."""
ANSWER_MS = 100
"""So long the unit may take for an answer to begin, but for that to STORE."""
REST_MS = 10.0
"""Between two looks whether the axes stand, where there is no WATCHDOG."""
DONE_WORDS = 2
"""DONE and RESULT."""
AS_IT_SHOULD = "answered as it should be"
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
        self._master = Master(baud)
        self._gap_ms = gap_ms(baud)
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
        request = read_request(image.first, count * AXES)
        what = "the last look at the axes"
        words = self._words(self._ask(request, what), count * AXES, what)
        each = (words[count * axis : count * (axis + 1)] for axis in range(AXES))
        self.axes = [axis_state(n, image.numbers, own) for n, own in enumerate(each, 1)]
        return self.axes

    def _perform(self, request: Request) -> None:
        self.executed += len(request.lines)
        line = request.line
        what = f"line {line.number}, {line.word},"
        if not request.asked:
            self._tell(line, OUT_OF_RANGE)
            return
        answer = self._ask(request.asked, what, may_refuse=line.word == SETTING)
        if answer[0] & REFUSED:
            self._tell(line, answer[1])
        elif line.word == READ:
            words = self._words(answer, len(IN_NUMBERS), what)
            self._tell(line, 0, axis_state(line.axis, IN_NUMBERS, words))
        elif request.instruction:
            done, result = self._words(answer, DONE_WORDS, what)
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

    def _ask(self, request: bytes, what: str, may_refuse: bool = False) -> bytes:
        """The answer, from its function on."""
        self._wait(self._free_ms)
        self._master.ask(NODE, request, ANSWER_MS, 1, self._now_ns)
        heard = b""
        while (end := self._master.poll(self._now_ns)) is End.WAITS:
            if out := self._master.out:
                self.talk.say(out)
                self._master.note_written()
            data = self.talk.until(self._master.until_ns / NS_PER_MS)
            self._master.take(data, self._now_ns)
            heard += data
        self._free_ms = self.talk.ms + self._gap_ms
        if end is End.ANSWERED or (end is End.REFUSED and may_refuse):
            return self._master.answer
        raise self._failure(what, AS_IT_SHOULD if heard else "answered")

    def _words(self, answer: bytes, count: int, what: str) -> list[int]:
        words = words_in(answer, count)
        if words is None:
            raise self._failure(what, AS_IT_SHOULD)
        return words

    @property
    def _now_ns(self) -> int:
        return round(self.talk.ms * NS_PER_MS)

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
