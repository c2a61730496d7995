"""Looks into the Cortex-M4 objects of the firmware for what must not be there.

    python -m checks.arm_check --stage step a.obj b.obj --stage base c.obj ... [--report FILE]

It fails on floating point (helper calls and instructions), on the heap, on mutable file-level
state, on recursion, and on 64-bit division helpers in whatever the step stage may call. The table
that it prints has the size of every stage and its largest stack frame.

The calls come from the .ci files that gcc leaves beside the objects (-fcallgraph-info=su). A call
through a function pointer has no callee there: recursion and division in one stay unseen.
"""

from __future__ import annotations

import argparse
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

from rkm04_tools.objects import Graph, binutil, short

FLOAT_HELPER = re.compile(
    r"__aeabi_(c?[fd]|u?[il]2[fd]|h2)\w*|__\w+([sd]f|[sd]c)\w*"
    r"|(sqrt|sin|cos|tan|atan2?|exp2?|log(10|2)?|pow|floor|ceil|l?l?(round|rint)|trunc"
    r"|fabs|fmod|fmin|fmax|hypot|cbrt)[fl]?"
)
HEAP = re.compile(r"malloc|calloc|realloc|free|aligned_alloc|strdup|strndup|_sbrk|_\w+_r")
DIVISION_64 = re.compile(r"__aeabi_u?ldivmod|__u?(div|mod|divmod)di[34]")
FLOAT_INSTRUCTION = re.compile(r"\s+[0-9a-f]+:\t(v[\w.]+)")
FUNCTION_HEADING = re.compile(r"[0-9a-f]+ <(.+)>:")
MUTABLE_SYMBOL = re.compile(r"[0-9a-f]+ (?:[0-9a-f]+ )?[bBdDCgGsS] (.+)")


@dataclass
class Stage(Graph):
    """What the objects of one stage hold, and what is wrong with them."""

    name: str
    text: int = 0
    rodata: int = 0
    ram: int = 0
    errors: list[str] = field(default_factory=list)

    def add_object(self, path: Path) -> None:
        self._add_sizes(path)
        self.add_calls(path.with_suffix(".ci"))
        for line in binutil("nm", "--undefined-only", "--format=just-symbols", path):
            if FLOAT_HELPER.fullmatch(line):
                self._error(path, f"floating point: calls {line}")
            if HEAP.fullmatch(line):
                self._error(path, f"heap: calls {line}")
        for line in binutil("nm", "--defined-only", path):
            if match := MUTABLE_SYMBOL.fullmatch(line):
                self._error(path, f"mutable file-level state: {match[1]}")
        function = ""
        for line in binutil("objdump", "-d", "--no-show-raw-insn", path):
            if match := FUNCTION_HEADING.fullmatch(line):
                function = match[1]
            elif match := FLOAT_INSTRUCTION.match(line):
                self._error(path, f"floating point: {match[1]} in {function}")

    def _error(self, path: Path, what: str) -> None:
        self.errors.append(f"{self.name}/{path.stem}: {what}")

    def _add_sizes(self, path: Path) -> None:
        for line in binutil("size", "-A", path):
            section, *rest = line.split() or [""]
            kind = section.lstrip(".").split(".")[0]
            if kind == "text":
                self.text += int(rest[0])
            elif kind == "rodata":
                self.rodata += int(rest[0])
            elif kind in ("data", "bss", "COMMON"):
                self.ram += int(rest[0])


def paths_from(function: str, calls: dict[str, set[str]]) -> dict[str, list[str]]:
    """Everything that a function may call, each with a shortest chain of calls that leads there."""
    chains = {function: [function]}
    found: dict[str, list[str]] = {}
    pending = [function]
    while pending:
        caller = pending.pop(0)
        for callee in sorted(calls.get(caller, ())):
            if callee not in found:
                found[callee] = chains[caller] + [callee]
                chains.setdefault(callee, found[callee])
                pending.append(callee)
    return found


def call_errors(stages: list[Stage]) -> list[str]:
    calls: dict[str, set[str]] = {}
    for stage in stages:
        for caller, callees in stage.calls.items():
            calls.setdefault(caller, set()).update(callees)
    errors = []
    reported: set[str] = set()
    for stage in stages:
        for function in stage.frames:
            found = paths_from(function, calls)
            if function in found and function not in reported:
                reported.update(found[function])
                errors.append(f"{stage.name}: recursion: {chain(found[function])}")
            if stage.name == "engine/step":
                for callee in filter(DIVISION_64.fullmatch, found):
                    errors.append(f"step: 64-bit division: {chain(found[callee])}")
    return errors


def chain(functions: list[str]) -> str:
    return " -> ".join(map(short, functions))


def table(stages: list[Stage]) -> str:
    rows = [f"{'stage':<12} {'text':>7} {'rodata':>7} {'ram':>5} {'stack':>6}  largest frame"]
    for stage in stages:
        function, frame = max(stage.frames.items(), key=lambda item: item[1], default=("-", 0))
        rows.append(
            f"{stage.name:<12} {stage.text:>7} {stage.rodata:>7} {stage.ram:>5} {frame:>6}"
            f"  {short(function)}"
        )
    total = [sum(getattr(stage, name) for stage in stages) for name in ("text", "rodata", "ram")]
    rows.append(f"{'total':<12} {total[0]:>7} {total[1]:>7} {total[2]:>5}         bytes")
    return "\n".join(rows)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--stage", nargs="+", action="append", required=True,
                        metavar=("NAME", "OBJECT"))  # fmt: skip
    parser.add_argument("--report", type=Path, help="where to write the table, if all is well")
    options = parser.parse_args(arguments)
    stages = []
    for name, *objects in options.stage:
        stage = Stage(name)
        for path in map(Path, objects):
            stage.add_object(path)
        stages.append(stage)
    print(table(stages))
    errors = [error for stage in stages for error in stage.errors] + call_errors(stages)
    for error in errors:
        print(f"arm-check: {error}", file=sys.stderr)
    if errors:
        return 1
    if options.report:
        options.report.write_text(table(stages) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
