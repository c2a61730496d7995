"""A file on its way: how far it is, and what the unit executes of it now."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.gve134.service.files import File
from rkm04_tools.gve134.service.saying import WORDS
from rkm04_tools.gve134.state import Flags, Positions

SENDING, FINISHING, WAITS, HELD, DONE, FAILED = (
    "sending", "finishing", "waits", "held", "done", "failed",
)  # fmt: skip
UNDER_WAY = (SENDING, FINISHING, WAITS)


@dataclass
class Work:
    """A file that was started. `text` is what a person is asked, `trouble` what has stopped it."""

    file: File
    sender: Sender
    begin: Positions
    at: int | None = 0
    """The vector of its course that is executed; None: it is not known."""
    phase: str = SENDING
    text: str = ""
    trouble: Failure | None = None

    @property
    def is_under_way(self) -> bool:
        """Whether it is being sent, or its last vectors are executed."""
        return self.phase in UNDER_WAY

    @property
    def is_open(self) -> bool:
        """Whether it is, or may be gone on with."""
        return self.is_under_way or self.phase == HELD

    def as_json(self) -> dict[str, Any]:
        """What all browsers know of it."""
        return {
            "file": self.file.number,
            "name": self.file.name,
            "phase": self.phase,
            "text": self.text,
            "trouble": self.trouble and WORDS.told(self.trouble),
            "begin": self.begin,
        }

    def see(self, positions: Positions, is_at_rest: bool) -> list[Positions]:
        """Take in positions; the corners that the axes have passed since the last ones."""
        course, executed = self.file.course, self.sender.executed
        if course is None or executed is None:
            return []
        if is_at_rest:
            executed.stood(positions)
        done = self.sender.look(positions)
        before, self.at = self.at, None if done is None else int(course.counts[done])
        if self.at is None or before is None:
            return []
        place, corners = np.array(executed.place), []
        for number in range(self.at, before, -1):
            x, y, z, a = (int(each) for each in place)
            corners.append((x, y, z, a))
            place = place - course.parts[number - 1]
        return corners[::-1]

    def progress(self, flags: Flags, factor: float | None) -> dict[str, Any] | None:
        """How far it is; None: nothing is known of that."""
        file, at = self.file, self.at
        if file.course is None or file.seconds is None or not len(file.course):
            return None
        taken = int(file.course.counts[self.sender.sent])
        if at is None:
            return {"at": None, "line": None, "level": None, "sent": taken, "left_s": None}
        left = float(np.sum(file.seconds[at:])) / (factor or 1.0)
        runs = at < len(file.course) and (at < taken or not flags.stands)
        line = int(file.course.lines[at]) if runs else None
        return {
            "at": at,
            "line": line,
            "level": taken - at,
            "sent": taken,
            "left_s": round(left, 1) if factor is not None else None,
        }
