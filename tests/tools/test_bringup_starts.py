"""`bringup`: who it is that answers, and a board that starts anew while the walk goes on."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

import pytest
from bringup_bench import NAME, FakeLine, Hands, powered, whole
from rkm04_tools import board
from rkm04_tools.bringup import talk
from rkm04_tools.line_errors import GarbledAnswer

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host") / "bin" / "rkm04-vboard"
modelled = pytest.mark.skipif(
    not PROGRAM.is_file() or not shutil.which(board.COMPILER),
    reason="there is no virtual board, or no compiler for the image",
)


@modelled
def test_a_board_that_starts_by_itself_is_not_good_though_all_else_is(tool, tmp_path, monkeypatch):
    with powered(tmp_path, monkeypatch, "f405", "--fault", "2000:reset") as bench:
        monkeypatch.setattr("sys.stdin", Hands(["y", "", "", *bench.only("clocks", ["", ""])[2:]]))
        result = tool("bringup", "--port", "virtual")

    assert result.status == 1
    assert re.search(r"BAD +starts anew +reset \(reset pin\)", result.out)
    assert "clocks (starts anew); NOT DONE: part" in result.out


@modelled
def test_an_image_of_another_header_of_that_board_ends_the_walk(tool, tmp_path, monkeypatch):
    header = (board.BOARDS / "f405" / "board.h").read_text()
    with powered(tmp_path, monkeypatch, "f405") as bench:
        (tmp_path / "boards" / "f405").mkdir(parents=True)
        changed = header.replace("X(BO_1, B, 8, OUT)", "X(BO_1, D, 2, OUT)")
        (tmp_path / "boards" / "f405" / "board.h").write_text(changed)
        monkeypatch.setattr(board, "BOARDS", tmp_path / "boards")
        monkeypatch.setattr("sys.stdin", Hands(bench.walked()))
        result = tool("bringup", "--board", "f405", "--port", "virtual")

    assert result.status == 1
    assert re.search(r"not bringup-f405 4 \w{8}, whose board\.h is another one: flash", result.out)
    assert "NOT DONE: line, part" in result.out


def test_a_start_that_was_not_asked_for_is_kept_in_mind():
    late = whole(b"crystal_ready 1\n", b"c")
    inputs = whole(b"inputs 00\n", b"i")
    asked = talk.Talk(FakeLine(NAME, NAME + late, inputs, NAME[:-9] + b"\n"))

    for command in ("h", "h", "i"):
        asked.ask(command)
        assert not asked.started
    with pytest.raises(GarbledAnswer):
        asked.ask("i")
    assert asked.started


def test_a_start_before_the_first_question_is_that_of_the_power():
    line = FakeLine(NAME)
    line.write(b"")
    line.texts = [NAME]
    asked = talk.Talk(line)

    asked.ask("h")
    assert not asked.started
