"""Pulses that are laid ahead come where they come one at a time, whatever stops or changes a move.

What a stop lays before it has been planned, its stopgap, may be a tick off: the brake begins from
the rounded ticks of a pulse, the plan from the exact place. `RKM04_PROGRAMS=5000` draws that many
moves instead of a hundred; RKM04_SEED=... repeats a run.
"""

from __future__ import annotations

import dataclasses
import os
from collections import Counter
from collections.abc import Iterator

import pytest
from chance import SEED
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from program_probe import MOTORS, Probe, Record, Request, Script
from program_strategies import scripts

AHEAD = (2000, 5376, 84_000)
MOVES = int(os.environ.get("RKM04_PROGRAMS", "100"))
PROGRAMS = MOVES // 4
MS = 84_000


def examples(count: int) -> settings:
    return settings(
        max_examples=count, deadline=None, suppress_health_check=list(HealthCheck), database=None
    )


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


@st.composite
def moves(draw: st.DrawFn) -> Script:
    """Moves of all motors, with stops, changes of speed and what is left of a stop, at any time."""
    requests = []
    end = 0
    for motor in draw(st.sets(st.sampled_from(MOTORS), min_size=1)):
        start, speed = draw(st.integers(1, 2000)), draw(st.integers(1, 16000))
        sections = draw(st.integers(1, 5))
        text = f"S{start} "
        for _ in range(sections):
            accel = draw(st.integers(100, 60000))
            steps = draw(st.integers(1, 3000))
            text += f"V{speed} A{accel} F{steps} Y "
            speed = draw(st.integers(max(1, speed // 2), min(16000, 2 * speed)))
        requests.append(Request(0, f"\x02{motor} {text}R".encode()))
        times = draw(st.lists(st.integers(1, 500 * MS), max_size=4))
        for tick in times:
            message = draw(st.sampled_from(["K", "K", "C75", "V{}"]))
            speed = draw(st.integers(1, 16000))
            requests.append(Request(tick, f"\x02{motor}{message.format(speed)}".encode()))
        end = max([end, *times])
    requests.sort(key=lambda request: request.tick)
    return Script(tuple(requests), end=end + 2000 * MS, epoch=draw(st.integers(0, 2**33)))


def stops_of(record: Record, motor: int) -> list[int]:
    return [event.tick for event in record.events if (event.motor, event.name) == (motor, "stop")]


def is_on_stopgap(train: list[int], place: int, stops: list[int], ahead: int) -> bool:
    """Whether a stop laid this pulse before it was planned: up to the first one beyond `ahead`."""
    before = abs(train[place - 1]) if place else 0
    return any(stop <= abs(train[place]) and before < stop + ahead for stop in stops)


def count_off(script: Script, probe: Probe, *, by_stopgap: bool) -> Counter[str]:
    """Compares a script with itself, pulses laid ahead; those that are a tick off are counted."""
    count: Counter[str] = Counter()
    alone = probe.run(script)
    for ahead in AHEAD:
        record = probe.run(dataclasses.replace(script, ahead=ahead))
        assert (record.late, record.complaints) == (alone.late, alone.complaints)
        assert record.positions == alone.positions
        for motor in MOTORS:
            stops = stops_of(alone, motor)
            for one, other in (
                (alone.pulses[motor], record.pulses[motor]),
                (alone.simulated[motor], record.simulated[motor]),
            ):
                assert len(one) == len(other)
                count["pulses"] += len(one)
                for place in (at for at, tick in enumerate(one) if tick != other[at]):
                    count["off"] += 1
                    assert abs(one[place] - other[place]) == 1
                    assert not by_stopgap or is_on_stopgap(one, place, stops, ahead)
        count["stops"] += sum(event.name == "stop" for event in alone.events)
    return count


def test_any_move_makes_the_same_pulses_however_far_ahead_they_are_laid(probe: Probe) -> None:
    count: Counter[str] = Counter()

    @seed(SEED)
    @examples(MOVES)
    @given(moves())
    def check(script: Script) -> None:
        count.update(count_off(script, probe, by_stopgap=True))

    check()
    print(f"moves with pulses laid ahead: {dict(count)}, RKM04_SEED={SEED}")
    assert count["off"] < count["stops"]


def test_any_program_makes_the_same_pulses_however_far_ahead_they_are_laid(probe: Probe) -> None:
    count: Counter[str] = Counter()

    @seed(SEED)
    @examples(PROGRAMS)
    @given(scripts())
    def check(script: Script) -> None:
        count.update(count_off(script, probe, by_stopgap=False))

    check()
    print(f"programs with pulses laid ahead: {dict(count)}, RKM04_SEED={SEED}")
    assert count["off"] < max(1, count["stops"])
