"""What may begin a motion is not sent once it is late, nor repeated; nobody expects it any more."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from pos_desk import MM_MIN, PosDesk
from relay import Relay
from rkm04_tools.positioning import client
from rkm04_tools.positioning.unit import open_unit
from served import Served

SENDING_SECONDS = 0.6
"""After so long a request was sent, and has not been repeated for the last time."""


@pytest.fixture
def served(pos_serve: Callable[..., Served]) -> Served:
    return pos_serve("--unpaced", speed="1")


@pytest.fixture
def relay(served: Served) -> Iterator[Relay]:
    relay = Relay(served.place)
    yield relay
    relay.close()


@pytest.fixture
def desk(relay: Relay) -> Iterator[PosDesk]:
    desk = PosDesk(relay.port)
    desk.connected()
    yield desk
    desk.close()


def grows_old_on_the_line(desk: PosDesk, relay: Relay, kind: str, **told: Any) -> dict[str, Any]:
    """The answer to what is late when its first request comes to be repeated."""
    relay.muted = True
    number = desk.say(kind, **told)
    desk.state(lambda m: m["busy"] == kind)
    time.sleep(SENDING_SECONDS)
    desk.late = True
    relay.muted = False
    answer = dict(desk.answer(number)["error"])
    desk.late = False
    return answer


def test_a_motion_whose_measure_took_too_long_does_not_begin(desk: PosDesk, relay: Relay) -> None:
    error = grows_old_on_the_line(
        desk, relay, "measure", axis=1, um=50_000, accel=500, feed=600 * MM_MIN, absolute=False
    )

    assert error["kind"] == "NotBegun"
    assert "it was not told to move" in error["cause"]
    axis = desk.axis()
    assert (axis["state"], axis["feed"], axis["position_um"]) == ("READY", 0, 0)
    assert desk.ask("control", axis=1, feed=600 * MM_MIN, permitted=True)["error"] is None
    desk.axis(lambda a: a["state"] == "MOVING")


def test_what_lets_an_axis_move_is_not_repeated_when_it_is_late(
    desk: PosDesk, relay: Relay
) -> None:
    desk.ask("take", axis=1)
    desk.ask("measure", axis=1, um=50_000, accel=500, absolute=False)
    error = grows_old_on_the_line(desk, relay, "control", axis=1, feed=600 * MM_MIN, permitted=True)

    assert error["kind"] == "NotRepeated"
    assert "whether it has begun to is not known" in error["next"]
    axis = desk.axis()
    assert (axis["state"], axis["feed"], axis["position_um"]) == ("READY", 0, 0)


def test_what_makes_an_axis_slower_is_repeated_for_longer(desk: PosDesk, relay: Relay) -> None:
    desk.ask("measure", axis=1, um=50_000, accel=500, feed=600 * MM_MIN, absolute=False)
    relay.muted = True
    number = desk.say("control", axis=1, feed=0)
    desk.state(lambda m: m["busy"] == "control")
    time.sleep(SENDING_SECONDS)
    desk.late = True
    relay.muted = False

    assert desk.answer(number)["error"] is None
    assert desk.axis(lambda a: not a["speed"])["feed"] == 0


def test_clicks_that_grow_old_while_they_wait_are_refused(desk: PosDesk) -> None:
    numbers = [desk.say("take", axis=3) for _ in range(20)]
    desk.late = True
    kinds = [(desk.answer(number)["error"] or {}).get("kind") for number in numbers]
    assert kinds[-1] == "Late"
    assert set(kinds) <= {None, "Late"}


def test_a_command_that_took_too_long_does_not_let_an_axis_move(
    served: Served, positioning: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "LATE_SECONDS", -1.0)
    place = served.place
    assert positioning("settings", "set", "REFERENCE=3", "--port", place).status == 0
    for command in (["move", "50"], ["home", "--method", "21"]):
        result = positioning(*command, "--port", place)
        assert (result.status, "it was not told to move" in result.err) == (1, True), result
    assert positioning("mode", "50", "--port", place).status == 0
    for command in (["go"], ["feed", "600"]):
        result = positioning(*command, "--port", place)
        assert (result.status, "it was not told to move" in result.err) == (1, True), result
    assert positioning("hold", "--port", place).status == 0
    with open_unit(place) as unit:
        assert unit.axis(1).read().position_steps == 0
