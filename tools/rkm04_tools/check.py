"""`check`: every error and warning of program files, with their places."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from dataclasses import dataclass
from typing import Any, TextIO

from rkm04_tools import host
from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.host import Parsed, Problem, program_path, stored
from rkm04_tools.source import Place, Source, read_source

SHOWN_MAX = 50


@dataclass(frozen=True)
class Diagnostic:
    """An error or a warning about a place of a file. Errors have the unit's flag, 1 or 2.

    `end_column` is that after the command.
    """

    place: Place
    severity: str
    rule: str
    message: str
    flag: int = 0
    end_column: int = 0

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        found = {
            "line": self.place.line,
            "column": self.place.column,
            "severity": self.severity,
            "rule": self.rule,
            "message": self.message,
        }
        return {**found, "flag": self.flag} if self.flag else found


@dataclass(frozen=True)
class Checked:
    """A file, what the parser made of it, and what is to be said about it."""

    source: Source
    parsed: Parsed
    diagnostics: list[Diagnostic]

    @property
    def is_good(self) -> bool:
        """Whether the unit accepts it."""
        return self.parsed.is_good


def check_source(source: Source) -> Checked:
    """Check a text; warnings are for texts without errors only."""
    parsed = host.check(source.text)
    return Checked(source, parsed, [_diagnostic(problem) for problem in parsed.problems])


def show(source: Source, diagnostic: Diagnostic, stream: TextIO) -> None:
    """Print a diagnostic with its line, if there is anything in it, and a caret."""
    place = diagnostic.place
    where = f"{source.name}:{place.line}:{place.column}"
    print(f"{where}: {diagnostic.severity}: {diagnostic.message}", file=stream)
    if source.line(place.line).strip():
        print(source.excerpt(place), file=stream)


def show_all(checked: Checked, stream: TextIO, but: str = "") -> None:
    """Print what there is to say about a file, at most SHOWN_MAX; `but` is a rule to leave out."""
    told = [each for each in checked.diagnostics if each.rule != but]
    for diagnostic in told[:SHOWN_MAX]:
        show(checked.source, diagnostic, stream)
    if (more := len(told) - SHOWN_MAX + checked.parsed.more) > 0:
        what = "warning" if checked.is_good else "error"
        print(f"{checked.source.name}: and {_count(more, f'more {what}')}", file=stream)


def run(options: Namespace) -> int:
    """Check all files; the status is that of the worst one."""
    program_path()
    status = DONE
    answers = []
    for path in options.files:
        try:
            checked = check_source(read_source(path))
        except Failure as failure:
            print(f"rkm04: {failure}", file=sys.stderr)
            status = max(status, failure.status)
            continue
        status = max(status, DONE if checked.is_good else NOT_SO)
        answers.append(_as_json(checked))
        if not options.json:
            _report(checked)
    if options.json:
        print(json.dumps({"files": answers}, indent=2))
    return status


def _diagnostic(told: Problem) -> Diagnostic:
    place = Place(told.line, told.column)
    return Diagnostic(place, told.severity, told.rule, told.message, told.flag, told.end_column)


def _report(checked: Checked) -> None:
    show_all(checked, sys.stdout)
    errors = 0 if checked.is_good else len(checked.diagnostics) + checked.parsed.more
    commands = len(stored(checked.parsed.commands))
    verdict = _count(errors, "error") if errors else _count(commands, "command")
    warnings = 0 if errors else len(checked.diagnostics)
    noted = f", {_count(warnings, 'warning')}" if warnings else ""
    print(f"{checked.source.name}: {verdict}{noted}")


def _count(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"


def _as_json(checked: Checked) -> dict[str, Any]:
    found = [diagnostic.as_json() for diagnostic in checked.diagnostics]
    return {
        "file": checked.source.name,
        "ok": checked.is_good,
        "commands": len(stored(checked.parsed.commands)),
        "errors": [d for d in found if d["severity"] == "error"],
        "more_errors": checked.parsed.more,
        "warnings": [d for d in found if d["severity"] == "warning"],
    }
