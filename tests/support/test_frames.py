"""The shared frames are what the second implementation makes, and say what they are meant to."""

from __future__ import annotations

import json
from pathlib import Path

import frames
import pytest

VECTORS = json.loads(frames.JSON_FILE.read_text())


@pytest.mark.parametrize("path", [frames.JSON_FILE, frames.C_FILE], ids=lambda path: path.name)
def test_the_file_is_up_to_date(path: Path) -> None:
    assert path.read_text() == frames.contents()[path]


def test_the_fcs_has_the_check_value_of_x_25() -> None:
    assert frames.fcs16(b"123456789") == 0x906E


def test_a_frame_with_its_fcs_leaves_the_residue_of_rfc_1662() -> None:
    for vector in VECTORS["frames"]:
        content = bytes([vector["address"], vector["number"]]) + bytes.fromhex(vector["message"])
        assert frames.fcs16(frames.with_fcs(content)) ^ 0xFFFF == 0xF0B8


def test_between_the_flags_of_a_frame_there_is_none() -> None:
    for vector in VECTORS["frames"]:
        data = bytes.fromhex(vector["frame"])
        assert data[0] == data[-1] == frames.FLAG
        assert frames.FLAG not in data[1:-1]
