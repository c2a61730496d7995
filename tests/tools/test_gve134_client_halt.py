"""What is answered when the axes stand, a line that is dead for long, and the halt that always gets
through; virtual time."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fake_gve134 import FakeGve, cut_off, damaged, lost
from gve134_ports import Ends, VirtualPort, answer_of
from rkm04_tools.gve134.answers import Answer, encoded
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.link_errors import (
    NoAnswer,
    NotConfirmed,
    Restarted,
)
from rkm04_tools.gve134.wire import Wire

BAUD = 115_200


@pytest.fixture
def unit() -> FakeGve:
    return FakeGve()


@pytest.fixture
def port(unit: FakeGve) -> Ends:
    return Ends(unit)


@pytest.fixture
def link(port: Ends) -> Link:
    link = Link(Wire(port, BAUD, clock=port.clock))
    link.connect()
    return link


def bare(port: Ends) -> Link:
    """A link that has not connected."""
    return Link(Wire(port, BAUD, clock=port.clock))


# ---- what takes long ----


def test_a_reference_run_is_answered_at_its_end(link: Link, unit: FakeGve, port: Ends) -> None:
    unit.home_s = 20.0

    assert link.ask_long("WX-100,50,10,50", 60) == Answer(0, False)

    assert port.now > 20
    assert unit.done.count("WX-100,50,10,50") == 1
    assert link.ask("P4").numbers == (0, 0, 0, 0)


@pytest.mark.parametrize("fault", [lost, damaged, cut_off])
def test_a_reference_run_whose_answer_comes_to_harm_is_made_once(
    link: Link, unit: FakeGve, fault: Callable[[bytes], bytes]
) -> None:
    unit.home_s = 3.0
    unit.faults.append(fault)

    assert link.ask_long("WX-100,50,10,50", 60).code == 0
    assert unit.done.count("WX-100,50,10,50") == 1


@pytest.mark.parametrize("fault", [lost, damaged, cut_off])
def test_a_reference_run_that_comes_to_harm_is_sent_again(
    link: Link, unit: FakeGve, port: Ends, fault: Callable[[bytes], bytes]
) -> None:
    port.requests.append(fault)

    assert link.ask_long("WX-100,50,10,50", 60).code == 0
    assert unit.done.count("WX-100,50,10,50") == 1


def test_a_restart_during_a_reference_run_is_told(link: Link, unit: FakeGve, port: Ends) -> None:
    unit.home_s = 5.0
    port.before = lambda data: unit.restart() if data.startswith(b"!0@") else None

    with pytest.raises(Restarted, match="executed before that or not at all"):
        link.ask_long("WX-100,50,10,50", 60)


def test_a_reference_run_without_an_end_is_not_known_about(link: Link, unit: FakeGve) -> None:
    unit.home_s = 1000.0

    with pytest.raises(NotConfirmed, match="NOT KNOWN whether the axes move"):
        link.ask_long("WX-100,50,10,50", 60)


# ---- a dead line ----


def dead_for(seconds: float, unit: FakeGve, port: Ends) -> None:
    """The next answer is lost, and so long all that is sent after it."""
    end = port.now + seconds
    unit.faults.append(lost)
    port.requests.append(lambda data: data)
    port.requests.extend([lambda data: b"" if port.now < end else data] * 100)


@pytest.mark.parametrize("seconds", [2.5, 3.5, 5.0])
@pytest.mark.parametrize("commands", [["C1,0,0,0"], ["C1,0,0,0", "C2,0,0,0"]])
def test_what_was_executed_before_a_line_was_dead_for_long_is_not_gone_on_with(
    link: Link, unit: FakeGve, port: Ends, seconds: float, commands: list[str]
) -> None:
    ask = link.send_packet if commands[1:] else lambda one: link.ask(one[0])
    dead_for(seconds, unit, port)

    with pytest.raises(NoAnswer):
        ask(commands)

    assert len(unit.taken) == len(commands)
    assert link.ask("P4").code == 0


def test_a_line_that_was_dead_for_a_moment_is_gone_on_with(
    link: Link, unit: FakeGve, port: Ends
) -> None:
    dead_for(0.9, unit, port)

    assert link.ask("C1,0,0,0").code == 0
    assert unit.taken == [(1, 0, 0, 0)]


# ---- halting ----


@pytest.mark.parametrize("sums_before", [False, True])
@pytest.mark.parametrize("rest", [b"", b"!0C10,2", b"!0*S\r!0C1,2\r", b"!0*S,FA\r!0C1"])
def test_a_halt_works_in_any_state_of_the_line(
    unit: FakeGve, port: Ends, sums_before: bool, rest: bytes
) -> None:
    unit.vector_s = 100.0
    unit.receiver.sums = sums_before
    unit.take(encoded("L1000,0,0,0", sums_before) + rest)

    bare(port).halt()

    assert unit.inta
    assert not unit.moves


@pytest.mark.parametrize("seed", range(40))
def test_a_halt_works_on_a_bad_line(seed: int) -> None:
    unit = FakeGve(vector_s=100.0)
    unit.take(b"!0L1000,0,0,0\r")
    port = VirtualPort(unit, probability=0.1, seed=seed)

    Link(Wire(port, BAUD, clock=port.clock)).halt()

    assert unit.inta


def test_a_halt_interrupts_a_reference_run(link: Link, unit: FakeGve) -> None:
    class Wish(Exception):
        pass

    unit.home_s = 1000.0

    def wish() -> None:
        raise Wish

    link.wire.look = lambda: None
    link.wire.port.write(encoded("WX-100,50,10,50", sums=True))
    link.pause(0.1)

    link.halt()

    assert unit.inta
    assert link.ask("P4").code == 0


def test_the_rest_of_a_late_answer_neither_confirms_a_halt_nor_holds_it_up(
    link: Link, unit: FakeGve, port: Ends
) -> None:
    for rest in (b"8\r", b"4\r"):
        link.ask("D")
        link.ask("L1000,0,0,0")
        sent = len(port.written)
        port.say(b"0,10,20,0,0,")
        port.say(rest, after_s=0.001)

        link.halt()

        assert [each for each in port.written[sent:] if b"H" in each] == [encoded("H", sums=True)]
        assert unit.inta
        assert not link.restarted


def test_a_long_ramp_is_waited_for_and_told(link: Link, unit: FakeGve, port: Ends) -> None:
    unit.vector_s, unit.brake_s = 100.0, 12.0
    link.ask("L1000,0,0,0")
    told = []

    link.halt(waits=lambda: told.append(port.now))

    assert len(told) == 1
    assert unit.inta


def test_a_halt_without_an_answer_is_not_confirmed(link: Link, unit: FakeGve) -> None:
    unit.mute = True

    with pytest.raises(NotConfirmed, match="H has no answer in 30 s"):
        link.halt()


def test_answers_before_a_halt_do_not_confirm_it(link: Link, unit: FakeGve, port: Ends) -> None:
    unit.mute = True
    port.say(answer_of("0"), 0.05)
    port.say(answer_of("0,17"), 0.1)
    port.say(b"8,65\r", 0.15)

    with pytest.raises(NotConfirmed):
        link.halt()
