"""The image on the virtual board, seen as by an analyser, is what the simulator says: `compare`."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from rkm04_tools import virtual_board

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {1: "\\C100 S300 V3000 A20000 F400 R W20 D R", 3: "\\C100 S100 V900 A9000 B150 R W7 D R"}


@pytest.fixture(scope="module")
def has_board() -> None:
    build = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
    if not (build / "bin" / virtual_board.PROGRAM).is_file():
        pytest.skip("the virtual board is not built: libunicorn or libcapstone is missing")


@pytest.fixture
def both(has_board, tool, write, tmp_path):
    """Waves of the image, and steps and waves of the simulator, of the same programs."""
    programs = [
        f"--motor={motor}={write(text, f'{motor}.rks')}" for motor, text in PROGRAMS.items()
    ]
    board, steps, waves = (tmp_path / name for name in ("board.vcd", "steps.csv", "waves.vcd"))
    assert tool("sim", "--target", "stm32", *programs, "--vcd", board).status == 0
    assert tool("sim", *programs, "--steps", steps, "--vcd", waves).status == 0
    return board, steps, waves


@pytest.mark.parametrize("against", ["steps", "waves"])
def test_the_image_makes_the_pulses_of_the_simulator(both, tool, against):
    board, steps, waves = both

    result = tool("compare", board, steps if against == "steps" else waves, "--no-rate", "--json")

    moved = {m["motor"]: m for m in result.json["motors"] if m["captured"]}
    assert (result.status, sorted(moved)) == (0, [1, 3])
    for motor, count in ((1, 800), (3, 300)):
        told = moved[motor]
        assert (told["simulated"], told["both"], told["wrong_dir"]["count"]) == (count, count, 0)
        assert abs(told["worst_ns"]) <= 2  # both are whole nanoseconds
        assert told["width_ns"][0] >= 499.9
        assert told["dir_setup_ns"] >= 5000
        assert told["dir_hold_ns"] >= 5000


def test_a_pulse_that_the_image_loses_is_found(both, tool, tmp_path):
    board, steps, _ = both
    text = board.read_text()
    code = re.search(r"\$var wire 1 (\S) m1_step \$end", text)
    assert code
    rises = [m.start() for m in re.finditer(rf"^1{re.escape(code[1])}$", text, re.MULTILINE)]
    at = rises[122]
    end = text.index(f"\n0{code[1]}\n", at) + 1
    lost = tmp_path / "lost.vcd"
    lost.write_text(text[:at] + text[at + 3 : end] + text[end + 3 :])

    result = tool("compare", lost, steps, "--no-rate", "--json")

    (motor,) = [m for m in result.json["motors"] if m["motor"] == 1]
    assert result.status == 1
    assert [(p["first"], p["last"]) for p in motor["missing"]["pulses"]] == [(123, 123)]
    assert motor["surplus"]["count"] == 0
