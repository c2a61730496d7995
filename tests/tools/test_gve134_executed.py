"""How many vectors of a job are executed, told from positions: never too many, in the end all."""

from __future__ import annotations

import random
from collections.abc import Sequence

import pytest
from fake_gve134 import FakeGve
from gve134_ports import VirtualPort
from hypothesis import given
from hypothesis import strategies as st
from rkm04_tools.bar import Bar
from rkm04_tools.gve134.client_send import Progress
from rkm04_tools.gve134.executed import Executed
from rkm04_tools.gve134.job import Command, Job, job_of
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.sending import Interrupted, Sender
from rkm04_tools.gve134.state import Positions
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.source import Source

HERE = (7, -3, 2**31 - 20, 0)
BAUD = 115_200


def commands(*texts: str) -> list[Command]:
    return [Command(line, text) for line, text in enumerate(texts, start=1)]


def chain(vectors: Sequence[tuple[int, ...]]) -> list[Command]:
    return commands(*(f"C{','.join(map(str, each))}" for each in vectors))


def told(place: list[int]) -> Positions:
    """As a unit tells it: modulo 2^32."""
    x, y, z, a = ((each + 2**31) % 2**32 - 2**31 for each in place)
    return x, y, z, a


def made(vector: tuple[int, ...], whole: int, part: int) -> list[int]:
    """The pulses of each axis when the longest has come to the place whole + part/100."""
    length = max(map(abs, vector))
    ways = (abs(d) * (100 * whole + part) // (100 * length) for d in vector)
    return [way if d >= 0 else -way for way, d in zip(ways, vector, strict=True)]


steps = st.integers(-9, 9)
vectors = st.lists(st.tuples(steps, steps, steps, steps), min_size=1, max_size=127)


@given(vectors, st.data())
def test_never_more_are_told_than_are_executed(
    path: list[tuple[int, ...]], data: st.DataObject
) -> None:
    executed = Executed(HERE)
    executed.taken(chain(path))
    place = list(HERE)
    for number, vector in enumerate(path):
        length = max(map(abs, vector))
        if length and data.draw(st.booleans()):
            at = data.draw(st.integers(0, length - 1))
            part = made(vector, at, data.draw(st.integers(0, 99)))
            now = [a + b for a, b in zip(place, part, strict=True)]
            before = executed.done
            count = executed.look(told(now))
            assert count is not None
            assert before is not None
            assert before <= count <= number
        place = [a + b for a, b in zip(place, vector, strict=True)]


@given(st.lists(st.tuples(st.integers(1, 9), steps, steps, steps), min_size=1, max_size=127))
def test_on_a_path_that_never_comes_back_the_number_is_right(path: list[tuple[int, ...]]) -> None:
    executed = Executed(HERE)
    executed.taken(chain(path))
    place = list(HERE)
    for number, vector in enumerate(path):
        middle = made(vector, max(map(abs, vector)) // 2, 50)
        between = [a + b for a, b in zip(place, middle, strict=True)]
        place = [a + b for a, b in zip(place, vector, strict=True)]
        if middle[0] and between != place:
            assert executed.look(told(between)) == number
        assert executed.look(told(place)) == number + 1


def test_what_the_queue_cannot_hold_is_executed() -> None:
    executed = Executed((0, 0, 0, 0))
    executed.taken(chain([(1, 0, 0, 0)] * 100 + [(0, 0, 0, 0)] * 20 + [(1, 0, 0, 0)] * 60))

    assert executed.done == 32


def test_before_an_l_and_an_n_all_is_executed() -> None:
    executed = Executed((0, 0, 0, 0))
    executed.taken(commands("C5,0,0,0", "C5,0,0,0", "L5,0,0,0"))
    assert executed.done == 2

    executed.taken(commands("NX-70", "C5,0,0,0"))
    assert executed.done == 3
    assert executed.look((-68, 0, 0, 0)) == 3
    assert executed.look((-65, 0, 0, 0)) == 4


def test_axes_that_go_back_are_on_the_next_vector() -> None:
    executed = Executed((0, 0, 0, 0))
    executed.taken(commands("C9,0,0,0", "C-9,0,0,0", "C9,0,0,0"))

    assert [executed.look((x, 0, 0, 0)) for x in (2, 6, 5, 1, 1, 4)] == [0, 0, 1, 1, 1, 2]


def test_the_pulses_of_a_coupled_axis_are_no_matter() -> None:
    executed = Executed((0, 0, 0, 0))
    executed.taken(commands("C5,0,0,0", "C5,0,0,0"))

    assert executed.look((7, 0, 0, 7)) == 1


@pytest.mark.parametrize("command", ["D", "K", "R", "J", "!7J", "WX5,10,5,10"])
def test_what_drops_vectors_or_changes_their_place_makes_the_number_unknown(command: str) -> None:
    executed = Executed((0, 0, 0, 0))
    executed.taken(commands("C5,0,0,0", command, "C5,0,0,0"))

    assert executed.look((5, 0, 0, 0)) is None


# ---- of a job ----


def job(text: str) -> Job:
    return job_of(Source("a.gve", text))


def sender(unit: FakeGve, text: str) -> Sender:
    port = VirtualPort(unit)
    return Sender(Unit(Link(Wire(port, BAUD, clock=port.clock))), job(text))


def test_at_the_end_of_a_job_all_is_executed() -> None:
    sending = sender(FakeGve(vector_s=0.01), "C1,2\nC0,0\nC-1,-2\n" * 100)
    sending.send()
    sending.finish()

    assert sending.look() == 300


def test_after_a_reference_run_the_vectors_are_followed() -> None:
    sending = sender(FakeGve(vector_s=0.01), "C10\nWX-5,10,5,10\nNX70\nC1\nC1\n")
    sending.send()
    sending.finish()

    assert sending.look() == 3


def test_an_interrupt_tells_how_many_vectors_were_executed_and_sent() -> None:
    rng = random.Random(5)
    unit = FakeGve(vector_s=0.01)
    sending = sender(unit, "\n".join(f"C{rng.randint(1, 9)},1" for _ in range(500)))
    over = []

    def interrupt(sent: int) -> None:
        if sent > 200 and not unit.inta:
            unit.interrupt(1)
            over.append(len(unit.taken) - len(unit.queue))

    sending.tell = interrupt
    with pytest.raises(Interrupted) as raised:
        sending.send()

    text = f"{over[0]} of 500 vectors were executed, {len(unit.taken)} were sent"
    assert text in str(raised.value)


@pytest.mark.parametrize("before", ["L1\nH", "L1"])
def test_of_a_unit_that_has_other_vectors_the_number_is_not_known(before: str) -> None:
    unit = FakeGve(vector_s=0.5)
    for line in before.splitlines():
        unit.take(f"!0{line}\r".encode())
    sending = sender(unit, "G\nC1\n" if "H" in before else "H\nG\nC1\n")
    sending.send()
    sending.finish()

    assert sending.look() is None
    assert sending.executed_text((0, 0, 0, 0)).startswith("it is not known how many of 1 vectors")


def test_progress_tells_executed_vectors_and_the_time_left(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    unit = FakeGve(vector_s=0.05)
    sending = sender(unit, "C1\n" * 600)
    port = sending.unit.link.wire.port
    assert isinstance(port, VirtualPort)
    with Bar("executing") as bar:
        sending.tell = Progress(bar, sending, port.clock).show
        sending.send()
        sending.finish()

    shown = capsys.readouterr().err.split("\r")
    left = [each for each in shown if " sent, 0:15 left" in each]
    assert any("] 30" in each or "] 29" in each for each in left)
