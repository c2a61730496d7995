"""`positioning sim`, `check` and `registers`, and what the example scripts make of it."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from blark.parse import parse_source_code
from rkm04_tools.positioning.state import ERRORS

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "tools/examples/positioning"
TICKS_PER_MS = 84_000
PLAIN = "0,1,POS_INIT\n1,1,POS_MODE,10000,500\n2,1,POS_CONTROL,1000mm/min,1\n"

Write = Callable[..., Path]
Tool = Callable[..., Any]


def pulses(path: Path, motor: int = 1) -> list[tuple[int, int]]:
    """Tick and position of each pulse."""
    rows = [tuple(map(int, line.split(","))) for line in path.read_text().splitlines()[2:]]
    return [(tick, position) for tick, number, position in rows if number == motor]


def test_the_pulses_are_those_of_the_contract(positioning: Tool, write: Write, tmp_path: Path):
    steps, trace = tmp_path / "steps.csv", tmp_path / "trace.csv"

    result = positioning("sim", write(PLAIN, "a.csv"), "--steps", steps, "--trace", trace)

    assert (result.status, result.err) == (0, "")
    [start] = [int(x.split(",")[0]) for x in trace.read_text().splitlines() if ",move," in x]
    made = pulses(steps)
    assert [made[n - 1][0] - start for n in (1, 2, 28, 999, 1000)] == [
        531_263, 751_319, 2_811_200, 52_668_700, 53_199_963,
    ]  # fmt: skip
    assert [position for _, position in made] == list(range(1, 1001))


def test_the_summary_is_a_table_of_the_axes_with_the_times(positioning: Tool, write: Write):
    lines = positioning("sim", write(PLAIN, "a.csv")).out.splitlines()

    assert lines[0].split("  ")[0] == "axis"
    assert lines[1].split() == [
        "1", "1", "1", "000", "10.000", "1", "000", "1666.7", "0.633", "REACHED",
    ]  # fmt: skip
    assert lines[-1] == "ended because the script is over and the axes stand"


def test_what_is_refused_is_told_with_its_line_and_ends_with_1(positioning: Tool, write: Write):
    path = write("# a\n0,1,POS_MODE,5,5\n1,0,SETTING,31,5\n2,1,POS_INIT,7\n", "a.csv")

    result = positioning("sim", path)

    assert result.status == 1
    assert result.err.splitlines() == [
        f"{path}:2: error: POS_MODE of axis 1 was refused: error 3: {ERRORS[3]}",
        f"{path}:3: error: SETTING was refused: exception 3: the value is out of its range",
        f"{path}:4: error: POS_INIT of axis 1 was refused: error 2: {ERRORS[2]}",
    ]


def test_a_fault_at_the_end_ends_with_1(positioning: Tool, write: Write):
    limit = "0,0,SETTING,147,1\n" + PLAIN
    inputs = write("100,1,1\n", "inputs.csv")

    result = positioning("sim", write(limit, "a.csv"), "--inputs", inputs, "--json")

    assert result.status == 1
    assert (result.json["axes"][0]["error"], result.json["told"]) == (7, [])


@pytest.mark.parametrize(
    ("line", "wrong"),
    [
        ("1,1,POS_FOO", "no such instruction"),
        ("1,5,POS_INIT", "the axis must be 1 to 4"),
        ("1,1,POS_MODE,5", "too few values"),
        ("1,1,POS_RESET,5", "too many values"),
        ("1,1,POS_MODE,5,70000", "the acceleration must be 0 to 65535 mm/s2"),
        ("1,1,POS_CONTROL,70000mm/min", "the feed must be"),
        ("-1,1,POS_INIT", "the time must be milliseconds"),
        ("nonsense", "a time, an axis and an instruction"),
    ],
)
def test_a_script_that_cannot_be_read_is_told_with_its_place(
    positioning: Tool, write: Write, line: str, wrong: str
):
    path = write(f"0,1,POS_INIT\n{line}\n", "a.csv")

    for command in ("check", "sim"):
        result = positioning(command, path)
        assert result.status == 1
        assert result.complaint.startswith(f"positioning: {path}:2: {wrong}")


def test_check_counts_the_instructions(positioning: Tool, write: Write):
    path = write(PLAIN + "# end\n", "a.csv")

    assert positioning("check", path).out == f"{path}: 3 instructions\n"
    assert positioning("check", path, "--json").json == {
        "files": [{"file": str(path), "ok": True, "lines": 3}]
    }


def test_a_missing_script_is_wrong_usage(positioning: Tool):
    assert positioning("sim", "nothing.csv").status == 2
    assert positioning("check", "nothing.csv").status == 2


def test_steps_waveforms_and_a_picture_are_written(positioning: Tool, tmp_path: Path):
    names = {"vcd": "a.vcd", "plot": "a.svg", "steps": "steps.csv", "trace": "trace.csv"}
    files = [part for kind, name in names.items() for part in (f"--{kind}", tmp_path / name)]

    result = positioning("sim", EXAMPLES / "hold.csv", *files)

    assert (result.status, result.err) == (0, "")
    assert "axis 2" in (tmp_path / "a.svg").read_text()
    assert "m1_step" in (tmp_path / "a.vcd").read_text()


# Example and motor: how many pulses; the first, the middle and the last one, tick and position.
GOLDEN = {
    ("first-move", 1): (1000, [(2259983, 1), (28379101, 501), (73436753, 1000)]),
    ("hold", 1): (2500, [(2148720, 1), (54685311, 1251), (78391320, 2500)]),
    ("hold", 2): (1250, [(2322690, -1), (25387320, -626), (48978720, -1250)]),
    ("home", 1): (2727, [(2259983, -1), (282162720, 4), (341088720, 1367)]),
}


@pytest.mark.parametrize(("name", "motor"), list(GOLDEN))
def test_the_examples_make_their_pulses(positioning: Tool, tmp_path: Path, name: str, motor: int):
    inputs = EXAMPLES / f"{name}-inputs.csv"
    given = ["--inputs", inputs] if inputs.exists() else []

    result = positioning("sim", EXAMPLES / f"{name}.csv", *given, "--steps", tmp_path / "s.csv")

    made = pulses(tmp_path / "s.csv", motor)
    assert (result.status, result.err) == (0, "")
    assert (len(made), [made[0], made[len(made) // 2], made[-1]]) == GOLDEN[name, motor]


def test_every_example_has_its_pulses_here():
    names = {path.stem for path in EXAMPLES.glob("*.csv")}

    assert names == {n for n, _ in GOLDEN} | {"home-inputs"}


def test_registers_are_listed_for_spreadsheets(positioning: Tool):
    rows = list(csv.DictReader(io.StringIO(positioning("registers", "--csv").out)))

    numbers = [int(row["number"]) for row in rows]
    assert numbers == sorted(set(numbers))
    [status] = [row for row in rows if row["number"] == "210"]
    assert (status["name"], status["axis"], status["access"]) == ("STATUS", "2", "r")
    told = positioning("registers", "--json").json
    assert len(told["registers"]) == len(rows)
    assert told["bits"]["JEDE"] == 0x0100
    assert told["instructions"]["POS_HOME"] == 5


def test_registers_are_listed_as_in_the_document(positioning: Tool):
    document = (ROOT / "firmware/positioning/docs/registers.md").read_text()
    lines = [x for x in positioning("registers", "--md").out.splitlines() if x.startswith("| ")]

    assert all(line in document for line in lines)
    assert len(lines) > 60


def test_registers_are_listed_as_structured_text_that_parses(positioning: Tool):
    text = positioning("registers", "--st").out

    assert parse_source_code(text).exception is None
    assert "POS_AXIS_STATUS : UINT := 10;" in text


def test_a_form_is_asked_for(positioning: Tool):
    assert positioning("registers").status == 2
    assert json.loads(positioning("registers", "--json").out)["images"]["FULL_IN"]["first"] == 640
