"""`rkm04-host sim --curve`: speed and position over time in few points."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

LONG = "\\ S2000 V16000 A60000 F80000 R W500 B3 R V300 A100 S20 B5000 R"
MANY = 200_000
TICK_HZ = 84_000_000


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    program = Path(os.environ["RKM04_BUILD"]) / "bin" / "rkm04-host"
    return subprocess.run(
        [program, "sim", *arguments], cwd=folder, capture_output=True, text=True, timeout=60
    )


@pytest.fixture
def curve(tmp_path):
    def draw(*programs: str, **options):
        arguments = ["--curve", "curve.json"]
        for motor, text in enumerate(programs, 1):
            (tmp_path / f"{motor}.rks").write_text(text)
            arguments += ["--motor", f"{motor}={motor}.rks"]
        for name, value in options.items():
            arguments += [f"--{name.rstrip('_')}", str(value)]
        done = run(tmp_path, *arguments)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout), json.loads((tmp_path / "curve.json").read_text())

    return draw


def points(line) -> list[tuple[float, float, int]]:
    return list(zip(line["t"], line["speed"], line["position"], strict=True))


def test_a_short_move_keeps_every_pulse(curve, tmp_path):
    _, told = curve("\\ S100 V1000 A2000 F400 R", steps="steps.csv")
    rows = (tmp_path / "steps.csv").read_text().splitlines()[2:]
    ticks = [int(row.split(",")[0]) for row in rows]

    line = points(told["motors"][0])
    middles = [
        ((a + b) / 2 / TICK_HZ, TICK_HZ / (b - a)) for a, b in zip([0, *ticks], ticks, strict=False)
    ]
    drawn = [(t, speed) for t, speed, _ in line if speed > 0][1:-1]
    assert [t for t, _ in drawn] == pytest.approx([t for t, _ in middles], abs=1e-5)
    assert [speed for _, speed in drawn] == pytest.approx([v for _, v in middles], rel=1e-3)
    assert [position for *_, position in line[-3:]] == [400, 400, 400]


def test_single_pulses_are_told_with_their_times_where_they_are_few(curve, tmp_path):
    _, told = curve("\\ S100 V100 F3 R W20 =900 B2 R", steps="steps.csv")
    rows = [row.split(",") for row in (tmp_path / "steps.csv").read_text().splitlines()[2:]]
    pulses = [(int(tick) / TICK_HZ, int(position)) for tick, _, position in rows]

    line = told["motors"][0]
    assert line["before"] == 0
    times = [seconds for seconds, position in line["steps"] if position != 900]
    assert [position for _, position in line["steps"]] == [1, 2, 3, 900, 899, 898]
    assert [position for _, position in pulses] == [1, 2, 3, 899, 898]
    assert times == pytest.approx([seconds for seconds, _ in pulses], abs=1e-6)


def test_a_part_tells_its_own_pulses_and_the_position_at_its_beginning(curve):
    _, told = curve("\\ S100 V100 F300 R", from_=1.005, to=1.035, points=24)
    line = told["motors"][0]

    assert (line["before"], line["steps"]) == (
        100,
        [[pytest.approx(1.01, abs=1e-5), 101], [pytest.approx(1.02, abs=1e-5), 102],
         [pytest.approx(1.03, abs=1e-5), 103]],
    )  # fmt: skip


def test_more_pulses_than_points_are_not_told_one_by_one(curve):
    assert len(curve("F48 R", points=48)[1]["motors"][0]["steps"]) == 48
    assert curve("F49 R", points=48)[1]["motors"][0]["steps"] is None


def test_a_position_that_is_written_before_the_first_move_is_where_the_curve_begins(curve):
    _, told = curve("\\ =900000 S100 V100 F2 R")
    line = told["motors"][0]

    assert line["before"] == 900_000
    assert next(position for t, _, position in points(line) if t > 0) == 900_000


def test_a_move_begins_and_ends_at_speed_0(curve):
    _, told = curve("\\ S100 V1000 A2000 W300 F400 R W200")
    line = points(told["motors"][0])

    assert line[0] == (0, 0, 0)
    (begin,) = [i for i, (_, speed, _) in enumerate(line) if speed > 0][:1]
    assert line[begin - 1][0] == pytest.approx(0.3, abs=1e-3)
    assert line[begin - 1][1:] == (0, 0)
    assert line[begin][0] == line[begin - 1][0]
    assert line[-1][1:] == (0, 400)


def test_speeds_backward_are_negative(curve):
    _, told = curve("\\ S200 V200 B100 R F50 R")
    line = told["motors"][0]

    assert min(line["speed"]) == pytest.approx(-200, abs=1)
    assert max(line["speed"]) == pytest.approx(200, abs=1)
    assert (min(line["position"]), line["position"][-1]) == (-100, -50)


@pytest.mark.parametrize("most", [24, 100, 2000])
def test_few_points_keep_peaks_ends_and_order(curve, most):
    _, full = curve(LONG, points=MANY, for_=100)
    _, thin = curve(LONG, points=most, for_=100)
    all_of_them, few = points(full["motors"][0]), points(thin["motors"][0])

    assert len(all_of_them) > 80_000
    assert len(few) <= most
    assert [t for t, *_ in few] == sorted(t for t, *_ in few)
    assert set(few) <= set(all_of_them)
    for value in (1, 2):
        assert max(p[value] for p in few) == max(p[value] for p in all_of_them)
        assert min(p[value] for p in few) == min(p[value] for p in all_of_them)
    assert (few[0], few[-1]) == (all_of_them[0], all_of_them[-1])


def test_ramps_begin_and_end_where_they_do(curve):
    summary, told = curve(LONG, for_=100)
    line = points(told["motors"][0])
    column = summary["seconds"] / (2000 / 6 / 2)

    top = [t for t, speed, _ in line if speed > 15_999]
    assert top[0] == pytest.approx(14_000 / 60_000, abs=2 * column)
    assert 0 in [speed for t, speed, _ in line if abs(t - top[-1] - 14_000 / 60_000) < 2 * column]


def test_the_position_counter_may_be_set(curve):
    _, told = curve("\\ S100 F10 R =500 W100 F5 R C100")
    line = points(told["motors"][0])

    assert 10 in [position for *_, position in line]
    assert 505 in [position for *_, position in line]
    assert line[-1][2] == 0


def test_a_motor_that_still_moves_is_drawn_to_the_end(curve):
    summary, told = curve("\\ S100 V1000 A20000 G+", for_=2)
    line = points(told["motors"][0])

    assert line[-1][0] == summary["seconds"] == 2
    assert line[-1][1] == pytest.approx(1000, abs=1)


def test_a_part_has_a_point_before_and_one_after_it(curve):
    _, told = curve("\\ S100 V100 F1000 R", "\\ S100 V100 F10 R", "W1", from_=2, to=3)
    line, standing, still = (points(each) for each in told["motors"][:3])

    assert line[0][0] < 2 <= line[1][0]
    assert line[-2][0] <= 3 < line[-1][0]
    assert len(line) == pytest.approx(102, abs=2)
    assert [position for *_, position in standing] == [10, 10]
    assert [position for *_, position in still] == [0, 0]


def test_outputs_are_told_with_their_times(curve):
    _, told = curve("W100 T02 W100 T08 C02")

    assert told["outputs"] == [
        [pytest.approx(0.1, abs=1e-3), 2, 1],
        [pytest.approx(0.2, abs=1e-3), 8, 1],
        [pytest.approx(0.2, abs=1e-3), 2, 0],
    ]
    assert told["outputs_cut"] is None


def test_too_many_outputs_are_cut(curve):
    _, told = curve("@1 T1 W1 C1 W1 J1", points=50, for_=1)

    assert len(told["outputs"]) == 50
    assert told["outputs"][-1][0] < told["outputs_cut"] == pytest.approx(0.051, abs=0.002)


def test_the_real_time_can_be_limited(curve):
    summary, told = curve("@1 J1", for_=1_000_000, real=0.05)

    assert summary["ended"] == "real"
    assert 0 < summary["seconds"] < 1_000_000
    assert told["motors"][0]["t"][-1] == pytest.approx(summary["seconds"], abs=1e-5)


def test_a_program_in_time_is_not_disturbed_by_the_limit(curve):
    summary, _ = curve("F100 R", real=100)

    assert summary["ended"] == "idle"


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--points", "23"),
        ("--points", "200001"),
        ("--points", "x"),
        ("--from", "-1"),
        ("--to", "x"),
        ("--real", "soon"),
        ("--curve", ""),
        ("--steps", "c.json"),
    ],
)
def test_a_wrong_option_is_told(tmp_path, option, value):
    (tmp_path / "a.rks").write_text("R")
    done = run(tmp_path, "--motor", "1=a.rks", "--curve", "c.json", option, value)

    assert done.returncode == 2
    assert option in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "c.json").exists()


moves = st.tuples(
    st.integers(1, 2000), st.integers(1, 16_000), st.integers(1, 60_000), st.sampled_from("FB"),
    st.integers(1, 3000), st.integers(1, 500),
)  # fmt: skip


@settings(
    max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.lists(moves, min_size=1, max_size=6), st.integers(24, 300))
def test_thinning_keeps_what_matters_of_any_program(curve, program, most):
    text = "\\" + "".join(f"S{s}V{v}A{a}{way}{n}RW{ms}" for s, v, a, way, n, ms in program)
    _, full = curve(text, points=MANY, for_=20)
    _, thin = curve(text, points=most, for_=20)
    all_of_them, few = points(full["motors"][0]), points(thin["motors"][0])

    assert len(few) <= most
    assert set(few) <= set(all_of_them)
    for value in (1, 2):
        assert max(p[value] for p in few) == max(p[value] for p in all_of_them)
        assert min(p[value] for p in few) == min(p[value] for p in all_of_them)
    assert few[-1] == all_of_them[-1]
