"""The line to a bring-up image: text commands of one letter, and answers with a sum."""

from __future__ import annotations

import time
import zlib
from dataclasses import dataclass

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.line_errors import GarbledAnswer, NoAnswer
from rkm04_tools.transport import Transport

VERSION = "4"
"""Of commands and answers; bringup_main.c has the same."""
READY, ASK_NAME = "ready", "h"
STARTED = b"ready bringup-"
TRIES = 3
ANSWER_SECONDS = 2.0
"""From one byte of an answer to the next."""
WHOLE_SECONDS = 5.0
"""For a whole answer, and for the line to be quiet before it."""
QUIET_SECONDS = 0.02
LINE_BYTES_MAX = 200
GARBLED = "something came back, but no whole answer of a bring-up image"


class Refused(Failure):
    """The image understands a command and does not do it."""

    def __init__(self, command: str, why: str) -> None:
        super().__init__(f"the image does not do {command}: {why}", NOT_SO)
        self.why = why


@dataclass(frozen=True)
class Answer:
    """Lines of a name and values."""

    rows: list[list[str]]

    def words(self, name: str) -> list[str]:
        """The values of a line; of the first, if there are more."""
        for row in self.rows:
            if row[0] == name:
                return row[1:]
        raise GarbledAnswer(f"the answer has no line {name}: an image of another version?")

    def word(self, name: str) -> str:
        """The only value of a line."""
        return (self.words(name) or [""])[0]

    def numbers(self, name: str, base: int = 10) -> list[int]:
        """The values as numbers."""
        try:
            return [int(word, base) for word in self.words(name)]
        except ValueError:
            raise GarbledAnswer(f"{' '.join(self.words(name))} is no {name}") from None

    def number(self, name: str, base: int = 10) -> int:
        """The only value as a number."""
        return (self.numbers(name, base) or [0])[0]


class Talk:
    """Asks, and asks again where something was lost."""

    def __init__(self, transport: Transport) -> None:
        self.port = transport.name
        self._transport = transport
        self._buffer = b""
        self.asked = 0.0
        """When the last command was sent."""
        self.started = False
        """Whether the image has said, without being asked, that it has started."""

    def ask(self, command: str, tries: int = TRIES) -> Answer:
        """Send a command; the answer, its sum being right."""
        heard = False
        for _ in range(tries):
            heard = self._drain() or heard
            self._transport.write(f"\n{command}\n".encode())
            self.asked = time.monotonic()
            answer, some = self._answer(command)
            heard = heard or some
            if answer is not None:
                return answer
        if heard:
            raise GarbledAnswer(f"{self.port}: {GARBLED}")
        raise NoAnswer(f"{self.port}: no answer")

    def wait_ready(self, seconds: float) -> float | None:
        """How long it took until the image said that it had started; None: too long."""
        begin = time.monotonic()
        while (left := begin + seconds - time.monotonic()) > 0:
            line = self._line(left)
            if line is not None and READY in line:
                return time.monotonic() - begin
        return None

    def _answer(self, command: str) -> tuple[Answer | None, bool]:
        """What has come, and whether anything has."""
        rows: list[list[str]] = []
        total, heard = 0, False
        end = time.monotonic() + WHOLE_SECONDS
        while time.monotonic() < end and (line := self._line(ANSWER_SECONDS)) is not None:
            heard = heard or line not in ("", command)
            words = line.split()
            if line == command or not words:
                continue  # an adapter that hears itself
            self.started |= words[0] == READY and command != ASK_NAME
            if words[:2] == ["end", command[0]]:
                whole = words[2:] == [f"{total:08x}"]
                return (Answer(rows) if whole else None), True
            if words[0] == "error":
                if words[1:2] == [command[0]]:
                    raise Refused(command, " ".join(words[2:]))
                return None, True
            rows.append(words)
            total = zlib.crc32(f"{line}\n".encode("latin-1"), total)
        return None, heard

    def _line(self, seconds: float) -> str | None:
        """A line; None if so long nothing comes."""
        while b"\n" not in self._buffer:
            data = self._transport.read(seconds)
            if not data:
                return None
            self._buffer += data
            if len(self._buffer) > LINE_BYTES_MAX and b"\n" not in self._buffer:
                self._buffer = b"\n"
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line.decode("latin-1").strip("\r")

    def _drain(self) -> bool:
        """What comes unasked is no answer, but may be the word of a board that has started. Whether
        it does not end."""
        came, self._buffer = self._buffer, b""
        end = time.monotonic() + WHOLE_SECONDS
        while (quiet := time.monotonic() < end) and (data := self._transport.read(QUIET_SECONDS)):
            came += data
        self.started |= self.asked > 0 and STARTED in came
        return not quiet
