"""Bytes of the line: requests out, and out of what comes back the answer to each.

What comes is cut at CR. A line with a right checksum that cannot be the answer to a request, by
what its values look like, is skipped: it belongs to one that was given up. So is the rest of a line
that had begun to come before the request went out. A line that is damaged ends the wait: it was the
answer, as only one is under way.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import Answer, encoded, form_of, parsed
from rkm04_tools.transport import Port, seconds_on_line

PATIENCE_SECONDS = 0.5
"""For an answer to begin: 1 ms is the unit's, the rest is for converters and a busy computer."""
PACKET_OVER_SECONDS = 1.2
"""After so much silence no packet is open, and nothing is thrown away any more."""
GAP_SECONDS = 0.1
CUT_SECONDS = 0.03
"""Between two parts of an answer: what a converter makes of them."""
SLICE_SECONDS = 0.02
"""How long a wait goes on before it is looked whether it is to end."""
STALE_BYTES_MAX = 65_536
LINE_BYTES_MAX = 4096

BARE = re.compile("[24AC]")
"""What a unit without checksums answers to a command with one."""


@dataclass(frozen=True)
class Request:
    """What is sent at once and has one answer; `counts` commands if it comes whole."""

    commands: tuple[str, ...]
    form: re.Pattern[str]
    counts: int
    seconds: float

    @classmethod
    def of(cls, command: str, seconds: float = PATIENCE_SECONDS) -> Request:
        """A single command."""
        counts = 0 if answers.addressed(command)[1:].startswith(("@", ">")) else 1
        return cls((command,), form_of(command), counts, seconds)

    @classmethod
    def packet(cls, commands: Sequence[str]) -> Request:
        """Commands C and B that are taken together or not at all."""
        whole = ("*S", *commands, f"*E{len(commands)}")
        form = re.compile(f"0|{len(commands)}")
        return cls(whole, form, len(whole), PACKET_OVER_SECONDS)

    def encode(self, sums: bool) -> bytes:
        """As the line has it."""
        return b"".join(encoded(command, sums) for command in self.commands)


@dataclass
class Heard:
    """What has come since a request was sent, and was no answer to it.

    `echoes`: what was sent came back. `bare`: an answer of a unit without checksums. `other`: the
    values of an answer to something else.
    """

    damaged: int = 0
    echoes: int = 0
    bare: bool = False
    other: str = ""

    def add(self, more: Heard) -> None:
        """Take in what was heard at another time, too."""
        self.damaged += more.damaged
        self.echoes += more.echoes
        self.other = self.other or more.other

    @property
    def any(self) -> bool:
        """Whether anything has come."""
        return bool(self.damaged or self.echoes)


@dataclass(eq=False)
class Wire:
    """An open port. `sums`: whether the line has checksums now.

    `look` is called again and again while an answer is waited for, and may raise what ends that.
    """

    port: Port
    baud: int
    sums: bool = True
    clock: Callable[[], float] = time.monotonic
    look: Callable[[], None] = lambda: None
    heard: Heard = field(default_factory=Heard)
    _buffer: bytes = b""
    _sent: bytes = b""
    _cut_until: float = -math.inf
    """A line had begun to come when a request went out: until then its rest can come."""

    def exchange(self, request: Request) -> Answer | None:
        """Send once and wait; None: nothing came, or nothing that could be read."""
        data = request.encode(self.sums)
        self.write(data)
        return self.wait(request.form, seconds_on_line(len(data), self.baud) + request.seconds)

    def write(self, data: bytes) -> None:
        """Send; what has come before that is no answer to it."""
        dropped = 0
        stale = self._buffer
        while dropped < STALE_BYTES_MAX and (more := self.port.read(0)):
            dropped += len(more)
            stale = more
        if stale := stale.rstrip(b"\n"):
            self._cut_until = -math.inf if stale.endswith(b"\r") else self.clock() + CUT_SECONDS
        self._buffer = b""
        self.heard = Heard()
        self._sent = data
        self.port.write(data)

    def wait(self, form: re.Pattern[str] | None, seconds: float) -> Answer | None:
        """The first answer of a form; None: there is none in time, or it was damaged."""
        until = self.clock() + seconds
        last = until + GAP_SECONDS
        while (left := until - self.clock()) > 0:
            for line in self.lines(left):
                answer = parsed(line, self.sums)
                if form is None:
                    continue
                if answer is not None and answers.fits(answer, form):
                    return answer
                if answer is not None:
                    self.heard.other = answer.values
                elif self._is_damage(line):
                    return None
            if self._buffer:
                until = min(last, max(until, self.clock() + GAP_SECONDS))
        self.heard.damaged += bool(self._buffer)
        return None

    def _is_damage(self, line: str) -> bool:
        """Note a line that is no answer. False: it is what was sent, from a line that echoes."""
        if f"{line}\r".encode("latin-1") in self._sent:
            self.heard.echoes += 1
            return False
        self.heard.bare = self.heard.bare or BARE.fullmatch(line) is not None
        self.heard.damaged += 1
        return True

    def lines(self, seconds: float) -> list[str]:
        """The lines that come whole within a slice of the time."""
        self.look()
        came = self.port.read(min(seconds, SLICE_SECONDS)).replace(b"\n", b"")
        *lines, rest = (self._buffer + came).split(b"\r")
        self._buffer = rest[-LINE_BYTES_MAX:]
        told = [line.decode("latin-1") for line in lines]
        if told and self.clock() < self._cut_until:
            self._cut_until = -math.inf
            if parsed(told[0], sums=True) is None:
                del told[0]
        return [line for line in told if line]
