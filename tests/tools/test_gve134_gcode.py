"""What each word of G-code becomes, and what is refused with its place."""

from __future__ import annotations

import re

import pytest
from gcode_bad import BAD
from gcode_played import body, content, good, mill, play
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.directives import Pause, Probe, Wait, directive_of


def test_a_file_begins_with_what_holds_for_all_of_it() -> None:
    assert good("").lines == [
        "; a.nc, for Small mill; written by gve134 gcode",
        "; ;@wait, ;@pause and ;@probe are for the host, gve134 send and sim",
        "L0,0,0,0",
        "T1",
        "VK",
        "B200000",
        "VL16000,16000,12000,20000",
        "VJ1600,1600,800,1000",
    ]


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("G0 X10", ["V200000", "A160", "C3200,0,0,0 ; line 1", "L0,0,0,0"]),
        ("G1 F300 X10\nX0", ["V1600", "A160", "C3200,0,0,0 ; line 1", "C-3200,0,0,0 ; line 2",
                             "L0,0,0,0"]),
        ("G1Z-1F300", ["V2000", "A120", "C0,0,-400,0 ; line 1", "L0,0,0,0"]),
        ("g1 f360\n a 1 (turn) ; on", ["V2133", "A100", "C0,0,0,356 ; line 2", "L0,0,0,0"]),
        ("G20\nN20 G91 G1 X.1 F10", ["V1355", "A160", "C813,0,0,0 ; line 2", "L0,0,0,0"]),
        ("G92 X5\nG0 X0", ["V200000", "A160", "C-1600,0,0,0 ; line 2", "L0,0,0,0"]),
        ("G0 X1\nG92 X5\nG92.1\nG0 X0", ["V200000", "A160", "C320,0,0,0 ; line 1",
                                         "C-320,0,0,0 ; line 4", "L0,0,0,0"]),
        ("G0 X1\nG4 P2.5", ["V200000", "A160", "C320,0,0,0 ; line 1", "L0,0,0,0", ";@wait 2.5"]),
        ("G4 P0", []),
        ("G1 X0.001 F300", []),
        ("S12000 M3\nS24000\nM5", ["!7V500", ";@wait 2", "!7V1000", "!7V0"]),
        ("S1 M3 M8\nM7\nM9\nM2", ["!7V1", ";@wait 2", "O0,FA", "O0,F2", "O0,FE", "!7V0"]),
        ("M8 M7", ["O0,F3"]),
        ("M8 M7\nS600 M3\nM30", ["O0,F3", "!7V25", ";@wait 2", "!7V0", "O0,FF"]),
        ("G0 X1 M0 (turn it)", ["V200000", "A160", "C320,0,0,0 ; line 1", "L0,0,0,0",
                                ";@pause line 1: turn it"]),
        ("M1", [";@pause line 1: M1"]),
        ("S600 M3\nT3 M6 (6 mm)", ["!7V25", ";@wait 2", "!7V0",
                                   ";@pause line 2: put in tool 3 (6 mm)"]),
        ("G40 G49 G80 G54 G64 G91.1 G17 G21 G90 G94", []),
        ("%\nN1 G0\n%", []),
        ("", []),
    ],
)  # fmt: skip
def test_each_word_becomes_what_the_unit_has_for_it(program: str, expected: list[str]) -> None:
    assert body(program) == expected


def test_g28_is_a_reference_run_of_each_axis_z_first() -> None:
    assert body("G0 X1\nG28") == [
        "V200000", "A160", "C320,0,0,0 ; line 1", "L0,0,0,0",
        ";@wait 0.01", "SW2,07", "A120", "WZ36000,4000,4000,400 ; line 2", "NZ0",
        ";@wait 0.01", "SW2,07", "A160", "WX-100000,8000,3200,320 ; line 2", "NX0",
        ";@wait 0.01", "SW2,07", "WY-68000,8000,3200,320 ; line 2", "NY0",
    ]  # fmt: skip


def test_g28_with_positions_goes_there_first_and_homes_those_axes_alone() -> None:
    lines = body("G28 Z5")
    assert lines[:3] == ["V200000", "A120", "C0,0,2000,0 ; line 1"]
    assert [line[:2] for line in lines if line[0] == "W"] == ["WZ"]


def test_after_g28_an_axis_is_where_the_machine_file_says() -> None:
    told = content()
    told["gve134"]["axes"]["x"]["homing"]["position_steps"] = -640
    lines = body("G92 X100\nG28 X100\nG0 X1", mill(told))
    assert lines[-2:] == ["C960,0,0,0 ; line 3", "L0,0,0,0"]
    assert "NX-640" in lines


def test_after_g28_limits_of_the_machine_file_are_kept() -> None:
    assert good("G0 X400").errors == []
    ((line, column, message),) = play("G28\nG0 Y10\nG1 X299 F100\nX301").errors
    assert (line, column) == (4, 1)
    assert message == "X would go to 301, beyond its highest position, 300 mm"
    ((_, _, message),) = play("G28\nG1 F100 X50 Y2\nG3 X50 I-10").errors
    assert message.startswith("Y would go to -")


def test_a_probe_ends_a_vector_of_its_own() -> None:
    assert body("G91 G38.2 Z-10 F50\nG0 Z1\nG92 Z0\nG90 G0 Z5") == [
        ";@wait 0.01", "SW3,00", "SW1,80", "V333", "A120", "L0,0,-4000,0 ; line 1", ";@probe",
        "V200000", "C0,0,400,0 ; line 2", "C0,0,2000,0 ; line 4", "L0,0,0,0",
    ]  # fmt: skip


def test_nobody_knows_where_a_probed_axis_is_but_the_others_are_known() -> None:
    played = play("G38.2 Z-10 F50\nG0 X1\nG0 Z0\nG28 Z0\nG28")
    assert [(line, column) for line, column, _ in played.errors] == [(3, 4), (4, 5)]
    good("G38.2 Z-10 F50\nG91 G28 Z0\nG90 G0 Z-5")


def test_a_spindle_that_turns_both_ways_stops_in_between() -> None:
    told = content()
    told["gve134"]["spindle"]["reverse_bit"] = 4
    assert body("S24000 M3\nM4\nM5", mill(told)) == [
        "O0,FF", "!7V1000", ";@wait 2", "!7V0", ";@wait 2", "O0,EF", "!7V1000", ";@wait 2", "!7V0",
    ]  # fmt: skip


def test_where_vk_would_count_above_the_top_the_longest_axis_is_counted() -> None:
    told = content()
    for axis in told["gve134"]["axes"].values():
        axis["speed_steps_per_s"] = 200_000
    told["motors"][2]["steps_per_mm"] = 320
    told["gve134"]["axes"]["z"]["accel_steps_per_s2"] = 160_000
    lines = body("G0 X10 Y10 Z10\nG1 X20 Y20 Z20 F60000\nX30", mill(told))
    assert lines == [
        "VN", "V200000", "A160", "C3200,3200,3200,0 ; line 1",
        "V184752", "C3200,3200,3200,0 ; line 2",
        "VK", "V200000", "C3200,0,0,0 ; line 3", "L0,0,0,0",
    ]  # fmt: skip


@pytest.mark.parametrize(("program", "line", "column", "message"), BAD)
def test_what_is_wrong_is_told_with_its_place(
    program: str, line: int, column: int, message: str
) -> None:
    found = play(program).errors
    if column < 0:
        assert [(each[0], each[2]) for each in found] == [(line, message)]
    else:
        assert (line, column, message) in found


def test_every_error_is_told_and_none_twice() -> None:
    program = "\n".join(text for text, line, _, _ in BAD if line == 1 and "\n" not in text)
    lines = {line for line, _, _ in play(program).errors}
    # What a line alone lacks another one may have given.
    assert len(lines) > len(program.split("\n")) - 8


def test_a_machine_without_an_axis_a_spindle_or_a_probe_says_so() -> None:
    told = content()
    del told["gve134"]["axes"]["a"], told["gve134"]["spindle"], told["gve134"]["probe"]
    for axis in told["gve134"]["axes"].values():
        del axis["homing"]
    errors = play("G0 A1\nM3\nS5\nG38.2 Z-1 F50\nG28", mill(told)).errors
    assert [message for _, _, message in errors] == [
        "the machine has no axis A",
        "the machine file tells of no spindle",
        "the machine file tells of no spindle",
        "the machine file tells of no probe",
        "G28: the machine file tells of no reference run",
    ]


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("G4 P500", [(1, "G4 P500 is a dwell of 500 s; P is in seconds here")]),
        ("M30\nG0 X1\nG0 X2", [(2, "what follows the end of the program is left out")]),
        ("%\nG0 X1\n%\n\nnotes", [(5, "what follows the end of the program is left out")]),
        ("S50 M3", [(1, "the program ends without M2 or M30: the spindle stays on")]),
        ("S50 M3\nT1 M6\nG0 X1\nG1 F100 Z-1\nX2\nM2", [
            (4, "the spindle is off since the tool was changed (M6); write M3 after it"),
        ]),
        ("S50 M3\nT1 M6\nM3\nG1 F100 Z-1\nM2", []),
        ("T1 M6\nG1 F100 Z-1\nM2", []),
        ("G1 F3000 Z1\nZ2\nX5", [(1, "vectors go slower than F, at an axis' limit; there are 2, "
                                     "the first one here")]),
    ],
)  # fmt: skip
def test_what_is_surely_not_meant_is_a_warning(
    program: str, expected: list[tuple[int, str]]
) -> None:
    assert good(program).warnings == expected


def test_a_line_without_end_is_one_error() -> None:
    ((line, column, message),) = play("G0 X1\nG0 " + "X" * 5000 + "\nG0 X2").errors
    assert (line, column) == (2, 1001)
    assert "is this G-code?" in message


@given(st.text(alphabet="GMXYZAIJKRFSTPN0123456789.-+ ()#;%\t[]Ežč\x00", max_size=60),
       st.text(alphabet="GXYZIJRF0123456789.- ", max_size=40))  # fmt: skip
@example("G2 R9", "F9 X1 R.5")
@settings(max_examples=400, deadline=None)
def test_any_text_is_turned_or_refused_inside_it(one: str, two: str) -> None:
    texts = [one, two]
    played = play(["G90", "F100", *texts])

    for line, column, message in played.errors:
        assert 3 <= line <= 4
        assert 1 <= column <= len(texts[line - 3]) + 1
        assert re.fullmatch(r"[^\n\x00]+", message)
    if not played.errors:
        assert host.check("\n".join(played.lines)).errors == []


NUMBERS = ("0", "1", "-1", "2.5", ".5", "-.25", "10", "123.4567", "-0", "99", "0.001", "400")
G_NUMBERS = (0, 1, 2, 3, 4, 17, 18, 19, 20, 21, 28, 38.2, 80, 90, 91, 92, 92.1, 93, 94)
CODES = [*(f"G{each}" for each in G_NUMBERS), *(f"M{each}" for each in range(10)), "T1", "N10", "%"]
word = st.sampled_from(CODES) | st.builds(
    str.__add__, st.sampled_from("XYZAIJKRFSP"), st.sampled_from(NUMBERS)
)


@given(st.lists(st.lists(word, min_size=1, max_size=6).map(" ".join), max_size=12))
@settings(max_examples=300, deadline=None)
def test_any_words_are_turned_into_what_the_unit_takes_or_refused(lines: list[str]) -> None:
    played = play(["F100 S100", *lines])

    for line, column, _ in played.errors:
        assert 1 <= column <= len(lines[line - 2]) + 1
    assert host.check("\n".join(played.lines)).errors == []


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (";@wait 2.5", Wait(2.5)),
        (";@wait 0.01", Wait(0.01)),
        (";@pause line 7: put in tool 1", Pause("line 7: put in tool 1")),
        (";@pause", Pause("")),
        ("  ;@probe", Probe()),
        ("C1,2,3,4 ; line 5", None),
        ("; ;@wait 5", None),
    ],
)
def test_lines_for_the_host_are_known(line: str, expected: object) -> None:
    assert directive_of(line) == expected


@pytest.mark.parametrize("line", [";@wait", ";@wait x", ";@stop", ";@probe X", ";@pauses"])
def test_lines_for_a_host_that_knows_more_are_refused(line: str) -> None:
    with pytest.raises(ValueError, match="nothing is known of ;@"):
        directive_of(line)
