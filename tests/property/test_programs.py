"""Random programs, and random messages at random times, against the model of the language.

`RKM04_PROGRAMS=11000` draws that many scripts instead of 150; RKM04_SEED=... repeats
a run.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator

import pytest
from chance import SEED
from hypothesis import HealthCheck, given, seed, settings
from language_model import compare
from language_signals import Unsure
from program_probe import Probe, Request, Script
from program_strategies import scripts

PROGRAMS = int(os.environ.get("RKM04_PROGRAMS", "150"))
BATCH = 300
"""Programs that are drawn together, by one seed; hypothesis grows slow and large with many more."""

UNSURE_SHARE_MAX = 0.35


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


@pytest.mark.parametrize("batch", range(-(-PROGRAMS // BATCH)))
def test_any_program_does_what_the_language_says(probe: Probe, batch: int) -> None:
    count: Counter[str] = Counter()

    @seed(SEED + batch)
    @settings(
        max_examples=min(PROGRAMS, BATCH),
        deadline=None,
        suppress_health_check=list(HealthCheck),
        database=None,
    )
    @given(scripts())
    def check(script: Script) -> None:
        record = probe.run(script)
        try:
            compare(script, record)
        except Unsure:
            count["unsure"] += 1
            return
        count["compared"] += 1
        count["moves"] += sum(event.name == "move" for event in record.events)
        count["pulses"] += sum(map(len, record.pulses.values()))

    check()
    print(f"programs compared with the model: {dict(count)}, RKM04_SEED={SEED + batch}")
    assert count["unsure"] < UNSURE_SHARE_MAX * sum(count[kind] for kind in ("unsure", "compared"))


@pytest.mark.parametrize(
    ("program", "stop_tick"),
    [
        (b"S50 V50 A500 F1 S1 T51 V15 A100 F1 Y V15 A100 F1 Y R", 84_000),
        (b"S100 V1000 A2000 T51 F500 Y V1000 A2000 F1000 Y R", 50_400_000),
    ],
)
def test_a_stop_that_brakes_into_the_last_section_sets_its_output(
    probe: Probe, program: bytes, stop_tick: int
) -> None:
    sent = Request(tick=0, data=b"\x021 " + program)
    stopped = Request(tick=stop_tick, data=b"\x021K")
    script = Script(requests=(sent, stopped), edges=(), end=126_084_000, epoch=0)

    compare(script, probe.run(script))
