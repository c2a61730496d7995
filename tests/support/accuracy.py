"""How far the pulses of the firmware are from their ideal ticks, over a fixed set of moves.

Every move of `accuracy_moves.py` runs through planner and step generator (`motion_probe.c`) and is
compared with the exact reference (`reference.py`); each starts at a moment of its own, drawn with
a seed, so that nothing depends on where the timer stands. Of moves of up to 2000 pulses every pulse
is compared, after a change from the pulse before it on; of longer ones the first and the last 200,
30 on both sides of every corner, and 500 spread evenly. M1 to M4 are compared whole.

    python tests/support/accuracy.py [--json] [--seed N]
"""

from __future__ import annotations

import argparse
import json
import math
import random
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise

from accuracy_moves import GROUPS, PEERS
from motion_probe import (
    EPOCH_BITS,
    Case,
    Deviation,
    Missing,
    Move,
    Run,
    complaints,
    deviation,
    run,
    run_one,
    worst_of,
)
from reference import FRACTION_BITS, TICK_HZ

GOAL_TICKS = 1
SEED = 1962
WHOLE, ENDS, CORNERS, SPREAD = 2000, 200, 30, 500


class Wrong(Exception):
    """A run without the pulses of its move; then deviations say nothing."""


@dataclass(frozen=True)
class Group:
    """The figures of a group of moves."""

    name: str
    moves: int
    pulses: int
    worst_ticks: float
    worst_move: str


def wanted_pulses(move: Move) -> Sequence[int]:
    """Return the pulses of a move that are compared."""
    last = move.curve.last
    assert last is not None
    first = max(move.changes[0][0] - 1, 1) if move.changes else 1
    if last <= WHOLE:
        return range(min(first, last), last + 1)
    near = {*range(1, ENDS + 1), *range(last - ENDS + 1, last + 1)}
    for leg in move.curve.legs:
        for x in (math.floor(leg.x0), math.floor(leg.x1)):
            near.update(range(x - CORNERS, x + CORNERS + 2))
    near.update(1 + i * (last - 1) // (SPREAD - 1) for i in range(SPREAD))
    return sorted(k for k in near if 1 <= k <= last)


def group_of(name: str, measured: Iterable[tuple[Case, int, Deviation]]) -> Group:
    """Sum up the pulses compared in each case of a group, and the worst of them."""
    moves, pulses, worst, place = 0, 0, 0.0, ""
    for case, compared, found in measured:
        moves += 1
        pulses += compared
        if found.ticks > worst:
            worst = found.ticks
            place = f"{case.move}, pulse {found.pulse}, started at {case.epoch}"
    return Group(name, moves, pulses, round(worst, 4), place)


def measure_cases(cases: Sequence[Case]) -> Iterator[tuple[Case, int, Deviation]]:
    """Run cases and compare them; refuse runs that are not the pulses of their moves."""
    for case, made in zip(cases, run(cases), strict=True):
        refuse_wrong(case, made)
        yield case, len(made.ticks), deviation(case, made)


def refuse_wrong(case: Case, made: Run) -> None:
    """Raise if a run is not what its case asks for."""
    if wrong := complaints(case, made):
        raise Wrong(f"{wrong[0]}, started at {case.epoch}")


def measure_groups(seed: int) -> Iterator[Group]:
    """Measure group by group; each draws from a generator of its own."""
    for moves in GROUPS:
        rng = random.Random(f"{seed} {moves.__name__}")
        cases = [
            Case(move, rng.getrandbits(EPOCH_BITS), wanted_pulses(move)) for move in moves(rng)
        ]
        yield group_of(moves.__name__, measure_cases(cases))


def measure_peers(seed: int) -> tuple[Group, dict[str, dict[str, float]]]:
    """Compare M1 to M4 whole: as a group, and in the units in which others are measured."""
    rng = random.Random(f"{seed} peers")
    measured, figures = [], {}
    for name, move in PEERS.items():
        case = Case(move, rng.getrandbits(EPOCH_BITS))
        made = run_one(case)
        refuse_wrong(case, made)
        ticks = [0, *made.ticks]
        ideal = [move.curve.tick_scaled(k) for k in range(len(ticks))]
        found = worst_of(zip(range(len(ticks)), ticks, ideal, strict=True))
        measured.append((case, len(made.ticks), found))
        figures[name] = {
            "max_error_us": round(found.ticks / TICK_HZ * 1e6, 5),
            "worst_speed_error_percent": round(100 * worst_speed_error(ticks, ideal), 4),
        }
    return group_of("peers", measured), figures


def worst_speed_error(ticks: Sequence[int], ideal: Sequence[int]) -> float:
    """Return the worst error of a mean speed from one pulse to the next, as a part of it."""
    return max(
        abs((y - x) / ((b - a) << FRACTION_BITS) - 1)
        for (a, b), (x, y) in zip(pairwise(ticks), pairwise(ideal), strict=True)
    )


def measure(seed: int) -> dict[str, object]:
    """Return all figures."""
    peers, figures = measure_peers(seed)
    groups = [*measure_groups(seed), peers]
    worst = max(groups, key=lambda group: group.worst_ticks)
    return {
        "moves": sum(group.moves for group in groups),
        "pulses_compared": sum(group.pulses for group in groups),
        "worst_ticks": worst.worst_ticks,
        "worst_move": worst.worst_move,
        "goal_ticks": GOAL_TICKS,
        "seed": seed,
        "groups": [asdict(group) for group in groups],
        "peers": figures,
    }


def table(result: dict[str, object]) -> str:
    """Return the figures as text."""
    groups, peers = result["groups"], result["peers"]
    assert isinstance(groups, list)
    assert isinstance(peers, dict)
    lines = [f"{'group':20}{'moves':>8}{'pulses':>12}{'worst, ticks':>14}"]
    lines += [
        f"{g['name'].replace('_', ' '):20}{g['moves']:8}{g['pulses']:12}{g['worst_ticks']:14.4f}"
        for g in groups
    ]
    lines.append(
        f"{'all':20}{result['moves']:8}{result['pulses_compared']:12}{result['worst_ticks']:14.4f}"
    )
    lines += ["", f"worst: {result['worst_move']} (seed {result['seed']})", ""]
    lines.append(f"{'':20}{'max error, µs':>20}{'worst speed error, %':>24}")
    lines += [
        f"{name:20}{p['max_error_us']:20.5f}{p['worst_speed_error_percent']:24.4f}"
        for name, p in peers.items()
    ]
    return "\n".join(lines)


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Measures the accuracy of the step times.")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument(
        "--seed", type=int, default=SEED, help="of the moments at which moves start"
    )
    options = parser.parse_args()
    try:
        result = measure(options.seed)
    except (Missing, Wrong, subprocess.CalledProcessError) as error:
        print(f"accuracy: {error}", file=sys.stderr)
        return 1
    print(json.dumps(result) if options.json else table(result))
    return 0


if __name__ == "__main__":
    sys.exit(main())
