"""A long job over a bad line, sent by a host that knows the contract alone.

The host, the line and the model that the pulses are held against share nothing with the tool. Three
switches interrupt the job; each time the host keeps the queue, lifts the tool, lowers it and goes
on. `RKM04_JOB=100000` makes it as long as a real one.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest
from gve_course import MS
from gve_host import Host, Person
from gve_job import any_job
from gve_live import Live
from gve_model import compare
from gve_probe import Probe

VECTORS = int(os.environ.get("RKM04_JOB", "2000"))
HARM = 0.0002
"""The chance of a byte to be lost, and to be changed: every third packet comes to harm at 0.001."""

LATE_MS = (0, 7, 23)
"""So long after a switch was due it is hit: the axes are anywhere then."""


class Switches(Person):
    """Hits a switch after each quarter of the job, and lets go when the axes stand."""

    def __init__(self, line: Live, vectors: int) -> None:
        """Plan the hits: input, level when hit, and the causes that then stand in ST4 and ST5."""
        self.line = line
        self.hits = [(2, 0, (2, 0)), (7, 0, (0, 0x40)), (1, 1, (1, 0))]
        self.due = [vectors * quarter // 4 for quarter in (1, 2, 3)]
        self.hit: list[tuple[int, int, tuple[int, int]]] = []
        self.seen: list[tuple[int, int]] = []

    def vectors_taken(self, count: int) -> None:
        if len(self.hit) < len(self.due) and count >= self.due[len(self.hit)]:
            number, level, _ = self.hits[len(self.hit)]
            self.line.set_input(number, level, after=LATE_MS[len(self.hit)] * MS)
            self.hit.append(self.hits[len(self.hit)])

    def interrupted(self, low: int, high: int) -> None:
        self.seen.append((low, high))
        number, level, _ = self.hit[-1]
        self.line.set_input(number, 1 - level)


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


def run_job(probe: Probe, seed: int, vectors: int, harm: float) -> tuple[Host, Live, Switches]:
    """A job to its end."""
    line = Live(probe, seed, harm)
    switches = Switches(line, vectors)
    host = Host(line, switches)
    line.set_input(1, 0)
    line.receive(150 * MS)
    host.connect()
    for command in ("SW2,01", "SW0,0F", "SW1,C0"):
        host.ask(command)
    host.run(any_job(seed, vectors))
    return host, line, switches


def check(host: Host, line: Live, switches: Switches) -> None:
    """Hold what was done against the sum of the vectors and against the model."""
    assert host.positions() == tuple(host.total)
    assert host.ask("SR7").values == ("00",)
    assert switches.seen == [causes for _, _, causes in switches.hits]
    trains = line.done.motors.trains
    assert [train.places[-1] for train in trains] == host.total
    assert [len(train.ticks) for train in trains] == host.pulses
    session = line.session()
    worst = compare(session, line.done)
    print(
        f"{host.figures}, {line.harmed} bytes came to harm of {len(session.line)}, "
        f"{sum(host.pulses)} pulses in {line.now / MS / 1000:.1f} s, worst {worst:.2f} ticks"
    )


def test_a_job_with_interrupts_over_a_bad_line_is_exact(probe: Probe) -> None:
    host, line, switches = run_job(probe, 17, VECTORS, HARM)

    check(host, line, switches)

    assert host.figures.vectors == VECTORS + 6 + 1
    assert sum(line.harmed) > VECTORS / 200
    assert host.figures.repairs > VECTORS / 200


@pytest.mark.parametrize("seed", range(6))
def test_a_job_over_a_very_bad_line_is_exact(probe: Probe, seed: int) -> None:
    check(*run_job(probe, seed, 200, 10 * HARM))
