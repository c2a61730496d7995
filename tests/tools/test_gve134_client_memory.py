"""`gve134 memory` on a fake unit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine

Tool = Any
Result = Any


@pytest.fixture
def gve_unit() -> FakeGve:
    return FakeGve(vector_s=0.001)


@pytest.fixture
def unit(gve_unit: FakeGve, gve_line: FakeGveLine) -> FakeGve:
    """The unit at the end of the line."""
    return gve_unit


# ---- memory ----


def test_memory_is_read_and_written(gve: Tool, unit: FakeGve) -> None:
    assert gve("memory", "set", "0c", "3").out == "0C: 03\n"
    assert unit.memory[0x0C] == 3
    assert gve("memory", "get", "0B", "--count", "2").out == "0B: FF\n0C: 03\n"
    assert gve("memory", "set", "10", "12345678", "--as", "word").status == 0
    assert unit.memory[0x10:0x14] == bytes([0x78, 0x56, 0x34, 0x12])


def test_a_byte_that_is_not_kept_is_told(gve: Tool, unit: FakeGve) -> None:
    unit.stuck = {5}

    result = gve("memory", "set", "05", "3")

    assert result.status == 1
    assert "3 was written, and reads as FF" in result.complaint


def test_what_is_written_while_the_axes_move_is_refused(gve: Tool, unit: FakeGve) -> None:
    unit.vector_s = 1000.0
    unit.take(b"!0L1000\r")

    result = gve("memory", "set", "05", "3")

    assert result.status == 1
    assert "not while a vector runs" in result.complaint
    assert "after a fault" not in result.complaint
    assert gve("memory", "get", "0", "--count", "0").complaint.endswith(": write 1 or more")


def test_a_backup_comes_back_and_only_what_differs_is_written(
    gve: Tool, unit: FakeGve, tmp_path: Path
) -> None:
    unit.memory[:] = bytes(range(256))
    path = tmp_path / "unit.mem"
    assert gve("memory", "backup", path).status == 0
    assert gve("memory", "diff", path).status == 0
    unit.memory[7:9] = b"\0\0"

    assert gve("memory", "diff", path).out == "07: file 07, unit 00\n08: file 08, unit 00\n"
    result = gve("memory", "restore", path)

    assert result.out == f"{path}: 2 bytes written, the others were so already\n"
    assert unit.memory == bytes(range(256))
    assert [each for each in unit.done if each.startswith("EW")] == ["EW07,07", "EW08,08"]


def test_bytes_that_are_not_kept_are_named(gve: Tool, unit: FakeGve, tmp_path: Path) -> None:
    unit.stuck = {8}
    path = tmp_path / "unit.mem"
    path.write_text("07: 01 02 03 ; three\n")

    result = gve("memory", "restore", path)

    assert result.status == 1
    assert "08: NOT KEPT: 02 was written" in result.out
    assert unit.memory[7:10] == bytes([1, 0xFF, 3])


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("07 01", ":1: write a place, a colon and bytes"), ("\nFF: 01 02", ":2: place 100 is past"),
        ("00: 1\n", ":1: write a place"), ("00: 01\n00: 01", ":2: place 00 is there twice"),
        ("; nothing", "has no bytes"), (None, "no such file"), ("00: 0g", ":1: write a place"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("command", ["restore", "diff"])
def test_a_file_that_is_no_backup_is_one_line(
    gve: Tool, unit: FakeGve, tmp_path: Path, text: str | None, complaint: str, command: str
) -> None:
    path = tmp_path / "a.mem"
    if text is not None:
        path.write_text(text)

    result = gve("memory", command, path)

    assert result.status in (1, 2)
    assert complaint in result.complaint
    assert unit.done == []
