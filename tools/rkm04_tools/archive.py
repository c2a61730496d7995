"""The programs of all units of a line as files in a folder, and back.

A file is named `unit-03-motor-2.rks` and is an ordinary program. Restoring runs nothing: each motor
is reset, and then stopped as by K.
"""

from __future__ import annotations

import itertools
import re
import textwrap
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.check import Checked, check_source
from rkm04_tools.failure import (
    NO_CONNECTION,
    NOT_SO,
    Failure,
    finished_or_absent,
    writing_failed,
)
from rkm04_tools.line import Line, Motor, Unit
from rkm04_tools.line_errors import UnitRestarted
from rkm04_tools.messages import MOTORS
from rkm04_tools.sending import (
    Tell,
    held_commands,
    load_program,
    plan_program,
    silent,
    without_hold,
)
from rkm04_tools.source import read_source

NAME = re.compile(r"unit-(0[1-9]|1[0-6])-motor-([1-4])\.rks")
COLUMNS = 100


@dataclass(frozen=True)
class Saved:
    """A program of a motor and its file."""

    node: int
    motor: int
    path: Path
    commands: int


@dataclass(frozen=True)
class Program(Saved):
    """The same, with what is in the file."""

    checked: Checked


def backup(line: Line, folder: Path, tell: Tell = silent) -> list[Saved]:
    """Write all programs of a line to a folder that has none yet; empty memories are left out.

    All are read before the first is written: a folder with some of them would look like a backup.
    """
    if folder.is_dir() and any(NAME.fullmatch(path.name) for path in folder.iterdir()):
        raise Failure(f"{folder}: has programs of units already; choose another folder")
    found = line.scan(tell=tell)
    if not found:
        raise Failure(
            "nobody answers on addresses 1 to 16, so there is nothing to save", NO_CONNECTION
        )
    doubtful = [each for each in found if each.remark]
    if doubtful:
        raise Failure(f"unit {doubtful[0].node}: {doubtful[0].remark}; nothing was saved", NOT_SO)
    try:
        texts = _read_memories(line, [each.node for each in found], folder)
    except Failure as failure:
        failure.args = (f"{failure}; nothing was saved",)
        raise
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write_all(texts)
    except OSError as error:
        raise writing_failed(folder, error) from None
    return list(texts)


def read_folder(folder: Path) -> list[Program]:
    """Read and check all programs of a folder; the first error is raised.

    So is a name that looks like one of backup and is none: its motor would be left out unseen.
    """
    try:
        found = sorted(folder.iterdir())
    except OSError as error:
        raise Failure(
            f"{folder}: {(error.strerror or str(error)).lower()}; name a folder"
        ) from None
    paths = [path for path in found if NAME.fullmatch(path.name)]
    for path in found:
        if path not in paths and path.name.lower().startswith("unit-"):
            raise Failure(
                f"{path}: is named like no motor of a unit (unit-03-motor-2.rks: unit 01 to 16, "
                "motor 1 to 4); nothing was restored; rename it or take it away"
            )
    if not paths:
        raise Failure(f"{folder}: has no file like unit-03-motor-2.rks, as backup writes them")
    return [_read(path) for path in paths]


def restore(line: Line, programs: Sequence[Program], tell: Tell = silent) -> list[Program]:
    """Load and store programs, and read each of them back; return those whose motors moved.

    All units are looked for first, and at the end once more: one that has restarted meanwhile runs
    what it has stored.
    """
    nodes = sorted({program.node for program in programs})
    moved = []
    with ExitStack() as sessions:
        for node in nodes:
            sessions.enter_context(line.one_session(node))
            line.unit(node).version()
        for done, program in enumerate(programs):
            motor = line.unit(program.node).motor(program.motor)
            moved += [program] if motor.table() else []
            tell(done, len(programs))
            _restore_one(motor, program)
        tell(len(programs), len(programs))
        for node in nodes:
            _require_not_restarted(line.unit(node))
    return moved


def _restore_one(motor: Motor, program: Program) -> None:
    load_program(motor, program.checked)
    motor.store()
    if not plan_program(program.checked).is_held(held_commands(motor)):
        raise Failure(f"{program.path}: the unit holds another program; restore again", NOT_SO)


def _require_not_restarted(unit: Unit) -> None:
    """By any question but the version, which a session begins with."""
    try:
        unit.positions()
    except UnitRestarted:
        raise Failure(
            f"unit {unit.node} has restarted meanwhile, and runs what it has stored; "
            f"rkm04 stop --node {unit.node} stops it",
            NOT_SO,
        ) from None


def names_of(programs: Sequence[Saved]) -> str:
    """The motors of programs, in words."""
    return ", ".join(f"unit {each.node} motor {each.motor}" for each in programs) or "none"


def motors_without(programs: Sequence[Saved]) -> list[Saved]:
    """The motors of the same units that have no program among these."""
    there = {(each.node, each.motor) for each in programs}
    nodes = sorted({node for node, _ in there})
    missing = [(node, motor) for node in nodes for motor in MOTORS if (node, motor) not in there]
    return [Saved(node, motor, Path(), 0) for node, motor in missing]


def _read_memories(line: Line, nodes: Sequence[int], folder: Path) -> dict[Saved, str]:
    """What is to be written, and its text."""
    texts = {}
    for node, motor in itertools.product(nodes, MOTORS):
        commands = without_hold(held_commands(line.unit(node).motor(motor)))
        path = folder / f"unit-{node:02}-motor-{motor}.rks"
        if commands:
            texts[Saved(node, motor, path, len(commands))] = _text_of(node, motor, commands)
    return texts


def _text_of(node: int, motor: int, commands: Sequence[str]) -> str:
    filled = textwrap.fill(
        " ".join(commands), COLUMNS, break_long_words=False, break_on_hyphens=False
    )
    return f"\\ {{ unit {node}, motor {motor} }}\n{filled}\n"


def _write_all(texts: Mapping[Saved, str]) -> None:
    """Write all files, or leave none."""
    try:
        for saved, text in texts.items():
            with finished_or_absent(saved.path) as part:
                part.write_text(text, encoding="ascii")
    except BaseException:
        for saved in texts:
            saved.path.unlink(missing_ok=True)
        raise


def _read(path: Path) -> Program:
    match = NAME.fullmatch(path.name)
    assert match
    checked = check_source(read_source(path))
    if not checked.is_good:
        first = checked.diagnostics[0]
        where = f"{path}:{first.place.line}:{first.place.column}"
        raise Failure(f"{where}: {first.message}; nothing was restored", NOT_SO)
    commands = len(plan_program(checked).commands)
    return Program(int(match[1]), int(match[2]), path, commands, checked)
