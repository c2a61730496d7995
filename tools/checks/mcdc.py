"""Branch and MC/DC coverage of the firmware.

Runs the tests of the preset `mcdc`, which must have been built, and prints a line a stage. It
fails when a branch that can be reached was not, or when fewer conditions than MCDC_PERCENT were
shown to decide on their own. What cannot be reached is in unreachable.txt beside this file, with
its reason; assertions count nowhere.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from checks.c_source import source, words

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/mcdc"
PROFILES = BUILD / "profiles"
IMAGE_ONLY = "main.c"  # of each unit; what the tests have a main of their own for
LIST = Path(__file__).with_name("unreachable.txt")
MCDC_PERCENT = 95.0
VERSION = 19  # of clang and llvm

Place = tuple[str, int, int]  # file below firmware/, line, column


@dataclass
class Branch:
    function: str
    condition: str  # or the value of a switch, or `case NAME`, or `default`
    taken: int = 0
    passed: int = 0


@dataclass
class Stage:
    branches: dict[Place, Branch] = field(default_factory=dict)
    decisions: dict[Place, list[bool]] = field(default_factory=dict)


@dataclass(frozen=True)
class Excuse:
    """A side of a branch that no run can take."""

    file: str
    function: str
    condition: str
    side: str
    reason: str


def read_excuses(text: str) -> list[Excuse]:
    """Lines `file | function | condition | true or false | reason`."""
    excuses = []
    for line in text.splitlines():
        if line and not line.startswith("#"):
            excuses.append(Excuse(*(part.strip() for part in line.split(" | "))))
    return excuses


def assertion_lines(source: str) -> set[int]:
    """The lines of all assertions, those of several lines included; from 1."""
    lines: set[int] = set()
    for start in re.finditer(r"\b(?:static_)?assert\(", source):
        depth, end = 1, start.end()
        while depth:
            depth += {"(": 1, ")": -1}.get(source[end], 0)
            end += 1
        first = source.count("\n", 0, start.start()) + 1
        lines.update(range(first, source.count("\n", 0, end) + 2))
    return lines


def run(*command: str | Path) -> str:
    return subprocess.run(
        list(map(str, command)), check=True, stdout=subprocess.PIPE, text=True
    ).stdout


def programs() -> list[Path]:
    return sorted(p for p in (BUILD / "tests").rglob("*") if p.is_file() and os.access(p, os.X_OK))


def merge_profiles() -> Path:
    merged = BUILD / "merged.profdata"
    profiles = sorted(PROFILES.glob("*.profraw"))
    run(f"llvm-profdata-{VERSION}", "merge", "--sparse", "-o", merged, *profiles)
    return merged


def read_files(merged: Path) -> list[dict[str, Any]]:
    """What llvm-cov knows of each source, over all programs."""
    objects = [f"--object={program}" for program in programs()]
    text = run(
        f"llvm-cov-{VERSION}", "export", "--format=text", "--skip-expansions", "--skip-functions",
        f"--instr-profile={merged}", *objects,
    )  # fmt: skip
    files: list[dict[str, Any]] = json.loads(text)["data"][0]["files"]
    return files


def stage_of(name: str) -> str:
    """The folder of a source."""
    return str(PurePosixPath(name).parent)


def collect(files: Iterable[dict[str, Any]], sources: dict[str, str]) -> dict[str, Stage]:
    """The branches and decisions of our sources, without assertions; copies of a line are one."""
    stages = {stage_of(name): Stage() for name in sources}
    for file in files:
        name = os.path.relpath(file["filename"], ROOT / "firmware")
        if name not in sources:
            continue
        stage = stages[stage_of(name)]
        asserted = assertion_lines(sources[name])
        for line, column, to_line, to_column, taken, passed, *_ in file.get("branches", []):
            if line not in asserted:
                place = (name, line, column)
                if place not in stage.branches:
                    begin = offset(sources[name], line, column)
                    end = offset(sources[name], to_line, to_column)
                    function = source(sources[name]).function_at(begin)
                    stage.branches[place] = Branch(function, sources[name][begin:end])
                branch = stage.branches[place]
                branch.taken += taken
                branch.passed += passed
        for line, column, *_, shown in file.get("mcdc_records", []):
            if line not in asserted:
                merge_decision(stage.decisions, (name, line, column), shown)
    return stages


def offset(text: str, line: int, column: int) -> int:
    """A place in a text, of lines and columns from 1."""
    return sum(map(len, text.splitlines(keepends=True)[: line - 1])) + column - 1


def never_linked(files: Iterable[dict[str, Any]], sources: dict[str, str]) -> list[str]:
    """The sources that no test program has in it: of their branches nothing is known."""
    known = {os.path.relpath(file["filename"], ROOT / "firmware") for file in files}
    return [name for name in sources if name.endswith(".c") and name not in known]


def merge_decision(decisions: dict[Place, list[bool]], place: Place, shown: list[bool]) -> None:
    known = decisions.setdefault(place, [False] * len(shown))
    decisions[place] = [a or b for a, b in zip(known, shown, strict=True)]


def missing_branches(stage: Stage) -> list[tuple[Place, str]]:
    return [
        (place, side)
        for place, branch in sorted(stage.branches.items())
        for side, count in (("true", branch.taken), ("false", branch.passed))
        if count == 0
    ]


def missing_conditions(stage: Stage) -> list[tuple[Place, int]]:
    return [
        (place, index + 1)
        for place, shown in sorted(stage.decisions.items())
        for index, good in enumerate(shown)
        if not good
    ]


def line_of(place: Place, sources: dict[str, str]) -> str:
    return sources[place[0]].splitlines()[place[1] - 1].strip()


def read_sources() -> dict[str, str]:
    firmware = ROOT / "firmware"
    return {
        str(path.relative_to(firmware)): path.read_text()
        for path in sorted(firmware.rglob("*.[ch]"))
        if path.name != IMAGE_ONLY
    }


def report(stages: dict[str, Stage], sources: dict[str, str], excuses: list[Excuse]) -> bool:
    """Prints a line a stage and what is missing. Whether it is enough."""
    good = True
    unused = list(excuses)  # a row excuses one side
    print(f"{'stage':12} {'branches':>8} {'reached':>8} {'excused':>8}   conditions  shown")
    for name, stage in stages.items():
        unexcused = []
        missing = missing_branches(stage)
        for place, side in missing:
            excuse = find_excuse(unused, place[0], stage.branches[place], side)
            if excuse is None:
                unexcused.append((place, side))
            else:
                unused.remove(excuse)
        branches = 2 * len(stage.branches)
        conditions = sum(map(len, stage.decisions.values()))
        hidden = missing_conditions(stage)
        percent = 100.0 * (conditions - len(hidden)) / conditions if conditions else 100.0
        print(
            f"{name:12} {branches:8} {branches - len(missing):8} {len(missing) - len(unexcused):8}"
            f"   {conditions:10} {conditions - len(hidden):6} = {percent:.1f} %"
        )
        for place, side in unexcused:
            print(f"  never {side}: {place[0]}:{place[1]}:{place[2]}  {line_of(place, sources)}")
        for place, index in hidden:
            print(f"  condition {index} of {place[0]}:{place[1]}  {line_of(place, sources)}")
        good = good and not unexcused and percent >= MCDC_PERCENT
    for excuse in unused:
        row = " | ".join((excuse.file, excuse.function, excuse.condition, excuse.side))
        print(f"excused but reached, or not there: {row}")
        good = False
    return good


def find_excuse(excuses: list[Excuse], file: str, branch: Branch, side: str) -> Excuse | None:
    wanted = (file, branch.function, words(branch.condition), side)
    for excuse in excuses:
        if (excuse.file, excuse.function, words(excuse.condition), excuse.side) == wanted:
            return excuse
    return None


def run_tests() -> bool:
    """Every test program once, each with a profile of its own. Whether all passed."""
    shutil.rmtree(PROFILES, ignore_errors=True)
    environment = {**os.environ, "LLVM_PROFILE_FILE": str(PROFILES / "%p-%m.profraw")}
    done = subprocess.run(
        ["ctest", "--preset", "mcdc"], cwd=ROOT, env=environment, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
    )  # fmt: skip
    if done.returncode != 0:
        print(done.stdout)
    return done.returncode == 0


def main() -> int:
    if not run_tests():
        return 1
    sources = read_sources()
    files = read_files(merge_profiles())
    good = report(collect(files, sources), sources, read_excuses(LIST.read_text()))
    for name in (unknown := never_linked(files, sources)):
        print(f"in no test: {name}")
    return 0 if good and not unknown else 1


if __name__ == "__main__":
    sys.exit(main())
