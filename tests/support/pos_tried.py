"""Random sessions with the positioning unit, tried by their seeds.

`PYTHONPATH=tools:tests/support build/venv/bin/python -P -m pos_tried 5231 40000-40999` holds the
session of a seed, and those of a range of seeds, against the model, and tells those that it cannot
decide and those in which the two differ; `--text` tells what comes in each, too.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from pos_model import compare
from pos_run import run_session
from pos_sessions import session
from pos_words import MS, Mismatch, Unsure


@dataclass
class Tried:
    """What sessions have shown."""

    count: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)
    """In which the two differ, and how."""
    unsure: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        """Tell all of it."""
        head = f"sessions held against the model: {dict(self.count)}"
        return "\n".join((head, *self.unsure, *self.wrong))

    def take(self, seed: int) -> None:
        """Try the session of a seed."""
        spoken, done = run_session(session(seed))
        try:
            compare(spoken, done, MS)
        except Unsure as reason:
            self.count["unsure"] += 1
            self.unsure.append(f"session {seed} is open: {reason}")
        except Mismatch as mismatch:
            self.count["wrong"] += 1
            self.wrong.append(f"session {seed} differs: {mismatch}")
        else:
            self.count["compared"] += 1
            self.count["registers"] += sum(len(sample.values) for sample in done.samples)
            self.count["pulses"] += sum(len(train.ticks) for train in done.trains)


def tried(seeds: Iterable[int]) -> Tried:
    """Try the sessions of some seeds."""
    found = Tried()
    for seed in seeds:
        found.take(seed)
    print(found)
    return found


def _seeds(words: list[str]) -> Iterator[int]:
    for word in words:
        first, _, last = word.partition("-")
        yield from range(int(first), int(last or first) + 1)


def main() -> int:
    """Run; 1: in some sessions the two differ."""
    parser = argparse.ArgumentParser(prog="pos_tried", description=__doc__)
    parser.add_argument("seeds", nargs="+", metavar="SEED|FIRST-LAST")
    parser.add_argument("--text", action="store_true", help="tell what comes in each session")
    chosen = parser.parse_args()
    seeds = list(_seeds(chosen.seeds))
    if chosen.text:
        for seed in seeds:
            print(session(seed).text)
    return 1 if tried(seeds).wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
