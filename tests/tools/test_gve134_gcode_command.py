"""The command `gve134 gcode`: files, summaries, previews and machine files."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from gcode_played import MACHINE, content, good
from rkm04_tools.cli import run_tool
from rkm04_tools.gve134.cli import make_parser
from rkm04_tools.gve134.gcode.reading import CHUNK_BYTES, lines_of

ROOT = Path(__file__).resolve().parents[2]
Gcode = Callable[..., tuple[int, str, str]]

SQUARE = """\
G21 G90 (a square)
G0 X10 Y10
G1 X20 F600
Y20
X10
Y10
M30
"""


@pytest.fixture
def gcode(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Gcode:
    """Turn a text; the exit status, and what is printed."""

    def run(
        text: str | bytes, *options: str, machine: Path | None = MACHINE
    ) -> tuple[int, str, str]:
        path = tmp_path / "a.nc"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        named = ["--machine", str(machine)] if machine else []
        status = run_tool(make_parser(), ["gcode", str(path), *named, *options])
        told = capsys.readouterr()
        return status, told.out.replace(f"{tmp_path}/", ""), told.err.replace(f"{tmp_path}/", "")

    return run


def test_a_summary_has_lengths_time_and_speeds(gcode: Gcode) -> None:
    assert gcode(SQUARE) == (
        0,
        "lines      7\n"
        "vectors    5\n"
        "rapid      14.142 mm\n"
        "lines      40.000 mm\n"
        "time       4.317 s\n"
        "peak       4 243 mm/min\n"
        "           X 16 000, Y 16 000 pulses/s\n"
        "a.nc: no errors\n",
        "",
    )


def test_vectors_are_written_as_they_are_turned(gcode: Gcode, tmp_path: Path) -> None:
    status, out, _ = gcode(SQUARE, "-o", str(tmp_path / "a.gve"))

    written = (tmp_path / "a.gve").read_text(encoding="utf-8")
    assert status == 0
    assert out.endswith("a.gve: written\n")
    assert written.splitlines() == good(SQUARE).lines
    assert run_tool(make_parser(), ["check", str(tmp_path / "a.gve")]) == 0


def test_with_an_error_nothing_is_written_and_each_has_a_caret(
    gcode: Gcode, tmp_path: Path
) -> None:
    status, out, err = gcode("G0 X1\n\tG1 X2 ž Y\n", "-o", str(tmp_path / "a.gve"))

    assert (status, err) == (1, "")
    assert out.splitlines() == [
        "a.nc:2:8: error: no word of G-code: ž",
        "\tG1 X2 ž Y",
        "\t      ^",
        "a.nc:2:10: error: Y without a number, found Y",
        "\tG1 X2 ž Y",
        "\t        ^",
        "a.nc: 2 errors; nothing was written",
    ]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.nc"]


def test_the_program_itself_is_not_overwritten(gcode: Gcode, tmp_path: Path) -> None:
    status, _, err = gcode(SQUARE, "-o", str(tmp_path / "a.nc"))
    assert (status, err.count("\n")) == (2, 1)
    assert (tmp_path / "a.nc").read_text(encoding="utf-8") == SQUARE


def test_a_file_that_was_there_stays_if_there_is_an_error(gcode: Gcode, tmp_path: Path) -> None:
    (tmp_path / "a.gve").write_text("V1000\n", encoding="utf-8")
    assert gcode("G7", "-o", str(tmp_path / "a.gve"))[0] == 1
    assert (tmp_path / "a.gve").read_text(encoding="utf-8") == "V1000\n"


def test_the_answer_for_scripts_is_one_object(gcode: Gcode) -> None:
    status, out, _ = gcode(f"{SQUARE}G7\nrest", "--json")
    told = json.loads(out)

    assert (status, told["ok"], told["written"], told["errors"]) == (0, True, None, [])
    assert told["lines"] == 9
    assert told["length_mm"] == {"rapid": pytest.approx(14.142, abs=1e-3), "feed": 40, "arc": 0,
                                 "probe": 0}  # fmt: skip
    assert told["preview"]["vectors"] == told["vectors"] == 5
    assert [each["line"] for each in told["warnings"]] == [8]

    status, out, _ = gcode("G0 Xx", "--json", "--check")
    told = json.loads(out)
    assert (status, told["ok"], told["preview"]) == (1, False, None)
    assert told["errors"] == [{"line": 1, "column": 4, "message": "X without a number, found Xx"}]


def test_a_check_writes_nothing_and_tells_no_time(gcode: Gcode, tmp_path: Path) -> None:
    status, out, _ = gcode(SQUARE, "--check", "-o", str(tmp_path / "a.gve"))
    assert status == 0
    assert "time" not in out
    assert not (tmp_path / "a.gve").exists()


def test_the_path_is_drawn_in_mm(gcode: Gcode, tmp_path: Path) -> None:
    status, _, err = gcode(SQUARE, "--xy", str(tmp_path / "a.svg"))
    picture = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert (status, err) == (0, "")
    for words in ("X (mm)", "Y (mm)", "speed along the path (mm/min)", "a.nc"):
        assert words in picture

    assert gcode(f"{SQUARE}G7", "--xy", str(tmp_path / "b.svg"))[0] == 0
    assert gcode("G7", "--xy", str(tmp_path / "c.svg"))[0] == 1
    assert not (tmp_path / "c.svg").exists()
    status, _, err = gcode(SQUARE, "--xy", str(tmp_path / "a.pdf"))
    assert (status, err.count("\n")) == (2, 1)


def test_the_start_is_where_positions_count_from(gcode: Gcode) -> None:
    _, out, _ = gcode("G0 X10 Y20 A30", "--start", "10,20,0,30", "--json")
    assert json.loads(out)["vectors"] == 0


def test_dwells_and_what_nobody_knows_are_told(gcode: Gcode) -> None:
    _, out, _ = gcode("G4 P61.5\nS1000 M3\nG28\nM0\nM6 T1\nM2")
    assert "time       1 min 3.5 s, without 3 reference runs and 2 pauses\n" in out
    assert "dwells     63.500 s of it\n" in out


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--tolerance", "0"), "0 is not from 0.0001 to 1 mm"),
        (("--tolerance", "nan"), "nan is not from 0.0001 to 1 mm"),
        (("--start", "1,2,3,4,5"), "is not one to four numbers with commas between"),
        (("--start", "x"), "is not one to four numbers with commas between"),
        (("-o", "no/such/folder/a.gve"), "a.gve: cannot be written: no such file or directory"),
        (("--machine", "none.rkm"), "none.rkm: no such file"),
    ],
)
def test_what_cannot_be_is_one_line(gcode: Gcode, options: tuple[str, ...], complaint: str) -> None:
    status, out, err = gcode(SQUARE, *options)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert complaint in err


def test_without_a_machine_one_is_asked_for(gcode: Gcode, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GVE134_MACHINE", raising=False)
    status, _, err = gcode(SQUARE, machine=None)
    assert (status, err.count("\n")) == (2, 1)
    assert "which machine?" in err
    monkeypatch.setenv("GVE134_MACHINE", str(MACHINE))
    assert gcode(SQUARE, machine=None)[0] == 0


def without(*path: str) -> dict[str, Any]:
    """The machine of the examples without a part."""
    told = content()
    place: Any = told
    for each in path[:-1]:
        place = place[int(each) if each.isdigit() else each]
    del place[path[-1]]
    return told


def changed(key: str, value: object, *path: str) -> dict[str, Any]:
    """The same with another value."""
    told = content()
    place: Any = told
    for each in path:
        place = place[int(each) if each.isdigit() else each]
    place[key] = value
    return told


@pytest.mark.parametrize(
    ("told", "complaint"),
    [
        (without("gve134"), 'lacks "gve134", the part for this unit'),
        (without("gve134", "axes"), 'gve134: lacks "axes"'),
        (without("gve134", "axes", "x", "jump_steps_per_s"), 'gve134, axes, x: lacks "jump'),
        (without("motors", "0", "steps_per_mm"), "motor 1 is axis X and needs steps_per_mm"),
        (without("motors", "3", "steps_per_degree"), "motor 4 is axis A and needs steps_per_deg"),
        (changed("u", {}, "gve134", "axes"), 'nothing is known of "u"'),
        (changed("speed_steps_per_s", 200_001, "gve134", "axes", "y"), "200000 is the most"),
        (changed("accel_steps_per_s2", 999, "gve134", "axes", "y"), "1000 is the least"),
        (changed("way_steps", 0, "gve134", "axes", "z", "homing"), "way_steps 0 leads to no"),
        (
            changed("speed_max_steps_per_s", 1000, "motors", "0", "limits"),
            "gve134, axes, x: speed_steps_per_s 16000 is above speed_max_steps_per_s 1000 of "
            "motor 1, limits",
        ),
        (
            changed("speed_steps_per_s", 12_001, "gve134", "axes", "z", "homing"),
            "z, homing: speed_steps_per_s 12001 is above speed_steps_per_s 12000 of axis z",
        ),
        (
            changed("back_speed_steps_per_s", 12_001, "gve134", "axes", "z", "homing"),
            "z, homing: back_speed_steps_per_s 12001 is above speed_steps_per_s 12000 of axis z",
        ),
        (changed("opens", 1, "gve134", "probe"), "opens: must be true or false, found 1"),
        (changed("interrupt", 3, "gve134", "probe"), "interrupt: 3 is too small; 14 is the least"),
    ],
)
def test_a_machine_file_that_will_not_do_is_refused_in_plain_words(
    gcode: Gcode, tmp_path: Path, told: dict[str, Any], complaint: str
) -> None:
    machine = tmp_path / "m.rkm"
    machine.write_text(json.dumps(told), encoding="utf-8")
    status, out, err = gcode(SQUARE, machine=machine)
    assert (status, out) == (1, "")
    assert err.count("\n") == 1
    assert complaint in err


def test_an_axis_and_its_reference_run_may_be_as_fast_as_allowed_and_the_switch_lie_anywhere(
    gcode: Gcode, tmp_path: Path
) -> None:
    told = changed("speed_steps_per_s", 12_000, "gve134", "axes", "z", "homing")
    told["motors"][2]["limits"]["speed_max_steps_per_s"] = 12_000
    told["gve134"]["axes"]["x"]["homing"]["position_steps"] = -100  # its switch, beyond its limit
    machine = tmp_path / "m.rkm"
    machine.write_text(json.dumps(told), encoding="utf-8")

    assert gcode(SQUARE, machine=machine)[0] == 0


@pytest.mark.parametrize(
    ("program", "scale", "is_told"),
    [
        ("G0 X1\nG1 X20 F600", 1e-9, True),
        ("G2 X0.0001 I0.00005 F9", 320, True),
        ("G0 X0.0001", 320, True),
        ("G0 X0.0001\nG0 X1", 320, False),
        ("G0 X0", 320, False),
        ("G0 X1\nG0 Y1", 1e-9, False),
    ],
)
def test_a_program_of_which_no_move_has_a_pulse_is_told(
    gcode: Gcode, tmp_path: Path, program: str, scale: float, is_told: bool
) -> None:
    machine = tmp_path / "m.rkm"
    machine.write_text(json.dumps(changed("steps_per_mm", scale, "motors", "0")), encoding="utf-8")

    status, out, _ = gcode(program, machine=machine)

    assert status == 0
    assert ("1:1: warning: all moves of this program are shorter than a pulse" in out) is is_told


def test_the_machine_of_the_examples_is_a_good_machine_file(tool: Any) -> None:
    assert tool("machine", "check", MACHINE).status == 0


@pytest.mark.parametrize(
    "content",
    [b"\xff\xfeG\x000\x00", b"\x00" * 100, b"G0 X1\n" + bytes(range(32)) * 40],
)
def test_what_is_no_text_is_refused(gcode: Gcode, content: bytes) -> None:
    status, out, err = gcode(content)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
@pytest.mark.parametrize("shift", range(4))
def test_lines_are_whole_wherever_the_pieces_of_a_file_end(
    tmp_path: Path, end: bytes, shift: int
) -> None:
    lines = [b"G0 X%d" % number for number in range(CHUNK_BYTES // 6)]
    path = tmp_path / "a.nc"
    path.write_bytes(b"(" + b"x" * shift + b")" + end + end.join(lines) + b"\x1a")
    found = list(lines_of(path, lambda done, total: None))
    assert found[1:] == lines


def run_limited(path: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """Run the command as a process; the memory that it may use is bounded."""

    def bound() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

    return subprocess.run(
        [sys.executable, "-P", "-m", "rkm04_tools.gve134", "gcode", str(path), "--machine",
         str(MACHINE), *options],
        capture_output=True, text=True, check=False, preexec_fn=bound,
        env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
    )  # fmt: skip


def write_large(path: Path, size: int) -> int:
    """A program of so many bytes; its lines."""
    block = "".join(f"G1 X{i % 97}.{i % 10} Y{i % 89}.25 Z-{i % 5}.5 F{600 + i % 7}\n"
                    for i in range(1000))  # fmt: skip
    times = size // len(block) + 1
    with path.open("w", encoding="ascii") as file:
        for _ in range(times):
            file.write(block)
    return 1000 * times


def test_a_megabyte_is_turned_checked_and_previewed(tmp_path: Path) -> None:
    lines = write_large(tmp_path / "a.nc", 1_000_000)
    done = run_limited(tmp_path / "a.nc", "--json")
    told = json.loads(done.stdout)
    assert (done.returncode, told["lines"]) == (0, lines)
    assert told["preview"]["vectors"] == told["vectors"]


@pytest.mark.skipif("RKM04_LONG" not in os.environ, reason="in tools/test --long")
def test_a_hundred_megabytes_need_no_more_memory(tmp_path: Path) -> None:
    lines = write_large(tmp_path / "a.nc", 100_000_000)
    with (tmp_path / "a.nc").open("a", encoding="ascii") as file:
        file.write("G1 X1 oops\n")
    done = run_limited(tmp_path / "a.nc", "-o", str(tmp_path / "a.gve"), "--json")
    told = json.loads(done.stdout)
    assert done.returncode == 1
    assert told["errors"] == [
        {"line": lines + 1, "column": 7, "message": "O without a number, found oops"}
    ]
    assert not (tmp_path / "a.gve").exists()


def test_a_program_without_motion_has_no_peak_of_an_axis(gcode: Gcode) -> None:
    status, out, _ = gcode("")
    assert (status, out.splitlines()[-2:]) == (0, ["peak       0 mm/min", "a.nc: no errors"])


def test_a_file_of_errors_alone_keeps_so_many_of_them(gcode: Gcode) -> None:
    status, out, _ = gcode("G7\n" * 5000)
    assert status == 1
    assert out.endswith("a.nc: and 4950 more errors\na.nc: 5000 errors; nothing was written\n")
