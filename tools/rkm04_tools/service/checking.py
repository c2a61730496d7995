"""What is wrong with a program, with places for an editor, and the examples."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from rkm04_tools.check import Checked, Diagnostic, check_source
from rkm04_tools.failure import Failure
from rkm04_tools.host import stored
from rkm04_tools.inputs import read_inputs
from rkm04_tools.service.trouble import as_json
from rkm04_tools.source import Source, read_source
from rkm04_tools.tree import ROOT

NAME = "the program"
PROBLEMS_MAX = 100
EXAMPLES = ROOT / "tools" / "examples"


def check(text: str) -> dict[str, Any]:
    """The errors, or else the warnings, and what is stored of it.

    `more`: so many of them are not told. `listing`: line, column and canonical text of each stored
    command, in the order of their ordinals from 1. `resets`: it forgets what the unit had before.
    """
    checked = check_source(Source(NAME, text))
    told = checked.diagnostics[:PROBLEMS_MAX]
    kept = stored(checked.parsed.commands) if checked.is_good else []
    return {
        "problems": [_problem(each) for each in told],
        "more": len(checked.diagnostics) - len(told) + checked.parsed.more,
        "commands": len(stored(checked.parsed.commands)),
        "listing": [[each.line, each.column, each.text] for each in kept],
        "resets": any(each.opcode == "RESET" for each in checked.parsed.commands),
    }


def first_error(checked: Checked) -> dict[str, Any] | None:
    """The first error of a program that the unit would refuse."""
    if checked.is_good:
        return None
    first = checked.diagnostics[0]
    return as_json(
        Failure(f"{first.message}; correct it, then send again"),
        line=first.place.line,
        column=first.place.column,
    )


@cache
def examples() -> list[dict[str, Any]]:
    """The examples, each with what its inputs do."""
    paths = sorted(EXAMPLES.glob("*.rks"), key=lambda path: path.name)
    return [_example(path) for path in paths]


def _example(path: Path) -> dict[str, Any]:
    inputs = path.with_suffix(".csv")
    rows = read_inputs(inputs) if inputs.exists() else []
    return {"name": path.name, "text": read_source(path).text, "inputs": rows}


def _problem(diagnostic: Diagnostic) -> dict[str, Any]:
    place = diagnostic.place
    return {
        "line": place.line,
        "column": place.column,
        "end_column": diagnostic.end_column,
        "severity": diagnostic.severity,
        "message": diagnostic.message,
    }
