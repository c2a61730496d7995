"""Random sessions with the positioning unit, each held against the model of the contract.

`RKM04_PROGRAMS=11000` tries that many sessions instead of a few hundred; the seeds of the sessions
count from 0, so that `pos_sessions.session(SEED)` is a session again.
"""

from __future__ import annotations

import os
from collections import Counter

import pytest
from pos_model import compare
from pos_run import run_session
from pos_sessions import session
from pos_words import MS, Mismatch, Unsure

SESSIONS = int(os.environ.get("RKM04_PROGRAMS", "300"))
BATCH = 1000
WRONG_SHARE_MAX = 0.05
"""Of sessions in which the model loses the place of a change: most come between two pulses, after
one that planning could not touch any more."""

UNSURE_SHARE_MAX = 0.35
"""What is open at once is more than the model can follow."""


@pytest.mark.parametrize("batch", range(-(-SESSIONS // BATCH)))
def test_any_session_goes_as_the_contract_says(batch: int) -> None:
    count: Counter[str] = Counter()
    wrong = []
    seeds = range(batch * BATCH, min(SESSIONS, (batch + 1) * BATCH))
    for seed in seeds:
        spoken, done = run_session(session(seed))
        try:
            compare(spoken, done, MS)
        except Unsure:
            count["unsure"] += 1
        except Mismatch as mismatch:
            wrong.append(f"session {seed}: {mismatch}")
        else:
            count["compared"] += 1
            count["registers"] += len(done.samples)
            count["pulses"] += sum(len(train.ticks) for train in done.trains)
    print(f"sessions held against the model: {dict(count)}", *wrong, sep="\n")
    assert len(wrong) <= WRONG_SHARE_MAX * len(seeds), "\n".join(wrong)
    assert count["unsure"] < UNSURE_SHARE_MAX * len(seeds)
