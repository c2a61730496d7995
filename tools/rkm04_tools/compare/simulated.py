"""What should be in a capture: the steps file of a simulation, or its waveforms.

A steps file has the ticks of the pulses, and positions, which tell the direction unless the
program has written the counter just before. Waveforms have STEP and DIR in whole nanoseconds.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from rkm04_tools.compare.channels import wire
from rkm04_tools.compare.recording import Floats, Ints, Trace, parts
from rkm04_tools.compare.vcd import VcdReader
from rkm04_tools.failure import Failure

TICK_HZ = 84_000_000
"""The timer's rate, which waveforms do not tell."""
RATE = b"# tick_hz="
HEAD = b"tick,motor,position"
ROW = re.compile(rb"-?\d{1,18},-?\d{1,18},-?\d{1,18}")
FORWARD, BACKWARD, UNKNOWN = 0, 1, -1
MOTORS = range(1, 5)

Directions = NDArray[np.int8]


@dataclass(frozen=True)
class Pulses:
    """The pulses that a motor should make, in seconds from the start; 1 is backward."""

    seconds: Floats
    directions: Directions


@dataclass(frozen=True)
class Simulated:
    """A simulation: the pulses of each motor that moved, and how finely it tells their times."""

    kind: str
    tick_hz: int
    digit_seconds: float
    motors: Mapping[int, Pulses]


def read_simulated(path: Path, file: IO[bytes], head: bytes) -> Simulated:
    """Read what a simulation wrote; `head` is the begin of the file, which was read already."""
    if head.startswith(RATE):
        return _of_steps(path, file, head)
    if head.lstrip()[:1] == b"$":
        return _of_waves(path, file, head)
    raise Failure(f"{path}: is no steps file; tools/rkm04 sim PROGRAM --steps FILE writes one")


def _of_steps(path: Path, file: IO[bytes], head: bytes) -> Simulated:
    rate, _, rest = head.partition(b"\n")
    names, found, rows = rest.partition(b"\n")
    digits = rate.removeprefix(RATE).strip()
    if not digits.isdigit() or not 0 < int(digits) < 10**12 or not found or names.strip() != HEAD:
        raise Failure(f"{path}: does not begin as a steps file; write it once more by sim --steps")
    hz = int(digits)
    tables = [_table(path, part) for part in parts(path, file, b"\n", rows)]
    table = np.concatenate(tables) if tables else np.empty((0, 3), dtype=np.int64)
    if not np.isin(table[:, 1], MOTORS).all() or (np.diff(table[:, 0]) < 0).any():
        raise Failure(f"{path}: its steps are not those of motors 1 to 4 by time; write it again")
    motors = {int(m): _of_motor(table[table[:, 1] == m], hz) for m in np.unique(table[:, 1])}
    return Simulated("steps", hz, 0.0, motors)


def _table(path: Path, part: bytes) -> Ints:
    lines = part.split()
    try:
        return np.loadtxt(lines, dtype=np.int64, delimiter=",", ndmin=2, usecols=(0, 1, 2))
    except ValueError:
        for line in lines:
            if not ROW.fullmatch(line):
                shown = line[:40].decode("ascii", "replace")
                raise Failure(
                    f"{path}: {shown} is no tick,motor,position; write it again"
                ) from None
        raise


def _of_motor(rows: Ints, hz: int) -> Pulses:
    moved = np.diff(rows[:, 2], prepend=0)
    directions = np.full(len(rows), UNKNOWN, dtype=np.int8)
    directions[moved == 1] = FORWARD
    directions[moved == -1] = BACKWARD
    return Pulses(rows[:, 0] / hz, directions)


def _of_waves(path: Path, file: IO[bytes], head: bytes) -> Simulated:
    reader = VcdReader(path, file, head)
    wirings = wire(str(path), reader.names, None)
    channels = [c.name for w in wirings.values() for c in (w.step, w.direction) if c]
    recording = reader.read(channels)
    motors = {}
    for motor, wiring in wirings.items():
        rises = wiring.step.of(recording.traces).rises
        if len(rises):
            direction = wiring.direction.of(recording.traces) if wiring.direction else None
            motors[motor] = Pulses(rises, _directions(direction, rises))
    return Simulated("waveforms", TICK_HZ, recording.digit_seconds, motors)


def _directions(trace: Trace | None, rises: Floats) -> Directions:
    if trace is None:
        return np.full(len(rises), UNKNOWN, dtype=np.int8)
    return trace.levels(rises).astype(np.int8)
