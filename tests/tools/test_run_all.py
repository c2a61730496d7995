"""What tools/test counts from one C test program, and how it tells of what runs side by side."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import pytest
from checks import run_all
from checks.run_all import NICENESS, TRIED_AGAIN, Count, count_program, python_tests


@pytest.mark.parametrize(
    ("status", "output", "count"),
    [
        ("run", "5 Tests 0 Failures 2 Ignored\nOK", Count(3, 0, 2)),
        ("fail", "5 Tests 1 Failures 0 Ignored\nFAIL", Count(4, 1, 0)),
        ("fail", "5 Tests 0 Failures 0 Ignored\nOK\nleaked 8 bytes", Count(5, 1, 0)),
        ("fail", "a.c:1:test_a:PASS\nsegmentation fault", Count(0, 1, 0)),
        ("notrun", "", Count(0, 1, 0)),
        ("run", "not a Unity program", Count(1, 0, 0)),
    ],
)
def test_a_program_counts_its_tests_and_its_crash(status: str, output: str, count: Count) -> None:
    case = ElementTree.Element("testcase", status=status)
    ElementTree.SubElement(case, "system-out").text = output

    assert count_program(case) == count


@pytest.mark.parametrize(
    ("runs", "count"),
    [
        ([Count(9, 0, 1)], Count(9, 0, 1)),
        ([Count(7, 2, 1), Count(2)], Count(9, 0, 1)),
        ([Count(7, 2, 1), Count(1, 1)], Count(8, 1, 1)),
        ([Count(7, 2, 1), Count(failed=1)], Count(7, 2, 1)),
        ([Count(6, TRIED_AGAIN + 1)], Count(6, TRIED_AGAIN + 1)),
    ],
)
def test_few_python_tests_that_fail_are_tried_once_more(
    monkeypatch: pytest.MonkeyPatch, runs: list[Count], count: Count
) -> None:
    left = iter(runs)
    monkeypatch.setattr(run_all, "pytest", lambda *_: next(left))

    assert python_tests() == count
    assert list(left) == []


SEEDS = """
import subprocess
from pathlib import Path
from checks import run_all

def run(_command, *, env, **_options):
    print(env.get("RKM04_SEED"))
    return subprocess.CompletedProcess([], 1)

subprocess.run = run
run_all.BUILD = Path("nowhere")
run_all.python_tests()
"""


def test_what_tests_draw_is_the_same_when_they_are_tried_once_more() -> None:
    environment = {name: value for name, value in os.environ.items() if name != "RKM04_SEED"}
    command = [sys.executable, "-P", "-c", SEEDS]

    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)

    first, second = (line for line in done.stdout.splitlines() if not line.startswith(" "))
    assert first.isdigit()
    assert first == second


SIDE_BY_SIDE = """
import os, sys, time
from checks import run_all
from checks.run_all import Count

def says(words, count):
    def step(*_):
        time.sleep(0.2 * (words == "tests"))
        print(words, os.nice(0))
        return count
    return step

run_all.c_tests_once = says("C", Count(2))
run_all.python_tests = says("tests", Count(3, 0, 1))
run_all.begin_proofs = lambda *_: says("proofs", Count(1))
run_all.build = lambda preset: True
run_all.fuzzers = says("fuzzers", Count(1))
run_all.steps_beside = lambda: {"Good": says("good", Count(1)), "Bad": says("bad", Count(0, 1))}
sys.argv = ["tools/test", *sys.argv[1:]]
sys.exit(run_all.main())
"""


def side_by_side(*options: str) -> tuple[int, list[str]]:
    """The status of a run of such steps, and what it prints without titles and times."""
    done = subprocess.run(
        [sys.executable, "-P", "-c", SIDE_BY_SIDE, *options], capture_output=True, text=True
    )
    assert done.stderr == ""
    lines = [line.strip().split(";")[0] for line in done.stdout.splitlines()]
    return done.returncode, [line for line in lines if line and not line.startswith("==")]


def test_what_runs_beside_is_told_in_its_place_and_counts() -> None:
    nice = os.nice(0)
    yielding = min(19, nice + NICENESS)
    status, lines = side_by_side()

    assert status == 1
    assert lines == [
        f"C {nice}", "2 passed, 0 failed, 0 skipped",
        f"tests {nice}", "3 passed, 0 failed, 1 skipped",
        f"good {yielding}", "1 passed, 0 failed, 0 skipped",
        f"bad {yielding}", "0 passed, 1 failed, 0 skipped",
        f"proofs {nice}", f"proofs {nice}", "2 passed, 0 failed, 0 skipped",
        f"fuzzers {nice}", "1 passed, 0 failed, 0 skipped",
        "9 passed, 1 failed, 1 skipped",
    ]  # fmt: skip


def test_nothing_runs_beside_a_quick_run() -> None:
    assert side_by_side("--quick") == (
        0,
        [*side_by_side()[1][:4], "5 passed, 0 failed, 1 skipped"],
    )
