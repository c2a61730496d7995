"""speed: who gets V, and whether the move has it then."""

from __future__ import annotations

import time

import pytest
from client_acts import GOES, NODE, PROGRAMS, acts, lines
from fake_unit import MOVING, RUNNING, STOPPED, WAITING, FakeUnit
from rkm04_tools import acting, speeding
from rkm04_tools.messages import BreakPoint


@pytest.fixture
def unit():
    return FakeUnit(NODE, programs=dict(PROGRAMS))


@pytest.fixture
def fake(fake, monkeypatch):
    """The same line, beside a tool that has less patience."""
    monkeypatch.setattr(acting, "LOOK_SECONDS", 0.1)
    monkeypatch.setattr(acting, "POLL_SECONDS", 0.01)
    return fake


def test_speed_goes_to_those_motors_that_move(tool, fake, unit):
    unit.states[:] = [GOES, RUNNING | WAITING, STOPPED | MOVING, GOES]
    unit.waits[1] = 1

    result = tool("speed", "500", "--motor", "0")

    assert acts(unit) == [(1, b"V500"), (4, b"V500")]
    assert result.status == 0
    assert lines(result) == [
        "motor 1 speed 500 steps/s",
        "motor 2 stands, waiting for input 1 to become 0: nothing was sent",
        "motor 3 brakes: nothing was sent",
        "motor 4 speed 500 steps/s",
    ]


def test_no_speed_goes_to_a_unit_that_has_restarted_since_it_was_looked_at(tool, fake, unit):
    unit.states[:] = [GOES] * 4

    def restart(answer: bytes) -> bytes:
        if unit.done[-1:] == [b"\xc8"] and unit.done.count(b"\xc8") == 1:
            unit.restart()
        return answer

    fake.faults += [restart] * 1000

    result = tool("speed", "500", "--motor", "0")

    assert result.status == 3
    assert "has restarted" in result.complaint
    assert acts(unit) == []


def test_speed_at_rest_sends_nothing_and_says_so(tool, fake, unit):
    result = tool("speed", "6000")

    assert result.status == 1
    assert lines(result) == ["motor 1 stands: nothing was sent"]
    assert acts(unit) == []


CHANGES = [
    # what V does to the fake unit, what is told of V700
    ({"programs": b"@1F50RW100J1V700"},
     "may not have moved when V700 came: it is the last command in its memory, and was stored "
     "there if the program did not end so before"),
    ({"states": 0}, "has come to a stand meanwhile; V700 was not stored"),
    ({"tables": b"  1;[(1;100)]"},
     "V700 has changed nothing of its move: a limit run, or one that brakes, takes none, or it has "
     "begun since"),
    ({"tables": b"  4;[(1;100),(40;300),(90;600),(200;0)]"},
     "does not come to 700 steps/s: the way is too short, or another move has begun since; rkm04 "
     "table tells its speeds"),
]  # fmt: skip


@pytest.mark.parametrize(("made", "words"), CHANGES)
def test_speed_tells_a_change_that_was_not_made(tool, fake, unit, monkeypatch, made, words):
    unit.states[0] = GOES
    unit.tables[1] = b"  1;[(1;100)]"

    def execute(unit: FakeUnit, message: bytes) -> bytes:
        answer = original(unit, message)
        if message == b"\x021V700":
            unit.tables[1] = b"  1;[(1;100)]"
            unit.programs[1] = made.get("programs", unit.programs[1])
            unit.tables[1] = made.get("tables", unit.tables[1])
            unit.states[0] = made.get("states", GOES)
        return answer

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)

    result = tool("speed", "700")

    assert (result.status, lines(result)) == (1, [f"motor 1 {words}"])


TABLES = [
    # before V, after it, the speed, whether the move has got it
    ([(1, 100), (495, 1000)], [(1, 100), (2562, 1000), (3017, 300)], 300, True),
    ([(1, 100), (495, 1000)], [(1, 100), (2571, 1000)], 1000, True),
    ([(1, 100), (495, 1000)], [(1, 100), (1970, 1000), (2465, 100)], 50, True),
    ([(1, 500), (10000, 0)], [(1, 500), (989, 500), (10000, 0)], 50, True),
    ([(1, 500), (10000, 0)], [(1, 500), (1223, 500), (10000, 0)], 600, True),
    ([(1, 100)], [(1, 100)], 100, True),
    ([(1, 100)], [(1, 100)], 500, False),
    # Braking, from the speed that is asked for.
    ([(1, 100), (900, 8000), (32895, 0)], [(1, 100), (900, 8000), (32895, 0)], 8000, False),
    ([(1, 100), (495, 1000), (3505, 1000), (4000, 0)], [(1, 100), (3700, 700), (4000, 0)], 900,
     False),
    ([(1, 100), (495, 1000), (3505, 1000), (4000, 0)],
     [(1, 100), (1113, 1000), (2309, 1842), (4000, 0)], 16000, False),
]  # fmt: skip


@pytest.mark.parametrize(("before", "after", "speed", "has"), TABLES)
def test_the_table_of_a_move_tells_whether_it_has_a_speed(before, after, speed, has):
    old, new = ([BreakPoint(*point) for point in table] for table in (before, after))

    assert speeding._has(new, old, speed) is has


@pytest.mark.parametrize(
    ("program", "inputs", "words"),
    [
        ("\\ S100 )1", "", "V500 has changed nothing of its move: "),
        ("\\ S100 V2000 A100 N3 G+ F100 R", "3=0", "V500 has changed nothing of its move: "),
        ("\\ S100 V2000 A2000 G+", "", "speed 500 steps/s"),
        ("\\ S1000 V300 G+", "", "speed 500 steps/s"),
    ],
)
def test_a_unit_makes_of_a_speed_what_is_told(tool, serve, write, monkeypatch, program, inputs,
                                              words):  # fmt: skip
    served = serve("--control", "0", paced=True)
    monkeypatch.setenv("RKM04_PORT", served.place)
    control = served.control()
    control.order("3=1")
    assert tool("send", write(program)).status == 0
    time.sleep(0.5)
    if inputs:
        control.order(inputs)

    result = tool("speed", "500")

    assert f"motor 1 {words}" in result.out
    assert result.status == (0 if words.startswith("speed") else 1)


def test_a_motor_that_begins_to_move_is_told_as_it_was(tool, fake, unit, monkeypatch):
    """A second look may find it moving, and would say that it got nothing although it moves."""
    unit.states[0], unit.waits[0] = RUNNING | WAITING, 96

    def execute(unit: FakeUnit, message: bytes) -> bytes:
        answer = original(unit, message)
        if message[0] == 200:
            unit.states[0] = GOES
        return answer

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)

    result = tool("speed", "700")

    assert result.status == 1
    assert lines(result) == ["motor 1 stands, waiting for a time: nothing was sent"]


def test_of_an_original_unit_positions_tell_which_motors_move(tool, fake, unit, monkeypatch):
    def execute(unit: FakeUnit, message: bytes) -> bytes:
        unit.positions[2] -= 1
        return original(unit, message)

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)
    unit.status = b""

    result = tool("speed", "500", "--motor", "0")

    assert acts(unit) == [(3, b"V500")]
    told = lines(result)
    assert told[0] == "motor 1 has not moved while it was watched: nothing was sent"
    assert told[2] == "motor 3 was sent V500"
    assert told[4] == "NOT CONFIRMED: the unit has other software and tells positions only"


def test_speed_of_all_units_is_refused(tool, fake, unit):
    result = tool("speed", "500", "--node", "0")

    assert result.status == 2
    assert "none can say which of its motors move" in result.complaint
    assert unit.done == []
