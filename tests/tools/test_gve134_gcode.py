"""What each word of G-code becomes, and what is refused with its place."""

from __future__ import annotations

import re

import pytest
from gcode_played import body, content, good, mill, play
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.directives import Pause, Probe, Wait, directive_of

CAM = "let the CAM program write grbl's G-code"
LOOPS = "conditions, loops and jumps are not known here"
SUBPROGRAMS = "subprograms are not: let the CAM program write them out"


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


NO_FEED = "the motion has no feed yet; write F"
BAD = [
    ("G1 X1", 1, 1, NO_FEED),
    ("G93\nG1 F2 X1\nX2", 3, -1, "the motion has no feed of its own in G93; write F"),
    ("X1", 1, 1, "X: no motion is in force; write G0, G1, G2 or G3"),
    ("G80 X1", 1, 5, "X: no motion is in force; write G0, G1, G2 or G3"),
    ("G1 F100 X1 X2", 1, 12, "X stands twice in the line"),
    ("G0 G1 X1 F5", 1, 4, "G1: the line has another G of its group (motion)"),
    ("M3 M5", 1, 4, "M5: the line has another M of its group (spindle)"),
    ("G1 F0", 1, 4, "F0: a feed is more than 0"),
    ("G1 F9000 X1", 1, 4, "F9000 is above the highest feed, 4608.69 mm/min"),
    ("G20\nG1 F182 X1", 2, 4, "F182 is above the highest feed, 181.444 inch/min"),
    ("F9000", 1, 1, "F9000 is above the highest feed, 4608.69 mm/min"),
    ("F200\nG20 F200\nG1 X1", 3, 1, "F200 is above the highest feed, 181.444 inch/min"),
    ("G1 A1 F3376", 1, 7, "F3376 is above the highest feed, 3375 degrees/min"),
    ("G1 F1 X1", 1, 7, "the feed is too low: the unit makes 10 pulses/s at least"),
    ("G0 X1000001", 1, 4, "X takes numbers up to 1000000"),
    ("G0 Z1e3", 1, 6, "E is of 3D printers, and no exponent of a number"),
    ("G0 X1 Y", 1, 7, "Y without a number, found Y"),
    ("G0 X1 . 5", 1, 7, "a number without a letter: ."),
    ("G0 X--1", 1, 4, "X without a number, found X--1"),
    ("G1 X1 garbage", 1, 7, "G without a number, found garbage"),
    ("G0 (one\nG0 X1", 1, 4, "a comment that does not end; write )"),
    ("G0 X1 )", 1, 7, "a ) without its ("),
    ("G0 X#5", 1, 4, "parameters (#) are not known here; write numbers"),
    ("#1=5", 1, 1, "parameters (#) are not known here; write numbers"),
    ("G0 X[1+2]", 1, 4, "expressions ([ ]) are not known here; write numbers"),
    ("/G0 X1", 1, 1, "blocks that may be skipped (/) are not known here; remove the / or the line"),
    ("N1 G0 X1 *57", 1, 10, "checksums (*) are of 3D printers; remove them"),
    ("$H", 1, 1, "commands of a controller ($) do not belong in a program"),
    ("O1000", 1, 1, "programs with numbers and subprograms (O) are not known; let one file be one "
                    "program"),
    ("G0 X1 E5", 1, 7, "E is of 3D printers, and no exponent of a number"),
    ("M104 S200", 1, 1, "M104 is not known; M0 to M9 and M30 are; M codes from 82 on are of 3D "
                        "printers"),
    ("G0 B5", 1, 4, "the machine has no axis B"),
    ("G43 H1 Z5", 1, 1, "G43: tool lengths are not known; set Z with G92 after a tool change"),
    ("G81 Z-5 R1 F100", 1, 1, "G81: canned cycles are not known; let the CAM program write single "
                              "moves"),
    ("G53 G0 X0", 1, 1, "G53: machine positions are not known; use G28 and G92"),
    ("G55", 1, 1, "G55: one coordinate system is known; set it with G92"),
    ("G77", 1, 1, "G77 is not known"),
    ("G1.5 X1", 1, 1, "G1.5 is not known"),
    ("M-3", 1, 1, "M-3 is not known; M0 to M9 and M30 are"),
    ("CYCLE83(1,2)", 1, 1, "calls with parameters are Siemens' dialect; " + CAM),
    ("N5 CALL_X(1)", 1, 4, "named commands are Klipper's, a 3D printer's; " + CAM),
    ("G0 X=10", 1, 4, "assignments (=) are of another dialect; write numbers"),
    ("G0 X1,5", 1, 6, "numbers have a point, no comma"),
    ("0 BEGIN PGM TEST MM", 1, 1, "this is Heidenhain's dialect; " + CAM),
    ("12 L X+10 Y-5 F100", 1, 1, "this is Heidenhain's dialect; " + CAM),
    ("IF [#1 GT 5] GOTO 10", 1, 1, LOOPS + "; let the CAM program write them out"),
    (" N10 WHILE [1] DO1", 1, 6, LOOPS + "; let the CAM program write them out"),
    ("IN;SP1;PU0,0;", 1, 1, "this is HPGL, a plotter's language; " + CAM),
    ("PD10,20;", 1, 1, "this is HPGL, a plotter's language; " + CAM),
    ("M117 hello", 1, 1, "M117 and M118 show texts of 3D printers; remove them"),
    ("<svg>", 1, 1, "this is XML or HTML, as SVG is; let a CAM program make G-code of it"),
    ("C10,-20 ; line 2", 1, 1, "this is a vector file; name it .gve"),
    ("M98 P1", 1, 1, "M98 is not known; M0 to M9 and M30 are; " + SUBPROGRAMS),
    ("(never ends here", 1, 1, "a comment that does not end; write )"),
    ("(one (two) three)", 1, 1, "a comment that does not end; write )"),
    ("L X+10 R0 F", 1, 1, "L without a number, found L"),
    ("G0 X1 I2", 1, 7, "I has no meaning in this line"),
    ("G0 X1 P2", 1, 7, "P has no meaning in this line"),
    ("G92.1 X1", 1, 7, "X has no meaning in this line"),
    ("G4", 1, 1, "G4 takes how long to dwell: P, in seconds"),
    ("G4 P-1", 1, 4, "G4 takes how long to dwell: P, in seconds"),
    ("G92", 1, 1, "G92 takes the positions that axes are to have"),
    ("G1 G92 X0 F5", 1, 1, "the line has two G that take its positions; divide it"),
    ("G28 A0", 1, 5, "the machine file has no reference run of A"),
    ("G38.2 F50", 1, 1, "G38.2 takes the position to which the probe may go"),
    ("G38.2 Z0 F50", 1, 7, "G38.2: the way is shorter than a pulse"),
    ("G38.2 Z0.001 F50", 1, 7, "G38.2: the way is shorter than a pulse"),
    ("G93 G38.2 Z-1 F50", 1, 5, "G38.2 takes a feed of G94"),
    ("F100 G2 X10", 1, 6, "the arc has no centre; write I and J, or R"),
    ("F100 G2 X10 I5 R5", 1, 16, "the arc has both R and a centre; keep one of them"),
    ("F100 G2 X10 K5", 1, 13, "K is not in the plane of the arc, G17"),
    ("F100 G2 X10 I4", 1, 13, "the arc does not close: its start is 4.0000 mm from the centre, "
                              "its end 6.0000 mm"),
    ("F100 G2 X10 R4.9", 1, 13, "the arc does not close: R4.9 mm does not reach the end, 10.0000 "
                                "mm away"),
    ("F100 G2 X0 R4", 1, 12, "an arc with R must end elsewhere than it starts; write a circle with "
                             "I, J, K"),
    ("F100 G2 X10 I0", 1, 13, "the arc has no radius: its centre is its start or its end"),
    ("M3", 1, 1, "M3: the spindle has no speed yet; write S"),
    ("S99999", 1, 1, "S99999: the spindle turns with 0 to 24000 turns a minute"),
    ("S100 M4", 1, 6, "M4: by the machine file the spindle turns one way only"),
    ("M6", 1, 1, "M6: no tool has been chosen; write T"),
    ("T1.5", 1, 1, "T takes the number of a tool, a whole one"),
    ("M8 M9", 1, 4, "M9 stands beside M7 or M8; keep one of them"),
    ("G0 N5", 1, 4, "a line's number stands at its beginning"),
    ("N-1 G0 X1", 1, 1, "N-1: a line's number has no sign"),
    ("F300\nG20\nG21\nG1 X1", 4, 1, "the motion has no feed since G21, with which that from before "
                                    "does not hold; write F"),
    ("G93\nG1 X1 F2\nG94\nX2", 4, -1, "the motion has no feed since G94, with which that from "
                                     "before does not hold; write F"),
    ("G0 X1 ž", 1, 7, "no word of G-code: ž"),
    ("G0 X1 % 5", 1, 7, "% stands alone in its line"),
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
