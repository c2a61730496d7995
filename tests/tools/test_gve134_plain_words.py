"""What a user is told where something did not go as meant."""

from __future__ import annotations

from pathlib import Path

import pytest
from rkm04_tools.failure import Failure
from rkm04_tools.gve134.client_memory import END, HEAD, read_file
from rkm04_tools.gve134.gcode.words import read_line
from rkm04_tools.gve134.job import Command
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.gve134.state import INTA, INTCOM, RUN, Flags, Status

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("bits", "told"),
    [(0, "nothing"), (INTA, "a reference run (W) that failed"), (INTA | INTCOM | RUN, "H")],
)
def test_status_says_what_has_stopped_the_axes(bits: int, told: str) -> None:
    text = Status((0,) * 7, Flags(bits), (255, 255), 0).as_text()

    assert f"stopped by    {told}" in text


def test_a_backup_that_was_cut_off_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "unit.mem"
    path.write_text(HEAD + "00: FF 01\n")
    with pytest.raises(Failure, match=r"cut off, it has 2 of 256 bytes .* nothing was done"):
        read_file(str(path))

    path.write_text("00: FF 01\n")
    assert read_file(str(path)) == {0: 255, 1: 1}
    path.write_text(HEAD + "00: FF 01\n" + END)
    assert read_file(str(path)) == {0: 255, 1: 1}


@pytest.mark.parametrize("text", ["o100 sub", "N5 O<fast> call [1]", "o1 while [#1 LT 2]"])
def test_subprograms_are_one_error_in_plain_words(text: str) -> None:
    (trouble,) = read_line(text).troubles

    assert trouble.message.startswith("subprograms, loops and branches")
    assert text[trouble.column - 1] in "oO"


@pytest.mark.parametrize(
    ("commands", "told"),
    [
        ([], "NOT KNOWN"),
        (["!7V300"], "THE SPINDLE TURNS at 30 %"),
        (["!7V300", "!7V0"], "the spindle is off"),
        (["!7V300", "J"], "the spindle is off"),
        (["!7V300", "O0,FF"], "NOT KNOWN"),
    ],
)
def test_whether_the_spindle_turns_is_told_as_the_file_has_set_it(
    commands: list[str], told: str
) -> None:
    sender = Sender(None, None)  # type: ignore[arg-type]
    sender._taken([Command(1, text) for text in commands])

    assert told in sender.spindle_text


def test_options_of_gcode_are_refused_for_vectors(gve134, tmp_path: Path) -> None:
    (tmp_path / "a.gve").write_text("L1\n")

    result = gve134("send", tmp_path / "a.gve", "--start", "1,2", "--port", "socket://127.0.0.1:1")

    assert result.status == 2
    assert "--start and --tolerance are for G-code" in result.err
