"""Runs Structured Text: the blocks of a source, as `blark` parses it, become Python classes.

Only what tools/plc/positioning.st uses is known: types, functions, function blocks and programs;
assignments, calls of blocks, IF. All types are checked when a source is read, as an IEC compiler
does it. What is not known raises Unsuitable.

    blocks = Blocks(source)
    axis, move = blocks.make("POS_AXIS"), blocks.make("MC_MoveRelative")
    move.call(Axis=axis, Execute=True, Distance=1.5)
    move["Busy"]
"""

from __future__ import annotations

import fcntl
import pickle
from hashlib import sha256
from itertools import chain
from pathlib import Path
from typing import Any, ClassVar

import blark
from blark import transform as tree
from blark.parse import parse_source_code
from st_expressions import Scope, python_name
from st_statements import body_lines
from st_values import ELEMENTARY, Unsuitable, fitted, initial, nearest, shifted

KEPT = Path(__file__).resolve().parents[2] / "build" / "structured-text"


class Instance:
    """A structure, or an instance of a block; its variables go by their names in the source."""

    types: ClassVar[dict[str, Any]]
    inputs: ClassVar[list[str]]

    def __getitem__(self, name: str) -> Any:
        return getattr(self, python_name(name))

    def __setitem__(self, name: str, value: Any) -> None:
        kind = self.types[name.upper()]
        if kind in ELEMENTARY - {"BOOL", "LREAL"}:
            fitted(kind, value)
        setattr(self, python_name(name), value)

    def call(self, **values: Any) -> None:
        """One call of a block; inputs that are not given stay as they were."""
        for name, value in values.items():
            self[name] = value
        self.run()

    def run(self) -> None:
        raise NotImplementedError


def items_of(source: str) -> list[Any]:
    """What a source declares. The library takes ten seconds to parse, so one process does it for
    all, and the others wait."""
    digest = sha256(f"{blark.__version__}\n{source}".encode()).hexdigest()
    KEPT.mkdir(parents=True, exist_ok=True)
    with (KEPT / digest).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        kept = KEPT / f"{digest}.pickle"
        if kept.exists():
            return list(pickle.loads(kept.read_bytes()))
        parsed = parse_source_code(source)
        if parsed.exception is not None:
            raise Unsuitable(str(parsed.exception))
        items = list(parsed.transform().items)
        part = kept.with_suffix(".part")
        part.write_bytes(pickle.dumps(items))
        part.replace(kept)
        return items


class Rise:
    """R_TRIG of the standard."""

    def __init__(self) -> None:
        self.clk_ = self.q_ = self.before = False

    def run(self) -> None:
        self.q_ = self.clk_ and not self.before
        self.before = self.clk_


class Blocks:
    """All that sources declare."""

    def __init__(self, *sources: str) -> None:
        self.declared: dict[str, Any] = {}
        for item in chain.from_iterable(map(items_of, sources)):
            inner = item.declaration if isinstance(item, tree.DataTypeDeclaration) else item
            self.declared[str(inner.name).upper()] = inner
        self.scopes = {name: self.scope(item) for name, item in self.declared.items()}
        self.python: dict[str, Any] = {
            "Instance": Instance, "fitted": fitted, "nearest": nearest, "shifted": shifted,
            "make": self.make, "r_trig_": Rise,
        }  # fmt: skip
        for name, item in self.declared.items():
            exec(self.source(name, item), self.python)

    def make(self, name: str) -> Any:
        """A structure, or an instance of a block, as at the start of a PLC."""
        return self.python[python_name(name)]()

    def signature(self, name: str) -> dict[str, dict[str, str]]:
        """The inputs, outputs and in-outs of a block, with their types; names as written."""
        return self.scopes[name.upper()].signature

    def scope(self, item: Any) -> Scope:
        """The variables of one declaration."""
        scope = Scope(str(item.name), self.declared)
        if isinstance(item, tree.StructureTypeDeclaration):
            scope.declare("structure", item.declarations)
        elif isinstance(item, tree.Function):
            scope.result = str(item.return_type.type.type).upper()
        if not isinstance(item, tree.StructureTypeDeclaration):
            for part in item.declarations:
                scope.declare(type(part).__name__, part.items)
        return scope

    def source(self, name: str, item: Any) -> str:
        """The Python of one declaration."""
        scope = self.scopes[name]
        scope.all_scopes = self.scopes
        if isinstance(item, tree.Function):
            return function_source(name, item, scope)
        lines = [f"class {python_name(name)}(Instance):", f"    types = {scope.types!r}"]
        lines += ["    def __init__(self):"]
        lines += [f"        self.{python_name(n)} = {code}" for n, code in starts(scope)]
        if not isinstance(item, tree.StructureTypeDeclaration):
            lines += ["    def run(self):", *body_lines(item.body, scope, "        ")]
        return "\n".join(lines) + "\n"


def starts(scope: Scope) -> list[tuple[str, str]]:
    """The variables of a declaration, with the Python of what they are at the start."""
    lines = []
    for name, kind in scope.types.items():
        if name in scope.references:
            code = "None"
        elif isinstance(kind, tuple):
            code = f"[{initial(kind[1])!r}] * {kind[0]}"
        elif kind not in ELEMENTARY:
            code = f"make({kind!r})"
        elif name in scope.values:
            code = scope.assigned(kind, scope.values[name])
        else:
            code = repr(initial(kind))
        lines.append((name, code))
    return lines


def function_source(name: str, item: Any, scope: Scope) -> str:
    """The Python of a function: its variables are attributes of an object of its own."""
    inputs = ", ".join(python_name(n) for n in scope.signature["inputs"])
    lines = [f"def {python_name(name)}({inputs}):", "    class self: pass"]
    lines += [f"    self.{python_name(n)} = {code}" for n, code in starts(scope)]
    lines += [f"    self.{python_name(n)} = {python_name(n)}" for n in scope.signature["inputs"]]
    lines += [f"    self.{python_name(name)} = {initial(scope.result)!r}"]
    scope.types[name] = scope.result
    lines += [*body_lines(item.body, scope, "    "), f"    return self.{python_name(name)}"]
    return "\n".join(lines) + "\n"
