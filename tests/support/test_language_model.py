"""The model of the language must see what is wrong: runs that were changed a little."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import replace

import pytest
from language_model import compare
from language_signals import MS, Difference, Unsure
from language_text import Command, Refused, listing, parse
from program_probe import Edge, Probe, Record, Request, Script

PROGRAM = (
    b"\x021\\ S100 V500 A9000 M3 F50 R U T1 L2 B7 R W20 T80 E O80 [ T2 ] W5 @1 I80H2 J1 @2 C80"
)
SCRIPT = Script(
    (
        Request(0, PROGRAM),
        Request(60 * MS, b"\x021V300"),
        Request(500 * MS, b"\x041"),
        Request(900 * MS, b"\x051"),
    ),
    (Edge(80 * MS, 3, 1),),
    1000 * MS,
    7,
)


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


def test_a_run_as_it_should_be_agrees(probe: Probe) -> None:
    record = probe.run(SCRIPT)
    assert len(record.pulses[1]) > 20
    compare(SCRIPT, record)


def _move_pulse(record: Record) -> None:
    record.pulses[1][9] += 2


def _lose_pulse(record: Record) -> None:
    del record.pulses[1][9]


def _lose_last_pulse(record: Record) -> None:
    del record.pulses[1][-1]


def _turn_pulse(record: Record) -> None:
    record.pulses[1][9] *= -1


def _miscount(record: Record) -> None:
    record.positions[0] += 1


def _lose_write(record: Record) -> None:
    record.events = [event for event in record.events if event.name != "out"]


def _delay_output(record: Record) -> None:
    late = [replace(e, tick=e.tick + MS) if e.name == "out" else e for e in record.events]
    record.events = late


def _delay_move(record: Record) -> None:
    late = [replace(e, tick=e.tick + 1) if e.name == "wait" else e for e in record.events]
    record.events = late


def _add_error(record: Record) -> None:
    record.events.append(replace(record.events[-1], name="error", value=1))


def _answer_otherwise(record: Record) -> None:
    record.answers[3] = record.answers[3].replace(b"M03", b"M3")


@pytest.mark.parametrize(
    "spoil",
    [
        _move_pulse, _lose_pulse, _lose_last_pulse, _turn_pulse, _miscount, _lose_write,
        _delay_output, _delay_move, _add_error, _answer_otherwise,
    ],
)  # fmt: skip
def test_a_run_that_was_changed_differs(probe: Probe, spoil: Callable[[Record], None]) -> None:
    record = deepcopy(probe.run(SCRIPT))
    spoil(record)
    with pytest.raises(Difference):
        compare(SCRIPT, record)


def test_two_things_at_one_time_are_unsure(probe: Probe) -> None:
    script = Script((Request(0, b"\x021W5 T1"), Request(5 * MS, b"\x021K")), (), 50 * MS)
    with pytest.raises(Unsure):
        compare(script, probe.run(script))


def test_a_text_is_read_and_listed() -> None:
    commands = parse(b"\\ M05{x}I81L010\tG-G+G007=-1`3")
    assert commands[1:3] == [Command("M", 5), Command("IL", 81, 10)]
    assert listing(commands) == b"\\M05I81L10G-G+G7=-1'3"


@pytest.mark.parametrize(
    ("text", "flag", "char"),
    [
        (b"S100 r", 2, b"r"),
        (b"F1{", 2, b"{"),
        (b"V", 1, b"V"),
        (b"V 5", 1, b"V"),
        (b"V16001", 1, b"V"),
        (b"L256", 1, b"L"),
        (b"C9", 1, b"C"),
        (b"G-5", 2, b"5"),
        (b"I05X1", 1, b"I"),
        (b"99", 2, b"9"),
        (b"F" + b"9" * 50, 1, b"F"),
    ],
)
def test_a_wrong_text_is_refused(text: bytes, flag: int, char: bytes) -> None:
    with pytest.raises(Refused) as refused:
        parse(text)
    assert (refused.value.flag, refused.value.char) == (flag, char[0])
