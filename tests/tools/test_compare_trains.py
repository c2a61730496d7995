"""`compare` finds in any pulse train what was done to it, and nothing else."""

from __future__ import annotations

import contextlib
import io
import json
from pathlib import Path
from typing import Any

import pytest
from captures import Analyser, Distortion, Move, edges, pulses, steps_file, vcd_file
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rkm04_tools.cli import main

MOVES = st.builds(
    Move,
    st.integers(60, 250) | st.integers(-250, -60),
    st.integers(80, 300),
    st.integers(600, 16_000),
    st.integers(3_000, 60_000),
    st.floats(0, 0.4),
)
TRAINS = st.lists(MOVES, min_size=1, max_size=4).map(pulses)
ANALYSERS = st.builds(
    Analyser, st.floats(0.01, 2.0), st.floats(-200, 200), st.sampled_from([8e6, 12e6, 24e6, 100e6])
)
FAR_SECONDS = 1e-6
"""Beyond the limit of the slowest analyser, and within what is still the same pulse."""


@st.composite
def distortions(draw: st.DrawFn, count: int) -> Distortion:
    """Up to a twentieth of the pulses is dropped, moved, turned or followed by another one."""

    def some(most: int) -> frozenset[int]:
        return draw(st.frozensets(st.integers(1, count), max_size=most))

    dropped = some(count // 20)
    far = st.floats(FAR_SECONDS, 8e-6) | st.floats(-8e-6, -FAR_SECONDS)
    return Distortion(
        dropped,
        some(count // 20),
        {number: draw(far) for number in some(count // 20) - dropped},
        {number: draw(st.floats(0.4, 0.6)) for number in some(count // 20) if number < count},
    )


def compared(folder: Path, *options: str) -> dict[str, Any]:
    """What the command says of the files in a folder; run without fixtures, for each example."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        status = main(["compare", str(folder / "a.vcd"), str(folder / "a.csv"), "--json", *options])
    told: dict[str, Any] = json.loads(out.getvalue())
    assert status == (0 if told["same"] else 1)
    return told


def numbers(places: dict[str, Any]) -> set[int]:
    """The pulses of a list of those in a row."""
    found = {n for row in places["pulses"] for n in range(row["first"], row["last"] + 1)}
    assert len(found) == places["count"]
    return found


def surplus(count: int, distortion: Distortion) -> set[int]:
    """The numbers, in the capture, of the pulses that were added."""
    found, seen = set(), 0
    for number in range(1, count + 1):
        seen += number not in distortion.dropped
        if number in distortion.added_after:
            seen += 1
            found.add(seen)
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("trains")


settled = settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@given(st.lists(TRAINS, min_size=1, max_size=2), ANALYSERS)
@settled
def test_a_train_that_is_only_sampled_is_the_same(folder, trains, analyser):
    motors = dict(enumerate(trains, 1))
    steps_file(folder / "a.csv", motors)
    found = [
        e for motor, train in motors.items() for e in edges(motor, train, analyser, Distortion())
    ]
    vcd_file(folder / "a.vcd", found, analyser)

    told = compared(folder)

    assert told["same"], told
    for motor in told["motors"]:
        assert abs(motor["worst_ns"]) <= told["resolution_ns"]
    span = max(train[-1][0] for train in trains) / 84e6
    assert told["rate_ppm"] == pytest.approx(analyser.ppm, abs=2e6 / analyser.sample_hz / span)


@given(st.data(), TRAINS, ANALYSERS)
@settled
def test_exactly_what_was_done_to_a_train_is_found(folder, data, train, analyser):
    distortion = data.draw(distortions(len(train)))
    steps_file(folder / "a.csv", {1: train})
    vcd_file(folder / "a.vcd", edges(1, train, analyser, distortion), analyser)

    (motor,) = compared(folder)["motors"]

    assert numbers(motor["missing"]) == distortion.dropped
    assert numbers(motor["surplus"]) == surplus(len(train), distortion)
    assert numbers(motor["wrong_dir"]) == distortion.turned - distortion.dropped
    assert numbers(motor["too_far"]) == set(distortion.moved_seconds)


@given(st.data(), TRAINS, ANALYSERS)
@settled
def test_a_capture_of_a_part_is_told_from_one_that_lacks_pulses(folder, data, train, analyser):
    first = data.draw(st.integers(0, len(train) // 3))
    last = data.draw(st.integers(2 * len(train) // 3, len(train) - 1))
    steps_file(folder / "a.csv", {1: train})
    seen = edges(1, train, analyser, Distortion())
    rises = [seconds for seconds, name, level in seen if name == "STEP1" and level]
    begin, end = rises[first] - 1e-5, rises[last] + 1e-5
    vcd_file(folder / "a.vcd", [e for e in seen if begin < e[0] < end], analyser, end)
    text = (folder / "a.vcd").read_text()
    dir_before = [level for seconds, name, level in seen if name == "DIR1" and seconds <= begin]
    text = text.replace('#0 0! 0"', f'#{begin * 1e10:.0f} 0! {(dir_before or [0])[-1]}"')
    (folder / "a.vcd").write_text(text.rpartition("#")[0] + f"#{end * 1e10:.0f}\n")

    whole, part = compared(folder), compared(folder, "--part")

    if not whole["fits_elsewhere"]:
        assert whole["motors"][0]["outside"] == len(train) - (last - first + 1)
        assert whole["motors"][0]["both"] == last - first + 1
        assert part["same"]


def test_a_long_cruise_with_many_faults_and_short_ramps_is_found_where_it_is(folder):
    train = pulses([Move(104, 256, 666, 59_828, 0.361), Move(166, 289, 631, 13_707, 0.229)])
    dropped = frozenset({4, 18, 35, 98, 128, 149, 153, 181, 232, 238, 269})
    far = {28: 6.4e-6, 62: 1e-6, 100: 5.5e-6, 104: 1.5e-6, 107: 4.6e-6, 138: 1e-6, 192: 1e-6}
    added = {45: 0.53, 54: 0.4, 113: 0.55, 121: 0.5, 122: 0.4, 137: 0.6, 218: 0.5}
    distortion = Distortion(dropped, frozenset(), far, added)
    analyser = Analyser(0.4393, -100.4, 8e6)
    steps_file(folder / "a.csv", {1: train})
    vcd_file(folder / "a.vcd", edges(1, train, analyser, distortion), analyser)

    (motor,) = compared(folder)["motors"]

    assert numbers(motor["missing"]) == dropped
    assert numbers(motor["surplus"]) == surplus(len(train), distortion)
    assert numbers(motor["too_far"]) == set(far)
