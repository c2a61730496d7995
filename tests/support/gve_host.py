"""A host of the GVE134 unit, written from the contract alone: jobs over a line that loses bytes.

It sends packets with sums, repairs with `@` and `>`, waits where there is no room, and after an
interrupt lifts the tool and goes on as in the contract's example. It shares no code with the tool.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from gve_course import MS
from gve_live import Live

PACKET_LINES = 16
TRIES_MAX = 30
ROOM_TICKS = 20 * MS
ANSWER_TICKS = 30 * MS
RESTS = (150 * MS, 1300 * MS)
"""What a unit needs to be in step again: after damage, and in a packet that broke off."""

DONE, NO_ROOM, DAMAGED, NOTHING, BUSY = 0, 1, 2, 6, 7
INTA, RUN = 0x80, 0x40
DONE_BEFORE = {"K": NO_ROOM, "R": NOTHING, "G": NOTHING}
"""What these answer when they have been executed already."""

ONCE = ("XU", "XD")
"""Not to be sent again where it is not known whether they were executed."""

Four = tuple[int, int, int, int]


class Lost(Exception):
    """The host does not know any more what the unit has done."""


@dataclass(frozen=True)
class Told:
    """An answer: its code without INTA, INTA, and its values."""

    code: int
    inta: bool
    values: tuple[str, ...]


def sum_of(text: str) -> str:
    """The sum of a text that ends with a comma."""
    return f"{sum(text.encode('latin-1')) & 255:02X}"


def line_of(command: str) -> bytes:
    """A command for the interpolator as the line has it."""
    text = f"!0{command},"
    return f"{text}{sum_of(text)}\r".encode()


def read(came: bytes) -> Told | None:
    """The answer; None: there is none that is whole."""
    found = re.fullmatch(r"([0-9A-F])((?:,[^,]+)*),([0-9A-F]{2})\r", came.decode("latin-1"))
    if not found or sum_of(found[1] + found[2] + ",") != found[3]:
        return None
    digit = int(found[1], 16)
    return Told(digit & 7, digit > 7, tuple(found[2].split(",")[1:]))


@dataclass
class Figures:
    """What a job took."""

    vectors: int = 0
    packets: int = 0
    no_room: int = 0
    repairs: int = 0
    by_position: int = 0
    interrupts: int = 0


class Person:
    """Who stands at the machine."""

    def vectors_taken(self, count: int) -> None:
        """The unit has taken so many vectors."""

    def interrupted(self, low: int, high: int) -> None:
        """The axes stand; ST4 and ST5 tell why."""


@dataclass
class Host:
    """Sends a job, with a person who sees to interrupts."""

    line: Live
    person: Person = field(default_factory=Person)
    total: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    """Of the vectors that the unit has taken."""
    pulses: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    """That they and what the host does besides have on each axis."""
    figures: Figures = field(default_factory=Figures)
    stopped: bool = False
    _index: int = 0
    _kept_at: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    """How far from `total` the axes stand when all is done that was taken since K."""

    # ---- a command, once ----

    def connect(self) -> None:
        """Switch the sums on, whether they are on or not."""
        for _ in range(TRIES_MAX):
            self.line.send(b"!0%+,5D\r")
            told = read(self.line.receive(ANSWER_TICKS))
            if told is None:
                self._rest(1)
                self.line.send(b"!0%+\r")
                told = read(self.line.receive(ANSWER_TICKS))
            if told and told.code == DONE:
                self._index = self._ask_index()
                return
            self._rest(1)
        raise Lost("no unit")

    def ask(self, command: str) -> Told:
        """Have a command executed once."""
        return self._once([command])

    def _once(self, commands: Sequence[str], form: str = ".*") -> Told:
        """Have commands executed once that have one answer, with values of a form."""
        data = b"".join(map(line_of, commands))
        for _ in range(TRIES_MAX):
            self.line.send(data)
            told = read(self.line.receive(ANSWER_TICKS))
            if told and told.code != DAMAGED and re.fullmatch(form, ",".join(told.values)):
                self._index += len(commands)
                return told
            if (told := self._repair(commands)) is not None:
                return told
        raise Lost(f"{commands[-1]} does not get through")

    def _repair(self, commands: Sequence[str]) -> Told | None:
        """How commands ended whose answer did not come; None: they are to be sent again."""
        self.figures.repairs += 1
        self._rest(0)
        last = self._ask_last()
        before, self._index = self._index, self._ask_index()
        counted = (self._index - before) % 256
        if counted < len(commands):
            return None
        if counted > len(commands):
            raise Lost(f"{commands[-1]}: {counted} counted")
        if last is not None and last.code != DAMAGED:
            return last
        if last is not None and last.values:
            return None  # a packet of which something was damaged
        return self._end_unknown(commands)

    def _end_unknown(self, commands: Sequence[str]) -> Told | None:
        """What was executed, and its answer is lost for good."""
        command = commands[-1]
        if command in ONCE:
            raise Lost(f"{command} was executed or refused")
        if len(commands) == 1 and command[0] not in "LC":
            told = self.ask(command)
            is_done = told.code == DONE_BEFORE.get(command)
            return Told(DONE, told.inta, told.values) if is_done else told
        self.figures.by_position += 1
        while (flags := self.number("SR6")) & RUN:
            if flags & INTA:
                self._interrupted()
            self.line.receive(ROOM_TICKS)
        here = map(sum, zip(self.total, self._kept_at, strict=True))
        taken = self.positions() != tuple(here)
        return Told(DONE if taken else NO_ROOM, bool(flags & INTA), ())

    def _rest(self, which: int) -> None:
        end = self.line.now + RESTS[which]
        while self.line.now < end:
            self.line.receive(end - self.line.now)

    def _ask_last(self) -> Told | None:
        self.line.send(line_of(">"))
        return read(self.line.receive(ANSWER_TICKS))

    def _ask_index(self) -> int:
        for attempt in range(TRIES_MAX):
            self.line.send(line_of("@"))
            told = read(self.line.receive(ANSWER_TICKS))
            if told and told.code == DONE and len(told.values) == 1 and told.values[0].isdigit():
                return int(told.values[0])
            self._rest(attempt % 2)
        raise Lost("no answer to @")

    # ---- what the unit tells ----

    def number(self, command: str) -> int:
        """A byte that the unit tells in hex."""
        return int(self.ask(command).values[0], 16)

    def positions(self) -> tuple[int, ...]:
        """Where the axes are."""
        while len(values := self.ask("P4").values) != 4:
            pass
        return tuple(map(int, values))

    # ---- a job ----

    def run(self, job: Sequence[str]) -> None:
        """Send a job, and wait until the axes stand at its end."""
        at = 0
        while at < len(job):
            end = at
            while end < len(job) and end - at < PACKET_LINES and job[end][0] in "CB":
                end += 1
            if end - at > 1:
                self._send_packet(job[at:end])
            else:
                end = at + 1
                self._send_single(job[at])
            at = end
        self._send_single("L0,0,0,0")

    def _send_packet(self, lines: Sequence[str]) -> None:
        packet = ["*S", *lines, f"*E{len(lines)}"]
        while True:
            self.figures.packets += 1
            told = self._once(packet, f"0|{len(lines)}")
            if self._is_taken(told, lines):
                return

    def _send_single(self, command: str) -> None:
        while not self._is_taken(self.ask(command), [command]):
            pass

    def _is_taken(self, told: Told, lines: Sequence[str]) -> bool:
        """Count what was taken; see to an interrupt, and wait for room."""
        if told.code not in (DONE, NO_ROOM):
            raise Lost(f"{lines[-1]} is answered {told}")
        if told.code == DONE:
            self._count(lines)
        if told.inta and not self.stopped:
            self._interrupted()
        elif told.code == NO_ROOM:
            self.figures.no_room += 1
            self.line.receive(ROOM_TICKS)
        return told.code == DONE

    def _count(self, lines: Sequence[str]) -> None:
        for line in lines:
            if line[0] in "LC":
                self.figures.vectors += 1
                for axis, steps in enumerate(line[1:].split(",")):
                    self.total[axis] += int(steps)
                    self.pulses[axis] += abs(int(steps))
        self.person.vectors_taken(self.figures.vectors)

    # ---- an interrupt ----

    def _interrupted(self) -> None:
        """Keep the queue, lift the tool and lower it, go on slower."""
        self.stopped = True
        self.figures.interrupts += 1
        enabled = self.number("SR0"), self.number("SR1")
        self.person.interrupted(self.number("SR4"), self.number("SR5"))
        self._require("K", DONE)
        self.stopped = False
        self._kept_at = [a - b for a, b in zip(self.positions(), self.total, strict=True)]
        self._send_single("L0,0,-1000")
        self._send_single("L0,0,1000")
        while (told := self.ask("R")).code == BUSY:
            self.line.receive(ROOM_TICKS)
        if told.code != DONE or not told.inta:
            raise Lost(f"R is answered {told}")
        self.stopped, self._kept_at = True, [0, 0, 0, 0]
        for command in ("V5000", "XA", f"SW0,{enabled[0]:02X}", f"SW1,{enabled[1]:02X}"):
            self._require(command, DONE)
        self._require("G", DONE)
        self.stopped = False

    def _require(self, command: str, code: int) -> None:
        told = self.ask(command)
        if told.code != code:
            raise Lost(f"{command} is answered {told}")
