"""Runs ten jobs on grblHAL's simulator and on the simulated GVE134 unit and compares their pulses.

    build/venv/bin/python -P -m peer_grblhal SIMULATOR [--job NAME]     (PYTHONPATH=tests/support)

SIMULATOR is a program grblHAL_sim that writes its step pulses to the file that PULSES names: a line
`clock steps directions` for each call of its stepperPulseStart that has steps to make, with its
masterclock (16 000 000 a second), step_out.bits and dir_out.bits. The project has none of its code;
firmware/gve134/docs/compared.md says which version was measured, and what the figures mean.

Each job runs several times (--times). The simulator runs in real time and its planner starves on a
busy machine; so times that differ by more than a microsecond are an error, not a result.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from peer_jobs import ACCEL_MM_PER_S2, FEED_MM_PER_MIN, JOBS, STEPS_PER_MM, Job
from peer_pulses import AXES, Train, corner_speeds, deviation, middle, off_the_circles

ROOT = Path(__file__).resolve().parents[2]
MACHINE = Path(__file__).with_name("peer_machine.rkm")
GRBL_HZ = 16_000_000
RECEIVE_BYTES = 900
"""Of grblHAL's 1024, as the host fills them: the simulator reads on while 100 are free."""
ARC_MM = 0.002
"""How far a chord may be from its arc, on both sides."""
BAUD = 115_200
SAME_S = 1e-6
OFFSETS = {"grblHAL": 0.5, "GVE134": 0.0}
"""Whether pulses are between two steps of the line or on them."""

SETTINGS = (
    "$0=2.5", "$1=255", "$11=0.01", f"$12={ARC_MM}",
    *(f"${100 + axis}={STEPS_PER_MM}" for axis in range(AXES)),
    *(f"${110 + axis}={FEED_MM_PER_MIN}" for axis in range(AXES)),
    *(f"${120 + axis}={ACCEL_MM_PER_S2}" for axis in range(AXES)),
)  # fmt: skip


@dataclass
class Result:
    """What is told of one controller and job; None is what a job of arcs or one move has not."""

    job: str
    controller: str
    seconds: float
    deviation_pulses: float | None = None
    deviation_us: float | None = None
    slowest_corner_mm_per_s: float | None = None
    middle_corner_mm_per_s: float | None = None
    off_the_arc_pulses: float | None = None


class Grbl:
    """A simulator that runs, and the lines that it has not answered."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self._in, self._out = process.stdin, process.stdout
        self._waiting: deque[int] = deque()
        while not self._read().startswith("GrblHAL"):
            pass

    def _read(self) -> str:
        line = self._out.readline()
        if not line:
            raise SystemExit("grblHAL has ended")
        return line

    def _one_answer(self) -> None:
        answer = self._read()
        if answer.startswith(("error", "ALARM")):
            raise SystemExit(f"grblHAL refuses a line: {answer.strip()}")
        if answer.startswith("ok"):
            self._waiting.popleft()

    def now(self, text: str) -> None:
        """Sends without counting."""
        self._in.write(text)
        self._in.flush()

    def fits(self, line: str) -> bool:
        return sum(self._waiting) + len(line) + 1 <= RECEIVE_BYTES

    def send(self, line: str) -> None:
        """A line, as soon as there is room."""
        while not self.fits(line):
            self._one_answer()
        self.now(line + "\n")
        self._waiting.append(len(line) + 1)

    def finish(self) -> None:
        """Until all is answered."""
        while self._waiting:
            self._one_answer()


def stream(grbl: Grbl, lines: Iterable[str]) -> None:
    """Sends a job; it begins when grblHAL's buffer is full, as if it came from a card."""
    for line in SETTINGS:
        grbl.send(line)
    grbl.finish()
    grbl.send("M0")
    rest = deque(lines)
    while rest and grbl.fits(rest[0]):
        grbl.send(rest.popleft())
    time.sleep(1)
    grbl.now("~")
    for line in rest:
        grbl.send(line)
    grbl.finish()


def run_grbl(program: Path, job: Job, folder: Path) -> Train:
    """The pulses of grblHAL."""
    log = folder / "pulses.txt"
    log.unlink(missing_ok=True)
    memory = str(folder / "eeprom.dat")
    command = ["stdbuf", "-oL", str(program), "-n", "-t", "1", "-e", memory, "-b", os.devnull]
    with subprocess.Popen(
        command, text=True, cwd=folder, env={**os.environ, "PULSES": str(log)},
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    ) as process:  # fmt: skip
        try:
            stream(Grbl(process), job.gcode().splitlines())
        finally:
            process.kill()
    return train_of(log.read_text().splitlines())


def train_of(lines: Iterable[str]) -> Train:
    """Of what the simulator has written."""
    train = Train()
    for line in lines:
        tick, steps, ways = map(int, line.split())
        for axis in range(AXES):
            if steps >> axis & 1:
                train.add(axis, tick / GRBL_HZ, -1 if ways >> axis & 1 else 1)
    return train


def run_gve134(job: Job, folder: Path) -> Train:
    """The pulses of the simulated unit, which has its vectors over a line of the same rate."""
    source, vectors, steps = folder / "job.nc", folder / "job.gve", folder / "steps.csv"
    source.write_text(job.gcode())
    tool = str(ROOT / "tools" / "gve134")
    turn = [tool, "gcode", str(source), "--machine", str(MACHINE), "--tolerance", str(ARC_MM)]
    play = [tool, "sim", str(vectors), "--baud", str(BAUD), "--for", "600", "--steps", str(steps)]
    for command in ([*turn, "-o", str(vectors)], play):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return train_of_steps(steps.read_text().splitlines())


def train_of_steps(lines: list[str]) -> Train:
    """Of what `sim --steps` has written."""
    hz = int(lines[0].split("=")[1])
    train = Train()
    for row in lines[2:]:
        tick, motor, position = map(int, row.split(","))
        last = train.positions[motor - 1][-1:] or [0]
        train.add(motor - 1, tick / hz, position - last[0])
    return train


def measure(train: Train, job: Job, controller: str) -> Result:
    """What is told of one run."""
    result = Result(job.name, controller, train.duration())
    if not job.points:
        result.off_the_arc_pulses = off_the_circles(train, job.circles)
        return result
    worst = deviation(train, job.steps(), OFFSETS[controller])
    result.deviation_pulses, result.deviation_us = worst.pulses, worst.us
    corners = [speed / STEPS_PER_MM for speed in corner_speeds(train, job.steps())]
    result.slowest_corner_mm_per_s = min(corners, default=None)
    result.middle_corner_mm_per_s = middle(corners)
    return result


def same_result(run: Callable[[], Train], times: int, job: Job, controller: str) -> Result:
    """Of runs that must take the same time."""
    results = [measure(run(), job, controller) for _ in range(times)]
    took = [each.seconds for each in results]
    if max(took) - min(took) > SAME_S:
        told = ", ".join(f"{each:.6f}" for each in took)
        raise SystemExit(
            f"{controller}, {job.name}: {told} s; its planner has starved: use a quiet machine"
        )
    return results[0]


COLUMNS = ("seconds", "deviation_pulses", "deviation_us", "slowest_corner_mm_per_s",
           "middle_corner_mm_per_s", "off_the_arc_pulses")  # fmt: skip


def table(results: list[Result]) -> str:
    """As Markdown, three digits of what is below 1."""
    rows = [f"| job | controller | {' | '.join(COLUMNS)} |", "| --- " * (len(COLUMNS) + 2) + "|"]
    for each in results:
        values = [getattr(each, name) for name in COLUMNS]
        cells = ["" if v is None else f"{v:.4f}" if v < 1 else f"{v:.3f}" for v in values]
        rows.append(f"| {each.job} | {each.controller} | {' | '.join(cells)} |")
    return "\n".join(rows)


def parse(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("simulator", type=Path)
    parser.add_argument("--job", action="append", choices=[job.name for job in JOBS])
    parser.add_argument("--times", type=int, default=3, help="runs on grblHAL (default: 3)")
    parser.add_argument("--json", action="store_true")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    """Runs everything; some minutes, as grblHAL's simulator runs in real time."""
    options = parse(argv)
    program = options.simulator.resolve()
    results: list[Result] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for job in (job for job in JOBS if not options.job or job.name in options.job):

            def grbl(job: Job = job) -> Train:
                return run_grbl(program, job, folder)

            results.append(same_result(grbl, options.times, job, "grblHAL"))
            results.append(measure(run_gve134(job, folder), job, "GVE134"))
            print(table(results[-2:]).split("\n", 2)[2], file=sys.stderr)
    print(json.dumps([asdict(each) for each in results]) if options.json else table(results))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
