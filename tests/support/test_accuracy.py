"""Tests of the accuracy figures: of the set of moves, of the measuring, and of the probe."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from itertools import product
from pathlib import Path
from random import Random

import accuracy
import pytest
from accuracy_moves import ACCELS, COMPOUND, GROUPS, LONGEST, MANUAL, SINGLE, SPEEDS, START_SPEEDS
from motion_probe import (
    EPOCH_BITS,
    ROOT,
    STOP,
    Case,
    Missing,
    Move,
    Run,
    complaints,
    deviation,
    run,
    run_one,
    single,
    worst_of,
)
from reference import ENDLESS, FRACTION_BITS, Section

PROBE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin" / "motion-probe"
MOVE = single(100, 1000, 2000, 5000)


def all_moves() -> list[Move]:
    """Make the whole set."""
    return [move for group in GROUPS for move in group(Random(1))]


def exact(move: Move) -> Run:
    """Make the run that is as good as whole ticks allow."""
    last = move.curve.last
    assert last is not None
    return Run(move.curve.nearest_ticks(range(1, last + 1)), last, 0, [])


# --- the set ------------------------------------------------------------------------


def test_the_set_has_all_corners_of_the_ranges_with_few_steps_and_with_most() -> None:
    moves = {(m.start_speed, m.sections) for m in all_moves() if not m.changes}
    for start, speed, accel, steps in product(
        (1, 2000), (1, 16_000), (1, 60_000), (1, 2, 3, LONGEST)
    ):
        assert (start, (Section(steps, speed, accel),)) in moves
    for start, speed, accel in product(START_SPEEDS, SPEEDS, ACCELS):
        assert (start, (Section(7, speed, accel),)) in moves


def test_the_set_has_the_longest_compound_move() -> None:
    assert (
        max(sum(s.steps for s in m.sections) for m in all_moves() if not m.changes) == 160_000_000
    )


@pytest.mark.parametrize("move", [SINGLE, COMPOUND], ids=["single", "compound"])
def test_the_set_has_changes_at_every_pulse_of_the_reference_moves(move: Move) -> None:
    changes = {m.changes[0] for m in all_moves() if m.sections == move.sections and m.changes}
    last = move.curve.last
    assert last is not None
    for pulse, speed in product(range(1, last + 1), (STOP, 50, 16_000)):
        assert (pulse, speed) in changes


def test_the_set_is_the_same_every_time() -> None:
    assert all_moves() == all_moves()


# --- the measuring ------------------------------------------------------------------


def test_all_pulses_of_a_short_move_are_compared() -> None:
    assert list(accuracy.wanted_pulses(single(100, 1000, 2000, 2000))) == list(range(1, 2001))


def test_pulses_are_compared_from_the_one_before_a_change_on() -> None:
    move = Move(100, SINGLE.sections, ((40, STOP),))
    assert list(accuracy.wanted_pulses(move)) == list(range(39, 81))


def test_of_a_long_move_ends_and_corners_and_a_spread_are_compared() -> None:
    wanted = accuracy.wanted_pulses(single(100, 16_000, 60_000, LONGEST))
    assert wanted == sorted(set(wanted))
    assert {*range(1, 201), *range(LONGEST - 199, LONGEST + 1)} <= set(wanted)
    assert {*range(2103, 2163), *range(LONGEST - 2162, LONGEST - 2102)} <= set(wanted)
    assert 900 <= len(wanted) <= 1100


def test_the_nearest_ticks_deviate_by_half_a_tick_at_most() -> None:
    found = deviation(Case(MOVE), exact(MOVE))
    assert 0.49 < found.ticks <= 0.5


def test_the_pulse_that_is_off_most_is_found() -> None:
    made = exact(MOVE)
    made.ticks[1233] += 3
    made.ticks[4000] -= 2
    found = deviation(Case(MOVE), made)
    assert found.pulse == 1234
    assert 2.5 <= found.ticks <= 3.5


def test_only_wanted_pulses_are_compared() -> None:
    curve = MOVE.curve
    made = Run([*curve.nearest_ticks([7]), *(t + 9 for t in curve.nearest_ticks([8]))], 5000, 0, [])
    assert deviation(Case(MOVE, 0, [7, 8]), made).pulse == 8


def test_a_deviation_far_from_the_start_keeps_its_digits() -> None:
    tick = 10**15
    assert worst_of([(1, tick, (tick << FRACTION_BITS) + (1 << 60))]).ticks == 1 / 16


@pytest.mark.parametrize(
    ("made", "complaint"),
    [
        (Run([1, 2], 2, 0, []), "2 pulses instead of 3"),
        (Run([1, 2, 3], 3, 1, []), "1 pulses were late"),
        (Run([1, 2], 3, 0, []), "2 pulses told instead of 3"),
    ],
)
def test_a_run_that_is_not_its_move_is_refused(made: Run, complaint: str) -> None:
    case = Case(single(100, 100, 1, 3))
    assert complaint in complaints(case, made)[0]
    with pytest.raises(accuracy.Wrong):
        accuracy.refuse_wrong(case, made)


def test_a_speed_error_is_that_of_an_interval() -> None:
    ideal = [0, 100 << FRACTION_BITS, 200 << FRACTION_BITS]
    assert accuracy.worst_speed_error([0, 100, 200], ideal) == 0
    assert accuracy.worst_speed_error([0, 100, 180], ideal) == pytest.approx(0.25)


@pytest.fixture
def small_set(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave only few moves in the set."""

    def few(_: Random) -> list[Move]:
        return [MANUAL, MOVE]

    monkeypatch.setattr(accuracy, "GROUPS", (few,))
    monkeypatch.setattr(accuracy, "PEERS", {"M1": single(100, 3000, 2000, 1000)})


@pytest.fixture
def call(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Call the script: its status, output and errors."""

    def called(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["accuracy", *arguments])
        status = accuracy.main()
        told = capsys.readouterr()
        return status, told.out, told.err

    return called


Call = Callable[..., tuple[int, str, str]]


@pytest.mark.usefixtures("small_set")
def test_the_figures_come_as_json(call: Call) -> None:
    status, out, _ = call("--json", "--seed", "7")
    told = json.loads(out)
    assert status == 0
    assert told["moves"] == 3
    assert told["seed"] == 7
    assert told["goal_ticks"] == 1
    assert 0.4 < told["worst_ticks"] <= told["goal_ticks"]
    assert [group["name"] for group in told["groups"]] == ["few", "peers"]
    assert told["peers"]["M1"]["max_error_us"] == pytest.approx(0.006, rel=0.02)


@pytest.mark.usefixtures("small_set")
def test_the_figures_come_as_a_table(call: Call) -> None:
    status, out, _ = call()
    assert status == 0
    assert [line.split()[0] for line in out.splitlines()[1:4]] == ["few", "peers", "all"]


def test_without_the_probe_one_line_says_so(
    call: Call, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("RKM04_BUILD", str(tmp_path))
    status, out, err = call("--json")
    assert (status, out, err.count("\n")) == (1, "", 1)
    assert "motion-probe is not there" in err
    with pytest.raises(Missing):
        run_one(Case(MOVE))


# --- the probe ----------------------------------------------------------------------


def test_the_probe_tells_pulses_and_break_points() -> None:
    made = run_one(Case(MOVE))
    assert (made.pulses, made.late, len(made.ticks)) == (5000, 0, 5000)
    assert made.corners == [(1, 100), (248, 1000), (4753, 1000), (5000, 0)]


def test_the_probe_tells_only_wanted_pulses() -> None:
    all_ticks, wanted = run([Case(MOVE), Case(MOVE, 0, [1, 2, 4999, 5000])])
    assert wanted.ticks == [*all_ticks.ticks[:2], *all_ticks.ticks[-2:]]


def test_the_probe_makes_changes_at_their_pulses() -> None:
    before, after = run([Case(MOVE), Case(Move(100, MOVE.sections, ((1000, 500), (2000, STOP))))])
    assert after.ticks[:1000] == before.ticks[:1000]
    assert after.ticks[1000] > before.ticks[1000]
    assert after.pulses == 2060


def test_the_probe_tells_break_points_as_they_are_after_the_changes() -> None:
    made = run_one(Case(Move(100, MOVE.sections, ((1000, 500),))))
    assert made.corners == [(1, 100), (1000, 1000), (1188, 500), (4940, 500), (5000, 0)]


def test_the_probe_runs_without_end_until_it_is_stopped() -> None:
    made = run_one(Case(Move(100, (Section(ENDLESS, 1000, 2000),), ((2000, STOP),))))
    assert made.pulses == 2247


def test_the_probe_starts_anywhere_in_time() -> None:
    early, late = run([Case(MOVE, 0, [5000]), Case(MOVE, (1 << EPOCH_BITS) - 1, [5000])])
    assert early.ticks == late.ticks


@pytest.mark.parametrize("text", ["1 2 3\n", "hello\n", "0 100 11\n", "0 100 1 5 10 10 0 70000\n"])
def test_the_probe_refuses_what_is_no_case(text: str) -> None:
    done = subprocess.run([PROBE], input=text, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_the_probe_has_nothing_to_say_to_nothing() -> None:
    done = subprocess.run([PROBE], input="\n", capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "")
