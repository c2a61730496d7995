"""`bench` compares each figure with its goal, and says why one could not be measured."""

from __future__ import annotations

import pytest
from rkm04_tools import bench, host

MEASURED = {
    "generator": [
        {"move": "F1", "pulses_per_second": 30e6},
        {"move": "F2", "pulses_per_second": 1},
    ],
    "simulation": {"program": "G+", "ratio": 99.0},
}


@pytest.fixture
def scripts(tmp_path, monkeypatch):
    """A folder of measuring scripts, and a host that has measured already."""
    monkeypatch.setattr(host, "measure", lambda: MEASURED)
    monkeypatch.setattr(bench, "SCRIPTS", tmp_path)
    return tmp_path


def figures(tool):
    result = tool("bench", "--json")
    assert result.status == 0
    return {row["figure"]: row for row in result.json["figures"]}


ACCURACY = "worst deviation of a pulse"
INSTRUCTIONS = "next tick of a pulse on Cortex-M4"


def test_a_goal_is_met_at_its_limit_and_not_beyond(tool, scripts):
    (scripts / "accuracy.py").write_text("print('{\"worst_ticks\": 1.0}')")
    (scripts / "arm_count.py").write_text("print('{\"generator_worst_mean\": 60.1}')")

    rows = figures(tool)

    assert (rows[ACCURACY]["measured"], rows[ACCURACY]["met"]) == (1.0, True)
    assert (rows[INSTRUCTIONS]["measured"], rows[INSTRUCTIONS]["met"]) == (60.1, False)
    assert [row["met"] for name, row in rows.items() if "generator" in name] == [True, False]
    assert rows["simulation, 4 motors, G+"]["met"] is False


@pytest.mark.parametrize(
    ("script", "note"),
    [
        ("import sys; sys.exit('needs the compiler for ARM')", "needs the compiler for ARM"),
        ("import sys; sys.exit(1)", "accuracy.py failed"),
        ("print('nonsense')", "accuracy.py gave no figure"),
        ("print('[]')", "accuracy.py gave no figure"),
        ("print('{}')", "accuracy.py gave no figure"),
    ],
)
def test_what_cannot_be_measured_is_told_with_its_reason(tool, scripts, script, note):
    (scripts / "accuracy.py").write_text(script)

    row = figures(tool)[ACCURACY]

    assert (row["measured"], row["met"], row["note"]) == (None, None, note)


def test_the_table_has_a_row_for_each_figure_and_the_reasons_below(tool, scripts):
    (scripts / "accuracy.py").write_text("print('{\"worst_ticks\": 0.75}')")

    result = tool("bench")

    lines = result.out.splitlines()
    assert (result.status, result.err) == (0, "")
    assert lines[0].split() == ["figure", "measured", "goal", "unit", "met"]
    assert lines[1].split("  ")[0] == ACCURACY
    assert lines[1].split()[-6:] == ["0.75", "at", "most", "1", "ticks", "yes"]
    assert lines[-1] == f"not measured: {INSTRUCTIONS}: {scripts}/arm_count.py is not there"


def page_figures(tool):
    result = tool("bench", "--target", "page", "--json")
    assert result.status == 0
    return {row["figure"]: row for row in result.json["figures"]}


def test_the_figures_of_the_pages_come_from_one_script_and_what_is_missing_is_told(tool, scripts):
    (scripts / "page_figures.py").write_text('print(\'{"check_ms": 21.5, "late_steps": 1}\')')

    rows = page_figures(tool)

    check = rows["check of 700 commands while typing"]
    assert (check["measured"], check["goal"], check["met"]) == (21.5, 50, True)
    assert rows["... late steps"]["met"] is False
    assert rows["from opening to the first curve"]["note"] == "page_figures.py gave none"
    assert rows["the largest wheel of build/wheels"]["note"] == "tools/wheels builds it"


def test_pages_that_cannot_be_measured_are_told_with_the_reason(tool, scripts):
    assert {row["note"] for row in page_figures(tool).values()} == {
        f"{scripts}/page_figures.py is not there"
    }
    (scripts / "page_figures.py").write_text("import sys; sys.exit('needs Chromium')")
    assert {row["note"] for row in page_figures(tool).values()} == {"needs Chromium"}
