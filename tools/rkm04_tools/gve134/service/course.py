"""The way that a file leads, vector by vector, and where on it the axes are.

Places are in pulses from where the axes stand at the beginning, and absolute from the command N of
an axis on. The unit does not tell which vector it executes, so that is told from the positions.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rkm04_tools.gve134.gcode.directives import Probe
from rkm04_tools.gve134.job import Command, Job
from rkm04_tools.gve134.state import AXES, Positions

ORIGIN = re.compile(r"; line (\d+)\Z")
SET_POSITION = re.compile(r"N(?:([XYZA]),?(-?\d+))?")
OFF_MAX = 1.01
"""Pulses by which an axis may be off the straight line between two of its own pulses."""

Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Course:
    """All vectors of a file, those without a way left out.

    `counts` says how many of them there are before each vector of the file. `syncs` are numbers of
    vectors of the file after which a command may have changed what positions mean.
    """

    parts: Ints
    begins: Ints
    lines: Ints
    """In the file as the user has it."""
    absolute_from: tuple[int | None, ...]
    """Of each axis the first vector from which on places are absolute."""
    counts: Ints
    syncs: frozenset[int]
    end: Ints

    def __len__(self) -> int:
        return len(self.lines)

    def place(self, number: int) -> Ints:
        """Where a vector begins."""
        return self.begins[number] if number < len(self) else self.end


def course_of(job: Job, is_gcode: bool) -> Course:
    """The course of a file without errors."""
    origins = _origins(job) if is_gcode else None
    at = [0, 0, 0, 0]
    parts, begins, lines, counts = [], [], [], [0]
    absolute: list[int | None] = [None] * len(AXES)
    syncs: set[int] = set()
    for command in job:
        if command.is_vector:
            part = [int(each) for each in command.text[1:].split(",")]
            if any(part):
                parts.append(part)
                begins.append(list(at))
                lines.append(origins[command.line] if origins else command.line)
                at = [a + b for a, b in zip(at, part, strict=True)]
            counts.append(len(parts))
        elif _changes_places(command, at, absolute, len(parts)):
            syncs.add(len(counts) - 1)
    shape = (len(parts), len(AXES))
    return Course(
        np.array(parts, np.int64).reshape(shape),
        np.array(begins, np.int64).reshape(shape),
        np.array(lines, np.int64),
        tuple(absolute),
        np.array(counts, np.int64),
        frozenset(syncs),
        np.array(at, np.int64),
    )


def _changes_places(
    command: Command, at: list[int], absolute: list[int | None], number: int
) -> bool:
    """Whether positions may mean something else after it; sets those that are told."""
    if match := SET_POSITION.fullmatch(command.text):
        for axis in [AXES.index(match[1])] if match[1] else range(len(AXES)):
            at[axis] = int(match[2] or 0)
            absolute[axis] = number if absolute[axis] is None else absolute[axis]
        return True
    is_probe = isinstance(command.asked_of_host, Probe)
    return is_probe or command.letter in ("W", "J", "D", "K", "R", "H")


def _origins(job: Job) -> list[int]:
    """By line of the vectors, from 1, the line of the program that they come from."""
    found, last = [0], 0
    for line in job.source.text.split("\n"):
        match = ORIGIN.search(line)
        last = int(match[1]) if match else last
        found.append(last)
    return found


class Tracker:
    """Follows the axes along a course."""

    def __init__(self, course: Course, begin: Positions) -> None:
        self._course = course
        self._offset = np.array(begin, np.int64)
        self.number = 0
        """The vector that is executed."""
        self.is_known = True
        self._part = 0.0

    def see(self, positions: Positions, sent: int, stands: bool) -> Iterator[Positions]:
        """Take in positions; the corners that the axes have passed since the last ones.

        `sent` vectors of the file have been taken; where the axes stand without one that waits,
        they are at the end of these.
        """
        course, first = self._course, self.number
        count = int(course.counts[sent])
        now = np.array(positions, np.int64)
        if stands:
            self.number, self._part, self.is_known = count, 0.0, True
            self._offset = now - course.place(count)
        else:
            self._find(now - self._offset, count)
        for number in range(first, self.number if self.is_known else first):
            x, y, z, a = (int(each) for each in course.place(number + 1) + self._offset)
            if number + 1 < len(course):
                yield x, y, z, a

    def _find(self, place: Ints, count: int) -> None:
        """The first vector from the last one on that leads over a place."""
        number = self.number
        parts, begins = self._course.parts[number:count], self._course.begins[number:count]
        if not len(parts):
            self.is_known = bool((place == self._course.place(count)).all())
            return
        ways = place - begins
        axis = np.abs(parts).argmax(axis=1)[:, None]
        longest = np.take_along_axis(parts, axis, 1)[:, 0]
        shares = np.take_along_axis(ways, axis, 1)[:, 0] / longest
        off = np.abs(parts * shares[:, None] - ways).max(axis=1)
        slack = 1 / np.abs(longest)
        least = np.zeros(len(parts))
        least[0] = self._part
        fits = (off <= OFF_MAX) & (shares >= least - slack) & (shares <= 1 + slack)
        self.is_known = bool(fits.any())
        if self.is_known:
            found = int(fits.argmax())
            self.number = number + found
            self._part = float(shares[found])
