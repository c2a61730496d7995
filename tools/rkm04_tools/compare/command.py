"""`compare`: whether a unit did on its pins what the simulator says it does."""

from __future__ import annotations

import json
import math
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from rkm04_tools.compare.align import Alignment, Trains, align
from rkm04_tools.compare.channels import DIR, STEP, Role, Wiring, mapping_of, too_wide, wire
from rkm04_tools.compare.clock import RATE_MAX
from rkm04_tools.compare.findings import (
    Allowed,
    Wires,
    compare,
    find_jump,
    find_shift,
    wander,
)
from rkm04_tools.compare.options import LIMIT_NS_MAX
from rkm04_tools.compare.recording import Reader, Recording, hertz
from rkm04_tools.compare.report import Result, Scope, as_json, text
from rkm04_tools.compare.saleae import SaleaeReader
from rkm04_tools.compare.sampling import resolution
from rkm04_tools.compare.sigrok import MAGIC, SigrokReader
from rkm04_tools.compare.simulated import UNKNOWN, Pulses, Simulated, read_simulated
from rkm04_tools.compare.vcd import VcdReader
from rkm04_tools.failure import DONE, NOT_SO, Failure, reading_failed
from rkm04_tools.source import named

HEAD_BYTES = 1 << 16
NO_PULSES = Pulses(np.empty(0), np.empty(0, dtype=np.int8))


@dataclass(frozen=True)
class _Captured:
    """What was captured, and from where."""

    path: Path
    kind: str
    recording: Recording
    wires: Mapping[int, Wires]
    mapping: str
    """Which channels were taken, as `--channels` says it."""
    too_wide: Sequence[str]
    """What is named as another wire and is none."""


def run(options: Namespace) -> int:
    """Read both, align them, and say what differs."""
    limit = _limit(options.limit)
    given_hz = _rate(options.sample_rate)
    steps, capture = named(options.steps), named(options.capture)
    with _reading(steps) as file:
        simulated = read_simulated(steps, file, file.read(HEAD_BYTES))
    if not simulated.motors:
        raise Failure(f"{steps}: no motor moves in it, so there is nothing to compare")
    with _reading(capture) as file:
        captured = _read_capture(capture, file, options.channels, given_hz)
    result = _compare(captured, steps, simulated, limit, given_hz, options)
    print(json.dumps(as_json(result), indent=2) if options.json else text(result))
    return DONE if result.is_same else NOT_SO


def _limit(given: str | None) -> float:
    """The limit in seconds; 0 if none was given."""
    if given is None:
        return 0.0
    try:
        nanoseconds = float(given)
    except ValueError:
        nanoseconds = math.nan
    if not 0 < nanoseconds <= LIMIT_NS_MAX:
        raise Failure(
            f"--limit {given}: write nanoseconds, more than 0, at most {LIMIT_NS_MAX:.0f}"
        )
    return nanoseconds * 1e-9


def _rate(given: str | None) -> float:
    """The sample rate in hertz; 0 if none was given."""
    if given is None:
        return 0.0
    if not (hz := hertz(given)):
        raise Failure(f"--sample-rate {given}: write a rate as 24MHz or 500kHz")
    return hz


@contextmanager
def _reading(path: Path) -> Iterator[IO[bytes]]:
    """A file that is read; what goes wrong is told."""
    try:
        with path.open("rb") as file:
            yield file
    except OSError as error:
        raise reading_failed(path, error) from None


def _read_capture(path: Path, file: IO[bytes], channels: str | None, given_hz: float) -> _Captured:
    reader = _reader(path, file, given_hz)
    wirings = wire(str(path), reader.names, channels)
    names = [c.name for w in wirings.values() for c in (w.step, w.direction) if c]
    recording = reader.read(list(dict.fromkeys(names)))
    wires = {
        motor: Wires(
            each.step.of(recording.traces),
            each.direction.of(recording.traces) if each.direction else None,
        )
        for motor, each in wirings.items()
    }
    wide = [] if channels is not None else too_wide(reader.names, _roles(wirings))
    if not any(len(each.step.rises) for each in wires.values()):
        told = f"{', '.join(wide)}: more than one bit, and so not used; " if wide else ""
        raise Failure(
            f"{path}: has no pulse in {', '.join(each.step.name for each in wirings.values())}; "
            f"{told}check the probes, their ground and the trigger"
        )
    return _Captured(path, reader.kind, recording, wires, mapping_of(wirings), wide)


def _roles(wirings: Mapping[int, Wiring]) -> list[Role]:
    found = [(STEP, motor) for motor in wirings]
    return found + [(DIR, motor) for motor, each in wirings.items() if each.direction]


def _reader(path: Path, file: IO[bytes], given_hz: float) -> Reader:
    """What the begin of a file says that it is."""
    head = file.read(HEAD_BYTES)
    if not head:
        raise Failure(f"{path}: is empty; record it once more")
    if head.startswith(MAGIC):
        if not path.is_file():
            raise Failure(f"{path}: a session of sigrok must be a file, and no pipe")
        return SigrokReader(path, given_hz)
    if head.lstrip()[:1] == b"$":
        return VcdReader(path, file, head)
    return SaleaeReader(path, file, head)


def _compare(
    captured: _Captured, steps: Path, simulated: Simulated, limit: float, given_hz: float,
    options: Namespace,
) -> Result:  # fmt: skip
    found = resolution(captured.recording, given_hz)
    finest = found.seconds + simulated.digit_seconds
    pulses = {m: simulated.motors.get(m, NO_PULSES) for m in captured.wires}
    trains = {motor: each.seconds for motor, each in pulses.items()}
    rises = {m: w.step.rises for m, w in captured.wires.items()}
    if 0 < limit < finest:
        raise Failure(
            f"--limit {options.limit}: the capture resolves {finest * 1e9:.1f} ns, so that nothing "
            "below can be asked; sample faster"
        )
    noise = limit or finest + 1 / simulated.tick_hz
    alignment = align(trains, rises, finest, noise, options.rate)
    limit = limit or noise + _unknown_rate(alignment, trains, options.rate)
    recording = captured.recording
    allowed = Allowed(limit, options.part, recording.begin, recording.end)
    return Result(
        str(captured.path), captured.kind, str(steps), simulated.kind, simulated.tick_hz, found,
        allowed, alignment,
        wander(alignment, trains) if alignment else 0.0,
        find_shift(alignment, trains, rises, finest, noise) if alignment else None,
        find_jump(alignment, trains, rises, limit) if alignment else None,
        [compare(m, pulses[m], w, alignment, allowed) for m, w in captured.wires.items()],
        Scope(
            [m for m in simulated.motors if m not in captured.wires],
            [m for m, w in captured.wires.items() if w.direction is None],
            [
                m for m, w in captured.wires.items()
                if w.direction is None and (pulses[m].directions != UNKNOWN).any()
            ],
            options.channels is not None, captured.mapping, captured.too_wide,
        ),
    )  # fmt: skip


def _unknown_rate(alignment: Alignment | None, trains: Trains, with_rate: bool) -> float:
    """How far clocks may drift apart where too few pulses tell their rate."""
    if not with_rate or alignment is None or alignment.has_rate:
        return 0.0
    found = [trains[m][numbers] for m, (numbers, _) in alignment.pairs.items() if len(numbers)]
    return RATE_MAX * float(np.ptp(np.concatenate(found))) if found else 0.0
