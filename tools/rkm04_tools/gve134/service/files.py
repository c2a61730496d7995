"""A file that a page has brought: checked, turned if it is G-code, and planned.

Errors are those of the firmware's own parser and of `gve134 gcode`; what the plan says is said by
the planner of the firmware.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt

from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import Mill
from rkm04_tools.gve134.gcode.preview import Preview, Previewed
from rkm04_tools.gve134.gcode.reading import KIND, LINE_BYTES_MAX
from rkm04_tools.gve134.gcode.turning import Problem, turn_file
from rkm04_tools.gve134.job import Job, job_of
from rkm04_tools.gve134.service.course import Course, course_of
from rkm04_tools.gve134.source import is_gcode
from rkm04_tools.service.trouble import BadRequest
from rkm04_tools.source import Source, decode, why_no_text

FILE_BYTES_MAX = 10_000_000
PROBLEMS_MAX = 100
NO_MILL = Mill("", (None, None, None, None), None, None)

Floats = npt.NDArray[np.float64]
_numbers = itertools.count(1)


@dataclass(frozen=True)
class File:
    """What became of it; `job`, `course`, `seconds` and `plan` are None if it has errors.

    `seconds` are those of each vector of the course. `text` is the file as the user has it.
    """

    number: int
    name: str
    text: str
    problems: list[dict[str, Any]]
    more: int
    job: Job | None = None
    course: Course | None = None
    seconds: Floats | None = None
    plan: Previewed | None = None
    dwelt_s: float = 0.0
    is_own: bool = False
    """Of the page itself, and not what a user has opened."""

    def as_json(self) -> dict[str, Any]:
        """What all browsers know of it."""
        return {
            "number": self.number,
            "name": self.name,
            "ok": self.job is not None,
            "errors": self.more + sum(each["severity"] == "error" for each in self.problems),
            "vectors": len(self.course) if self.course else 0,
            "seconds": self.plan.seconds + self.dwelt_s if self.plan else None,
            "peaks": self.plan.peaks if self.plan else None,
            "absolute_from": self.course.absolute_from[:3] if self.course else None,
        }

    def rows(self) -> bytes:
        """The course for a page, a row for a vector: x, y, z at its end in pulses, seconds, line.

        Before a vector that begins elsewhere stands a row without seconds (NaN): its begin.
        """
        course = self.course
        if course is None or self.seconds is None or not len(course):
            return b""
        ends = course.begins + course.parts
        apart = np.ones(len(course), bool)
        apart[1:] = (course.begins[1:, :3] != ends[:-1, :3]).any(axis=1)
        shown = np.column_stack((ends[:, :3], self.seconds, course.lines))
        before = np.column_stack((course.begins[:, :3], np.full(len(course), np.nan), course.lines))
        order = np.argsort(
            np.concatenate((2.0 * np.flatnonzero(apart), 2.0 * np.arange(len(course)) + 1))
        )
        return np.concatenate((before[apart], shown))[order].astype("<f4").tobytes()


def read_file(name: str, data: bytes, mill: Mill | None) -> File:
    """Read a vector file or a program of G-code, by its name."""
    if wrong := why_no_text(data, KIND if is_gcode(name) else "a vector file (.gve)"):
        raise BadRequest(f"{name}: {wrong}")
    return _read_gcode(name, data, mill) if is_gcode(name) else _read_vectors(name, data)


def _read_gcode(name: str, data: bytes, mill: Mill | None) -> File:
    if mill is None:
        raise BadRequest(f"{name}: for which machine? open its machine file (.rkm) first")
    pieces: list[str] = []
    turned = turn_file(_lines(data), name, mill, pieces.append)
    problems = [_problem("error", each) for each in turned.problems]
    problems += [_problem("warning", each) for each in turned.warnings]
    file = File(
        next(_numbers), name, decode(data), problems[:PROBLEMS_MAX],
        max(0, len(turned.problems) - PROBLEMS_MAX) + turned.more_problems,
    )  # fmt: skip
    if not turned.is_good:
        return file
    return _planned(file, Source(name, "".join(pieces)), mill, turned.dwelt_s)


def _lines(data: bytes) -> Iterable[bytes]:
    return (line[:LINE_BYTES_MAX].rstrip(b"\x1a") for line in data.splitlines())


def _problem(severity: str, problem: Problem) -> dict[str, Any]:
    return _told(severity, problem.line, problem.column, problem.message)


def _told(severity: str, line: int, column: int, message: str) -> dict[str, Any]:
    return {"severity": severity, "line": line, "column": column, "message": message}


def _read_vectors(name: str, data: bytes) -> File:
    source = Source(name, decode(data))
    parsed = host.check(source.text)
    problems = [_told("error", e.line, e.column, e.message) for e in parsed.errors]
    more = max(0, len(problems) - PROBLEMS_MAX) + parsed.more
    file = File(next(_numbers), name, source.text, problems[:PROBLEMS_MAX], more)
    return file if parsed.errors else _planned(file, source, None, None)


def _planned(file: File, source: Source, mill: Mill | None, dwelt_s: float | None) -> File:
    """Add what the planner says; what gcode has written has passed the same parser."""
    job = job_of(source)
    course = course_of(job, is_gcode=mill is not None)
    with TemporaryDirectory(prefix="gve134-") as folder:
        place = Path(folder) / "course"
        with Preview(mill or NO_MILL, course=place) as preview:
            preview.put(source.text if source.text.endswith("\n") else f"{source.text}\n")
            plan = preview.end()
        seconds = np.fromfile(place).reshape(-1, 3)[:, 2]
    seconds = seconds[~np.isnan(seconds)]
    if len(seconds) != len(course):
        raise Failure(f"{source.name}: the plan has {len(seconds)} vectors of {len(course)}")
    dwelt_s = course.waits_s if dwelt_s is None else dwelt_s
    return replace(file, job=job, course=course, seconds=seconds, plan=plan, dwelt_s=dwelt_s)
