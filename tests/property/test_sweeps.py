"""Stops and changes of speed at every pulse of reference moves, through the whole unit.

Each run is compared with the model of the language and the exact reference: the pulses, the place
where the motor stands, what the program does next, and after `K` and `C75` the rest of the move.
A run of some minutes tries one place at each pulse, `RKM04_LONG=1` all, and more pairs of pulses.
"""

from __future__ import annotations

import os
import random
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import pytest
from chance import epoch
from language_model import compare
from language_signals import MS, Difference, Unsure
from program_probe import Edge, Probe, Request, Script

LONG = bool(os.environ.get("RKM04_LONG"))
PAIRS = 10_000 if LONG else 60
"""So many pairs of pulses and actions of each kind of move are tried, of some 100 000."""

GO_ON_MS = 400
"""From the last action to the `C75` after it: longer than any ramp here."""

MOVES = {
    "short": "S100 V900 A9000 F3 R",
    "constant": "S300 V200 A9000 B25 R",
    "triangular": "S100 V2000 A9000 F60 R",
    "trapezoidal": "S100 V500 A9000 F70 R",
    "compound": "T53 S90 V900 A4000 F20 Y V16000 A1 F1 Y V250 A12000 F15 Y V1200 A9000 F24 Y R",
    "slow sections": "T54 S500 V300 A8000 B20 Y V900 B30 Y V40 B2 Y R",
    "endless": "S100 V800 A9000 G+",
    "limit": "S400 (8",
    "guarded": "M7 N6 S100 V700 A9000 F50 R",
    "jog": "S100 V900 A9000 G-",
}
PULSES_MAX, JOG_PULSES_MAX = 80, 15
"""Of a run without end; of the jog, whose curve is the same, what matters is how it is ended."""

INPUT_BEGIN = (Edge(0, 2, 1), Edge(0, 6, 1))
"""N2 and N6 guard inputs that are 1 at first."""

SETUP = "\\ M1 N2 X3 "
AFTER = {move: " U T1 W7 S200 F4 R T2" if move != "jog" else "" for move in MOVES}
"""The program around each move: guards and a total stop before it, more to do after it."""


@dataclass(frozen=True)
class Action:
    """What happens at a pulse: a message to a motor, or an edge of an input."""

    name: str
    text: str = ""
    edge: tuple[int, int] | None = None
    motor: int = 1


STOPS = (
    Action("K", "K"),
    Action("\\", "\\ C100 T5 F3 R"),
    Action("M", edge=(1, 1)),
    Action("N", edge=(2, 0)),
    Action("X", edge=(3, 1)),
)
SPEEDS = tuple(Action(f"V{v}", f"V{v}") for v in (1, 60, 100, 101, 300, 16_000))
SIMULATION = (Action("T41", "T41", motor=2), Action("C41", "C41", motor=2))
ACTIONS = (*STOPS, *SPEEDS, Action("C75", "C75"), Action("more", "T4 H C100 T6"), *SIMULATION)
OFFSETS = (0, 1, 40 * MS // 1000)
"""Ticks after the pulse: with it, right after it, while its interrupt has not ended."""


def script(move: str, actions: Iterable[tuple[int, Action]]) -> Script:
    """Return a run of a move with actions at given ticks, and a `C75` at last."""
    text = f"{SETUP}{MOVES[move]}{AFTER[move]}"
    requests, edges = [Request(0, b"\x021" + text.encode())], list(INPUT_BEGIN)
    tick = 0
    for tick, action in actions:
        if action.edge:
            edges.append(Edge(tick, *action.edge))
        else:
            requests.append(Request(tick, b"\x02%d" % action.motor + action.text.encode()))
    resume = tick + GO_ON_MS * MS
    requests += [Request(resume, b"\x021C75"), Request(resume + 1, b"\x040")]
    start = epoch(move, actions)
    return Script(tuple(requests), tuple(edges), resume + GO_ON_MS * MS, start)


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


def pulses_of(probe: Probe, move: str) -> list[int]:
    """The ticks of the pulses of a move that nothing disturbs."""
    run = Script((Request(0, f"\x021{SETUP}{MOVES[move]}".encode()),), INPUT_BEGIN, 2000 * MS)
    pulses = probe.run(run).pulses[1][: JOG_PULSES_MAX if move == "jog" else PULSES_MAX]
    return [abs(tick) for tick in pulses]


def assert_all_agree(probe: Probe, move: str, runs: Iterable[list[tuple[int, Action]]]) -> None:
    """Compare runs of a move; those in which an action falls on its end say nothing."""
    count: Counter[str] = Counter()
    for actions in runs:
        run = script(move, actions)
        try:
            compare(run, probe.run(run))
        except Unsure:
            count["unsure"] += 1
            continue
        except Difference as difference:
            raise AssertionError(f"{difference}\n{run.lines}") from difference
        count["compared"] += 1
    print(f"{move}: {dict(count)}")
    assert count["compared"] > count["unsure"]


@pytest.mark.parametrize("move", MOVES)
def test_any_action_at_every_pulse_does_what_the_language_says(probe: Probe, move: str) -> None:
    pulses = [1, *pulses_of(probe, move)[:-1]]
    places: Iterable[tuple[int, int, Action]] = product(pulses, OFFSETS, ACTIONS)
    if not LONG:
        at = random.Random(f"{move} 1945")
        places = ((tick, at.choice(OFFSETS), action) for tick, action in product(pulses, ACTIONS))
    assert_all_agree(probe, move, ([(tick + offset, a)] for tick, offset, a in places))


@pytest.mark.parametrize("move", MOVES)
def test_any_two_actions_at_any_pulses_do_what_the_language_says(probe: Probe, move: str) -> None:
    pulses = pulses_of(probe, move)[:-1]
    pairs = product(combinations_with_replacement(pulses, 2), ACTIONS, ACTIONS)
    runs = [[(k + 1, a), (m + 2, b)] for (k, m), a, b in pairs]
    runs = random.Random(f"{move} 2009").sample(runs, min(PAIRS, len(runs)))
    assert_all_agree(probe, move, runs)
