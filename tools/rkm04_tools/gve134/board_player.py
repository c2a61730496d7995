"""Plays the host of a unit on the virtual board, as `tools/gve134_host/gve_player.h` does that of a
simulated one: the same rules, where bytes take their time.

Lines that follow each other go one by one, each after the answer to the one before; code 1 has it
sent again, a packet from its *S. Lines with a time go beside them when the line is free, so several
may wait; answers come in order. J leaves what it finds without an answer: nothing is sent until its
own has come and 100 ms have passed.
"""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace

from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import addressed, encoded, parsed
from rkm04_tools.gve134.gcode.directives import Probe, Wait
from rkm04_tools.gve134.job import TIMED, commands_of
from rkm04_tools.gve134.report import Answer
from rkm04_tools.gve134.state import Flags
from rkm04_tools.source import Source
from rkm04_tools.transport import BITS_PER_BYTE
from rkm04_tools.virtual_board import Talk

RESET_MS = 100.0
"""So long a unit may need after J."""
REST_MS = 10.0
"""Between two looks whether the axes stand, and after the last one."""
AT_TIME = re.compile(r"@(\d+(?:\.\d+)?)[ \t]+(.*)")
SUM_CHARACTERS = 3

RESET, SUMS_ON, SUMS_OFF = "J", "%+", "%-"
ALONE = (RESET, SUMS_ON, SUMS_OFF)
"""While one of them waits for its answer nothing is sent."""
PACKET_BEGIN, PACKET_END = "*S", "*E"
ENDS_PACKET = (PACKET_END, "H", RESET)
LAST_ANSWER = ">"


@dataclass(frozen=True)
class Line:
    """A command of a line of the file. `ms`: when it is due, of one that has a time; else how long
    the host waits before it."""

    number: int
    text: str
    ms: float = 0.0
    is_timed: bool = False
    is_repeated: bool = False
    is_asked_first: bool = False
    """What the player asks of itself, and does not tell."""

    @property
    def name(self) -> str:
        """The command without address and parameters, as far as the player must know it."""
        text = addressed(self.text)[1:]
        return PACKET_END if text.startswith(PACKET_END) else text

    @property
    def is_vector(self) -> bool:
        """Whether it is L or C."""
        return self.text[0] in "LC"


@dataclass(frozen=True)
class Waiting:
    """A line that waits for its answer, and when the unit has all of it."""

    line: Line
    heard_ms: float


@dataclass
class Counts:
    """Of commands that were answered by another code than 1, or need no answer; of vectors that the
    unit has taken, of answers with code 1, and of lines without an answer because of J."""

    commands: int = 0
    vectors: int = 0
    repeats: int = 0
    unanswered: int = 0


def lines_of(source: Source) -> Iterator[Line]:
    """All lines that go to the unit. What a file asks of the host is in them, but for ;@probe."""
    wait_ms = 0.0
    for command in commands_of(source):
        if isinstance(command.asked_of_host, Probe):
            raise Failure(
                f"{source.name}:{command.line}: ;@probe: not with --target stm32; "
                "leave one of the two away"
            )
        if command.asked_of_host is not None:
            asked = command.asked_of_host
            wait_ms += 1000 * asked.seconds if isinstance(asked, Wait) else 0.0
        elif TIMED.match(command.text) and (match := AT_TIME.fullmatch(command.text)):
            text = answers.canonical(match[2].removeprefix("!0"))
            yield Line(command.line, text, float(match[1]), is_timed=True)
        else:
            yield Line(command.line, command.text, wait_ms)
            wait_ms = 0.0


class Player:
    """Sends a file from `talk.ms` on, at a rate of the line in Bd."""

    def __init__(self, talk: Talk, source: Source, baud: int) -> None:
        self.talk = talk
        self.counts = Counts()
        self.told: list[Answer] = []
        self._byte_ms = 1000 * BITS_PER_BYTE / baud
        self._begun_ms = self._free_ms = self._quiet_ms = talk.ms
        self._waiting: deque[Waiting] = deque()
        self._text, self._held = "", ""
        self._held_ms = 0.0
        self._sums = False
        timed = (line for line in lines_of(source) if line.is_timed)
        self._timed = sorted(
            (replace(line, ms=line.ms + talk.ms) for line in timed), key=lambda line: line.ms
        )
        self._lines = (line for line in lines_of(source) if not line.is_timed)
        self._again: deque[Line] = deque()
        self._packet: list[Line] = []
        self._is_packet_open = False
        self._next: Line | None = None
        self._next_waits = False
        self._next_ms = 0.0
        self._next_repeats = 0
        self._flags: Flags | None = None
        self._go_on()

    def play(self, seconds: float) -> bool:
        """Until all lines have been answered and the axes stand. False: not in that time."""
        end_ms = self._begun_ms + 1000 * seconds
        if not self._play_lines(end_ms):
            return False
        while not (self._flags and self._flags.stands):
            self._next, self._next_waits = Line(0, "F", is_asked_first=True), False
            self._next_ms = self.talk.ms + REST_MS
            if not self._play_lines(end_ms):
                return False
        self._wait(min(self.talk.ms + REST_MS, end_ms))
        return True

    @property
    def stuck(self) -> tuple[Line, str] | None:
        """The line that the others wait for, and why, as `report.STUCK` has it."""
        if self._waiting:
            line, reason = self._waiting[0].line, "no_answer"
        elif self._next is not None:
            line, reason = self._next, "time"
        elif self._timed:
            line, reason = self._timed[0], "time"
        else:
            return None
        if line.is_asked_first:
            return None
        has_repeats = line.is_repeated if line.is_timed else self._next_repeats > 0
        return line, "no_room" if has_repeats else reason

    # ---- the course of it ----

    def _play_lines(self, end_ms: float) -> bool:
        while self._waiting or self._next or self._timed:
            due_ms = self._due_ms()
            if due_ms <= self.talk.ms:
                self._act()
            elif self.talk.ms >= end_ms:
                return False
            else:
                self._hear(min(due_ms, end_ms))
        return True

    def _wait(self, until_ms: float) -> None:
        while self.talk.ms < until_ms:
            self._hear(until_ms)

    @property
    def _is_alone(self) -> bool:
        return bool(self._waiting) and self._waiting[-1].line.name in ALONE

    def _due_ms(self) -> float:
        """When there is something to do, if no answer comes before."""
        if self._is_alone:
            return self._quiet_ms if self._held else math.inf
        due_ms = self._next_ms if self._next and not self._next_waits else math.inf
        return max(min(due_ms, self._timed_ms()), self._quiet_ms, self._free_ms)

    def _timed_ms(self) -> float:
        return self._timed[0].ms if self._timed and not self._is_packet_open else math.inf

    def _act(self) -> None:
        if self._is_alone:
            self._finish_reset()
        elif self._timed_ms() <= self.talk.ms:
            line = self._timed.pop(0)
            self._await(line, self._send(line))
        elif self._next:
            self._send_next(self._next)

    def _send(self, line: Line) -> float:
        data = encoded(line.text, self._sums)
        self.talk.say(data)
        self._free_ms = self.talk.ms + len(data) * self._byte_ms
        return self._free_ms

    def _await(self, line: Line, heard_ms: float) -> None:
        self._waiting.append(Waiting(line, heard_ms))

    def _send_next(self, line: Line) -> None:
        heard_ms = self._send(line)
        if line.name == PACKET_BEGIN:
            self._packet.clear()
            self._is_packet_open = True
        if self._is_packet_open:
            self._packet.append(line)
        if self._is_packet_open and line.name not in ENDS_PACKET:
            self.counts.commands += 1
            self._go_on()
            return
        self._is_packet_open = False
        self._next_waits = True
        self._await(line, heard_ms)

    def _go_on(self) -> None:
        self._next = self._again.popleft() if self._again else next(self._lines, None)
        self._next_waits = False
        self._next_ms = self.talk.ms + (self._next.ms if self._next else 0.0)

    # ---- answers ----

    def _hear(self, until_ms: float) -> None:
        for byte in self.talk.until(until_ms).decode("latin-1"):
            if byte != "\r":
                self._text += byte
                continue
            text, self._text = self._text, ""
            self._take(text)

    def _take(self, text: str) -> None:
        ms, left = self.talk.ms, 0
        if self._is_resetting(ms):
            before, before_ms = self._held, self._held_ms
            self._held, self._held_ms = text, ms
            self._quiet_ms = ms + RESET_MS
            if not before:
                return
            text, ms, left = before, before_ms, 1
        if len(self._waiting) == left:
            self.told.append(Answer(0, 0, "", ms - self._begun_ms, text, refused=True))
            return
        self._finish(self._waiting.popleft().line, text, ms)

    def _is_resetting(self, ms: float) -> bool:
        last = self._waiting[-1] if self._waiting else None
        return last is not None and last.line.name == RESET and ms >= last.heard_ms

    def _finish_reset(self) -> None:
        """What waits before J has had no answer and will have none."""
        while len(self._waiting) > 1:
            self.counts.unanswered += 1
            if not self._waiting.popleft().line.is_timed:
                self._go_on()
        text, self._held = self._held, ""
        self._finish(self._waiting.popleft().line, text, self._held_ms)

    def _has_sum(self, name: str) -> bool:
        """Whether the answer to a command has a sum; those after it are noted."""
        has_sum = name == SUMS_ON or (self._sums and name != SUMS_OFF)
        self._sums = has_sum and name != RESET
        return has_sum

    def _finish(self, line: Line, text: str, ms: float) -> None:
        has_sum = self._has_sum(line.name)
        answer = parsed(text, has_sum)
        if answer and answer.code == answers.NO_ROOM and line.name != LAST_ANSWER:
            self._repeat(line)
            return
        is_done = answer is not None and answer.code == answers.DONE
        if line.is_asked_first:
            self._flags = Flags(int(answer.values, 16)) if answer and is_done else None
            self._next = None
            return
        self.counts.commands += 1
        if is_done:
            self._count_vectors(line)
        has_values = answer is not None and answer.values and line.name != PACKET_END
        if not is_done or has_values:
            shown = text[:-SUM_CHARACTERS] if has_sum and answer else text
            self._tell(line, shown, ms, not is_done)
        if not line.is_timed:
            self._next_repeats = 0
            self._go_on()

    def _tell(self, line: Line, text: str, ms: float, is_refused: bool) -> None:
        address = int(addressed(line.text)[0])
        command = line.text.removeprefix(f"!{address}")
        told = Answer(line.number, address, command, ms - self._begun_ms, text, is_refused)
        self.told.append(told)

    def _repeat(self, line: Line) -> None:
        self.counts.repeats += 1
        if line.is_timed:
            self._timed.insert(0, replace(line, ms=self.talk.ms, is_repeated=True))
            return
        self._next_waits = False
        self._next_repeats += 1
        if line.name == PACKET_END:
            self.counts.commands -= len(self._packet) - 1
            self._again.extend(self._packet)
            self._go_on()
        self._next_ms = self.talk.ms

    def _count_vectors(self, line: Line) -> None:
        if line.name == PACKET_END:
            self.counts.vectors += sum(each.text.startswith("C") for each in self._packet)
        else:
            self.counts.vectors += line.is_vector
