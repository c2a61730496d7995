"""Random sessions with the GVE134 unit, each held against the model of the contract.

`RKM04_PROGRAMS=11000` tries that many sessions instead of a few hundred; the seeds of the sessions
count from 0, so that `gve_sessions.session(SEED)` is a session again.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator

import pytest
from gve_course import Mismatch
from gve_model import compare
from gve_probe import Probe
from gve_sessions import session
from gve_unit import Unsure

SESSIONS = int(os.environ.get("RKM04_PROGRAMS", "600"))
BATCH = 1000
UNSURE_SHARE_MAX = 0.06


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


@pytest.mark.parametrize("batch", range(-(-SESSIONS // BATCH)))
def test_any_session_goes_as_the_contract_says(probe: Probe, batch: int) -> None:
    count: Counter[str] = Counter()
    wrong = []
    seeds = range(batch * BATCH, min(SESSIONS, (batch + 1) * BATCH))
    for seed in seeds:
        spoken = session(seed)
        done = probe.run(spoken)
        try:
            compare(spoken, done)
        except Unsure:
            count["unsure"] += 1
        except Mismatch as mismatch:
            wrong.append(f"session {seed}: {mismatch}")
        else:
            count["compared"] += 1
            count["answers"] += len(done.answers)
            count["pulses"] += sum(len(train.ticks) for train in done.motors.trains)
    print(f"sessions held against the model: {dict(count)}")
    assert not wrong, "\n".join(wrong)
    assert count["unsure"] < UNSURE_SHARE_MAX * len(seeds)
