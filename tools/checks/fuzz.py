"""Runs the fuzzers: replays the corpora of the tree, then explores from them; counts the runs.

What a fuzzer finds is told with the input that does it, which is kept in build/fuzz/found; what it
explores stays in build/fuzz/explored, so that the next exploration goes on from there.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "fuzz"
CORPUS = ROOT / "tests" / "fuzz" / "corpus"
NICE = 15
WORKERS = min(os.cpu_count() or 1, 2)
RUN_SECONDS_MAX = 5
RUNS = re.compile(r"^stat::number_of_executed_units:\s*(\d+)", re.MULTILINE)

INPUT_BYTES_MAX = {
    "frames": 100,
    "gve": 250,
    "gve-unit": 250,
    "interpreter": 80,
    "message": 250,
    "modbus": 250,
    "path": 200,
    "pos-unit": 250,
    "program": 96,
    "unit": 250,
}
"""The fuzzers, and how long an input may get: short ones find as much and run more often."""


@dataclass(frozen=True)
class Result:
    """What a fuzzer did."""

    runs: int
    output: str
    good: bool


def run(name: str, seconds: int, seed: int) -> Result:
    """Replay the corpus of a fuzzer, and with `seconds` explore from it."""
    explored = BUILD / "explored" / name
    found = BUILD / "found"
    explored.mkdir(parents=True, exist_ok=True)
    found.mkdir(exist_ok=True)
    folders = [explored, CORPUS / name] if seconds else [CORPUS / name]
    command = [
        "nice", "-n", str(NICE), str(BUILD / "bin" / f"fuzz-{name}"), *map(str, folders),
        "-print_final_stats=1", f"-artifact_prefix={found}/{name}-",
        f"-timeout={RUN_SECONDS_MAX}", f"-max_len={INPUT_BYTES_MAX[name]}",
        f"-max_total_time={seconds}" if seconds else "-runs=0", f"-seed={seed}",
    ]  # fmt: skip
    done = subprocess.run(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, errors="replace", check=False,
    )  # fmt: skip
    counted = RUNS.search(done.stdout)
    return Result(int(counted[1]) if counted else 0, done.stdout, done.returncode == 0)


def replay_and_run(name: str, seconds: int, seed: int) -> list[Result]:
    """The corpus alone, then the exploration."""
    return [run(name, each, seed) for each in ((0, seconds) if seconds else (0,))]


def explore(seconds: int, seed: int = 0) -> int:
    """Run all fuzzers, two at a time; return how many have found something."""
    failed = total = 0
    with ThreadPoolExecutor(WORKERS) as pool:
        names = list(INPUT_BYTES_MAX)
        done = pool.map(replay_and_run, names, [seconds] * len(names), [seed] * len(names))
    for name, results in zip(INPUT_BYTES_MAX, done, strict=True):
        for result in results:
            total += result.runs
            if not result.good:
                failed += 1
                print("\n".join(result.output.splitlines()[-60:]))
                print(f"fuzz-{name} failed")
        print(f"   fuzz-{name}: {result.runs:,} runs".replace(",", " "), flush=True)
    print(f"   {total:,} runs of fuzzers".replace(",", " "))
    return failed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=int, default=0, help="explore for so long, each")
    parser.add_argument(
        "--seed", type=int, default=0,
        help="the same sources and corpora get the same inputs in the same order; 0: others",
    )  # fmt: skip
    options = parser.parse_args()
    return 1 if explore(options.seconds, options.seed) else 0


if __name__ == "__main__":
    sys.exit(main())
