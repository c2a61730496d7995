"""Runs sessions with a GVE134 unit on the firmware, many in one process.

`build/host/bin/gve-probe` (`gve_probe.c`) runs them; `RKM04_BUILD` names another build folder.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from gve_course import Record
from gve_line import Byte
from gve_record import BYTE_TICKS, Answer, Done, Edge, Session
from motion_probe import ROOT, Missing


def begin_of(session: Session) -> list[str]:
    """How a session begins, as the probe reads it."""
    lines = [f"epoch {session.epoch}", f"ahead {session.ahead}", f"byte {BYTE_TICKS}"]
    return [*lines, f"cause {session.cause}"]


def lines_of(edges: Iterable[Edge], line: Iterable[Byte]) -> list[str]:
    """What comes to a unit, as the probe reads it."""
    lines = [f"in {edge.tick} {edge.number} {edge.level}" for edge in edges]
    return lines + [f"hear {byte.tick} {byte.value:02x} {byte.broken:d}" for byte in line]


class Probe:
    """A process that runs sessions one after the other; use it as a context."""

    def __init__(self) -> None:
        """Start the process."""
        path = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin/gve-probe"
        try:
            self._process = subprocess.Popen(
                [path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        except FileNotFoundError as error:
            raise Missing(f"{path} is not there: build the preset 'host' first") from error

    def __enter__(self) -> Probe:
        """Use it."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the process."""
        self._process.communicate()

    def run(self, session: Session) -> Done:
        """Run a session from power-on."""
        reader = Reader(session.end)
        lines = begin_of(session) + lines_of(session.edges, session.line)
        self.tell([*lines, f"run {session.end}"], reader)
        return reader.done

    def run_cut(self, session: Session, cut: int, after: Session) -> Done:
        """Run a session in which the power fails at a write of the flash, and the one after it.

        Returns what the unit did in the second one, whose ticks count from when the power was back.
        """
        lines = [*begin_of(session), f"cut {cut}", *lines_of(session.edges, session.line)]
        self.tell([*lines, f"run {session.end}"], Reader(session.end))
        reader = Reader(after.end, session.end)
        line = [replace(byte, tick=byte.tick + session.end) for byte in after.line]
        lines = ["again -", *lines_of((), line), f"run {session.end + after.end}"]
        self.tell(lines, reader)
        return reader.done

    def tell(self, lines: list[str], reader: Reader) -> None:
        """Have lines obeyed, the last of which runs the unit, and what it does read."""
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write("\n".join([*lines, ""]))
        self._process.stdin.flush()
        for line in self._process.stdout:
            if reader.read(line.split()):
                return
        raise RuntimeError(f"the probe ended with status {self._process.wait()}: {lines[-1]}")


class Reader:
    """Reads what the probe tells of a session."""

    def __init__(self, end: int, begin: int = 0) -> None:
        """Ticks count from the begin on."""
        self._from = begin
        self.done = Done(Record(end))
        self.tick = 0
        self.sent: list[tuple[int, int]] = []
        """The bytes that it has sent, each with its tick."""
        self._text = ""
        self._begin = 0

    def read(self, words: list[str]) -> bool:
        """Read one line; whether it was the last one."""
        kind = words[0]
        if kind == "sent":
            self._hear(int(words[1]) - self._from, int(words[2], 16))
        elif kind == "signal":
            self._note(" ".join(words[3:]), int(words[1]) - self._from, int(words[2]))
        elif kind == "at":
            self.tick = int(words[1])
        elif kind == "judge":
            self.done.complaints.append(" ".join(words[1:]))
        elif kind == "pulses":
            train = self.done.motors.trains[int(words[1]) - 1]
            for word in words[2:]:
                tick = int(word)
                train.add(abs(tick) - self._from, 1 if tick > 0 else -1)
        elif kind == "end" and words[1] != "0":
            self.done.complaints.append(f"{words[1]} pulses came too late")
        return kind == "end"

    def _note(self, name: str, tick: int, level: int) -> None:
        """A signal has changed; of changes at the same tick the last one counts."""
        changes = self.done.signals.setdefault(name, [])
        if changes and changes[-1][0] == tick:
            changes.pop()
        if level != (changes[-1][1] if changes else 0):
            changes.append((tick, level))

    def _hear(self, tick: int, value: int) -> None:
        """A byte of the unit has ended at a tick."""
        self.sent.append((tick, value))
        if not self._text:
            self._begin = tick - BYTE_TICKS
        if value == 13:
            self.done.answers.append(Answer(self._begin, tick, self._text))
            self._text = ""
        else:
            self._text += chr(value)
