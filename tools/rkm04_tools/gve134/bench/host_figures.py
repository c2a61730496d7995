"""`bench`: what the tools do on this computer, beside its goals."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import child
from rkm04_tools.bar import Bar
from rkm04_tools.bench import HEAD, Row
from rkm04_tools.failure import DONE, Failure
from rkm04_tools.gve134 import host
from rkm04_tools.table import table
from rkm04_tools.tree import ROOT

MILL = ROOT / "tools/examples/gve/mill.rkm"
VECTORS = 40_000
SIMULATED = 4000
MOTION = "A8000\nV200000\n$1\n"
VECTOR = "C100,-99,57,33\n"
GCODE_BYTES = 1_000_000
GCODE_HEAD = "G21 G90 G17 F600\nG0 X50 Y50\nG1 Z-0.5\n"
GCODE_BLOCK = (
    "G1 X{x:.3f} Y{y:.3f} Z-{z:.3f}\nG1 X{x2:.3f}\nG3 X{x2:.3f} Y{y2:.3f} I0 J5\n"
    "G2 X{x2:.3f} Y{y:.3f} I0 J-5\n"
)


def run(options: Namespace) -> int:
    """Measure everything and print it."""
    rows: list[Row] = []
    parts: list[Callable[[Path], Row]] = [planning, simulating, turning]
    with TemporaryDirectory(prefix="gve134-") as folder, Bar("measuring") as bar:
        for done, part in enumerate(parts):
            bar.show(done, len(parts))
            rows.append(part(Path(folder)))
    if options.json:
        print(json.dumps({"figures": [{**asdict(row), "met": row.met} for row in rows]}, indent=2))
    else:
        print(table([HEAD, *(row.cells() for row in rows)], "lrrll"))
    return DONE


def planning(folder: Path) -> Row:
    """Vectors a second through parser, speeds and planner of the firmware."""
    seconds = _seconds([host.program_path(), "plan", "1", "1", "1"], MOTION + VECTOR * VECTORS)
    measured = VECTORS / seconds
    return Row("vectors planned on this computer", "vectors/s", 2000, False, measured)


def simulating(folder: Path) -> Row:
    """The whole unit beside real time."""
    path = folder / "bench.gve"
    path.write_text(MOTION + VECTOR * SIMULATED)
    begin = time.monotonic()
    told = host.simulate([str(path), "--for", "60"])
    measured = float(told["seconds"]) / (time.monotonic() - begin)
    name = "simulation at 4 x 200 000 pulses/s, 2000 vectors/s"
    return Row(name, "times real time", 1, False, measured)


def turning(folder: Path) -> Row:
    """A program of 1 MB turned into vectors, checked and previewed, as a user would."""
    program, vectors = folder / "bench.nc", folder / "bench.gve"
    program.write_text(gcode_text(GCODE_BYTES))
    tool = [sys.executable, "-P", "-m", "rkm04_tools.gve134"]
    turn: list[str | Path] = ["gcode", program, "--machine", MILL, "-o", vectors]
    measured = _seconds([*tool, *turn]) + _seconds([*tool, "check", vectors])
    return Row("G-code of 1 MB, turned and checked", "s", 5, True, measured)


def gcode_text(size: int) -> str:
    """Lines, full arcs and depths, of so many bytes."""
    text, number = [GCODE_HEAD], 0
    length = len(GCODE_HEAD)
    while length < size:
        x, y = 50 + number % 97 * 0.5, 50 + number % 61 * 0.5
        block = GCODE_BLOCK.format(x=x, y=y, z=0.5 + number % 7 * 0.1, x2=x + 5, y2=y + 10)
        text.append(block)
        length += len(block)
        number += 1
    return "".join([*text, "M30\n"])


def _seconds(command: Sequence[str | Path], given: str = "") -> float:
    """How long a command takes, to a good end."""
    begin = time.monotonic()
    done = subprocess.run(
        list(map(str, command)), input=given, capture_output=True, text=True, env=child.bound()
    )
    if done.returncode:
        said = (done.stderr or done.stdout).strip().rpartition("\n")[2]
        raise Failure(f"{Path(command[0]).name}: {said}")
    return time.monotonic() - begin
