"""When the page of a positioning unit takes a stop for confirmed, and of which axes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest
from pos_cycles import cycles
from pos_desk import PosDesk
from relay import Relay
from rkm04_tools.positioning.service import stopping
from rkm04_tools.positioning.unit import Unit, open_unit
from rkm04_tools.service import turns
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
def relay(pos_serve: Serve) -> Iterator[Relay]:
    relay = Relay(pos_serve("--unpaced", speed="1").place)
    yield relay
    relay.close()


@pytest.fixture
def line_desk(relay: Relay, monkeypatch: pytest.MonkeyPatch) -> Iterator[PosDesk]:
    """A desk at the end of a line that can be muted, and that gives a stop up soon."""
    monkeypatch.setattr(stopping, "STOP_SECONDS", 0.8)
    monkeypatch.setattr(turns, "LOOK_AGAIN_SECONDS", 0.2)
    desk = PosDesk(relay.port)
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


def not_answered(desk: PosDesk, relay: Relay, order: str, axis: int = 1) -> None:
    """Ask for a stop while the line is dumb."""
    relay.muted = True
    assert desk.ask(order, axis=axis)["error"]["kind"] == "NotConfirmed"
    relay.muted = False
    desk.live()


def test_a_hold_of_an_axis_does_not_confirm_a_stop_of_all(line_desk: PosDesk, relay: Relay) -> None:
    desk = line_desk
    moving(desk, axis=2)
    not_answered(desk, relay, "halt")
    assert desk.now["unheld"] == (1, 2, 3, 4)

    told = desk.ask("hold", axis=1)
    assert (told["message"], told["error"]) == ("hold", None)
    assert (desk.now["halt"], desk.now["unheld"]) == ("failed", (2, 3, 4))
    assert desk.axis(number=2)["state"] == "MOVING"
    assert desk.ask("halt")["message"] == "halt"
    assert (desk.now["halt"], desk.now["unheld"]) == (None, ())


def test_a_hold_of_an_axis_does_not_confirm_that_of_another(
    line_desk: PosDesk, relay: Relay
) -> None:
    desk = line_desk
    moving(desk)
    moving(desk, axis=2)
    not_answered(desk, relay, "hold", axis=2)

    assert desk.ask("hold", axis=1)["error"] is None
    assert (desk.now["halt"], desk.now["unheld"]) == ("failed", (2,))
    assert desk.axis(number=2)["state"] == "MOVING"
    assert desk.ask("hold", axis=2)["error"] is None
    assert (desk.now["halt"], desk.now["unheld"]) == (None, ())
