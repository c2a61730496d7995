"""Instructions a vector costs the planner of paths, counted on the code the ARM compiler makes.

Compiles the stages step and path of firmware/engine for Cortex-M4 as `arm_count.py` does, and
counts what a chain of four axes costs from vector to vector: adding one, laying its section, and
handing over the segments of each axis. Counts, not cycles.

    python tests/support/path_count.py [--json]
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

from arm_count import Counter, Missing, link, load, summary

ADD, LAY, NEXT = "path_add", "path_lay_next", "path_next"
AXES = 4
SOURCES = ("base/base_[tw]i*.c", "engine/step/step_generator.c", "engine/path/*.c")

# Chains: steps of the axes 0 to 2 (axis 3: a third of axis 0), speeds in 1000 steps/s of each
# other vector, acceleration in 1000 steps/s².
CHAINS = {
    "100 steps, cruise": ((100, 99, 57), (20, 20), 8000),
    "100 steps, ramp and cruise in each": ((100, 99, 57), (20, 40), 8000),
    "100 steps, always speeding up": ((100, 99, 57), (200, 200), 8000),
    "the same, all axes alike": ((100, 100, 100), (200, 200), 8000),
}
VECTORS = 10
AHEAD = 8


def run_chain(
    counter: Counter, steps: tuple[int, int, int], speeds: tuple[int, int], accel: int
) -> dict[str, object]:
    """Counts for the first vectors of a chain: one is added for each that is handed over."""

    def add(i: int) -> None:
        counter.call("bench_add", *steps, accel << 16 | speeds[i % 2])

    counter.counts.clear()
    counter.call("bench_begin")
    for i in range(AHEAD):
        add(i)
    counter.call("bench_start")
    for name in (ADD, LAY, NEXT):
        counter.watch(name)
    handed, rest = [], 0
    for i in range(VECTORS):
        add(AHEAD + i)
        until = counter.call("bench_entry") + 1
        for axis in range(AXES):
            laid = len(counter.counts[LAY])
            while counter.call("bench_next", axis, until) & 0xFF:
                handed.append(counter.counts[NEXT][-1])
            rest += counter.counts[NEXT][-1] - sum(counter.counts[LAY][laid:])
    counts = {name: sum(counter.counts[name]) for name in (ADD, NEXT)}
    return {
        "adding a vector": summary(counter.counts[ADD]),
        "laying its section": summary(counter.counts[LAY]),
        "a segment": summary(handed),
        "segments of an axis": round(len(handed) / VECTORS / AXES, 2),
        "all of an axis": round((sum(handed) + rest) / VECTORS / AXES),
        "all of a vector": round((counts[ADD] + counts[NEXT]) / VECTORS),
    }


def measure(names: Iterable[str] = CHAINS) -> dict[str, dict[str, object]]:
    """Counts for chains."""
    with tempfile.TemporaryDirectory() as folder:
        counter = load(link(Path(folder), "path_bench.c", SOURCES))
    return {name: run_chain(counter, *CHAINS[name]) for name in names}


def main() -> int:
    parser = argparse.ArgumentParser(description="Counts instructions a vector on Cortex-M4.")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    try:
        result = measure()
    except Missing as missing:
        print(f"path_count: {missing}", file=sys.stderr)
        return 1
    if options.json:
        print(json.dumps(result))
        return 0
    for name, row in result.items():
        print(name)
        for part, counts in row.items():
            print(f"    {part:20}{counts}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
