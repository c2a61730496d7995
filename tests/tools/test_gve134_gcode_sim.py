"""Programs of G-code on the simulated unit: the examples, previews, and what the host does."""

from __future__ import annotations

import json
import re
import subprocess
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gcode_played import good, mill
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.preview import Preview, Previewed
from rkm04_tools.gve134.probing import WORDS

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "tools" / "examples" / "gve"
LEAD_S = 0.001
"""The unit begins a chain at most so long after it has got it; the preview counts T, 1 ms."""


def simulate(lines: list[str], folder: Path, *options: str | Path) -> dict[str, Any]:
    """Play lines to the simulated unit, and return the summary."""
    file = folder / "a.gve"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    done = subprocess.run(
        [host.program_path(), "sim", file, "--for", "1000", *options],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    told: dict[str, Any] = json.loads(done.stdout)
    return told


def preview(lines: list[str]) -> Previewed:
    """What the planner says of lines."""
    with Preview(mill()) as planner:
        planner.put("\n".join(lines) + "\n")
        told = planner.end()
    assert told is not None
    return told


@dataclass(frozen=True)
class Golden:
    """What an example makes: pulses and positions of the axes, how long it takes, and a digest of
    the ticks of all pulses.

    When each pulse is due is shown by the tests of paths; here none moves unseen.
    """

    pulses: tuple[int, ...]
    positions: tuple[int, ...]
    seconds: float
    pulses_digest: str


GOLDEN = {
    "circle": Golden((28800, 35200, 3200, 0), (3200, 9600, 800, 0), 8.11, "c0baaed39b14527b"),
    "pocket": Golden((65914, 46396, 7600, 0), (6400, 4160, 2000, 0), 24.60, "ee0265ca5d89c81f"),
    "engraving": Golden((112000, 27200, 21426, 0), (9600, 1600, 800, 0), 32.09, "dbdee3c7af30cc26"),
    "probe": Golden((12800, 0, 14156, 0), (12800, 0, -5748, 0), 6.71, "ba47f2cde4562ccd"),
    "home": Golden((24827, 15230, 8145, 0), (12800, 3200, 0, 0), 8.62, "2c16334e14845845"),
    "rotary": Golden((11200, 0, 6400, 480000), (11200, 0, 400, 480000), 32.90, "7fb612dd304698b6"),
    "packet": Golden((6128, 2858, 0, 0), (6128, 2858, 0, 0), 1.34, "465aca0d0d3cee41"),
    "stop": Golden((8000, 8000, 2000, 0), (0, 0, 0, 0), 24.33, "8c94516bd013b3c6"),
}


def lines_of_example(name: str) -> list[str]:
    """The vector file of an example."""
    if (vectors := EXAMPLES / f"{name}.gve").is_file():
        return vectors.read_text(encoding="utf-8").splitlines()
    return good((EXAMPLES / f"{name}.nc").read_text(encoding="utf-8")).lines


def inputs_of(name: str) -> list[str | Path]:
    """What the inputs of an example do."""
    inputs = EXAMPLES / f"{name}.csv"
    return ["--inputs", inputs] if inputs.is_file() else []


@pytest.mark.parametrize("name", sorted(GOLDEN))
def test_each_example_makes_its_pulses_in_its_time(name: str, tmp_path: Path) -> None:
    steps = tmp_path / "steps.csv"
    told = simulate(lines_of_example(name), tmp_path, *inputs_of(name), "--steps", steps)

    assert (told["ended"], told["refused"], told["late_steps"]) == ("idle", 0, 0)
    golden = GOLDEN[name]
    assert tuple(axis["pulses"] for axis in told["axes"]) == golden.pulses
    assert tuple(axis["position"] for axis in told["axes"]) == golden.positions
    assert told["seconds"] == pytest.approx(golden.seconds, abs=0.05)
    assert sha256(steps.read_bytes()).hexdigest()[:16] == golden.pulses_digest


def test_each_example_is_there_with_its_picture() -> None:
    for suffixes in ((".nc", ".gve"), (".svg",)):
        names = {path.stem for path in EXAMPLES.iterdir() if path.suffix in suffixes}
        assert names == set(GOLDEN)


def test_the_course_is_the_way_of_x_and_y_in_its_time(tmp_path: Path) -> None:
    lines = ["NX320", *good("G1 X10 F600\nY5 Z1\nA90\nG4 P1\nX0").lines]
    with Preview(mill(), course=tmp_path / "course") as planner:
        planner.put("\n".join(lines) + "\n")
        told = planner.end()
    assert told is not None

    rows = np.fromfile(tmp_path / "course").reshape(-1, 3)

    assert rows[:, :2].tolist() == [[1, 0], [11, 0], [11, 5], [11, 5], [11, 5], [1, 5]]
    assert np.isnan(rows[:, 2]).tolist() == [True, False, False, False, True, False]
    pauses = 0.001 * told.chains
    assert np.nansum(rows[:, 2]) == pytest.approx(told.seconds - pauses, rel=1e-6)


@pytest.mark.parametrize("name", ["circle", "pocket", "engraving", "rotary"])
def test_the_preview_is_what_the_unit_does(name: str, tmp_path: Path) -> None:
    played = good((EXAMPLES / f"{name}.nc").read_text(encoding="utf-8"))
    told, previewed = simulate(played.lines, tmp_path), preview(played.lines)

    seconds = previewed.seconds + played.turned.dwelt_s
    assert told["seconds"] == pytest.approx(seconds, abs=2 * LEAD_S * previewed.chains)
    for axis, peak in zip(told["axes"], previewed.peaks, strict=True):
        assert axis["peak_speed"] == pytest.approx(peak, rel=0.01)


def test_the_unit_ends_where_the_program_does(tmp_path: Path) -> None:
    told = simulate(good("G0 X12.5 Y-3\nG1 F900 Z1.25 A90\nG91 X0.5").lines, tmp_path)
    assert [axis["position"] for axis in told["axes"]] == [4160, -960, 500, 32_000]


def test_the_host_waits_as_long_as_a_dwell_says(tmp_path: Path) -> None:
    short = simulate(good("G0 X1\nG4 P0.25\nX2").lines, tmp_path)
    long = simulate(good("G0 X1\nG4 P10.25\nX2").lines, tmp_path)
    assert long["seconds"] - short["seconds"] == pytest.approx(10, abs=1e-9)


PROBING = ["A100", "V800", "SW3,00", "SW1,80", "L0,0,-4000,0", ";@probe", "P4", "L0,0,10,0"]


@pytest.mark.parametrize(("ms", "touched_at"), [(1000, -792), (2500, -1992)])
def test_a_probe_goes_back_to_where_it_was_touched(
    ms: int, touched_at: int, tmp_path: Path
) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text(f"{ms},8,0\n", encoding="utf-8")

    told = simulate(PROBING, tmp_path, "--inputs", inputs)

    (answer,) = told["answers"]
    at = int(answer["answer"].split(",")[3])
    assert (answer["command"], told["refused"]) == ("P4", 0)
    assert at == pytest.approx(touched_at, abs=5)
    assert told["axes"][2]["position"] == at + 10
    assert told["axes"][2]["pulses"] > -at + 10


def test_a_probe_goes_back_with_an_axis_that_a_is_coupled_with(tmp_path: Path) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("1000,8,0\n", encoding="utf-8")

    told = simulate(["EW0C,03", *PROBING], tmp_path, "--inputs", inputs)

    (answer,) = told["answers"]
    z, a = (int(each) for each in answer["answer"].split(",")[3:])
    assert told["refused"] == 0
    assert z == a == pytest.approx(-792, abs=5)
    assert [axis["position"] for axis in told["axes"]] == [0, 0, z + 10, z + 10]


def test_a_probe_that_touches_nothing_ends_the_file(tmp_path: Path) -> None:
    told = simulate(PROBING, tmp_path)
    assert refusals(told) == [(6, "untouched")]
    assert told["axes"][2]["position"] == -4000


def refusals(told: dict[str, Any]) -> list[tuple[int, str]]:
    return [(each["line"], each["reason"]) for each in told["answers"] if each["refused"]]


def test_a_sensor_that_is_closed_before_the_probe_moves_is_no_touch(tmp_path: Path) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("0,8,0\n", encoding="utf-8")

    told = simulate(["L0,0,30", "L0,0,0", *PROBING], tmp_path, "--inputs", inputs)

    assert refusals(told) == [(8, "before")]
    assert told["axes"][2]["position"] == 30


@pytest.mark.parametrize(
    ("levels", "reason"),
    [("500,3,0\n", "switch"), ("500,8,0\n530,3,0\n", "switch"), ("500,8,0\n620,3,0\n", "back")],
)
def test_a_reference_switch_is_no_touch(tmp_path: Path, levels: str, reason: str) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text(levels, encoding="utf-8")

    told = simulate(["SW0,04", "A10", *PROBING[1:]], tmp_path, "--inputs", inputs)

    assert refusals(told) == [(7, reason)]


def test_every_reason_has_its_words() -> None:
    source = (ROOT / "tools/gve134_host/gve_probing.c").read_text(encoding="utf-8")
    assert set(re.findall(r'fail\(probing, "([a-z]+)"\)', source)) == set(WORDS)


def test_a_halt_is_no_touch(tmp_path: Path) -> None:
    told = simulate([*PROBING, "@1000 H"], tmp_path)
    assert refusals(told) == [(6, "halted")]


@pytest.mark.parametrize(
    "line", [";@wait", ";@wait x", ";@wait 1.5 x", ";@wait -1", ";@pauses", ";@ probe", ";@probe X"]
)
def test_lines_for_a_host_that_knows_more_are_errors(line: str) -> None:
    (error,) = host.check(f"V1000\n  {line}\n").errors
    assert (error.line, error.column) == (2, 3)
    assert "there are ;@wait with seconds" in error.message


def test_lines_for_the_host_are_no_commands() -> None:
    parsed = host.check(
        "V1000 ; ;@x\n;@wait 1\n;@wait 2.5 \n;@pause\n;@pause a, b\nL1\n@5 H\n;@probe\n; ;@x"
    )
    assert (parsed.commands, parsed.errors) == (3, [])


@pytest.mark.parametrize(
    "before",
    ["", "C1\n", "V1000\n", "L1\n;@wait 1\n", "L1\n;@pause\n", "L1\n;@probe\n", "C1\n@5 L1\n"],
)
def test_a_probe_is_for_the_vector_right_before_it(before: str) -> None:
    (error,) = host.check(f"{before} ;@probe").errors
    assert (error.line, error.column) == (before.count("\n") + 1, 2)
    assert error.message == ";@probe stands right after the L that goes to the sensor"
