"""The unit's half of firmware/gve134/docs/compared.md is what the simulated unit does."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from gcode_played import good
from peer_grblhal import ARC_MM, BAUD, MACHINE, measure, train_of_steps
from peer_jobs import JOBS, Job
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import read_mill

PAGE = Path(__file__).resolve().parents[2] / "firmware/gve134/docs/compared.md"
TWO_TICKS_US = 2 / 84
"""The pulse's own rounding and that of the longest axis, by which it is measured."""


def rows() -> list[list[str]]:
    """The cells of the table, a row for each job."""
    lines = re.findall(r"^\| (\w.*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    return [line.split(" | ") for line in lines][1:]


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.name)
def test_a_job_on_the_unit_is_as_the_table_has_it(job: Job, tmp_path: Path) -> None:
    row = rows()[JOBS.index(job)]
    played = good(job.gcode(), read_mill(MACHINE), tolerance=ARC_MM)
    (tmp_path / "job.gve").write_text("\n".join([*played.lines, ""]))
    play: list[str | Path] = [
        "sim",
        tmp_path / "job.gve",
        "--baud",
        str(BAUD),
        "--steps",
        tmp_path / "steps.csv",
    ]
    subprocess.run([host.program_path(), *play], check=True, capture_output=True)

    result = measure(
        train_of_steps((tmp_path / "steps.csv").read_text().splitlines()), job, "GVE134"
    )

    assert re.findall(r"\w+", row[0])[0] == re.findall(r"\w+", job.name)[0]
    assert result.seconds == pytest.approx(float(row[2]), abs=0.0015)
    if job.points:
        assert result.deviation_us is not None
        assert result.middle_corner_mm_per_s == pytest.approx(float(row[10]), abs=0.06)
        assert result.deviation_us <= TWO_TICKS_US
