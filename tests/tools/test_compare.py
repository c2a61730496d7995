"""`compare` says in words, and as JSON, what differs between a capture and a simulation."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from captures import Analyser, Distortion, Edge, Move, edges, pulses, steps_file, vcd_file

DATA = Path(__file__).parent / "captures"
ANALYSER = Analyser(0.02, 40)
TRAIN = pulses([Move(100, 200, 2000, 30_000, 0.01), Move(-100, 200, 2000, 30_000)])
BACK = pulses([Move(-80, 100, 3000, 30_000)])


@pytest.fixture
def compared(tool, tmp_path):
    """Compare a motor that does this with what an analyser has seen."""

    def run(found: list[Edge], *options, motors=None, analyser=ANALYSER, end=0.0):
        steps = steps_file(tmp_path / "steps.csv", motors or {1: TRAIN})
        capture = vcd_file(tmp_path / "capture.vcd", found, analyser, end)
        return tool("compare", capture, steps, *options)

    return run


@pytest.mark.parametrize("name", ["sigrok.sr", "sigrok.vcd", "scattered.sr"])
def test_what_a_real_tool_wrote_is_the_same_as_the_simulation(tool, tmp_path, name):
    steps = tmp_path / "steps.csv"
    assert tool("sim", DATA / "program.rks", "--steps", steps).status == 0

    result = tool("compare", DATA / name, steps, "--json")

    told, (motor,) = result.json, result.json["motors"]
    assert (result.status, motor["both"], motor["wrong_dir"]["count"]) == (0, 400, 0)
    assert told["rate_ppm"] == pytest.approx(-63, abs=0.2)
    assert told["offset_seconds"] == pytest.approx(0.0123, abs=1 / 24e6)
    assert abs(motor["worst_ns"]) < 30
    assert motor["width_ns"] == pytest.approx([2500, 2500], abs=45)


def test_the_same_is_told_with_what_the_capture_can_show(compared):
    result = compared(edges(1, TRAIN, ANALYSER, Distortion()))

    lines = result.out.splitlines()
    assert (result.status, result.err) == (0, "")
    assert lines[0].endswith("a VCD, 0.250819 s, 24 MHz: it resolves 41.7 ns = 3.5 ticks")
    assert lines[1].endswith("steps of the simulator, 11.9 ns a tick")
    assert re.fullmatch(
        r"aligned by 200 pulses: the simulation begins at 0\.0200000\d\d s of the capture; "
        r"the capture's clock is (39\.9|40\.0)\d ppm fast against the unit's", lines[2],
    )  # fmt: skip
    assert lines[4].split() == [
        "motor", "captured", "simulated", "in", "both", "missing", "surplus", "wrong", "DIR",
        "worst", "median", "too", "far", "pulse", "width",
    ]  # fmt: skip
    assert lines[5].split()[:7] == ["1", "200", "200", "200", "0", "0", "0"]
    assert lines[-1] == (
        "the same: every pulse is within 53.6 ns = 4.5 ticks; what is below 41.7 ns cannot be seen"
    )


def test_what_differs_is_told_by_number_and_time(compared):
    distortion = Distortion(
        frozenset({20, 21, 22, 90}), frozenset({150, 151}), {60: 2e-6}, {40: 0.5}
    )

    result = compared(edges(1, TRAIN, ANALYSER, distortion))

    lines = result.out.splitlines()
    assert result.status == 1
    assert lines[5].split()[:7] == ["1", "197", "200", "196", "4", "1", "2"]
    second = r"\d\.\d{6} s"
    for expected in (
        rf"motor 1: missing: 20 to 22 \({second} to {second}\), 90 \({second}\)",
        rf"motor 1: surplus \(numbers are the capture's\): 38 \({second}\)",
        rf"motor 1: DIR is the other way round at: 150 to 151 \({second} to {second}\)",
        rf"motor 1: further off than 53\.6 ns: 60 \({second}\)",
        r"motor 1: the worst is pulse 60 at 0\.\d{9} s, \+(1\.9|2\.0)\d\d us = \+16\d\.\d ticks.*",
        r"motor 1: DIR changes at least \d+\.\d{3} us before a pulse, at least .* after one",
        r"not the same: see above; a pulse may be off by 53\.6 ns = 4\.5 ticks",
    ):
        assert any(re.fullmatch(expected, line) for line in lines), expected


def test_many_places_are_counted(compared):
    dropped = frozenset(range(12, 180, 8))

    result = compared(edges(1, TRAIN, ANALYSER, Distortion(dropped)))

    (line,) = [line for line in result.out.splitlines() if line.startswith("motor 1: missing")]
    assert line.endswith(" and 15 pulses more")


def test_motors_are_compared_each_for_itself_on_one_clock(compared):
    found = [
        *edges(1, TRAIN, ANALYSER, Distortion()),
        *edges(3, BACK, ANALYSER, Distortion(frozenset({5}))),
    ]

    told = compared(found, "--json", motors={1: TRAIN, 3: BACK, 4: BACK}).json

    assert [m["motor"] for m in told["motors"]] == [1, 3]
    assert [m["missing"]["count"] for m in told["motors"]] == [0, 1]
    assert told["not_captured"] == [4]


def test_a_motor_that_stood_is_missing_and_one_that_should_not_move_is_surplus(compared):
    told = compared(
        [*edges(1, TRAIN, ANALYSER, Distortion()), *edges(2, BACK, ANALYSER, Distortion())],
        "--json",
    ).json
    assert [m["surplus"]["count"] for m in told["motors"]] == [0, 80]
    assert not told["same"]

    stood = [(0.5, "STEP2", 1), (0.6, "STEP2", 0)]
    told = compared(
        [*edges(1, TRAIN, ANALYSER, Distortion()), *stood], "--json", motors={1: TRAIN, 2: BACK}
    ).json
    assert [m["missing"]["count"] for m in told["motors"]] == [0, 80]


def test_pulses_that_all_come_later_are_told_as_such(compared):
    late = {number: 0.0 if number <= 100 else 0.003217 for number in range(1, 201)}

    result = compared(edges(1, TRAIN, ANALYSER, Distortion(moved_seconds=late)))

    assert result.status == 1
    assert re.search(
        r"^from pulse 101 of motor 1 on, pulses come 3\.217 ms later: as after a wait for an "
        r"input, or where the analyser has lost samples$",
        result.out, re.MULTILINE,
    )  # fmt: skip


def test_a_wire_that_is_inverted_is_proposed(compared):
    turned = frozenset(range(1, 201))

    result = compared(edges(1, TRAIN, ANALYSER, Distortion(turned=turned)))

    assert "DIR is the other way round everywhere: --channels DIR1=!NAME" in result.out


def test_pulses_beyond_the_capture_are_told_apart(compared):
    found = edges(1, TRAIN, ANALYSER, Distortion())
    rises = [seconds for seconds, name, level in found if name == "STEP1" and level]
    part = [edge for edge in found if edge[0] < rises[149] + 1e-4]
    end = rises[149] + 1.5e-4 - 0.01

    whole = compared(part, end=end)
    wanted = compared(part, "--part", end=end)

    text = "50 pulses of the simulation before the capture begins or after it ends"
    assert (whole.status, wanted.status) == (1, 1)
    assert text not in wanted.out
    assert "motor 1: missing" in whole.out


def test_a_part_that_fits_at_two_places_is_not_known_to_be_the_same(compared):
    train = pulses([Move(60, 500, 500, 2000, 0.01)] * 6)
    found = edges(1, train, ANALYSER, Distortion())
    rises = [seconds for seconds, name, level in found if name == "STEP1" and level]
    begin, end = rises[120] - 1e-4, rises[239] + 1e-4
    part = [edge for edge in found if begin < edge[0] < end]

    result = compared(part, "--part", motors={1: train}, end=end - 0.01)
    told = compared(part, "--part", "--json", motors={1: train}, end=end - 0.01).json

    assert result.status == 1
    assert "the capture fits as well at another place of the simulation" in result.out
    assert result.out.splitlines()[-1].startswith("not known to be the same: every pulse is within")
    assert (told["same"], told["fits_elsewhere"]) == (False, True)


def test_without_a_rate_only_an_offset_is_fitted(compared):
    same = Analyser(0.02, 0)
    apart = compared(edges(1, TRAIN, ANALYSER, Distortion()), "--no-rate", "--json")
    alike = compared(edges(1, TRAIN, same, Distortion()), "--no-rate", "--json", analyser=same)

    assert (apart.status, apart.json["rate_ppm"]) == (1, None)
    assert max(abs(m["worst_ns"]) for m in apart.json["motors"]) > 1000
    assert (alike.status, alike.json["offset_seconds"]) == (0, pytest.approx(0.02, abs=5e-8))


def test_few_pulses_tell_no_rate_and_the_limit_grows(compared):
    train = [(tick * 100_000, tick) for tick in (1, 2, 3)]

    told = compared(edges(1, train, ANALYSER, Distortion()), "--json", motors={1: train}).json

    assert (told["same"], told["rate_ppm"]) == (True, None)
    assert told["limit_ns"] == pytest.approx(1e9 / 24e6 + 1e9 / 84e6 + 400e-6 * 200_000 / 0.084)


def test_slow_drift_of_a_clock_is_followed_and_told(compared):
    """A rate that changes by 0.02 ppm a second moves pulses by hundreds of ns in ten of them."""
    train = pulses([Move(1000, 300, 1500, 20_000, 0.2), Move(-1000, 300, 1500, 20_000, 0.2)] * 7)

    class Drifting(Analyser):
        def sees(self, seconds: float) -> float:
            return super().sees(seconds + 0.01e-6 * seconds**2)

    analyser = Drifting(0.02, 40)
    told = compared(
        edges(1, train, analyser, Distortion()), "--json", motors={1: train}, analyser=analyser
    ).json

    assert told["same"]
    assert 150 < told["wander_ns"] < 5000


def test_a_clock_that_jumps_more_than_crystals_do_is_not_the_same(compared):
    train = pulses([Move(1000, 300, 1500, 20_000, 0.2), Move(-1000, 300, 1500, 20_000, 0.2)] * 4)
    late = dict.fromkeys(range(4001, 8001), 40e-6)

    result = compared(edges(1, train, ANALYSER, Distortion(moved_seconds=late)), motors={1: train})

    assert result.status == 1


@pytest.mark.parametrize(
    ("rest_seconds", "late_seconds"), [(0.2, 12e-6), (1.0, 12e-6), (0.2, 0.5e-6), (1.0, -1e-6)]
)
def test_a_jump_within_a_pause_is_told_however_small_against_the_capture(
    compared, rest_seconds, late_seconds
):
    move = [Move(300, 300, 1500, 20_000, rest_seconds), Move(-300, 300, 1500, 20_000, rest_seconds)]
    train = pulses(move * 6)
    late = dict.fromkeys(range(1801, 3601), late_seconds)
    found = edges(1, train, ANALYSER, Distortion(moved_seconds=late))

    words = compared(found, motors={1: train})
    told = compared(found, "--json", motors={1: train}).json

    assert (words.status, told["same"]) == (1, False)
    assert told["jump"]["pulse"] == 1801
    assert told["jump"]["seconds"] == pytest.approx(late_seconds, abs=1.5 / 24e6)
    assert re.search(
        rf"^from pulse 1801 of motor 1 on \(\S+ s\), after .* without a pulse, all come .* "
        rf"{'later' if late_seconds > 0 else 'earlier'}: no clock jumps so; or the analyser",
        words.out, re.MULTILINE,
    )  # fmt: skip


def test_pulses_that_come_at_another_rate_from_some_time_on_are_not_the_same(compared):
    train = pulses([Move(500, 300, 1500, 20_000, 0.1), Move(-500, 300, 1500, 20_000, 0.1)] * 10)
    changed = train[5000][0] / 84e6
    late = {n: 2e-6 * (train[n - 1][0] / 84e6 - changed) for n in range(5001, 10_001)}
    analyser = Analyser(0.02, 40)

    result = compared(edges(1, train, analyser, Distortion(moved_seconds=late)), motors={1: train})

    assert result.status == 1
    assert re.search(
        r"^the rate of the clocks changes by [12]\.\d\d ppm in a second, more than the 0\.1 ppm "
        r"that crystals may", result.out, re.MULTILINE,
    )  # fmt: skip


@pytest.mark.parametrize(("sample_hz", "seconds_of_warmth"), [(24e6, 30), (8e6, 12), (100e6, 20)])
def test_crystals_that_warm_up_are_the_same(compared, sample_hz, seconds_of_warmth):
    """0.05 ppm a second at first, as a board does after power-on."""
    train = pulses([Move(1000, 300, 1500, 20_000, 0.2), Move(-1000, 300, 1500, 20_000, 3)] * 5)

    class Warming(Analyser):
        def sees(self, seconds: float) -> float:
            warmth = math.exp(-seconds / seconds_of_warmth)
            return super().sees(seconds + 0.05e-6 * seconds_of_warmth**2 * warmth)

    analyser = Warming(0.02, 40, sample_hz)
    told = compared(
        edges(1, train, analyser, Distortion()), "--json", motors={1: train}, analyser=analyser
    ).json

    assert told["same"], told
    assert 0.02 < told["rate_change_ppm_per_second"] < 0.1
    assert told["jump"] is None


def test_a_wire_that_is_said_to_be_inverted_and_is_not_is_told(compared):
    result = compared(
        edges(1, TRAIN, ANALYSER, Distortion()), "--channels", "STEP1=!STEP1,DIR1=DIR1"
    )

    assert result.status == 1
    assert "STEP of motor 1 is high between the pulses: turned round, the pulse is" in result.out


def test_a_glitch_is_surplus_and_its_width_is_no_pulses(compared):
    found = edges(1, TRAIN, ANALYSER, Distortion())
    rises = [seconds for seconds, name, level in found if name == "STEP1" and level]
    at = rises[49] + 10e-6
    glitch = [(at, "STEP1", 1), (at + 1 / 24e6, "STEP1", 0)]

    (motor,) = compared([*found, *glitch], "--json").json["motors"]

    assert motor["surplus"] == {
        "count": 1,
        "pulses": [
            {
                "first": 51,
                "last": 51,
                "begin_seconds": pytest.approx(at),
                "end_seconds": pytest.approx(at),
            }
        ],
    }
    assert motor["width_ns"][0] > 2000


def test_pulses_as_short_as_samples_are_warned_of(compared):
    slow = Analyser(0.02, 0, 400e3)

    result = compared(edges(1, TRAIN, slow, Distortion()), analyser=slow)

    assert result.status == 0
    assert "pulses are hardly longer than a sample: some may have been missed" in result.out


def test_the_help_tells_how(tool):
    result = tool("compare", "--help")

    assert result.status == 0
    assert "example:\n  rkm04 sim" in result.out
    assert "--channels STEP1=D0,DIR1=D1" in result.out
