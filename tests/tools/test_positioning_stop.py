"""When the page of a positioning unit takes a stop for confirmed, and of which axes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest
from pos_cycles import cycles
from pos_desk import PosDesk
from rkm04_tools.positioning.unit import Unit, open_unit
from served import Served

JEDE, MP = 0x100, 1
Serve = Callable[..., Served]


@pytest.fixture
def place(pos_serve: Serve) -> str:
    """A unit behind a gateway, so that it has several masters."""
    return pos_serve("--unpaced", speed="1", place="--modbus-tcp").place


@pytest.fixture
def desk(place: str) -> Iterator[PosDesk]:
    desk = PosDesk(place)
    desk.connected()
    yield desk
    desk.close()


@pytest.fixture
def other(place: str) -> Iterator[Unit]:
    with open_unit(place) as unit:
        yield unit


def moving(desk: PosDesk, axis: int = 1) -> None:
    assert desk.move(1000, axis=axis)["error"] is None
    desk.axis(lambda a: a["status"] & JEDE and abs(a["position_um"]) > 100, axis)


@pytest.mark.parametrize("seconds", [0.02, 0.1, 0.25])
@pytest.mark.parametrize("order", ["halt", "hold"])
def test_a_stop_that_a_plc_undoes_in_each_cycle_ends_the_measure_and_is_not_confirmed(
    desk: PosDesk, other: Unit, place: str, order: str, seconds: float
) -> None:
    moving(desk)
    moving(desk, axis=2)
    with cycles(place, seconds):
        time.sleep(2 * seconds)
        told = desk.ask(order, axis=1)

        assert told["error"]["kind"] == "NotHeld"
        assert told["error"]["cause"].startswith("axis 1 IS NOT HELD: another master")
        assert desk.now["halt"] == "failed"
        at = other.axis(1).read()
        assert (at.state, at.moves) == ("TAKEN", False)
        time.sleep(2 * seconds)
        assert other.axis(1).read().position_steps == at.position_steps
    assert other.axis(2).read().moves == (order == "hold")
    assert desk.ask("halt")["error"] is None
    assert desk.now["halt"] is None


def test_a_stop_that_somebody_undoes_once_is_confirmed_with_the_measure_ended(
    desk: PosDesk, other: Unit
) -> None:
    moving(desk)
    number = desk.say("halt")
    while other.wire.read(105, 1)[0] & MP:
        pass
    other.axis(1).go()

    assert desk.answer(number)["text"].endswith(
        "; another master gave axis 1 the permission again, so the measure was ended there"
    )
    assert other.axis(1).read().state == "TAKEN"
    assert not other.wire.read(105, 1)[0] & MP
