"""`bench`: how fast the unit is on this machine: moves in virtual time, and requests."""

from __future__ import annotations

import json
import subprocess
import time
from argparse import Namespace
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import child
from rkm04_tools.failure import DONE
from rkm04_tools.positioning import host
from rkm04_tools.positioning.unit import Unit, open_unit
from rkm04_tools.table import rounded, table

MOVES = 2000
MOVE_MS = 60
REQUESTS = 500
FAST_OUT, FAST_IN, FAST_OUT_WORDS, FAST_IN_WORDS = 500, 520, 12, 16
LINE_MOVES = 100


def run(options: Namespace) -> int:
    """Measure, and print one table."""
    moves_per_s, ratio = _simulated()
    with TemporaryDirectory(prefix="positioning-") as folder:
        request_us, line_moves_per_s = _served(Path(folder))
    figures = {
        "simulated_moves_per_s": moves_per_s,
        "simulated_times_real_time": ratio,
        "request_us": request_us,
        "moves_per_s_over_the_line": line_moves_per_s,
    }
    if options.json:
        print(json.dumps({name: round(value, 1) for name, value in figures.items()}))
        return DONE
    rows = [
        ("figure", "", ""),
        ("moves in virtual time, four axes", rounded(moves_per_s), "moves/s"),
        ("virtual time to real time", rounded(ratio), "times"),
        ("a request of the fast image (FC 23), no time on the line", rounded(request_us), "us"),
        (
            "moves of one step, each seen to its end",
            rounded(line_moves_per_s),
            "1/s",
        ),
    ]
    print(table(rows, "lrl"))
    return DONE


def _simulated() -> tuple[float, float]:
    """Moves per second of real time, and the ratio of unit time to real time."""
    lines = [f"0,{axis},POS_INIT" for axis in range(1, 5)]
    for move in range(MOVES):
        way = 1000 if move % 2 else -1000
        at = 1 + move * MOVE_MS
        lines += [f"{at},{axis},POS_MODE,{way},5000" for axis in range(1, 5)]
        lines += [f"{at},{axis},POS_CONTROL,6000mm/min,1" for axis in range(1, 5)]
    with TemporaryDirectory(prefix="positioning-") as folder:
        script = Path(folder) / "moves.csv"
        script.write_text("\n".join(lines) + "\n", encoding="ascii")
        answer = host.simulate([str(script), "--for", str(MOVES)])
    made = sum(axis["moves"] for axis in answer["axes"])
    return made / answer["real_seconds"], answer["ratio"]


def _served(folder: Path) -> tuple[float, float]:
    """Microseconds of a request, and moves per second, with a unit of its own."""
    command = [str(host.program_path()), "serve", "--tcp", "0", "--unpaced", "--speed", "0"]
    with subprocess.Popen(
        [*command, "--json"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, cwd=folder,
        env=child.bound(),
    ) as process:  # fmt: skip
        try:
            assert process.stdout is not None
            with open_unit(json.loads(process.stdout.readline())["listening"]) as unit:
                return _request_us(unit), _line_moves_per_s(unit)
        finally:
            process.terminate()


def _request_us(unit: Unit) -> float:
    unit.read()
    begin = time.perf_counter()
    for _ in range(REQUESTS):
        unit.wire.write_and_read(FAST_OUT, [0] * FAST_OUT_WORDS, FAST_IN, FAST_IN_WORDS)
    return (time.perf_counter() - begin) / REQUESTS * 1e6


def _line_moves_per_s(unit: Unit) -> float:
    axis = unit.axis(1)
    axis.init()
    begin = time.perf_counter()
    for _ in range(LINE_MOVES):
        axis.move(0.01, feed=6000, accel=5000)
    return LINE_MOVES / (time.perf_counter() - begin)
