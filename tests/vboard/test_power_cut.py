"""Power that goes while the image of the board stores a program: the old one is there or the new.

Each run is one board: it starts, is told to store, loses power in one operation of the flash (a
word, or an erase), starts again from what the flash holds then, and is asked what it has. What the
operation leaves is given too: the first half, all, or a part of the bits.
"""

from __future__ import annotations

import os
import random
from collections.abc import Sequence
from dataclasses import dataclass

import pytest
from board_talk import ask, heard
from stored import AREA_BYTES, area, flash, record
from virtual_board import TICKS_PER_MS, Modelled, VirtualBoard

OLD, NEW, NEXT = b"S2000V2000F5R", b"S2000V2000B7R", b"S2000V2000F3R"
OTHER = b"S2000V2000B2R"
MOVES = {b"": 0, OLD: 5, NEW: -7, NEXT: 3}
"""Each text that motor 1 may have, and the way that it goes when it starts by itself."""
START_MS = 40
"""Within it a stored program has run, and no other one has come."""
ERASE_MS = "0.5"
SET_MS, STORE_MS, ASK_MS, END_MS = 30.0, 60.0, 115.0, 155.0
AGAIN_MS, AGAIN_LATER_MS = 105.0, 80.0
LEAVES = ("half", "all", "{seed}")
SEED = 20261121
PAIRS = 12


@dataclass(frozen=True)
class Case:
    """What the flash holds before, and what motors 1 and 2 have stored then."""

    content: bytes
    before: bytes
    other: bytes
    operations: int


def nearly_full() -> bytes:
    """An area with so many texts of motor 1 that no other one fits after them."""
    records = [record(2, 2, OTHER)]
    size = len(record(1, 0, OLD))
    count = (AREA_BYTES - len(record(1, 0, b"")) - len(records[0])) // size
    return area(1, records + [record(1, 3 + i, OLD) for i in range(count)])


WORDS_OF_RECORD = 10 + len(NEW) // 4 + 1 + 1
WORDS_OF_AREA = 10 + 1
CHANGE_OF_AREAS = 1 + 2 * (WORDS_OF_RECORD + 1) + WORDS_OF_AREA + 1
"""An erase, two texts with their void-marks, the new area counts, the old one does not any more."""
CASES = {
    "first store": Case(flash(), b"", b"", 1 + WORDS_OF_AREA + WORDS_OF_RECORD),
    "next store": Case(
        flash(area(1, [record(2, 2, OTHER), record(1, 3, OLD)])), OLD, OTHER, WORDS_OF_RECORD
    ),
    "other area": Case(flash(nearly_full()), OLD, OTHER, CHANGE_OF_AREAS + WORDS_OF_RECORD),
    "back to the first area": Case(
        flash(b"\0" * 64, nearly_full()),
        OLD,
        OTHER,
        CHANGE_OF_AREAS + WORDS_OF_RECORD,
    ),
}


def run(unit: VirtualBoard, case: Case, cuts: Sequence[str], second: bytes = b"") -> Modelled:
    """Store once, or twice with `second`, with power cuts; the flash is left in a file."""
    path = unit.folder / "flash"
    path.write_bytes(case.content)
    script = ask(SET_MS, b"\x021\\" + NEW) + ask(STORE_MS, b"\x031")
    later = AGAIN_LATER_MS if second else 0.0
    if second:
        script += ask(AGAIN_MS, b"\x021\\" + second) + ask(AGAIN_MS + 25, b"\x031")
    script += ask(ASK_MS + later, b"\x051") + ask(ASK_MS + later + 20, b"\x052")
    options = ["--flash", str(path), "--flash-erase", ERASE_MS, "--power-back"]
    options += [part for cut in cuts for part in ("--power-cut", cut)]
    return unit.run(script, (END_MS + later) / 1000, "", *options)


def judge(
    unit: VirtualBoard, modelled: Modelled, case: Case, allowed: Sequence[bytes], cuts: int = 1
) -> bytes:
    """What motor 1 has; it must be a program that is allowed and, where nothing was stored after
    the last cut, the one that ran by itself."""
    told = [answer.message for answer in heard(unit.folder) if answer.message[:1] == b"\x05"]
    assert len(told) == 2, "the unit does not answer"
    assert told[1] == b"\x052" + case.other
    text = told[0][2:]
    assert text in allowed
    assert modelled.summary["motors"][0]["led"] == 0
    if modelled.summary["resets"]["power"] <= cuts:
        return text
    steps = modelled.steps
    begin = last_start_tick(modelled)
    last = (steps.tick > begin) & (steps.tick < begin + START_MS * TICKS_PER_MS)
    mine = steps.position[last & (steps.motor == 1)]
    assert len(mine) == abs(MOVES[text])
    return text


def last_start_tick(modelled: Modelled) -> int:
    return int(modelled.summary["last_reset"]["microseconds"] * TICKS_PER_MS / 1000)


@pytest.mark.parametrize("name", CASES)
def test_a_store_without_a_cut_takes_the_operations_that_are_cut_below(unit, name):
    case = CASES[name]

    modelled = run(unit, case, [])

    assert modelled.summary["flash"]["operations"] == case.operations
    assert modelled.summary["resets"]["power"] == 1


def cuts_of(case: Case) -> list[str]:
    """A cut for each operation: the three ways take turns, an erase and the last word get all.

    A run of some minutes takes each third of those between: the tests in C cut all of them.
    """
    found = []
    stride = 1 if "RKM04_LONG" in os.environ else len(LEAVES)
    between = range(2, case.operations, stride)
    for operation in (1, *between, case.operations):
        ways = [LEAVES[operation // stride % len(LEAVES)]]
        ways = list(LEAVES) if operation in (1, case.operations) else ways
        found += [f"{operation}:{way.format(seed=SEED + operation)}" for way in ways]
    return found


@pytest.mark.parametrize("name", CASES)
def test_power_cut_in_any_operation_of_a_store_leaves_the_old_program_or_the_new(unit, name):
    case = CASES[name]
    found = []

    for cut in cuts_of(case):
        modelled = run(unit, case, [cut])
        assert modelled.summary["resets"]["power"] == 2, cut
        found.append(judge(unit, modelled, case, (case.before, NEW)))

    # Only what the last word leaves decides.
    assert set(found[: -len(LEAVES)]) == {case.before}
    assert NEW in found


def recovering_cut(case: Case) -> int:
    """The last word of the record that makes the other area count: the old area is not void yet."""
    return case.operations - WORDS_OF_RECORD - 1


def test_power_cut_while_the_start_after_a_cut_completes_a_change_of_areas(unit):
    case = CASES["other area"]
    first = recovering_cut(case)

    for leaves in LEAVES:
        second = f"{first + 1}:{leaves.format(seed=SEED)}"
        modelled = run(unit, case, [f"{first}:all", second])

        # The third start completes it in one more operation.
        assert modelled.summary["resets"]["power"] == 3
        judge(unit, modelled, case, (OLD,))


def test_power_cut_in_a_store_that_follows_a_cut(unit):
    case = CASES["other area"]
    rng = random.Random(SEED)
    print(f"seed {SEED}")

    for _ in range(PAIRS):
        first = rng.randint(1, case.operations - 1)
        second = first + rng.randint(1, 3 * WORDS_OF_RECORD)
        cuts = [f"{first}:{rng.choice(LEAVES).format(seed=rng.randrange(10**6))}"]
        cuts += [f"{second}:{rng.choice(LEAVES).format(seed=rng.randrange(10**6))}"]
        modelled = run(unit, case, cuts, NEXT)
        judge(unit, modelled, case, (OLD, NEW, NEXT), len(cuts))
