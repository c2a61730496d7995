"""`compare`: what was not captured is not the same, unless it was left out on purpose."""

from __future__ import annotations

import pytest
from captures import (
    Analyser,
    Distortion,
    Move,
    csv_file,
    edges,
    pulses,
    samples,
    sr_file,
    steps_file,
    vcd_file,
)

ANALYSER = Analyser(0.02, 40)
TRAIN = pulses([Move(100, 200, 2000, 30_000, 0.01), Move(-100, 200, 2000, 30_000)])
BACK = pulses([Move(-80, 100, 3000, 30_000)])
FIRST = edges(1, TRAIN, ANALYSER, Distortion())
BOTH = [*FIRST, *edges(3, BACK, ANALYSER, Distortion())]
WITHIN = "is within 53.6 ns = 4.5 ticks"


@pytest.fixture
def compared(tool, tmp_path):
    """Compare motors 1 and 3 with a dump in which some channels have other names."""

    def run(*options, renamed=(), found=BOTH):
        steps = steps_file(tmp_path / "steps.csv", {1: TRAIN, 3: BACK})
        path = vcd_file(tmp_path / "a.vcd", found, ANALYSER)
        text = path.read_text()
        for old, new in renamed:
            assert text.count(f" {old} $end") == 1
            text = text.replace(f" {old} $end", f" {new} $end")
        path.write_text(text)
        return tool("compare", path, steps, *options)

    return run


def test_a_motor_of_the_simulation_that_was_not_captured_is_not_the_same(compared):
    result = compared(found=FIRST)
    told = compared("--json", found=FIRST).json

    assert result.status == 1
    assert (
        "not captured: STEP of motor 3, which the simulation moves: look at the names of the "
        "channels; if it is left out on purpose, say so: --channels STEP1=STEP1,DIR1=DIR1\n"
    ) in result.out
    assert result.out.splitlines()[-1].startswith("not the same: see above")
    assert (told["same"], told["not_captured"], told["dir_not_captured"]) == (False, [3], [])
    assert not told["left_out_on_purpose"]


def test_what_is_proposed_for_leaving_a_motor_out_is_the_same_and_says_of_which_one(compared):
    options = ["--channels", "STEP1=STEP1,DIR1=DIR1"]

    result = compared(*options, found=FIRST)
    told = compared(*options, "--json", found=FIRST).json

    assert result.status == 0
    assert result.out.splitlines()[-1].startswith(
        f"the same: every pulse of motor 1 {WITHIN}; left out: STEP of motor 3; what is below"
    )
    assert "not captured" not in result.out
    assert (told["same"], told["not_captured"], told["left_out_on_purpose"]) == (True, [3], True)


@pytest.mark.parametrize(
    ("renamed", "absent"),
    [
        ([("STEP3", "STPE3")], "STEP of motor 3"),
        ([("DIR3", "DRI3")], "DIR of motor 3"),
        ([("STEP1", "STPE1"), ("DIR3", "DRI3")], "STEP of motor 1 and DIR of motor 3"),
    ],
)
def test_a_misspelt_channel_is_not_the_same(compared, renamed, absent):
    result = compared(renamed=renamed)

    assert result.status == 1
    assert f"not captured: {absent}, which the simulation moves: look at the names" in result.out


def test_a_dir_may_be_left_out_on_purpose(compared):
    result = compared("--channels", "STEP1=STEP1,DIR1=DIR1,STEP3=STEP3")

    assert result.status == 0
    assert result.out.splitlines()[-1].startswith(
        f"the same: every pulse of motors 1, 3 {WITHIN}; left out: DIR of motor 3; what is below"
    )


def test_of_a_motor_that_stands_nothing_need_be_captured(compared):
    stood = [(0.5, "STEP2", 1), (0.5, "DIR2", 1), (0.6, "STEP2", 0)]

    result = compared("--part", renamed=[("DIR2", "x")], found=[*BOTH, *stood[:2], stood[2]])

    assert "not captured: DIR of motor 2: nothing is said about it" in result.out
    assert "which the simulation moves" not in result.out


def test_what_differs_tells_what_was_left_out_too(compared):
    late = Distortion(moved_seconds={60: 2e-6})

    result = compared("--channels", "STEP1=STEP1", found=edges(1, TRAIN, ANALYSER, late))

    assert result.status == 1
    assert result.out.splitlines()[-1].endswith("; left out: STEP of motor 3 and DIR of motor 1")


def test_two_channels_of_a_dump_with_one_name_are_refused(compared):
    result = compared(renamed=[("STEP3", "STEP1")])

    assert result.status == 2
    assert "two of its channels are named STEP1; rename one" in result.complaint
    named = compared("--channels", "STEP3=STEP1", renamed=[("STEP3", "STEP1")])
    assert "two of its channels are named STEP1" in named.complaint


def test_names_that_are_no_wires_of_motors_may_be_there_twice(compared):
    more = [(0.001, "STEP2", 1), (0.002, "DIR2", 1), (0.003, "STEP2", 0)]

    result = compared(renamed=[("STEP2", "x"), ("DIR2", "x")], found=[*BOTH, *more])

    assert result.status == 0


def test_a_wire_that_stands_in_two_scopes_is_one(compared):
    result = compared(renamed=[("STEP1", "STEP1 $end\n$var wire 1 ! STEP1")])

    assert result.status == 0


def test_two_channels_of_a_session_or_a_table_with_one_name_are_refused(tool, tmp_path):
    steps = steps_file(tmp_path / "steps.csv", {1: TRAIN})
    session = sr_file(tmp_path / "a.sr", samples(FIRST, ANALYSER), ["STEP1", "DIR1", "STEP1"])
    table = csv_file(tmp_path / "a.csv", FIRST)
    rows = table.read_text().splitlines()
    table.write_text("\n".join(f"{row},{row.split(',')[1]}" for row in rows))

    for path in (session, table):
        result = tool("compare", path, steps)

        assert result.status == 2
        assert "two of its channels are named STEP1; rename one" in result.complaint


def test_so_it_is_where_no_other_wire_has_a_pulse(compared):
    """The simulator's own waves have all four motors, of which the others may stand."""
    stood = [(0.5, "STEP2", 0), (0.5, "DIR2", 0)]
    wide = [("STEP1", "x $end\n$var wire 4 ~ STEP1"), ("DIR1", "DIR9")]

    result = compared(renamed=wide, found=[*FIRST, *stood])

    assert result.status == 2
    assert "has no pulse in STEP2; STEP1: more than one bit, and so not used; check" in result.err


@pytest.mark.parametrize("kind", ["wire 8", "reg 2"])
def test_a_variable_of_more_bits_is_no_wire_and_is_told(compared, kind):
    wide = [("STEP3", f"x $end\n$var {kind} ~ STEP3 [7:0]")]

    result = compared(renamed=wide)
    chosen = compared("--channels", "STEP1=STEP1,DIR1=DIR1,STEP3=STEP3", renamed=wide)

    assert result.status == 1
    assert "not used, as it has more than one bit: STEP3" in result.out
    assert "not captured: STEP of motor 3, which the simulation moves" in result.out
    assert chosen.status == 2
    assert "STEP3 has more than one bit; its channels are" in chosen.complaint


def test_where_only_variables_of_more_bits_are_named_as_wires_they_are_told(compared):
    wide = [("STEP1", "x $end\n$var wire 8 ~ STEP1")]

    result = compared(renamed=wide, found=FIRST)

    assert result.status == 2
    assert "its channels are x, DIR1 (STEP1: of more than one bit), and none" in result.complaint
