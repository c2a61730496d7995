"""Runs every test and check of the project; tools/test prepares the machine and calls this.

A C test counts once, from its run in the first preset; its runs in the other presets are one check
each. The Python tests wait for most of their time, so the checks that need nothing from them run
beside them.
"""

from __future__ import annotations

import argparse
import io
import os
import re
import secrets
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import MappingProxyType

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
FUZZ_SECONDS = 1  # of exploration, each fuzzer
FUZZ_SEED = 1  # the same inputs in each run of some minutes; a long one tries others
LONG_MINUTES = 4  # the same with --long
SOAK_MINUTES = 24 * 60  # of unit time, with --long
NICENESS = 10  # of what runs beside the Python tests
TRIED_AGAIN = 6  # Python tests that may have failed for a busy machine; more is no accident
SWEEPS = {"RKM04_LONG": "1", "RKM04_PROGRAMS": "11000", "RKM04_JOB": "100000"}  # with --long

UNITY_SUMMARY = re.compile(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", re.MULTILINE)
UNITY_SKIP = re.compile(r"^(?:.*/)?(.+:\d+:.+:IGNORE.*)$", re.MULTILINE)
PYTHON = [sys.executable, "-P", "-m"]
CONFIG = "tools/pyproject.toml"
PYTEST = [*PYTHON, "pytest", "-q", "-c", CONFIG, "--rootdir", str(ROOT)]
ENVIRONMENT = {
    **os.environ,
    "RKM04_BUILD": str(BUILD / "host"),
    "HYPOTHESIS_STORAGE_DIRECTORY": str(BUILD / "cache/hypothesis"),
}
CHANCE = {"RKM04_SEED": os.environ.get("RKM04_SEED") or str(secrets.randbelow(2**32))}
"""Of Python tests, which may be tried once more."""


@dataclass(frozen=True)
class Count:
    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def __add__(self, other: Count) -> Count:
        return Count(
            self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped
        )

    def __str__(self) -> str:
        return f"{self.passed} passed, {self.failed} failed, {self.skipped} skipped"


def succeeds(
    *command: str | Path, show: bool = False, more: Mapping[str, str] = MappingProxyType({})
) -> bool:
    """Runs a command; shows what it printed only if it fails, or if asked to."""
    done = subprocess.run(
        list(map(str, command)), cwd=ROOT, env={**ENVIRONMENT, **more}, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
    )  # fmt: skip
    if done.stdout.strip() and (show or done.returncode != 0):
        print(done.stdout.strip())
    if done.returncode != 0:
        print(f"failed with status {done.returncode}: {' '.join(map(str, command))}")
    return done.returncode == 0


def check(*command: str | Path) -> Count:
    return Count(passed=1) if succeeds(*command) else Count(failed=1)


def count_program(case: ElementTree.Element) -> Count:
    """What one Unity program counted; a crash, or a sanitizer's complaint, is one more failure."""
    output = case.findtext("system-out") or ""
    if summaries := UNITY_SUMMARY.findall(output):
        tests, failures, ignored = map(int, summaries[-1])
    else:
        tests, failures, ignored = (1, 0, 0) if case.get("status") == "run" else (0, 0, 0)
    crashed = case.get("status") != "run" and failures == 0
    return Count(tests - failures - ignored, failures + crashed, ignored)


def build(preset: str) -> bool:
    return succeeds("cmake", "--preset", preset) and succeeds(
        "cmake", "--build", "--preset", preset
    )


def c_tests(preset: str) -> Count:
    if not build(preset):
        return Count(failed=1)
    results = BUILD / preset / "ctest.xml"
    results.unlink(missing_ok=True)
    succeeds(
        "ctest", "--preset", preset, "--output-junit", results,
        "--test-output-size-passed", "1000000", "--test-output-size-failed", "1000000",
    )  # fmt: skip
    if not results.exists():
        return Count(failed=1)
    count = Count()
    for case in ElementTree.parse(results).iter("testcase"):
        count += count_program(case)
    return count


def c_tests_once(preset: str) -> Count:
    count = c_tests(preset)
    if count.skipped:
        for reason in UNITY_SKIP.findall((BUILD / preset / "ctest.xml").read_text()):
            print(f"skipped: {reason}")
    return count


def c_tests_again(preset: str) -> Count:
    count = c_tests(preset)
    return Count(passed=1) if count.failed == 0 else Count(failed=count.failed)


def arm_check() -> Count:
    if not build("arm-check"):
        return Count(failed=1)
    report = BUILD / "arm-check/arm_check.txt"
    print(report.read_text().rstrip() if report.exists() else "no firmware sources yet")
    return Count(passed=1)


def pytest(*options: str) -> Count:
    results = BUILD / "pytest.xml"
    results.unlink(missing_ok=True)
    command = [
        *PYTEST, "--junitxml", str(results), "--hypothesis-profile", "ci", *options, "tests",
    ]  # fmt: skip
    status = subprocess.run(
        command, cwd=ROOT, env={**ENVIRONMENT, **CHANCE}, stdin=subprocess.DEVNULL
    ).returncode
    suite = ElementTree.parse(results).getroot().find("testsuite") if results.exists() else None
    if suite is None:
        return Count(failed=1)
    tests, failures, errors, skipped = (
        int(suite.get(name, "0")) for name in ("tests", "failures", "errors", "skipped")
    )
    failed = failures + errors
    if failed == 0 and status not in (0, 5):  # 5: there are no tests
        failed = 1
    return Count(max(tests - failures - errors - skipped, 0), failed, skipped)


def python_tests() -> Count:
    """Two processes more than there are cores, as they mostly wait.

    Many talk to real processes against the clock. The few that fail are tried once more, one after
    the other, when the machine is less busy; pytest names them both times. What they draw at random
    is the same again, so what they find by that is found again.
    """
    processes = str((os.cpu_count() or 1) + 2)
    count = pytest("--numprocesses", processes, "--dist", "loadfile")
    if not 0 < count.failed <= TRIED_AGAIN:
        return count
    print(f"   {count}; what failed, once more:", flush=True)
    again = pytest("--last-failed", "--last-failed-no-failures", "none")
    if again.passed + again.failed != count.failed:
        return count
    return Count(count.passed + again.passed, again.failed, count.skipped)


def fuzzers(seconds: int) -> Count:
    """A check for the corpora and the exploration from them; what it prints are the runs."""
    if not build("fuzz"):
        return Count(failed=1)
    seed = FUZZ_SEED if seconds == FUZZ_SECONDS else 0
    command = [
        sys.executable, "-P", "tools/checks/fuzz.py",
        "--seconds", str(seconds), "--seed", str(seed),
    ]  # fmt: skip
    good = succeeds(*command, show=True)
    return Count(passed=1) if good else Count(failed=1)


def mcdc() -> Count:
    """A check: it runs the C tests again, from the second compiler, and reads what they reached."""
    if not build("mcdc"):
        return Count(failed=1)
    good = succeeds(*PYTHON, "checks.mcdc", show=True)
    return Count(passed=1) if good else Count(failed=1)


def sweeps() -> Count:
    """The tests that a run of some minutes does at some places only, at all of them."""
    stored = [
        "ctest",
        "--preset",
        "host",
        "-V",
        "-R",
        "power_cut|store_sweep|line_splits|pos_motion",
    ]
    random = [
        *PYTEST, "-rP", "--numprocesses", "logical",
        "tests/property", "tests/proofs", "tests/vboard", "tests/wasm",
    ]  # fmt: skip
    count = Count()
    for command in (stored, random):
        good = succeeds(*command, show=True, more=SWEEPS)
        count += Count(passed=1) if good else Count(failed=1)
    return count


def soak(minutes: int) -> Count:
    count = Count()
    for program, *more in (("rkm04-soak", "--twice"), ("positioning-soak",)):
        command = [str(BUILD / "host/bin" / program), "--minutes", str(minutes), *more]
        count += Count(passed=1) if succeeds(*command, show=True) else Count(failed=1)
    return count


def c_layout() -> Count:
    """All C as .clang-format has it; the annotations of proofs are laid out by hand."""
    from checks.house import project_files  # not at the top: --help comes before any set-up

    sources = [path for path in project_files() if path.suffix in (".c", ".h")]
    formatter = Path(sys.executable).with_name("clang-format")
    return check(formatter, "--dry-run", "--Werror", "--style=file", *sources)


def python_style() -> Count:
    folders = ["tools", "tests"]
    return (
        check(*PYTHON, "ruff", "check", "--config", CONFIG, *folders)
        + check(*PYTHON, "ruff", "format", "--check", "--config", CONFIG, *folders)
        + check(*PYTHON, "mypy", "--config-file", CONFIG, "tools", "tests")
    )


def begin_proofs(script: str, *options: str) -> Callable[[], Count]:
    """Starts proofs, which take minutes of one core, beside what needs no more than another.

    What it returns waits for their end: one line for each; status 77 means that a tool is missing,
    or that contracts have changed since they were proved, which the long run does.
    """
    BUILD.mkdir(exist_ok=True)
    log = BUILD / f"{script}.log"
    with log.open("w") as output:
        process = subprocess.Popen(
            ["nice", sys.executable, ROOT / "tests/support" / script, *options], cwd=ROOT,
            stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
        )  # fmt: skip

    def end() -> Count:
        status = process.wait()
        print(log.read_text(), end="")
        if status == 77:
            return Count(skipped=1)
        return Count(passed=1) if status == 0 else Count(failed=1)

    return end


def has_tiny_limits() -> bool:
    return any("RKM04_TINY_LIMITS" in path.read_text() for path in ROOT.glob("firmware/**/*.h"))


def steps_beside() -> dict[str, Callable[[], Count]]:
    """The checks that need no more than the sources."""
    chosen: dict[str, Callable[[], Count]] = {
        "House limits": lambda: check(sys.executable, "tools/checks/house.py"),
        "Layout of C (clang-format)": c_layout,
        "Python style and types": python_style,
        "Static analysis (clang-tidy, complexity, MISRA)": lambda: (
            check(*PYTHON, "checks.static") + check(*PYTHON, "checks.misra")
        ),
        "Objects for Cortex-M4 (arm-check)": arm_check,
    }
    if has_tiny_limits():
        chosen["C tests with tiny limits (tiny)"] = lambda: c_tests_again("tiny")
    chosen["C tests from the second compiler under sanitizers, branches, decisions (mcdc)"] = mcdc
    return chosen


@dataclass(frozen=True)
class Outcome:
    """What a step counted, what it has not printed yet, and how long it took."""

    count: Count
    text: str
    seconds: float


def take(step: Callable[[], Count]) -> Outcome:
    started = time.monotonic()
    count = step()
    return Outcome(count, "", time.monotonic() - started)


def taken(chosen: Mapping[str, Callable[[], Count]]) -> dict[str, Callable[[], Outcome]]:
    return {title: partial(take, step) for title, step in chosen.items()}


def take_beside(title: str) -> Outcome:
    """A step in a process of its own, whose words are kept."""
    with redirect_stdout(io.StringIO()) as text:
        outcome = take(steps_beside()[title])
    return Outcome(outcome.count, text.getvalue(), outcome.seconds)


def stand_back() -> None:
    """A process beside leaves the cores to the Python tests, and ends at Ctrl+C."""
    os.nice(NICENESS)
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def begin_beside(pool: ProcessPoolExecutor) -> dict[str, Callable[[], Outcome]]:
    """Starts these checks, one after the other; what it returns waits for each."""
    return {title: pool.submit(take_beside, title).result for title in steps_beside()}


def build_fuzzers() -> bool:
    """Called in the process beside."""
    return build("fuzz")


def steps(
    pool: ProcessPoolExecutor, quick: bool, fuzz_seconds: int = FUZZ_SECONDS
) -> dict[str, Callable[[], Outcome]]:
    first: dict[str, Callable[[], Count]] = {
        "C tests (host)": lambda: c_tests_once("host"),
        "Python tests": python_tests,
    }
    if quick:
        return taken(first)
    every = ["--all"] if fuzz_seconds > FUZZ_SECONDS else []
    contracts = begin_proofs("prove.py", *(every or ["--minutes", "0"]))
    models = begin_proofs("line_model.py", *every)
    last: dict[str, Callable[[], Count]] = {"Proofs": lambda: contracts() + models()}
    if fuzz_seconds > FUZZ_SECONDS:
        last["Sweeps at every place"] = sweeps
        last["A day of a unit"] = lambda: soak(SOAK_MINUTES)
    beside = begin_beside(pool)
    built = pool.submit(build_fuzzers)  # they explore by the clock: once the cores are theirs

    def explore() -> Count:
        built.result()
        return fuzzers(fuzz_seconds)

    last["Fuzzers (fuzz)"] = explore
    return taken(first) | beside | taken(last)


def long_steps() -> dict[str, Callable[[], Count]]:
    def shown(*module: str) -> Count:
        good = succeeds(*PYTHON, *module, show=True)
        return Count(passed=1) if good else Count(failed=1)

    return {
        "Static analysis across functions": lambda: shown("checks.static", "--deep"),
        "Planted bugs (host, stm32)": lambda: shown("checks.planted"),
        "Mutation (host)": lambda: shown("checks.mutation", "--jobs", "2"),
    }


def main() -> int:
    parser = argparse.ArgumentParser(prog="tools/test", description="Runs every test and check.")
    parser.add_argument(
        "--quick", action="store_true", help="the C tests and the Python tests only"
    )
    parser.add_argument(
        "--long", type=int, nargs="?", const=LONG_MINUTES, metavar="MINUTES",
        help=f"plants bugs, mutates, and each fuzzer explores for so long ({LONG_MINUTES})",
    )  # fmt: skip
    options = parser.parse_args()
    total = Count()
    fuzz_seconds = options.long * 60 if options.long else FUZZ_SECONDS
    more = taken(long_steps()) if options.long and not options.quick else {}
    pool = ProcessPoolExecutor(1, initializer=stand_back)
    try:
        for title, step in (steps(pool, options.quick, fuzz_seconds) | more).items():
            print(f"== {title}", flush=True)
            outcome = step()
            print(outcome.text, end="")
            print(f"   {outcome.count}; {outcome.seconds:.1f} s\n", flush=True)
            total += outcome.count
    finally:
        pool.shutdown(cancel_futures=True)
    print(total)
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main())
