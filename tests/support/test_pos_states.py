"""The tables of sections 2 and 3 of the contract, on the model of the positioning unit."""

from __future__ import annotations

import pytest
from pos_model import imagine, setting
from pos_session import Act, Edge, Session, Setting
from pos_words import (
    CONT,
    DISP,
    ERR,
    FEED_UNITS,
    INIC,
    JEDE,
    MP,
    MS,
    POL,
    PROG,
    SMER,
    Code,
    Error,
)

FEED = 1000 * FEED_UNITS
INIT = (Code.POS_INIT, (0,))
MODE = (Code.POS_MODE, (10_000, 500))
BACK = (Code.POS_MODE, (-10_000, 500))
GO = (Code.POS_CONTROL, (FEED, 1))
HOLD = (Code.POS_CONTROL, (FEED, 0))
RESET = (Code.POS_RESET, ())
CLOSED = Edge(150 * MS, 1, 1)
LATER = 200
Step = tuple[Code, tuple[int, ...]] | int

STATES: dict[str, tuple[Step, ...]] = {
    "FREE": (),
    "TAKEN": (INIT,),
    "READY": (INIT, MODE),
    "READY, held": (INIT, MODE, GO, 100, HOLD, LATER),
    "MOVING": (INIT, MODE, GO, 100),
    "REACHED": (INIT, MODE, GO, 1000),
    "FREE, it brakes": (INIT, MODE, GO, 100, RESET, 4),
    "TAKEN, it brakes": (INIT, MODE, GO, 100, INIT, 4),
    "WAITING": (INIT, MODE, GO, 100, INIT, 4, MODE, 4),
    "FAULT, it brakes": (INIT, MODE, GO, 139),
    "FAULT": (INIT, MODE, GO, 139 + LATER),
}
STATUS = {
    "FREE": 0,
    "TAKEN": DISP,
    "READY": DISP | PROG,
    "READY, held": DISP | PROG,
    "MOVING": DISP | PROG | JEDE,
    "REACHED": DISP | PROG | POL,
    "FREE, it brakes": JEDE,
    "TAKEN, it brakes": DISP | JEDE,
    "WAITING": DISP | PROG | JEDE,
    "FAULT, it brakes": DISP | ERR | JEDE,
    "FAULT": DISP | ERR,
}
REFUSED = {
    "FREE": Error.NOT_TAKEN,
    "FREE, it brakes": Error.NOT_TAKEN,
    "MOVING": Error.MOVES,
    "WAITING": Error.MOVES,
    "FAULT": Error.FAULT,
    "FAULT, it brakes": Error.FAULT,
}


def play(
    *steps: Step,
    edges: tuple[Edge, ...] = (),
    settings: tuple[Setting, ...] = (),
    then: float = 3,
) -> dict[str, int]:
    """What axis 1 tells after some instructions, 2 ms apart, and waits."""
    script: list[Act | Setting] = list(settings)
    ms = 5.0
    for step in steps:
        if isinstance(step, int):
            ms += step
        else:
            script.append(Act(round(ms * MS), 1, *step))
            ms += 2
    tick = round((ms - 2 + then) * MS)
    session = Session(tuple(script), edges, tick + 1, ((tick, 1),))
    (sample,) = imagine(session).samples
    return sample.values


def reach(state: str, *steps: Step, then: float = 3) -> dict[str, int]:
    """The same in a state."""
    fault = state.startswith("FAULT")
    edges = (CLOSED,) if fault else ()
    settings = (setting(MS, 1, "limit_plus", 1),) if fault else ()
    return play(*STATES[state], *steps, edges=edges, settings=settings, then=then)


@pytest.mark.parametrize("state", STATES)
def test_a_state_shows_its_bits(state: str) -> None:
    told = reach(state)
    assert told["STATUS"] == STATUS[state]
    inic = INIC if state == "WAITING" else 0
    cont = CONT if state in ("READY", "READY, held", "MOVING") else 0
    mp = 0 if state.startswith("FREE") or state == "READY, held" else MP
    assert told["CONTROL"] == inic | cont | mp


@pytest.mark.parametrize("state", STATES)
def test_a_measure_is_taken_or_refused(state: str) -> None:
    told = reach(state, MODE)
    error = REFUSED.get(state, Error.NONE)
    assert told["RESULT"] == error
    if error:
        fault = Error.LIMIT if state.startswith("FAULT") else error
        assert told["ERROR"] == fault
        assert told["STATUS"] & ~JEDE == STATUS[state] & ~JEDE | ERR
    else:
        assert told["STATUS"] & ~JEDE == DISP | PROG
        waits = INIC if state == "TAKEN, it brakes" else CONT
        assert told["CONTROL"] & (INIC | CONT) == waits
        assert told["FEED"] == 0


@pytest.mark.parametrize("state", STATES)
def test_what_pos_control_is_taken(state: str) -> None:
    told = reach(state, (Code.POS_CONTROL, (5 * FEED, 0)))
    permit = not state.startswith("FREE")
    feed = permit and not state.startswith(("TAKEN", "FAULT"))
    assert told["FEED"] == (5 * FEED if feed else 0)
    assert told["CONTROL"] & MP == 0
    assert told["RESULT"] == Error.NONE
    if permit:
        assert reach(state, (Code.POS_CONTROL, (0, 1)))["CONTROL"] & MP


@pytest.mark.parametrize("state", STATES)
def test_init_and_reset_are_taken_in_every_state(state: str) -> None:
    told = reach(state, INIT, then=LATER)
    assert (told["STATUS"], told["CONTROL"], told["FEED"]) == (DISP, MP, 0)
    told = reach(state, RESET, then=LATER)
    assert (told["STATUS"], told["CONTROL"], told["ERROR"]) == (0, 0, 0)
    assert told["FEED"] == 0


@pytest.mark.parametrize("state", STATES)
def test_a_refused_instruction_changes_nothing_else(state: str) -> None:
    before, told = reach(state, then=5), reach(state, (Code.POS_INIT, (7,)))
    assert told["STATUS"] == before["STATUS"] | ERR
    assert told["RESULT"] == Error.SPACE
    assert told["ERROR"] == (before["ERROR"] or Error.SPACE)
    same = ("CONTROL", "FEED", "FLAGS", "POSITION")
    assert [told[name] for name in same] == [before[name] for name in same]


HOME = Code.POS_HOME
WRONG: dict[str, tuple[tuple[Step, ...], Error]] = {
    "everything, without DISP": (((HOME, (20, -(2**31), 0)),), Error.NOT_TAKEN),
    "everything, moving": ((INIT, MODE, GO, 100, (HOME, (20, -(2**31), 0))), Error.MOVES),
    "a method before an input": ((INIT, (HOME, (20, 0, 0))), Error.METHOD),
    "an input before a slope": ((INIT, (HOME, (19, -(2**31), 0))), Error.NO_INPUT),
    "a slope before a way": ((INIT, (Code.POS_MODE, (-(2**31), 0))), Error.ACCEL),
    "a way": ((INIT, (Code.POS_MODE, (-(2**31), 1))), Error.WAY),
    "a position": ((INIT, (Code.POS_MODE_ABS, (-(2**31), 1))), Error.WAY),
    "a position too far": (
        (INIT, (HOME, (37, 2**31 - 1, 0)), (Code.POS_MODE_ABS, (-1, 1))),
        Error.WAY,
    ),
    "a space": (((Code.POS_INIT, (7,)),), Error.SPACE),
    "no input for a capture": (((Code.POS_CAPTURE, ()),), Error.NO_INPUT),
}


@pytest.mark.parametrize("case", WRONG)
def test_the_first_reason_is_told(case: str) -> None:
    steps, error = WRONG[case]
    told = play(*steps)
    assert (told["RESULT"], told["ERROR"], told["STATUS"] & ERR) == (error, error, ERR)


def test_what_is_just_allowed_is_taken() -> None:
    for step in ((Code.POS_MODE, (-(2**31) + 1, 1)), (Code.POS_MODE_ABS, (2**31 - 1, 65_535))):
        assert play(INIT, step)["STATUS"] == DISP | PROG
    assert play((Code.POS_INIT, (6,)))["STATUS"] == DISP


def test_the_error_is_the_first_until_a_fault_takes_its_place() -> None:
    told = play(MODE, (Code.POS_CAPTURE, ()))
    assert (told["ERROR"], told["RESULT"]) == (Error.NOT_TAKEN, Error.NO_INPUT)
    limit = setting(MS, 1, "limit_plus", 1)
    told = play(INIT, MODE, GO, 30, MODE, 300, settings=(limit,), edges=(CLOSED,))
    assert (told["ERROR"], told["RESULT"]) == (Error.LIMIT, Error.MOVES)


def test_direction_is_kept_at_rest() -> None:
    assert play(INIT, BACK, GO, 1000)["STATUS"] == DISP | PROG | POL | SMER
    assert play(INIT, BACK, GO, 1000, RESET)["STATUS"] == SMER


def test_a_measure_of_no_pulses_is_reached_without_a_feed() -> None:
    told = play(INIT, (Code.POS_MODE, (4, 500)))
    assert told["STATUS"] == DISP | PROG | POL
    assert told["CONTROL"] == MP


def test_a_limit_blocks_one_direction() -> None:
    limit = (setting(MS, 1, "limit_plus", -1),)
    told = play(INIT, MODE, GO, settings=limit)
    assert (told["STATUS"], told["ERROR"], told["POSITION"]) == (DISP | ERR, Error.LIMIT, 0)
    assert play(INIT, BACK, GO, 1000, settings=limit)["POSITION"] == -10_000


def test_a_software_limit_cuts_the_measure() -> None:
    limits = (setting(MS, 1, "soft_min", -50), setting(MS, 1, "soft_max", 200))
    here = (HOME, (37, 0, 0))
    told = play(INIT, MODE, GO, 1000, settings=limits)
    assert told["POSITION"] == 10_000
    told = play(INIT, here, MODE, GO, 1000, settings=limits)
    assert (told["STATUS"], told["ERROR"]) == (DISP | ERR, Error.SOFT_LIMIT)
    assert told["POSITION"] == 200
    told = play(INIT, here, BACK, GO, 1000, INIT, BACK, settings=limits)
    assert (told["ERROR"], told["POSITION"]) == (Error.SOFT_LIMIT, -50)
    outside = (HOME, (37, 1000, 0))
    told = play(INIT, outside, (Code.POS_MODE, (-500, 500)), GO, 1000, settings=limits)
    assert (told["ERROR"], told["POSITION"]) == (Error.NONE, 500)


def test_homing_finds_the_edge() -> None:
    settings = (setting(MS, 1, "reference", 1),)
    edges = (Edge(300 * MS, 1, 1), Edge(900 * MS, 1, 0))
    home = (HOME, (19, 5000, 500))
    told = play(INIT, home, GO, 1500, settings=settings, edges=edges)
    assert told["STATUS"] & ~SMER == DISP | PROG | POL
    assert (told["POSITION"], told["FLAGS"]) == (5000, 1)
    assert told["POSITION_STEPS"] > 100


def test_homing_gives_up_after_its_way() -> None:
    settings = (setting(MS, 1, "reference", 1), setting(MS, 1, "home_way", 1000))
    told = play(INIT, (HOME, (21, 0, 500)), GO, 1500, settings=settings)
    assert (told["STATUS"], told["ERROR"]) == (DISP | ERR | SMER, Error.NOT_FOUND)
    assert (told["POSITION"], told["FLAGS"]) == (-1000, 0)


def test_a_capture_keeps_the_position_at_the_edge() -> None:
    settings = (setting(MS, 1, "capture", 2),)
    edges = (Edge(200 * MS, 2, 1), Edge(250 * MS, 2, 0), Edge(300 * MS, 2, 1))
    steps = (INIT, MODE, (Code.POS_CAPTURE, ()), GO, 1000)
    told = play(*steps, settings=settings, edges=edges)
    assert told["CAPTURES"] == 1
    assert 270 < told["CAPTURED_STEPS"] < 310
