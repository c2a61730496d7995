"""Plants the bugs of tests/planted one at a time in a copy of the tree: is each one caught?

A bug has a name, a line that says what is wrong, and one that names the smallest test that must
fail: `Caught by: ctest NAME` or `Caught by: pytest NODE`; then come its changes of functions, as
c_changes.py reads them. A bug that does not compile is not caught, as no test saw it.
"""

from __future__ import annotations

import argparse
import filecmp
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from checks.c_changes import Change, read_block
from checks.c_source import Mismatch

ROOT = Path(__file__).resolve().parents[2]
LIST = ROOT / "tests" / "planted" / "bugs.txt"
COPY = ROOT / "build" / "planted" / "tree"
PARTS = (
    "CMakeLists.txt",
    "CMakePresets.json",
    "LICENSE",
    "README.md",
    "firmware",
    "hal",
    "tests",
    "tools",
)
C_SECONDS_MAX = 30  # that a test may take; a loop without end is caught by then
PYTHON_SECONDS_MAX = 300
HEAD = re.compile(r"([a-z0-9-]+): (.+\.)")
CAUGHT_BY = re.compile(r"Caught by: (ctest|pytest) (\S+)")
STATUS_SOME_FAILED = 1  # of pytest; others mean that no test ran


@dataclass(frozen=True)
class Bug:
    """What is wrong, the test that sees it, and the changes that make it so."""

    name: str
    what: str
    runner: str
    test: str
    changes: tuple[Change, ...]

    def __str__(self) -> str:
        return f"{self.name}: {self.what}"


def read(block: str) -> Bug:
    """The bug of a block of the list."""
    lines = block.splitlines()
    first, second = [*lines, "", ""][:2]
    head, caught = HEAD.fullmatch(first), CAUGHT_BY.fullmatch(second)
    if head is None or caught is None:
        raise Mismatch(f"`NAME: What is wrong.` and `Caught by: ...` must be the head of: {block}")
    places: list[list[str]] = []
    for line in lines[2:]:
        if line[:1] in "-+ " and places:
            places[-1].append(line)
        else:
            places.append([line])
    changes = [change for place in places for change in read_block(place)[0]]
    if not changes:
        raise Mismatch(f"{head[1]}: nothing is changed")
    return Bug(head[1], head[2], caught[1], caught[2], tuple(changes))


def bugs(names: list[str] | None = None) -> list[Bug]:
    """All bugs, or those that are named."""
    blocks = re.sub(r"^#.*\n", "", LIST.read_text(), flags=re.MULTILINE).strip().split("\n\n")
    there = [read(block) for block in blocks]
    if unknown := set(names or []) - {bug.name for bug in there}:
        raise Mismatch(f"there is no bug {', '.join(sorted(unknown))}")
    return [bug for bug in there if not names or bug.name in names]


def changed(bug: Bug, folder: Path) -> dict[Path, str]:
    """The files of a folder as they are with a bug; a Mismatch if it does not fit them."""
    after = {}
    for file, changes in groupby(bug.changes, lambda change: change.file):
        if not (folder / file).is_file():
            raise Mismatch(f"there is no file {file}")
        text = (folder / file).read_text()
        for change in changes:
            text = change.apply(text)
        after[folder / file] = text
    return after


def environment() -> dict[str, str]:
    """What the copy's builds and tests are run with: nothing of the tree that was copied."""
    return {
        **os.environ,
        "RKM04_BUILD": str(COPY / "build" / "host"),
        "PYTHONPATH": str(COPY / "tools"),
        "CCACHE_BASEDIR": str(COPY),
        "HYPOTHESIS_STORAGE_DIRECTORY": str(COPY / "build" / "cache" / "hypothesis"),
    }


def call(seconds: float, *command: str | Path) -> subprocess.CompletedProcess[str]:
    """Run a command in the copy, for so long at most."""
    return subprocess.run(
        list(map(str, command)), cwd=COPY, env=environment(), stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
        timeout=seconds,
    )  # fmt: skip


def copy_changed(source: str, target: str) -> None:
    """Copy a file that has changed; others keep their time, and so what was built of them."""
    if not (Path(target).exists() and filecmp.cmp(source, target, shallow=False)):
        shutil.copy(source, target)


def copy_tree() -> None:
    """Bring the copy up to date."""
    for part in PARTS:
        if (ROOT / part).is_file():
            COPY.mkdir(parents=True, exist_ok=True)
            copy_changed(str(ROOT / part), str(COPY / part))
            continue
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(
            ROOT / part, COPY / part, ignore=ignored, copy_function=copy_changed, dirs_exist_ok=True
        )
        for path in (COPY / part).rglob("*"):
            if path.is_file() and not (ROOT / path.relative_to(COPY)).exists():
                path.unlink()


def build(targets: set[str]) -> str:
    """Build targets for the host; what the build complains of."""
    command = ["cmake", "--build", str(COPY / "build/host"), "--target", *sorted(targets)]
    done = subprocess.run(
        command,
        cwd=COPY,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    return "" if done.returncode == 0 else done.stdout


def target(bug: Bug) -> str:
    """What must be built for the test of a bug."""
    return bug.test if bug.runner == "ctest" else "programs"


def test_fails(bug: Bug) -> bool | None:
    """Whether the test of a bug fails; None where it has not been run."""
    try:
        if bug.runner == "ctest":
            stage = bug.test.partition(".")[0]
            program = COPY / "build" / "host" / "tests" / stage / bug.test
            return call(C_SECONDS_MAX, program).returncode != 0
        status = call(
            PYTHON_SECONDS_MAX, sys.executable, "-P", "-m", "pytest", "-q", "-x",
            "-c", "tools/pyproject.toml", "--rootdir", COPY, bug.test,
        ).returncode  # fmt: skip
    except subprocess.TimeoutExpired:
        return True
    return status == STATUS_SOME_FAILED if status in (0, STATUS_SOME_FAILED) else None


def plant(bug: Bug) -> str:
    """Plant a bug, try its test and take the bug out again; what is wrong if it was not caught."""
    try:
        after = changed(bug, COPY)
    except Mismatch as error:
        return f"it no longer fits: {error}"
    before = {path: path.read_text() for path in after}
    try:
        write(after)
        if complaint := build({target(bug)}):
            return f"it does not compile: {complaint[-2000:]}"
        fails = test_fails(bug)
        if fails is None:
            return f"{bug.test} was not run"
        return "" if fails else f"{bug.test} does not see it"
    finally:
        write(before)


def write(files: dict[Path, str]) -> None:
    for path, text in files.items():
        path.write_text(text)


def prepare(chosen: list[Bug]) -> list[str]:
    """Copy and build the tree as it is, and run the tests: without a bug all must pass."""
    copy_tree()
    if not (COPY / "build" / "host" / "build.ninja").exists():
        done = call(PYTHON_SECONDS_MAX, "cmake", "--preset", "host")
        if done.returncode != 0:
            return [done.stdout]
    if complaint := build({target(bug) for bug in chosen}):
        return [complaint]
    tests = {bug.test: bug for bug in chosen}
    return [
        f"{test} does not pass without a bug"
        for test, bug in tests.items()
        if test_fails(bug) is not False
    ]


def main() -> int:
    parser = argparse.ArgumentParser(
        description="Plants bugs and looks whether the tests catch them."
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="of a bug (all)")
    try:
        chosen = bugs(parser.parse_args().names)
    except Mismatch as error:
        parser.error(str(error))
    if complaints := prepare(chosen):
        print("\n".join(complaints))
        return 1
    caught = 0
    for bug in chosen:
        started = time.monotonic()
        complaint = plant(bug)
        caught += not complaint
        print(f"{complaint or 'caught'} ({time.monotonic() - started:.1f} s): {bug}", flush=True)
    print(f"{caught} of {len(chosen)} planted bugs caught")
    return 0 if caught == len(chosen) else 1


if __name__ == "__main__":
    sys.exit(main())
