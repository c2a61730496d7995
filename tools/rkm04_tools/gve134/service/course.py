"""The way that a file leads, vector by vector.

Places are in pulses from where the axes stand at the beginning, and absolute from the command N of
an axis on.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rkm04_tools.gve134.gcode.directives import Wait
from rkm04_tools.gve134.job import Job
from rkm04_tools.gve134.state import AXES

ORIGIN = re.compile(r"; line (\d+)\Z")
SET_POSITION = re.compile(r"N(?:([XYZA]),?(-?\d+))?")

Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Course:
    """All vectors of a file, those without a way left out.

    `counts` says how many of them there are before each vector of the file.
    """

    parts: Ints
    begins: Ints
    lines: Ints
    """In the file as the user has it."""
    absolute_from: tuple[int | None, ...]
    """Of each axis the first vector from which on places are absolute."""
    counts: Ints
    waits_s: float
    """What the host waits in all."""

    def __len__(self) -> int:
        return len(self.lines)


def course_of(job: Job, is_gcode: bool) -> Course:
    """The course of a file without errors."""
    origins = _origins(job) if is_gcode else None
    at, waits_s = [0, 0, 0, 0], 0.0
    parts, begins, lines, counts = [], [], [], [0]
    absolute: list[int | None] = [None] * len(AXES)
    for command in job:
        if command.is_vector:
            part = list(command.steps)
            if any(part):
                parts.append(part)
                begins.append(list(at))
                lines.append(origins[command.line] if origins else command.line)
                at = [a + b for a, b in zip(at, part, strict=True)]
            counts.append(len(parts))
        elif match := SET_POSITION.fullmatch(command.text):
            for axis in [AXES.index(match[1])] if match[1] else range(len(AXES)):
                at[axis] = int(match[2] or 0)
                absolute[axis] = len(parts) if absolute[axis] is None else absolute[axis]
        elif isinstance(command.asked_of_host, Wait):
            waits_s += command.asked_of_host.seconds
    shape = (len(parts), len(AXES))
    return Course(
        np.array(parts, np.int64).reshape(shape),
        np.array(begins, np.int64).reshape(shape),
        np.array(lines, np.int64),
        tuple(absolute),
        np.array(counts, np.int64),
        waits_s,
    )


def _origins(job: Job) -> list[int]:
    """By line of the vectors, from 1, the line of the program that they come from."""
    found, last = [0], 0
    for line in job.source.text.split("\n"):
        match = ORIGIN.search(line)
        last = int(match[1]) if match else last
        found.append(last)
    return found
