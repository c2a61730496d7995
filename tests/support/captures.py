"""Pulse trains, what becomes of them on the way to a logic analyser, and the files of analysers."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

TICK_HZ = 84_000_000
HIGH_SECONDS = 2.5e-6
AFTER_SECONDS = 0.01
"""How long a capture goes on after the last edge."""

Edge = tuple[float, str, int]
"""When, which channel, and its level from then on."""


@dataclass(frozen=True)
class Move:
    """A move with ramps, and the rest after it; `steps` is negative for backward."""

    steps: int
    start: int
    speed: int
    accel: int
    rest_seconds: float = 0.0


@dataclass(frozen=True)
class Distortion:
    """What happens to the pulses of a motor; pulses count from 1."""

    dropped: frozenset[int] = frozenset()
    turned: frozenset[int] = frozenset()
    moved_seconds: Mapping[int, float] = field(default_factory=dict)
    added_after: Mapping[int, float] = field(default_factory=dict)
    """A pulse more at a part of the interval after a pulse."""


@dataclass(frozen=True)
class Analyser:
    """When it began, how its clock runs, and how often it looks."""

    begun_seconds: float = 0.1
    ppm: float = 0.0
    sample_hz: float = 24e6

    def sees(self, seconds: float) -> float:
        """The time of the sample that is the first one after an edge."""
        own = seconds * (1 + self.ppm * 1e-6) + self.begun_seconds
        return math.ceil(own * self.sample_hz - 1e-6) / self.sample_hz


def pulses(moves: Sequence[Move]) -> list[tuple[int, int]]:
    """Ticks and positions of the pulses of a motor."""
    begin, position, found = 0.0, 0, []
    for move in moves:
        times = _times(move)
        for seconds in times:
            position += 1 if move.steps > 0 else -1
            found.append((round((begin + seconds) * TICK_HZ), position))
        begin += times[-1] + move.rest_seconds + 1 / move.start
    return found


def _times(move: Move) -> list[float]:
    """When the pulses of a move come: up a ramp, along, and down a ramp."""
    count = abs(move.steps)
    ramp = (move.speed**2 - move.start**2) / (2 * move.accel)
    ramp = min(ramp, count / 2)
    peak = math.sqrt(move.start**2 + 2 * move.accel * ramp)
    up = (peak - move.start) / move.accel
    along = (count - 2 * ramp) / peak
    times = []
    for k in range(1, count + 1):
        if k <= ramp:
            times.append((math.sqrt(move.start**2 + 2 * move.accel * k) - move.start) / move.accel)
        elif k <= count - ramp:
            times.append(up + (k - ramp) / peak)
        else:
            left = math.sqrt(max(0.0, move.start**2 + 2 * move.accel * (count - k)))
            times.append(2 * up + along - (left - move.start) / move.accel)
    return times


def steps_file(path: Path, motors: Mapping[int, Sequence[tuple[int, int]]]) -> Path:
    """What the simulator would have written."""
    rows = sorted((tick, motor, at) for motor, found in motors.items() for tick, at in found)
    lines = [f"# tick_hz={TICK_HZ}", "tick,motor,position"]
    path.write_text("\n".join([*lines, *(",".join(map(str, row)) for row in rows), ""]))
    return path


def edges(
    motor: int, train: Sequence[tuple[int, int]], analyser: Analyser, distortion: Distortion
) -> list[Edge]:
    """What an analyser sees of a motor."""
    step, direction = f"STEP{motor}", f"DIR{motor}"
    seconds = [tick / TICK_HZ for tick, _ in train]
    found: list[Edge] = []
    level = 0
    for at, (_, position) in enumerate(train):
        number = at + 1
        backward = int(position < (train[at - 1][1] if at else 0)) ^ (number in distortion.turned)
        if backward != level:
            level = backward
            before = seconds[at] - (seconds[at] - seconds[at - 1]) / 5 if at else seconds[0] - 1e-3
            found.append((analyser.sees(before), direction, level))
        if number not in distortion.dropped:
            rise = seconds[at] + distortion.moved_seconds.get(number, 0.0)
            found += _pulse(analyser, step, rise)
        if number in distortion.added_after and number < len(train):
            part = distortion.added_after[number]
            found += _pulse(analyser, step, seconds[at] + part * (seconds[number] - seconds[at]))
    return found


def _pulse(analyser: Analyser, step: str, rise: float) -> list[Edge]:
    return [(analyser.sees(rise), step, 1), (analyser.sees(rise + HIGH_SECONDS), step, 0)]


def names(found: Sequence[Edge]) -> list[str]:
    """The channels, STEP and DIR of each motor."""
    motors = sorted({name[-1] for _, name, _ in found})
    return [f"{kind}{motor}" for motor in motors for kind in ("STEP", "DIR")]


def vcd_file(path: Path, found: Sequence[Edge], analyser: Analyser, end: float = 0.0) -> Path:
    """A dump as sigrok writes it."""
    found = sorted(found)
    codes = {name: chr(ord("!") + at) for at, name in enumerate(names(found))}
    scale = 1e10
    lines = [
        "$version libsigrok 0.5.2 $end", "$comment",
        f"  Acquisition with 8/8 channels at {analyser.sample_hz / 1e6:g} MHz", "$end",
        "$timescale 100 ps $end", "$scope module libsigrok $end",
        *(f"$var wire 1 {code} {name} $end" for name, code in codes.items()),
        "$upscope $end", "$enddefinitions $end",
        "#0 " + " ".join(f"0{code}" for code in codes.values()),
    ]  # fmt: skip
    lines += [f"#{seconds * scale:.0f} {level}{codes[name]}" for seconds, name, level in found]
    lines.append(f"#{max(end, found[-1][0] + AFTER_SECONDS) * scale:.0f}")
    path.write_text("\n".join([*lines, ""]))
    return path


def csv_file(path: Path, found: Sequence[Edge], iso: bool = False, every: bool = False) -> Path:
    """Raw data as Saleae's Logic exports it; `every` has rows without a change, too."""
    levels = dict.fromkeys(names(found), 0)
    rows = [(0.0, dict(levels))]
    for seconds, name, level in sorted(found):
        levels[name] = level
        if rows[-1][0] == seconds:
            rows.pop()
        rows.append((seconds, dict(levels)))
        if every:
            rows.append((seconds + 1e-7, dict(levels)))
    lines = [",".join(["Time [s]", *levels])]
    for seconds, now in rows:
        stamp = f"{seconds:.9f}"
        if iso:
            whole, _, part = stamp.partition(".")
            stamp = f"2026-11-22T10:59:{int(whole):02d}.{part}+00:00"
        lines.append(",".join([stamp, *map(str, now.values())]))
    path.write_text("\n".join([*lines, ""]))
    return path


def samples(found: Sequence[Edge], analyser: Analyser) -> NDArray[np.uint8]:
    """What an analyser of eight channels sends, a byte a sample."""
    last = max(seconds for seconds, _, _ in found)
    words = np.zeros(int((last + AFTER_SECONDS) * analyser.sample_hz), dtype=np.uint8)
    for bit, name in enumerate(names(found)):
        changes = sorted(round(s * analyser.sample_hz) for s, of, _ in found if of == name)
        toggles = np.zeros(len(words), dtype=np.uint8)
        np.bitwise_xor.at(toggles, changes, 1)
        words |= np.bitwise_xor.accumulate(toggles) << bit
    return words


def sr_file(
    path: Path, words: NDArray[np.uint8], channels: Sequence[str], hz: float = 24e6, parts: int = 3,
    unit: int = 1,
) -> Path:  # fmt: skip
    """A session as sigrok saves it."""
    probes = "".join(f"probe{at + 1}={name}\n" for at, name in enumerate(channels))
    wide = np.zeros((len(words), unit), dtype=np.uint8)
    wide[:, 0] = words
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("version", "2")
        file.writestr(
            "metadata",
            f"[global]\nsigrok version=0.5.2\n\n[device 1]\ncapturefile=logic-1\ntotal probes=8\n"
            f"samplerate={hz / 1e6:g} MHz\ntotal analog=0\n{probes}unitsize={unit}\n",
        )
        for number, part in enumerate(np.array_split(wide, parts), 1):
            file.writestr(f"logic-1-{number}", part.tobytes())
    return path
