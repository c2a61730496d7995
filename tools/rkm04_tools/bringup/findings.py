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


def bad_before(seen: list[Seen]) -> list[Seen]:
    """Of a try that is repeated: what is bad now and then is bad, too."""
    bad = [f"{each.what.strip()}: {each.seen}" for each in seen if each.verdict == BAD]
    return [noted("bad before", what) for what in bad]


@dataclass
class Part:
    """A step in the report."""

    name: str
    state: str = NOT_DONE
    seen: list[Seen] = field(default_factory=list)

    @property
    def bad(self) -> list[str]:
        """What was bad; what stands below something else with the name of that."""
        found, head = [], ""
        for seen in self.seen:
            below = seen.what.startswith(" ")
            head = head if below else seen.what
            if seen.verdict == BAD:
                found.append(f"{head}: {seen.what.strip()}" if below else head)
        return found


@dataclass
class Report:
    """All of them, in order; what was not done is there, too."""

    board: str
    port: str
    parts: list[Part]
    when: str = ""
    """Date and time at the begin."""

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
    def bad(self) -> list[str]:
        """Each step in which something was, and what."""
        return [f"{part.name} ({what})" for part in self.parts for what in part.bad]

    def as_object(self) -> dict[str, Any]:
        """For `--json`."""
        return {
            "board": self.board,
            "port": self.port,
            "when": self.when,
            "complete": self.complete,
            "good": self.looked and not self.bad,
            "steps": [asdict(part) for part in self.parts],
        }

    def as_text(self) -> str:
        """For people."""
        lines = [f"bring-up of {self.board} at {self.port}, {self.when}"]
        for part in self.parts:
            lines += ["", f"{part.name}: {part.state}"]
            if part.seen:
                lines.append(rows_of(part.seen))
        return "\n".join([*lines, "", self.result()])

    def result(self) -> str:
        """The last line."""
        missing = [part.name for part in self.parts if part.state != DONE]
        good = "nothing bad was seen" if self.looked else "nothing was seen"
        said = [f"BAD: {', '.join(self.bad)}" if self.bad else good]
        if missing:
            said.append(f"NOT DONE: {', '.join(missing)}")
        return "; ".join(said)


def rows_of(seen: list[Seen]) -> str:
    rows = [(s.verdict, s.what, s.seen, s.expected) for s in seen]
    return table([HEAD, *rows], "llll")
