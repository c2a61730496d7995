"""`check`: every error and warning of program files, with their places."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from dataclasses import dataclass
from typing import Any, TextIO

from rkm04_tools.complaint import describe, without_comments
from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.host import Parsed, opcode_rows, parse, program_path
from rkm04_tools.lint import Remark, lint, stored
from rkm04_tools.source import Place, Source, read_source

SHOWN_MAX = 50


@dataclass(frozen=True)
class Diagnostic:
    """An error or a warning about a place of a file. Errors have the unit's flag, 1 or 2."""

    place: Place
    severity: str
    rule: str
    message: str
    flag: int = 0

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
        return not self.parsed.errors


def check_source(source: Source, described: int | None = None) -> Checked:
    """Parse a text; warnings are for texts without errors only.

    Only the first of many errors are put into words if a number to be `described` is given.
    """
    parsed = parse(source.message)
    if parsed.errors:
        rows = opcode_rows()
        errors = without_comments(source.text, parsed.errors)
        found = [
            Diagnostic(
                source.place(error.offset),
                "error",
                "value" if error.flag == 1 else "command",
                describe(source.text, error, rows),
                error.flag,
            )
            for error in errors[:described]
        ]
        return Checked(source, parsed, found)
    return Checked(source, parsed, [_warning(source, remark) for remark in lint(parsed.commands)])


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
        what = "error" if checked.parsed.errors else "warning"
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


def _warning(source: Source, remark: Remark) -> Diagnostic:
    return Diagnostic(source.place(remark.offset), "warning", remark.rule, remark.message)


def _report(checked: Checked) -> None:
    show_all(checked, sys.stdout)
    errors = len(checked.diagnostics) + checked.parsed.more if checked.parsed.errors else 0
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
