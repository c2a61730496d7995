"""What was seen, and the report of it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from rkm04_tools.table import table

GOOD, BAD, NOTE = "good", "BAD", "note"
"""Of what was seen: as expected, not so, or only to be read."""
DONE, LEFT_OUT, NOT_DONE = "done", "left out", "not done"
HEAD = ("", "what", "seen", "expected")


@dataclass(frozen=True)
class Seen:
    """One thing that was looked at."""

    what: str
    seen: str
    expected: str
    verdict: str


def compared(what: str, seen: str, expected: str, good: bool) -> Seen:
    return Seen(what, seen, expected, GOOD if good else BAD)


def noted(what: str, seen: str, remark: str = "") -> Seen:
    return Seen(what, seen, remark, NOTE)


@dataclass
class Part:
    """A step in the report."""

    name: str
    state: str = NOT_DONE
    seen: list[Seen] = field(default_factory=list)


@dataclass
class Report:
    """All of them, in order; what was not done is there, too."""

    board: str
    port: str
    parts: list[Part]

    @property
    def begun(self) -> bool:
        return any(part.seen or part.state != NOT_DONE for part in self.parts)

    @property
    def complete(self) -> bool:
        return all(part.state == DONE for part in self.parts)

    @property
    def looked(self) -> bool:
        """Whether anything was seen at all."""
        return any(part.seen for part in self.parts)

    @property
    def bad(self) -> list[tuple[str, Seen]]:
        """Step and what was seen in it."""
        return [(p.name, s) for p in self.parts for s in p.seen if s.verdict == BAD]

    def as_object(self) -> dict[str, Any]:
        """For `--json`."""
        return {
            "board": self.board,
            "port": self.port,
            "complete": self.complete,
            "good": self.looked and not self.bad,
            "steps": [asdict(part) for part in self.parts],
        }

    def as_text(self) -> str:
        """For people."""
        lines = [f"bring-up of {self.board} at {self.port}"]
        for part in self.parts:
            lines += ["", f"{part.name}: {part.state}"]
            if part.seen:
                lines.append(rows_of(part.seen))
        return "\n".join([*lines, "", self.result()])

    def result(self) -> str:
        """The last line."""
        missing = [part.name for part in self.parts if part.state != DONE]
        bad = [f"{name} ({seen.what})" for name, seen in self.bad]
        good = "nothing bad was seen" if self.looked else "nothing was seen"
        said = [f"BAD: {', '.join(bad)}" if bad else good]
        if missing:
            said.append(f"NOT DONE: {', '.join(missing)}")
        return "; ".join(said)


def rows_of(seen: list[Seen]) -> str:
    rows = [(s.verdict, s.what, s.seen, s.expected) for s in seen]
    return table([HEAD, *rows], "llll")
