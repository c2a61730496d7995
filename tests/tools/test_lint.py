"""The warnings: each rule finds what it is for, and leaves reasonable programs alone."""

from __future__ import annotations

import pytest

WARNED = [
    ("missing-label", "J5", 1),
    ("missing-label", "F1 R I05H5", 6),
    ("missing-label", "F1 R '5", 6),
    ("duplicate-label", "@1 F1 R W9 @1 J1", 12),
    ("loop-end", "F1 R E", 6),
    ("loop-open", "L3 F1 R", 1),
    ("loop-depth", "F1 " + "L2 " * 9 + "R " + "E " * 9, 28),
    ("call-depth", "F1 '1 @9 W1 J9 @1 '2 . @2 '3 . @3 '4 . @4 '5 . @5 '6 . @6 '7 . @7 R .", 59),
    ("call-depth", "F1 '1 @9 W1 J9 @1 R '1 .", 4),
    ("return", "F1 R .", 6),
    ("return", "F1 '3 W1 @3 R .", 15),
    ("speed", "S200 V100 F1 R", 6),
    ("speed", "S100 V500 F1 R S600 R", 16),
    ("speed", "S200 V100", 6),
    ("speed", "S200 V500 F1 Y V100 Y R F1 R", 16),
    ("speed", "S200 V500 F1 Y V100 Y G5", 16),
    ("speed", "S200 V500 F1 Y R V100 B1 R", 18),
    ("unreachable", "F1 @1 R J1 F2 R", 12),
    ("unreachable", "F1 R J2 @1 R @2 W1", 9),
    ("unreachable", "G+ F1 R", 4),
    ("unreachable", "F1 '3 W1 @3 J3 .", 7),
    ("busy-loop", "@1 J1", 4),
    ("busy-loop", "@1 I01L1 F1 R", 4),
    ("busy-loop", "@1 T01 C01 J1", 12),
    ("busy-loop", "F1 R @1 '3 J1 @3 T01 .", 12),
    ("busy-loop", "@1 L3 T01 C01 E J1", 17),
    ("no-steps", "R", 1),
    ("no-steps", "R F5 R", 1),
    ("no-steps", "V500 Y F5 R", 6),
    ("ignored", "F1 R K", 6),
    ("ignored", "F1 R C75", 6),
    ("too-many", "F1 " + "R " * 700, 4 + 2 * 699),
    ("sections", "F1 " + "Y " * 11 + "R", 4 + 2 * 10),
    ("mark", "F1 Y T55 Y R", 6),
    ("mark-off", "T52 F1 Y Y R C52 C02 W5 R", 14),
    ("mark-off", "T52 F1 Y C52 Y R", 10),
    ("mark-off", "T52 T53 F1 Y Y C53 R", 16),
    ("simulation", "T41 F1 R", 1),
    ("simulation", "F1 R C41", 6),
    ("total-stop", "F1 R X04", 6),
    ("total-stop", "F1 R X04 T01 @1", 6),
    ("loop-returned", "F1 J9 @1 L5 . @9 '1 R E", 10),
    ("direction", "F1 Y B1 Y R", 9),
    ("direction", "F1 Y D Y R", 8),
    ("lost", "F1 R \\ F2 R", 6),
    ("empty", " { nothing } ", 1),
]

QUIET = [
    "K",
    "C75",
    "V500",
    "\\",
    "\\ F1 R",
    "F1 R",
    "H",
    "G500",
    "S500 V500 F1 R",
    "V50 S20 F1 R",
    "V50 F1 R",
    "G+",
    "M05 G+ F1 R",
    "G+ ]",
    "[ F1 @1 R J1 ]",
    "[ F1 R",
    "F1 L2 R L3 W1 E E",
    "F1 " + "L2 " * 8 + "R " + "E " * 8,
    "F1 '1 @9 W1 J9 @1 '2 . @2 '3 . @3 '4 . @4 '5 . @5 '6 . @6 R .",
    "F1 '3 '3 R '3 @1 W1 J1 @3 T01 .",
    "@1 I01L6 F2500 '3 Z3 J1 @6 B2500 '3 Z4 J1 @3 R W2000 D R .",
    "F1 @1 '3 J1 @3 R .",
    "@1 O01 J1",
    "@1 Z85 J1",
    "@1 )1 (2 J1",
    "@1 I01H2 W1 J1 @2 F1 R J1",
    "I01H2 @3 W1 J3 @2 J3",
    "F1 R I01H2 J3 @2 B1 R @3 W1",
    "L200 T01 C01 E",
    "F1 " + "R " * 699,
    "F1 " + "Y " * 10 + "R",
    "\\ S1000 A1 V1000 F10 Y V10 F10 Y R",
    "S200 V100 F1 Y V500 Y R R",
    "S200 V500 F1 Y V100 Y R D R",
    "F1 Y Y R B1 Y R",
    "F1 Y R T55 B1 Y D R",
    "F1 Y R D Y R",
    "T55 F1 Y R",
    "T55 F1 Y Y R C05 R",
    "T55 F1 Y Y R C55 F1 R",
    "T55 F1 Y C55 T55 Y R",
    "T55 C55 F1 Y R",
    "T41",
    "T41 C41",
    "X04",
    "S100 X04",
    "X04 F1 R",
    "F1 R X04 [",
    "F1 R X04 '1 @9 W1 J9 @1 R .",
    "@1 L10 F10 R I01H5 E @5 W10 J1",
    "F1 '1 @9 W1 J9 @1 L5 R I01H2 E @2 .",
    "F1 L2 '1 @9 W1 J9 @1 R E .",
    "'3 @1 R W1 J1 @3 F5 .",
]


def rules(tool, path) -> list[tuple[str, int]]:
    """Rule and column of all warnings."""
    result = tool("check", path, "--json")
    assert result.status == 0
    (file,) = result.json["files"]
    return [(warning["rule"], warning["column"]) for warning in file["warnings"]]


@pytest.mark.parametrize(("rule", "text", "column"), WARNED)
def test_a_rule_finds_what_it_is_for(tool, write, rule, text, column):
    assert (rule, column) in rules(tool, write(text))


@pytest.mark.parametrize("text", QUIET)
def test_a_reasonable_program_has_no_warning(tool, write, text):
    assert rules(tool, write(text)) == []


def test_a_warning_shows_its_place_and_the_status_stays_0(tool, write):
    path = write("F1 R\nJ5")

    result = tool("check", path)

    assert result.status == 0
    assert result.out.splitlines() == [
        f"{path}:2:1: warning: there is no label 5 (@5) in this file",
        "J5",
        "^",
        f"{path}: 3 commands, 1 warning",
    ]


def test_a_busy_loop_that_polls_an_input_is_told_how_to_wait(tool, write):
    result = tool("check", write("@1 I01L1"))

    assert "never waits, the program is busy; wait for an input with O or Z" in result.out


def test_a_program_with_errors_has_no_warnings(tool, write):
    result = tool("check", write("J5 Q"), "--json")

    assert result.json["files"][0]["warnings"] == []


def test_a_loop_of_many_labels_is_reported_once(tool, write):
    path = write("@1 @2 @3 T01 J1")

    assert rules(tool, path) == [("busy-loop", 14)]


def test_only_the_commands_after_the_last_reset_count(tool, write):
    assert rules(tool, write("@1 \\ J1")) == [("lost", 4), ("missing-label", 6)]
