"""The host's end of the line: every command once, whatever gets lost; in virtual time."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from fake_gve134 import FakeGve, cut_off, damaged, lost
from gve134_ports import Ends, VirtualPort, answer_of
from rkm04_tools.gve134.answers import Answer, canonical, encoded, parsed
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.link_errors import (
    EndUnknown,
    GarbledAnswer,
    LineError,
    NoAnswer,
    OtherDevice,
    OutOfStep,
    Restarted,
)
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.line_errors import PortLost

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


# ---- bytes ----


@pytest.mark.parametrize(
    ("command", "sent"),
    [
        ("?", b"!0?,BC\r"), ("PF", b"!0PF,13\r"), ("h", b"!0H,C5\r"), ("SR6", b"!0SR6,58\r"),
        ("A100", b"!0A100,4F\r"), ("!7V300", b"!7V300,6D\r"), ("*S", b"!0*S,FA\r"),
        ("*E10", b"!0*E10,4D\r"), ("%-", b"!0%-,CF\r"),
    ],
)  # fmt: skip
def test_what_is_sent_has_the_sums_of_the_data_sheet(command: str, sent: bytes) -> None:
    assert encoded(command, sums=True) == sent


def test_without_sums_only_the_sum_is_missing() -> None:
    assert encoded("PF", sums=False) == b"!0PF\r"


@pytest.mark.parametrize(
    ("typed", "sent"),
    [
        ("c1", "C1,0,0,0"), ("L-5,6", "L-5,6,0,0"), ("C1,2,3,4", "C1,2,3,4"), ("L", "L"),
        ("C1,", "C1,"),
    ],
)  # fmt: skip
def test_vectors_have_all_four_numbers(typed: str, sent: str) -> None:
    assert canonical(typed) == sent


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("0,-1000,2000,50,F5", Answer(0, False, "-1000,2000,50")),
        ("8,64", Answer(0, True)), ("8,D0,04", Answer(0, True, "D0")), ("2,5E", Answer(2, False)),
        ("0,5D", None), ("0", None), ("", None), ("8,d0,04", None), ("G,73", None), ("0,,88", None),
    ],
)  # fmt: skip
def test_an_answer_is_one_if_its_sum_is_right(line: str, answer: Answer | None) -> None:
    assert parsed(line, sums=True) == answer


# ---- connecting ----


@pytest.mark.parametrize("sums_before", [False, True])
def test_sums_are_on_after_connecting_however_they_were(
    unit: FakeGve, port: Ends, sums_before: bool
) -> None:
    unit.receiver.sums = sums_before
    link = bare(port)

    assert link.ask("V1000") == Answer(0, False)

    assert unit.receiver.sums
    assert link.version == unit.name
    assert unit.done[-1] == "V1000"


@pytest.mark.parametrize("sums_before", [False, True])
def test_sums_are_off_if_they_are_not_wanted(unit: FakeGve, port: Ends, sums_before: bool) -> None:
    unit.receiver.sums = sums_before
    link = Link(Wire(port, BAUD, clock=port.clock), sums=False)

    assert link.ask("P").numbers == (0, 0)

    assert not unit.receiver.sums
    assert port.written[-1] == b"!0P\r"


@pytest.mark.parametrize("rest", [b"!0C10,2", b"!0*S\r!0C1,2\r", b"!0*S,FA\r!0C1", b"\xff!0", b"!"])
@pytest.mark.parametrize("sums_before", [False, True])
def test_what_another_program_has_left_half_sent_is_overcome(
    unit: FakeGve, port: Ends, rest: bytes, sums_before: bool
) -> None:
    unit.receiver.sums = sums_before
    unit.take(rest)

    assert bare(port).ask("P4").numbers == (0, 0, 0, 0)
    assert unit.taken == []


@pytest.mark.parametrize(
    ("before", "after"), [(b"8,6", b"4\r"), (b"0,5", b"C\r"), (b"", b"4\r"), (b"8,64", b"\r")]
)
def test_the_rest_of_a_late_answer_is_no_restart(
    link: Link, unit: FakeGve, port: Ends, before: bytes, after: bytes
) -> None:
    port.say(before)
    port.say(after, after_s=0.001)

    link.connect()

    assert not link.restarted
    assert unit.receiver.sums
    assert link.ask("P4").numbers == (0, 0, 0, 0)


def test_an_answer_counts_that_comes_after_one_that_was_cut_off(link: Link, port: Ends) -> None:
    port.say(b"0,1,2")
    sent = len(port.written)

    assert link.ask("P4").numbers == (0, 0, 0, 0)
    assert len(port.written) == sent + 1


def test_a_restart_is_noticed_when_connecting_again(link: Link, unit: FakeGve) -> None:
    unit.restart()

    link.connect()

    assert link.restarted
    assert unit.receiver.sums


def test_a_silent_port_is_noanswer_of(unit: FakeGve, port: Ends) -> None:
    unit.mute = True

    with pytest.raises(NoAnswer, match="does not answer; check power") as raised:
        bare(port).connect()
    assert raised.value.status == 3
    assert {each[:2] for each in unit.done} <= {"%+", "?"}


def test_a_port_that_only_sends_back_says_so(unit: FakeGve, port: Ends) -> None:
    unit.mute = True
    port.before = port.say

    with pytest.raises(NoAnswer, match="only what is sent comes back"):
        bare(port).connect()


@pytest.mark.parametrize(
    "garbage", [b"error: 20\r\n", b"\x7e\x01\x02\x7e" * 9, b"\xff" * 40, b"\r\r0\r"]
)
def test_a_port_that_answers_garbage_says_so(unit: FakeGve, port: Ends, garbage: bytes) -> None:
    unit.mute = True
    port.before = lambda data: port.say(garbage, 0.01)

    with pytest.raises(GarbledAnswer, match="damaged or not from a GVE134; check the rate"):
        bare(port).connect()


def test_another_device_of_this_line_is_named(unit: FakeGve, port: Ends) -> None:
    unit.name = "LATHE/7 v2"

    with pytest.raises(OtherDevice, match="another device answers, LATHE/7 v2"):
        bare(port).connect()


def test_answers_to_a_program_before_are_not_taken_for_ours(unit: FakeGve, port: Ends) -> None:
    unit.receiver.sums = True
    link = bare(port)
    port.say(b"8,64\r", 0.02)

    assert link.ask("P4").numbers == (0, 0, 0, 0)
    assert link.ask("V50") == Answer(0, False)


# ---- what gets lost ----

FAULTS = [lost, damaged, cut_off, lambda data: b"", lambda data: b"\x00\xff" + data]


@pytest.mark.parametrize("fault", [lost, damaged, cut_off, lambda data: data[:3]])
@pytest.mark.parametrize("command", ["C1,2,3,4", "V50", "NX5", "XU", "P4"])
def test_a_command_whose_answer_comes_to_harm_is_executed_once(
    link: Link, unit: FakeGve, fault: Callable[[bytes], bytes], command: str
) -> None:
    unit.faults.append(fault)

    answer = link.ask(command)

    assert answer.code == 0
    assert unit.done.count(command) == 1
    assert link.repairs == 1


@pytest.mark.parametrize(
    "fault", [lost, damaged, cut_off, lambda data: data[:-1], lambda data: data[1:]]
)
@pytest.mark.parametrize("command", ["C1,2,3,4", "V50", "NX5", "XU", "P4"])
def test_a_command_that_comes_to_harm_is_sent_again(
    link: Link, unit: FakeGve, port: Ends, fault: Callable[[bytes], bytes], command: str
) -> None:
    port.requests.append(fault)

    assert link.ask(command).code == 0

    assert unit.done.count(command) == 1
    assert sum(encoded(command, sums=True) == data for data in port.written) == 2


@pytest.mark.parametrize("at", range(0, 57, 3))
def test_a_packet_that_is_harmed_anywhere_is_taken_once(
    link: Link, unit: FakeGve, port: Ends, at: int
) -> None:
    port.requests.append(lambda data: data[:at] + bytes([data[at] ^ 4]) + data[at + 1 :])

    answer = link.send_packet(["C1,2,3,4", "B500", "C5,6,7,8"])

    assert (answer.code, answer.numbers) == (0, (3,))
    assert unit.taken == [(1, 2, 3, 4), (5, 6, 7, 8)]


@pytest.mark.parametrize("at", range(0, 60, 7))
def test_a_packet_that_is_cut_off_is_taken_once(
    link: Link, unit: FakeGve, port: Ends, at: int
) -> None:
    port.requests.append(lambda data: data[:at])

    assert link.send_packet(["C1,2,3,4", "B500", "C5,6,7,8"]).numbers == (3,)
    assert unit.taken == [(1, 2, 3, 4), (5, 6, 7, 8)]


def test_a_refusal_that_got_lost_is_told_and_nothing_is_sent_again(
    link: Link, unit: FakeGve
) -> None:
    unit.vector_s = 100.0
    assert link.ask("L1,0,0,0").code == 0
    unit.faults.append(lost)

    assert link.ask("L2,0,0,0").code == 1
    assert unit.done.count("L2,0,0,0") == 1


def test_a_late_answer_is_not_taken_for_the_next_one(link: Link, unit: FakeGve, port: Ends) -> None:
    unit.faults.append(lost)
    sent = iter([True])

    def delay(data: bytes) -> None:
        if data.startswith(b"!0*S") and next(sent, False):
            port.say(answer_of("0,2"), 1.4)

    port.before = delay
    assert link.send_packet(["C1,0,0,0", "C2,0,0,0"]).numbers == (2,)
    port.before = lambda data: None

    assert unit.taken == [(1, 0, 0, 0), (2, 0, 0, 0)]
    assert link.ask("V50").code == 0
    assert link.ask("C3,0,0,0").code == 0
    assert len(unit.taken) == 3


def test_a_line_that_dies_is_an_error_and_the_port_is_given_up(unit: FakeGve, port: Ends) -> None:
    with bare(port) as link:
        link.connect()
    assert not port.abandoned
    unit.mute = True

    with pytest.raises(NoAnswer), bare(port) as link:
        link.ask("V50")

    assert port.abandoned


def test_nothing_that_was_asked_for_on_a_dead_line_is_sent_when_it_lives_again(
    link: Link, unit: FakeGve, port: Ends
) -> None:
    alive, port.before = port.requests, lambda data: port.requests.append(lost)
    with pytest.raises(NoAnswer):
        link.ask("L1000,0,0,0")
    port.before = lambda data: None
    alive.clear()

    assert link.ask("P4").code == 0
    assert unit.taken == []


def test_a_late_answer_that_looks_like_the_index_is_not_taken_for_it(
    link: Link, unit: FakeGve, port: Ends
) -> None:
    """The answer to the packet comes in front of that to the first @, and tells the number that
    says that nothing was executed."""
    unit.faults.append(lost)
    vectors = [f"C{number},0,0,0" for number in range(1, unit.index + 1)]
    asked = iter([True])

    def delay(data: bytes) -> None:
        if data.startswith(b"!0@") and next(asked, False):
            port.say(answer_of(f"0,{len(vectors)}"), 0.0)

    port.before = delay
    assert link.send_packet(vectors).numbers == (len(vectors),)
    assert len(vectors) > 1
    assert len(unit.taken) == len(vectors)


def test_commands_of_somebody_else_are_noticed(link: Link, unit: FakeGve) -> None:
    unit.index = 77
    unit.faults.append(lost)

    with pytest.raises(OutOfStep, match="commands that were not sent from here"):
        link.ask("C1,0,0,0")
    assert unit.taken == [(1, 0, 0, 0)]


@pytest.mark.parametrize("cut", ["!0*S,FA\r", "!0*S,FA\r!0C1,0,0,0,05\r"])
@pytest.mark.parametrize("heard", [9, 2, 0])
def test_what_has_become_single_vectors_as_a_packet_lost_its_begin_is_not_sent_again(
    link: Link, unit: FakeGve, port: Ends, cut: str, heard: int
) -> None:
    port.requests.append(lambda data: data.removeprefix(cut.encode()))
    unit.faults += [bytes] * heard + [lost] * 4

    with pytest.raises(OutOfStep, match="may have been executed"):
        link.send_packet(["C1,0,0,0", "C2,0,0,0", "C3,0,0,0"])
    assert unit.taken == [(n, 0, 0, 0) for n in (1, 2, 3)][cut.count("C") :]


def test_an_answer_that_is_overwritten_by_damage_is_told_as_not_known(
    link: Link, unit: FakeGve, port: Ends
) -> None:
    unit.faults.append(lost)
    port.requests += [bytes, damaged]

    with pytest.raises(EndUnknown, match="has executed C1,0,0,0 or refused it"):
        link.ask("C1,0,0,0")
    assert unit.taken == [(1, 0, 0, 0)]


def test_a_port_that_is_lost_is_that_error(link: Link, port: Ends) -> None:
    def lose(data: bytes) -> None:
        raise PortLost("gone")

    port.before = lose
    with pytest.raises(PortLost):
        link.ask("P4")


# ---- a unit that restarts ----


def test_a_restart_between_two_commands_is_told_and_the_second_is_not_executed(
    link: Link, unit: FakeGve
) -> None:
    link.ask("L1,0,0,0")
    unit.restart()

    with pytest.raises(Restarted, match=r"HAS RESTARTED.*not executed, and") as raised:
        link.ask("C2,0,0,0")

    assert not raised.value.executed
    assert unit.taken == [(1, 0, 0, 0)]
    assert link.ask("P4").code == 0


def test_a_restart_while_a_command_is_under_way_is_told(link: Link, unit: FakeGve) -> None:
    unit.restart_after = 0

    with pytest.raises(Restarted, match="executed before that or not at all"):
        link.ask("C2,0,0,0")
    assert unit.taken == []


def test_a_restart_in_the_middle_of_a_packet_is_told(link: Link, unit: FakeGve) -> None:
    for _ in range(100):  # so that its index goes back
        link.ask("P")
    unit.restart_after = 2

    with pytest.raises(Restarted):
        link.send_packet(["C1,0,0,0", "C2,0,0,0", "C3,0,0,0"])
    assert unit.taken == []


def test_what_is_asked_for_after_a_silence_is_not_for_a_unit_that_has_restarted(
    link: Link, unit: FakeGve
) -> None:
    unit.mute = True
    with pytest.raises(NoAnswer):
        link.ask("V50")
    unit.mute = False
    unit.restart()

    with pytest.raises(Restarted):
        link.ask("G")
    assert "G" not in unit.done


def test_a_damaged_answer_that_looks_like_a_restart_is_none(link: Link, unit: FakeGve) -> None:
    unit.faults.append(lambda answer: b"4\r")

    assert link.ask("C1,0,0,0") == Answer(0, False)
    assert unit.taken == [(1, 0, 0, 0)]


def test_a_reset_that_was_asked_for_is_no_surprise(link: Link, unit: FakeGve) -> None:
    assert link.reset().code == 0

    assert link.ask("P4").code == 0
    assert unit.receiver.sums


# ---- everything at once ----


@pytest.mark.parametrize("seed", range(200))
def test_on_a_bad_line_vectors_arrive_once_and_in_order_or_not_at_all(seed: int) -> None:
    """Seeds differ in how bad the line is; where it is given up nothing came twice or after it."""
    rng = random.Random(seed)
    unit = FakeGve(vector_s=0.003)
    port = VirtualPort(unit, probability=rng.choice([0.01, 0.03, 0.06]), seed=seed)
    link = Link(Wire(port, BAUD, clock=port.clock))
    wanted: list[tuple[int, ...]] = []
    under_way: list[tuple[int, ...]] = []
    try:
        while len(wanted) < 150:
            first = len(wanted)
            count = rng.choice([1, 1, 2, 5, 30])
            under_way = [(first + n, -n, 0, 1) for n in range(count)]
            commands = [f"C{','.join(map(str, each))}" for each in under_way]
            answer = link.ask(commands[0]) if count == 1 else link.send_packet(commands)
            if answer.code == 1:
                link.pause(0.01)
                continue
            assert answer.code == 0
            wanted += under_way
            under_way = []
    except LineError:
        assert unit.taken in (wanted, wanted + under_way)
    else:
        assert unit.taken == wanted


def test_on_a_line_with_few_faults_hardly_any_job_is_given_up() -> None:
    given_up = 0
    for seed in range(100):
        unit = FakeGve(vector_s=0.003)
        port = VirtualPort(unit, probability=0.01, seed=seed)
        link = Link(Wire(port, BAUD, clock=port.clock))
        try:
            for number in range(100):
                while link.ask(f"C{number},0,0,0").code == 1:
                    link.pause(0.01)
        except LineError:
            given_up += 1
    assert given_up <= 3
