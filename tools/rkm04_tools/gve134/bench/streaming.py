"""How well `send` keeps the queue of the image filled, over converters that are slow to answer.

The client is that of the tool. What is in the queue is counted from outside: the vectors that the
unit has answered for, less those whose last pulse has been made.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134.bench.converter import MS_PER_SECOND, Converter
from rkm04_tools.gve134.job import job_of
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.source import Source
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_run import TICKS_PER_MS, Ran, Rig

BEGIN_MS = 120.0
"""The unit is ready by then."""
PULSES = 100
SHARES = (1.0, -0.99, 0.57, 0.33)
ACCEL_MAX = 8000
SPARE_SECONDS = 10.0
FILLED = 100
"""So many must have been in the queue before its level counts: a job begins with it empty."""


@dataclass(frozen=True)
class Course:
    """A rate, a converter, and how many vectors pass how fast."""

    baud: int
    latency_ms: float
    vectors: int
    per_second: int


QUICK = Course(921_600, 1.0, 3000, 2000)
SLOW = Course(115_200, 16.0, 700, 200)
SLOWER = Course(115_200, 16.0, 900, 300)


@dataclass(frozen=True)
class Streamed:
    """What became of a job: vectors/s that were made, and the least that was in the queue."""

    ran: Ran
    made: float
    least: int
    packets: int
    repairs: int


def job_text(course: Course) -> str:
    """Vectors of so many pulses on X, which pass at a rate."""
    ways = ",".join(str(round(share * PULSES)) for share in SHARES)
    head = f"A{ACCEL_MAX}\nV{course.per_second * PULSES}\n$1\n"
    return head + f"C{ways}\n" * course.vectors


def stream(rig: Rig, course: Course) -> Streamed:
    """Send a job as `send` does, and see what the motors do."""
    job = job_of(Source("bench", job_text(course)))
    taken: list[tuple[float, int]] = [(0.0, 0)]
    seconds = SPARE_SECONDS + 3.0 * course.vectors / course.per_second
    options = ("--baud", str(course.baud), "--measure-from", f"{BEGIN_MS:.3f}")
    with rig.talk(seconds, *options, steps=True) as talk:
        port = Converter(talk, course.latency_ms)
        port.read(BEGIN_MS / MS_PER_SECOND)
        unit = port.unit(course.baud)

        def note(sent: int) -> None:
            if sent > taken[-1][1]:
                taken.append((port.heard_ms, sent))

        sender = Sender(unit, job, note)
        sender.send()
        sender.finish()
        ran = rig.ran(talk.end())
    ends = [round(share * PULSES) * course.vectors for share in SHARES]
    if ran.positions != ends:
        raise Failure(f"streaming: the axes stand at {ran.positions}, not at {ends}", NOT_SO)
    ms = x_pulses_ms(ran)[PULSES - 1 :: PULSES]
    middle = ms[len(ms) // 4 : -len(ms) // 4]
    made = MS_PER_SECOND * (len(middle) - 1) / float(middle[-1] - middle[0])
    least = least_in_queue(taken, ms)
    return Streamed(ran, made, least, sender.packets, unit.link.repairs)


def x_pulses_ms(ran: Ran) -> np.ndarray:
    """When the pulses of X came."""
    rows = np.loadtxt(ran.folder / "steps.csv", delimiter=",", skiprows=2, dtype=np.int64)
    ticks: np.ndarray = rows[rows[:, 1] == 1, 0]
    return ticks / TICKS_PER_MS


def least_in_queue(taken: list[tuple[float, int]], done_ms: np.ndarray) -> int:
    """The least that was in the queue from when it was filled until the last vector was taken.

    It has its least just before vectors are added.
    """
    filled, least = False, len(done_ms)
    for (_, before), (ms, after) in pairwise(taken):
        done = int(np.searchsorted(done_ms, ms))
        if filled:
            least = min(least, before - done)
        filled = filled or after - done >= FILLED
    return least if filled else 0


def quick(rig: Rig) -> Figures:
    """As fast as the axes go, over a converter that hands on what comes every millisecond."""
    return _told("quick", stream(rig, QUICK))


def slow(rig: Rig) -> Figures:
    """At the rate that units are delivered with, over a converter as they are delivered."""
    return _told("slow", stream(rig, SLOW)) | _told("slower", stream(rig, SLOWER))


def _told(name: str, streamed: Streamed) -> Figures:
    return {
        f"least_{name}": streamed.least,
        f"made_{name}": streamed.made,
        f"late_{name}": streamed.ran.late,
        f"load_{name}": streamed.ran.load,
        f"repairs_{name}": streamed.repairs,
        "stack_used": streamed.ran.stack_used,
    }
