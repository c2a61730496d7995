"""Stops of a positioning unit that gets what is sent, and whose answers are lost."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from pos_desk import PosDesk
from relay import Relay
from rkm04_tools.positioning.service import stopping
from rkm04_tools.positioning.unit import open_unit
from served import Served

Serve = Callable[..., Served]


@pytest.fixture
def served(pos_serve: Serve) -> Served:
    """A unit whose axis 1 moves."""
    served = pos_serve("--unpaced", speed="1")
    with open_unit(served.place) as unit:
        axis = unit.axis(1)
        axis.init()
        axis.mode(1000, 500)
        axis.control(600)
    return served


@pytest.fixture
def relay(served: Served) -> Iterator[Relay]:
    relay = Relay(served.place)
    relay.dumb = True
    yield relay
    relay.close()


def stands(state: dict[str, Any]) -> bool:
    return not state["moving"][0]


@pytest.mark.parametrize("stop", [["feed", "0"], ["hold"]])
def test_a_stop_goes_out_though_nobody_answers(
    positioning: Callable[..., Any], served: Served, relay: Relay, stop: list[str]
):
    assert positioning(*stop, "--port", relay.port).status == 3

    served.control().wait_for("stands", stands)


def test_a_move_whose_answers_are_lost_is_held_if_the_unit_hears_it(
    positioning: Callable[..., Any], served: Served, relay: Relay
):
    relay.dumb = False
    falls_dumb = threading.Timer(1.0, setattr, (relay, "dumb", True))
    falls_dumb.start()
    result = positioning("move", "1000", "--axis", "2", "--port", relay.port)

    assert result.status == 3
    assert result.err.startswith("STOP NOT CONFIRMED: ")
    served.control().wait_for("stands", lambda state: not state["moving"][1])
    assert served.control().order("?")["positions"][1] > 0


def test_a_stop_of_the_page_goes_out_to_a_unit_that_was_never_heard(
    served: Served, relay: Relay, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(stopping, "STOP_SECONDS", 0.8)
    desk = PosDesk(relay.port)
    try:
        assert desk.state(lambda m: m["error"] is not None)["error"]["kind"] == "NoAnswer"
        assert desk.ask("halt")["error"]["kind"] == "NotConfirmed"
        served.control().wait_for("stands", stands)
    finally:
        desk.close()
