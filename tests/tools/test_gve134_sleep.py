"""A computer that sleeps while it sends a file; in virtual time."""

from __future__ import annotations

import pytest
from fake_gve134 import FakeGve
from gve134_ports import VirtualPort
from rkm04_tools.gve134.job import job_of
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.sending import Interrupted, Sender
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.source import Source

VECTORS = 500


def sender(unit: FakeGve, text: str) -> Sender:
    port = VirtualPort(unit)
    return Sender(Unit(Link(Wire(port, 115_200, clock=port.clock))), job_of(Source("a.gve", text)))


def fall_asleep(sending: Sender, seconds: float) -> None:
    """Sleep between two looks for an answer."""
    wire = sending.unit.link.wire
    date = wire.calendar() + seconds
    wire.calendar = lambda: date


def test_after_a_sleep_the_axes_are_halted_and_nothing_is_sent_by_itself() -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, "".join(f"C{number}\n" for number in range(VECTORS)))
    sending.tell = lambda sent: fall_asleep(sending, 25) if sent > 200 else None

    with pytest.raises(Interrupted, match="slept for 25 s: INTERRUPTED by H; the axes stand at"):
        sending.send()

    assert unit.inta
    assert len(unit.taken) < VECTORS
    sending.tell = lambda sent: None
    sending.unit.order("G")
    sending.send()
    assert unit.taken == [(number, 0, 0, 0) for number in range(VECTORS)]


def test_a_sleep_while_a_person_is_waited_for_is_over_when_they_are_ready() -> None:
    unit = FakeGve()
    sending = sender(unit, "C5\n;@pause ready?\nC7\n")

    def ask(text: str) -> None:
        fall_asleep(sending, 25)
        sending.unit.flags()

    sending.ask_person = ask
    sending.send()
    assert unit.taken == [(5, 0, 0, 0), (7, 0, 0, 0)]
