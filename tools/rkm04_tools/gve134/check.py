"""`check`: what the unit would refuse of vector files, with the places."""

from __future__ import annotations

import json
import re
import sys
from argparse import Namespace
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TextIO

from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.source import read_source
from rkm04_tools.source import LINE_END, Place, Source

SHOWN_MAX = 50
LATE_DIRECTIVE = re.compile(r"^[ \t]*[^; \t][^;\n]*(;@(?:wait|pause|probe)\b)", re.MULTILINE)
"""What is for the host, after a command: there it is a comment."""


@dataclass(frozen=True)
class Oddity:
    """A place, from 1, and what is odd there."""

    line: int
    column: int
    message: str


@dataclass(frozen=True)
class Checked:
    """A file and what the unit would refuse of it."""

    source: Source
    parsed: host.Parsed

    def report(self, out: TextIO | None = None) -> None:
        """Print the errors, each with its line and a caret, and the verdict."""
        name, errors = self.source.name, self.parsed.errors
        for error in errors[:SHOWN_MAX]:
            print(f"{name}:{error.line}:{error.column}: error: {error.message}", file=out)
            print(self.source.excerpt(Place(error.line, error.column)), file=out)
        self.warn(out)
        total = len(errors) + self.parsed.more
        if (more := total - SHOWN_MAX) > 0:
            print(f"{name}: and {_count(more, 'more error')}", file=out)
        verdict = _count(total, "error") if total else _count(self.parsed.commands, "command")
        print(f"{name}: {verdict}", file=out)

    @cached_property
    def warnings(self) -> list[Oddity]:
        """What the unit takes, and is surely not meant."""
        text = "\n".join(LINE_END.split(self.source.text))
        found = []
        for match in LATE_DIRECTIVE.finditer(text):
            number = text.count("\n", 0, match.start(1)) + 1
            column = match.start(1) - text.rfind("\n", 0, match.start(1))
            message = f"{match[1]} after a command is only a comment; give it a line of its own"
            found.append(Oddity(number, column, message))
        return found

    def warn(self, out: TextIO | None = None) -> None:
        """Print the warnings."""
        name = self.source.name
        for each in self.warnings[:SHOWN_MAX]:
            print(f"{name}:{each.line}:{each.column}: warning: {each.message}", file=out)
            print(self.source.excerpt(Place(each.line, each.column)), file=out)

    def as_json(self) -> dict[str, object]:
        """For scripts."""
        return {
            "file": self.source.name,
            "ok": not self.parsed.errors,
            "commands": self.parsed.commands,
            "errors": [asdict(error) for error in self.parsed.errors],
            "more_errors": self.parsed.more,
            "warnings": [asdict(each) for each in self.warnings],
        }


def check_source(source: Source) -> Checked:
    """Check a file that has been read."""
    return Checked(source, host.check(source.text))


def run(options: Namespace) -> int:
    """Check all files; the status is that of the worst one."""
    host.program_path()
    status, answers = DONE, []
    for path in options.files:
        try:
            source = read_source(path)
            checked = check_source(source)
        except Failure as failure:
            print(f"gve134: {failure}", file=sys.stderr)
            status = max(status, failure.status)
            continue
        status = max(status, NOT_SO if checked.parsed.errors else DONE)
        answers.append(checked.as_json())
        if not options.json:
            checked.report(sys.stdout)
    if options.json:
        print(json.dumps({"files": answers}, indent=2))
    return status


def _count(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"
