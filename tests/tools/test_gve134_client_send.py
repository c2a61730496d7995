"""A vector file on its way: in order, once, with room, and what stops it; in virtual time."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from fake_gve134 import FakeGve
from gve134_ports import VirtualPort
from rkm04_tools.failure import Failure
from rkm04_tools.gve134.answers import encoded
from rkm04_tools.gve134.job import Job, job_of
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.link_errors import LineError, Refused, Restarted
from rkm04_tools.gve134.sending import (
    PACKET_COMMANDS_FIRST,
    PACKET_COMMANDS_MAX,
    PACKET_SECONDS,
    Interrupted,
    Sender,
)
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.source import Source

BAUD = 115_200


def job(text: str) -> Job:
    return job_of(Source("a.gve", text))


def sender(unit: FakeGve, text: str, **options: float) -> Sender:
    port = VirtualPort(unit, **options)  # type: ignore[arg-type]
    return Sender(Unit(Link(Wire(port, BAUD, clock=port.clock))), job(text))


def send(unit: FakeGve, text: str) -> Sender:
    sending = sender(unit, text)
    sending.send()
    return sending


def orders(unit: FakeGve) -> list[str]:
    """What a unit has executed of a file."""
    own = ("%+", "?", "@", ">", "SR", "F", "PL", "P4", "*")
    return [each for each in unit.done if not each.startswith(own)]


def chain(count: int) -> str:
    return "".join(f"C{number},-1\n" for number in range(count))


def vectors(count: int) -> list[tuple[int, ...]]:
    return [(number, -1, 0, 0) for number in range(count)]


def port_of(sending: Sender) -> VirtualPort:
    port = sending.unit.link.wire.port
    assert isinstance(port, VirtualPort)
    return port


# ---- order and room ----


def test_a_file_arrives_in_its_order() -> None:
    unit = FakeGve()

    send(unit, "V500 ; slow\nl1,2\nC3\nB600\n  !0C4,0,0,9\r\n!7V300\nVK\nC5\n\n;end\nC6")

    assert orders(unit) == [
        "V500", "L1,2,0,0", "C3,0,0,0", "B600", "C4,0,0,9", "!7V300", "VK", "C5,0,0,0", "C6,0,0,0",
    ]  # fmt: skip
    assert [parts[0] for parts in unit.taken] == [1, 3, 4, 5, 6]


def test_runs_of_vectors_go_in_packets() -> None:
    unit = FakeGve(vector_s=1e-6)

    sending = send(unit, chain(1000))

    assert unit.taken == vectors(1000)
    assert sending.packets < 1000 / PACKET_COMMANDS_FIRST


def test_a_packet_is_not_longer_on_the_line_than_a_halt_may_wait() -> None:
    unit = FakeGve(vector_s=1e-6)

    sending = send(unit, "C-2147483647,-2147483647,-2147483647,-2147483647\n" * 200)

    assert len(unit.taken) == 200
    assert max(map(len, port_of(sending).written)) * 10 / BAUD < PACKET_SECONDS + 0.01


def test_a_single_vector_is_no_packet() -> None:
    unit = FakeGve()

    assert send(unit, "C1\nV500\nC2\n").packets == 0
    assert len(unit.taken) == 2


@pytest.mark.parametrize("vector_s", [0.0005, 0.005, 0.05])
def test_a_full_queue_is_waited_for_and_never_runs_dry(vector_s: float) -> None:
    unit = FakeGve(vector_s=vector_s)
    sending = sender(unit, chain(500))
    least = []

    def look(sent: int) -> None:
        if 128 < sent < 500:
            least.append(len(unit.queue))

    sending.tell = look
    sending.send()

    assert unit.taken == vectors(500)
    if vector_s > 0.002:  # else the line is slower than the vectors
        assert min(least) > 32


def test_what_waits_for_the_axes_is_sent_when_they_stand() -> None:
    unit = FakeGve(vector_s=0.1)

    send(unit, "L1\nL2\nNX0\nL3\nEW10,5\n")

    assert orders(unit)[-1] == "EW10,5"
    assert [parts[0] for parts in unit.taken] == [1, 2, 3]
    assert unit.memory[0x10] == 5


def test_after_keeping_the_queue_a_chain_is_an_error_and_not_waited_for() -> None:
    with pytest.raises(Failure, match=r"a.gve:2: C1,0,0,0: no room, though nothing moves: after K"):
        send(FakeGve(), "K\nC1\n")


def test_packets_of_the_file_stay_as_they_are() -> None:
    unit = FakeGve()

    sending = send(unit, "*S\nC1\nB500\nC2\n*E3\nC3\n*S\n*E0\n")

    assert sending.packets == 2
    assert [each for each in unit.done if each.startswith("*")] == ["*S", "*E3", "*S", "*E0"]
    assert [parts[0] for parts in unit.taken] == [1, 2, 3]


def test_a_halt_in_a_packet_of_the_file_ends_it_as_on_the_unit() -> None:
    unit = FakeGve()

    sending = send(unit, "*S\nC1\nH\nD\nC5\n")

    assert [parts[0] for parts in unit.taken] == [5]
    assert sending.lines == 3


def test_what_the_line_does_itself_is_left_out() -> None:
    unit = FakeGve()

    sending = send(unit, "%+\nV500\n@\n>\n%-\n")

    assert orders(unit) == ["V500"]
    assert sending.job.left_out == ("%+", "@", ">", "%-")
    assert unit.receiver.sums


@pytest.mark.parametrize("text", ["V500\n@250.5 H\n", "V500\n;@nothing\n"])
def test_what_only_others_can_do_is_an_error_before_anything_is_sent(text: str) -> None:
    with pytest.raises(Failure, match=r"a.gve:2: .*nothing was sent") as raised:
        job(text)
    assert raised.value.status == 1


def test_the_example_of_the_data_sheet_goes_through() -> None:
    unit = FakeGve(vector_s=0.5)

    send(unit, "L50\nC60\nH\nK\nL0,0,-1000\nL0,0,1000\nR\nV500\nXA\nG\n")

    assert orders(unit)[-4:] == ["R", "V500", "XA", "G"]
    assert not unit.inta


def test_a_reset_in_the_file_is_gone_along_with() -> None:
    unit = FakeGve()

    send(unit, "V500\nJ\nC1\nC2\n")

    assert [parts[0] for parts in unit.taken] == [1, 2]
    assert unit.receiver.sums


# ---- what stops it ----


@pytest.mark.parametrize(
    ("st4", "st5", "names"), [(1, 0, "RefX"), (0, 0x80, "sensor plate"), (8, 0x40, "RefA, sensor")]
)
def test_an_interrupt_ends_the_job_and_is_told_with_its_cause(
    st4: int, st5: int, names: str
) -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, chain(500))
    sending.tell = lambda sent: unit.interrupt(st4, st5) if sent > 200 and not unit.inta else None

    with pytest.raises(Interrupted, match=f"INTERRUPTED by {names}") as raised:
        sending.send()

    assert raised.value.status == 1
    assert "positions at that moment" in str(raised.value)
    assert "the rest of the vectors waits" in str(raised.value)
    assert unit.taken == vectors(len(unit.taken))


def test_a_halt_by_another_one_is_told_without_positions_of_an_interrupt() -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, chain(500))
    sending.tell = lambda sent: unit.take(encoded("H", sums=True)) if sent > 200 else None

    with pytest.raises(Interrupted, match="INTERRUPTED by H; the axes stand at"):
        sending.send()


def test_an_interrupt_after_the_last_command_is_told() -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, chain(50))
    sending.send()
    unit.interrupt(2)

    with pytest.raises(Interrupted, match=r"a.gve: INTERRUPTED by RefY"):
        sending.finish()


def test_a_job_is_over_when_the_axes_stand() -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, chain(50))
    sending.send()

    assert not sending.finish().has(0xC0)
    assert unit.positions == [sum(range(50)), -50, 0, 0]


def test_nothing_is_added_to_what_was_interrupted() -> None:
    unit = FakeGve()
    unit.inta = True

    with pytest.raises(Failure, match=r"the unit is stopped, nothing waits.*nothing was sent"):
        send(unit, "V500\nC1\n")
    assert orders(unit) == []


@pytest.mark.parametrize("text", ["C1\n", "V500\nL1\n", "D\nC1\n", "NX0\n", "G\n"])
def test_nothing_joins_the_vectors_that_a_unit_still_makes(text: str) -> None:
    unit = FakeGve(vector_s=100.0)
    unit.take(b"!0C7\r!0C8\r")
    before = list(unit.taken)

    with pytest.raises(
        Failure, match=r"the unit is moving; nothing was sent; .*gve134 halt"
    ) as end:
        send(unit, text)

    assert end.value.status == 1
    assert unit.taken == before
    assert orders(unit) == ["C7", "C8"]


@pytest.mark.parametrize("first", ["H", "J"])
def test_a_file_that_begins_with_the_end_of_a_motion_is_for_a_unit_that_moves(first: str) -> None:
    unit = FakeGve(vector_s=100.0)
    unit.take(b"!0C7\r!0C8\r")

    send(unit, f"{first}\nV500\n")

    assert orders(unit) == ["C7", "C8", first, "V500"]


@pytest.mark.parametrize("first", ["D", "G", "J", "H"])
def test_a_file_may_begin_with_what_ends_an_interrupt(first: str) -> None:
    unit = FakeGve(vector_s=1.0)
    unit.take(b"!0L1\r!0H\r")

    send(unit, f"{first}\nV500\n")

    assert orders(unit)[-1] == "V500"


def test_going_on_with_nothing_is_refused() -> None:
    with pytest.raises(Refused, match="nothing to go on with"):
        send(FakeGve(), "G\nV500\n")


def test_a_refusal_ends_the_job_and_names_the_line() -> None:
    unit = FakeGve(codes={"C7,0,0,9": 5})

    with pytest.raises(Refused, match=r"a.gve:3: C7,0,0,9: refused: a parameter is out of bounds"):
        send(unit, "V500\n\nC7,0,0,9\nV600\n")
    assert orders(unit) == ["V500", "C7,0,0,9"]


def test_a_unit_that_restarts_ends_the_job() -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, chain(500))
    sending.tell = lambda sent: unit.restart() if sent > 200 else None

    with pytest.raises(Restarted, match="nothing was sent after it"):
        sending.send()
    assert unit.queue == type(unit.queue)()
    assert len(unit.taken) < 300


def test_a_unit_that_restarts_at_an_h_of_the_file_ends_the_job() -> None:
    unit = FakeGve(restarts_at="H")

    with pytest.raises(Restarted, match="nothing was sent after it"):
        send(unit, "C5\nH\nD\nC7\n")
    assert unit.taken == [(5, 0, 0, 0)]


@pytest.mark.parametrize("by_fault", [False, True])
def test_a_unit_that_restarts_when_all_is_sent_is_told(by_fault: bool) -> None:
    unit = FakeGve(vector_s=1.0)
    sending = sender(unit, chain(50))
    sending.send()
    unit.restart(by_fault)

    with pytest.raises(Restarted, match=r"HAS RESTARTED: .* nothing was sent after it"):
        sending.finish()
    assert len(unit.taken) == 50
    assert not unit.queue


def test_a_unit_without_motion_after_a_fault_is_told() -> None:
    unit = FakeGve()
    unit.restart(by_fault=True)

    with pytest.raises(Failure, match="restarted by its watchdog or a fault"):
        send(unit, "C1\n")


# ---- what is asked of the host ----


def test_a_wait_of_the_file_is_made() -> None:
    unit = FakeGve()

    sending = send(unit, "V500\n;@wait 2.5\nV600\n")

    assert port_of(sending).now > 2.5
    assert orders(unit) == ["V500", "V600"]


def test_a_person_is_asked_when_the_axes_stand() -> None:
    unit = FakeGve(vector_s=0.5)
    sending = sender(unit, "C1\nC2\n;@pause put in tool 2\nC3\n")
    asked = []
    sending.ask_person = lambda text: asked.append((text, unit.run, len(unit.taken)))

    sending.send()

    assert asked == [("put in tool 2", False, 2)]
    assert len(unit.taken) == 3


def test_a_probe_goes_back_to_where_it_was_touched() -> None:
    unit = FakeGve(vector_s=0.5)
    unit.positions = [7, 0, 20, 0]
    sending = sender(unit, "SW1,80\nL0,0,-500\n;@probe\nC1\n")

    def touch(sent: int) -> None:
        if sent == 1 and unit.run and not unit.inta:
            unit.positions = [7, 0, -30, 0]
            unit.interrupt(0, 0x80)
            unit.positions = [7, 0, -34, 0]

    sending.tell = touch
    sending.send()

    assert unit.taken == [(0, 0, -500, 0), (0, 0, 4, 0), (1, 0, 0, 0)]
    assert orders(unit) == ["SW1,80", "L0,0,-500,0", "SW1,00", "D", "L0,0,4,0", "C1,0,0,0"]


def test_a_probe_goes_back_without_an_axis_that_only_went_along() -> None:
    """A coupled A shows the positions of its axis, and takes no part of a vector."""
    unit = FakeGve(vector_s=0.5)
    sending = sender(unit, "SW1,80\nL0,0,-500\n;@probe\n")

    def touch(sent: int) -> None:
        if sent == 1 and unit.run and not unit.inta:
            unit.positions = [0, 0, -30, -30]
            unit.interrupt(0, 0x80)
            unit.positions = [0, 0, -34, -34]

    sending.tell = touch
    sending.send()

    assert unit.taken == [(0, 0, -500, 0), (0, 0, 4, 0)]


def test_a_probe_that_touches_nothing_ends_the_job() -> None:
    unit = FakeGve(vector_s=0.5)

    with pytest.raises(Failure, match=r"a.gve:2: ;@probe: nothing was touched"):
        send(unit, "L0,0,-500\n;@probe\nC1\n")
    assert len(unit.taken) == 1
    assert orders(unit)[-1] == "SW1,00"


def probing(touch: Callable[[FakeGve], None]) -> tuple[FakeGve, Sender]:
    """A probe during which this happens once."""
    unit = FakeGve(vector_s=0.5)
    sending = sender(unit, "SW1,80\nL0,0,-500\n;@probe\nC1\n")
    sending.tell = lambda sent: touch(unit) if sent == 1 and unit.run and not unit.inta else None
    return unit, sending


def test_a_sensor_that_is_touched_before_the_probe_moves_is_no_touch() -> None:
    unit, sending = probing(lambda unit: unit.interrupt(0, 0x80))

    with pytest.raises(Failure, match="touched before the axes moved, so nothing was probed"):
        sending.send()

    assert unit.taken == [(0, 0, -500, 0)]
    assert "D" not in unit.done


def test_a_reference_switch_that_stops_a_probe_is_no_touch() -> None:
    def hit(unit: FakeGve) -> None:
        unit.positions = [0, 0, -30, 0]
        unit.interrupt(4)

    unit, sending = probing(hit)

    with pytest.raises(Interrupted, match=r"a.gve:3: ;@probe: INTERRUPTED by RefZ"):
        sending.send()

    assert unit.taken == [(0, 0, -500, 0)]
    assert "D" not in unit.done


def test_a_reference_run_without_a_switch_is_told_as_that() -> None:
    unit = FakeGve(home_answer=5)

    with pytest.raises(Failure, match="WX1,10,1,10: its switch was not found") as raised:
        send(unit, "WX1,10,1,10\nC1\n")

    assert "the axes stand at X 0" in str(raised.value)
    assert "INTERRUPTED" not in str(raised.value)


def test_where_no_cause_is_known_no_position_of_it_is_told() -> None:
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, chain(5))
    sending.send()
    unit.interrupt()

    with pytest.raises(Interrupted) as raised:
        sending.finish()

    assert "INTERRUPTED by what the unit does not tell; the axes stand" in str(raised.value)


# ---- a bad line ----


@pytest.mark.parametrize("seed", range(200))
def test_on_a_bad_line_a_job_arrives_once_and_in_order_or_is_given_up(seed: int) -> None:
    rng = random.Random(seed)
    unit = FakeGve(vector_s=rng.choice([0.001, 0.01]))
    lines, wanted = [], []
    for number in range(rng.choice([40, 200])):
        letter = rng.choice("CCCCCCCCCCCCLBV")
        lines.append(f"{letter}{number}" if letter in "LC" else f"{letter}{number + 10}")
        wanted += [(number, 0, 0, 0)] if letter in "LC" else []
    sending = sender(unit, "\n".join(lines), probability=rng.choice([0.01, 0.04]), seed=seed)

    try:
        sending.send()
    except LineError:
        assert unit.taken == wanted[: len(unit.taken)]
        assert 0 <= len(unit.taken) - sending.sent <= PACKET_COMMANDS_MAX
    else:
        assert unit.taken == wanted
        sent = [canonical for canonical in orders(unit) if canonical[0] in "BV"]
        assert [each for each in lines if each[0] == "V"] == [e for e in sent if e[0] == "V"]
