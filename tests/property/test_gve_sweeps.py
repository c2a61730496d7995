"""A GVE134 unit that is stopped at every pulse of a chain, in each way, beside its model."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from gve_course import MS
from gve_model import compare
from gve_probe import Probe
from gve_record import BYTE_TICKS, Edge, Session
from gve_sessions import Writer

BEGIN = 200 * MS
CHAIN = ("C31,20,0,-7", "B700", "C30,-30,11,0", "C1,0,0,0", "B200000", "C0,24,25,13", "C-9,3,0,1")
SETTINGS = ("A40", "V2500", "VJ600,600,600,600", "SW0,01", "SW1,40", "SW3,00")
ASK_MS = 3
STAND_MS = 120.0
"""The axes stand by then, wherever they were stopped."""

Act = Callable[[Writer, int], None]


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


def chain() -> Writer:
    """The host sends the chain, which ends long after 200 ms."""
    writer = Writer("chain")
    writer.tick = 150 * MS
    for text in (*SETTINGS, "*S", *CHAIN, f"*E{len(CHAIN)}"):
        writer.send(f"!0{text}\r")
        writer.pause(0 if text[0] in "*CB" else 2)
    return writer


def end_at(writer: Writer, tick: int, text: str) -> None:
    """Send a line whose CR ends at a tick, or as soon as there is time for it."""
    writer.tick = max(writer.tick, tick - BYTE_TICKS * (len(text) + 3))
    writer.send(f"!0{text}\r")


def ask(writer: Writer, *texts: str, ms: float = ASK_MS) -> None:
    for text in texts:
        writer.send(f"!0{text}\r")
        writer.pause(ms)


def close(writer: Writer, tick: int, number: int, ms: float) -> None:
    """A switch is closed for a time."""
    writer.edges += [Edge(tick, number, 0), Edge(tick + round(ms * MS), number, 1)]


def close_both(writer: Writer, tick: int, ms: float) -> None:
    """Two switches are closed at once."""
    close(writer, tick, 1, ms)
    close(writer, tick, 7, ms)


def wait_until(writer: Writer, tick: int) -> None:
    writer.tick = max(writer.tick, tick)
    writer.pause(STAND_MS)


def halt(writer: Writer, tick: int) -> None:
    end_at(writer, tick, "H")
    writer.pause(STAND_MS)
    ask(writer, "SR6", "P4", "G")


def interrupt(writer: Writer, tick: int) -> None:
    """RefX opens when it is hit; ST2 is 00, so it is active at log. 0."""
    close(writer, tick, 1, 60)
    wait_until(writer, tick)
    ask(writer, "SR4", "SR5", "PL", "SR6", "G")


def two_at_once(writer: Writer, tick: int) -> None:
    close_both(writer, tick, 60)
    wait_until(writer, tick)
    ask(writer, "SR4", "SR5", "PL", "G")


def one_after_the_other(writer: Writer, tick: int) -> None:
    """The second one comes on the ramp of the first one."""
    close(writer, tick, 7, 60)
    close(writer, tick + MS, 1, 60)
    wait_until(writer, tick)
    ask(writer, "SR4", "SR5", "PL", "G")


def halt_and_interrupt(writer: Writer, tick: int) -> None:
    close(writer, tick, 1, 60)
    end_at(writer, tick, "H")
    writer.pause(STAND_MS)
    ask(writer, "SR4", "SR6", "PL", "G")


def still_active(writer: Writer, tick: int) -> None:
    """G while the switch is closed: no pulse comes, and it is told again."""
    close(writer, tick, 7, 300)
    wait_until(writer, tick)
    ask(writer, "G", "SR5", "G", "SR6", "P4")
    writer.pause(400)
    ask(writer, "G")


def lift_and_lower(writer: Writer, tick: int) -> None:
    end_at(writer, tick, "H")
    writer.pause(STAND_MS)
    ask(writer, "K")
    ask(writer, "L0,0,-12", "L0,0,12", ms=STAND_MS)
    ask(writer, "R", "V400", "XA", "G")


def interrupted_lift(writer: Writer, tick: int) -> None:
    """A halt of what is made beside the kept path; it is deleted, the path goes on all the same."""
    close(writer, tick, 1, 60)
    wait_until(writer, tick)
    ask(writer, "K", "L0,0,-200")
    writer.pause(20)
    ask(writer, "H")
    writer.pause(STAND_MS)
    ask(writer, "P4", "D", "R", "SR4", "G")


def lift_and_lower_after_two(writer: Writer, tick: int) -> None:
    """Two causes are kept with the path: gone after K, seen by none of what is made beside it."""
    close_both(writer, tick, 60)
    wait_until(writer, tick)
    ask(writer, "SR4", "SR5", "PL", "K", "SR4", "SR5")
    ask(writer, "L0,0,-12", "L0,0,12", ms=STAND_MS)
    ask(writer, "R", "SR4", "SR5", "SR6", "PL", "G")


def resume_against_two(writer: Writer, tick: int) -> None:
    """Both are active again when the path that has been brought back goes on: no pulse comes."""
    close_both(writer, tick, 60)
    wait_until(writer, tick)
    ask(writer, "K", "R", "SR4")
    close_both(writer, writer.tick + MS, 40)
    writer.pause(5)
    ask(writer, "G", "SR4", "SR5", "PL")
    writer.pause(60)
    ask(writer, "G")


def stop_twice(writer: Writer, tick: int) -> None:
    """H, G, and H again a moment after it has left."""
    halt(writer, tick)
    writer.pause(4)
    ask(writer, "H")
    writer.pause(STAND_MS)
    ask(writer, "XU", "G")


def another_speed(writer: Writer, tick: int) -> None:
    end_at(writer, tick, "XM40")
    writer.pause(10)
    ask(writer, "XM300")


def halt_and_delete(writer: Writer, tick: int) -> None:
    end_at(writer, tick, "H")
    writer.pause(STAND_MS)
    ask(writer, "D", "C7,-7,0,1")


def reset(writer: Writer, tick: int) -> None:
    end_at(writer, tick, "J")
    writer.pause(STAND_MS)
    ask(writer, "P4", "L3,0,-3")


def two_in_the_lift(writer: Writer, tick: int) -> None:
    """What is made beside the kept path has causes of its own; those that were kept come back."""
    close_both(writer, tick, 60)
    wait_until(writer, tick)
    ask(writer, "P4", "SR4", "SR5", "PL", "D", "R", "SR4", "SR5", "SR6", "G")


def kept_and_lifted() -> Writer:
    """The sensor's button has stopped the chain, which is kept; the host lifts an axis."""
    writer = chain()
    close(writer, BEGIN, 7, 60)
    wait_until(writer, BEGIN)
    ask(writer, "K", "L0,0,-60")
    return writer


def gone_on() -> Writer:
    writer = kept_and_lifted()
    writer.pause(STAND_MS)
    ask(writer, "R", "G")
    return writer


def session_of(act: Act, tick: int, begin: Callable[[], Writer] = chain) -> Session:
    writer = begin()
    act(writer, tick)
    writer.pause(600)
    ask(writer, "P4", "SR6", "SR7")
    return writer.written()


def pulses_of(session: Session, probe: Probe) -> list[int]:
    """When there is a pulse in a session that agrees with its model."""
    done = probe.run(session)
    compare(session, done)
    return sorted({tick for train in done.motors.trains for tick in train.ticks})


@pytest.mark.parametrize(
    "act",
    [
        halt, interrupt, two_at_once, one_after_the_other, halt_and_interrupt, still_active,
        lift_and_lower, lift_and_lower_after_two, resume_against_two, interrupted_lift, stop_twice,
        another_speed, halt_and_delete, reset,
    ],
)  # fmt: skip
def test_at_every_pulse_of_a_chain_it_does_what_the_contract_says(probe: Probe, act: Act) -> None:
    ticks = pulses_of(session_of(lambda writer, tick: None, 0), probe)
    assert len(ticks) > 100

    for tick in ticks:
        session = session_of(act, tick)
        compare(session, probe.run(session))


@pytest.mark.parametrize(
    ("begin", "act"),
    [(kept_and_lifted, two_in_the_lift), (gone_on, lift_and_lower_after_two)],
)
def test_a_kept_path_bears_two_interrupts_at_every_pulse_after_it(
    probe: Probe, begin: Callable[[], Writer], act: Act
) -> None:
    plain = begin()
    begun = plain.tick
    plain.pause(600)
    ticks = [tick for tick in pulses_of(plain.written(), probe) if tick >= begun - ASK_MS * MS]
    assert len(ticks) > 50

    for tick in ticks:
        session = session_of(act, tick, begin)
        compare(session, probe.run(session))
