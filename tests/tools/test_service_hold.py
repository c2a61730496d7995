"""A button that is held: who falls silent meanwhile has all motors stopped, and nobody else."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import pytest
from fake_unit import FakeLine, FakeUnit, lost
from rkm04_tools.service import virtual
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.holding import HOLD_SECONDS, Holds
from rkm04_tools.service.orders import SCAN, Connect, Disconnect, Forget, Request
from service_desk import Desk

MINE, OTHER = 1, 2
RUNS = Request("send", 1, "\\S200 V2000 A8000 G+")
RUN_OF_BUTTON = replace(RUNS, held=True)
LETTING_GO = Request("send", 1, "K", held=True)


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    desk.connect(virtual.NAME)
    yield desk
    desk.stop()
    desk.worker.close()
    desk.units.close()


@pytest.fixture
def unit() -> FakeUnit:
    return FakeUnit()


@pytest.fixture
def line(unit: FakeUnit) -> Iterator[FakeLine]:
    line = FakeLine(unit)
    yield line
    line.close()


@pytest.fixture
def busy(line: FakeLine) -> Iterator[Desk]:
    """A desk whose line is busy for more than a second."""
    desk = Desk()
    desk.connect(line.port)
    desk.worker.give(Request(SCAN, 0), Asked(OTHER, 100))
    desk.state(lambda told: told["busy"] == SCAN)
    yield desk
    desk.worker.close()


def is_moving(desk: Desk) -> bool:
    return bool(desk.live()["motors"][0]["moving"])


def test_a_browser_that_falls_silent_while_it_holds_a_button_has_all_motors_stopped(desk):
    desk.worker.holds.hold(MINE)
    desk.ask(RUNS)
    assert is_moving(desk)

    answer = desk.until(lambda told: told["type"] == "answer" and told["message"] == "stop")

    assert answer["error"] is None
    assert (answer["id"], answer["from"]) == (None, None)
    desk.until(lambda told: told["type"] == "live" and not told["motors"][0]["moving"])


@pytest.mark.parametrize("order", [Disconnect(), Connect(virtual.NAME, 2)])
def test_who_leaves_the_unit_while_another_one_holds_a_button_stops_it_first(desk, order):
    desk.worker.holds.hold(MINE)
    desk.ask(RUNS)
    assert is_moving(desk)
    desk.ask(order)
    stop, _ = [told for told in desk.told if told["type"] == "answer"][-2:]
    assert (stop["message"], stop["error"]) == ("stop", None)


def test_no_port_is_opened_because_a_button_is_let_go_after_the_port_was_closed(desk):
    desk.ask(Disconnect())
    desk.worker.holds.hold(MINE)  # it was on its way
    desk.worker.give(Forget(()), Asked())  # the worker sees it
    time.sleep(HOLD_SECONDS / 2)
    desk.worker.holds.let_go(MINE)
    time.sleep(HOLD_SECONDS)

    state = desk.worker.state
    assert (state.connected, state.error) == (False, None)


def test_a_button_that_is_held_or_let_go_stops_nothing(desk):
    desk.ask(RUNS)
    for _ in range(10):
        desk.worker.holds.hold(MINE)
        time.sleep(HOLD_SECONDS / 4)
    desk.worker.holds.let_go(MINE)
    time.sleep(2 * HOLD_SECONDS)
    assert is_moving(desk)


def test_a_run_that_waits_for_the_line_is_never_sent_after_its_button_was_let_go(busy, unit):
    busy.worker.holds.hold(MINE)
    busy.worker.give(RUN_OF_BUTTON, Asked(MINE, 101))
    busy.worker.give(RUN_OF_BUTTON, Asked(OTHER, 102))
    busy.worker.let_go(MINE)

    refused, scanned, sent = (busy.answer(number) for number in (101, 100, 102))

    assert refused["error"]["kind"] == "Stopped"
    assert (scanned["error"], sent["error"]) == (None, None)
    assert len([each for each in unit.done if each[:1] == b"\x02"]) == 1


def test_letting_go_cuts_short_what_is_under_way(busy, line, unit):
    unit.done.clear()
    busy.worker.holds.hold(MINE)
    busy.worker.give(Request("version", 0), Asked(OTHER, 101))
    busy.worker.give(LETTING_GO, Asked(MINE, 102))

    cut, told, waited = (busy.answer(number) for number in (100, 102, 101))

    assert cut["error"]["kind"] == "Stopped"
    assert (told["text"], told["values"], told["error"]) == ("K sent", {"alone": "K"}, None)
    assert waited["error"] is None
    assert busy.worker.holds.rest_seconds() is None
    assert (1, 0, b"\x021K") in line.requests


def test_a_unit_whose_answers_are_lost_hears_k_before_it_is_looked_at_again(busy, line):
    busy.answer(100)
    busy.live()
    line.faults.extend([lost] * 1000)
    asked = len(line.requests)
    while len(line.requests) == asked:
        time.sleep(0.001)
    asked = len(line.requests)
    busy.worker.give(LETTING_GO, Asked(MINE, 101))
    assert busy.answer(101)["error"]["kind"] == "NoAnswer"

    assert line.requests[asked : asked + 4] == 4 * [(1, 0, b"\x021K")]


def test_a_stop_goes_ahead_of_a_button_that_is_let_go(busy, line):
    busy.answer(100)
    line.faults.extend([lost] * 3)
    busy.worker.give(LETTING_GO, Asked(MINE, 101))
    while (1, 0, b"\x021K") not in line.requests:
        time.sleep(0.001)
    assert busy.stop()["error"] is None
    assert [told["error"]["kind"] for told in busy.told if told.get("id") == 101] == ["Stopped"]


def test_a_browser_that_goes_while_it_holds_a_button_is_not_waited_for(busy, unit):
    busy.worker.holds.hold(MINE)
    busy.worker.give(RUN_OF_BUTTON, Asked(MINE, 101))
    began = time.monotonic()
    busy.worker.lose(OTHER)
    busy.worker.lose(MINE)

    stop = busy.until(lambda told: told["type"] == "answer" and told["message"] == "stop")

    assert stop["error"] is None
    assert time.monotonic() - began < HOLD_SECONDS
    assert {each for each in unit.done if each[:1] == b"\x02"} == {b"\x020K"}


def test_a_page_that_is_gone_has_gone_for_the_worker_too(service):
    holding, other = service.browser(), service.browser()
    other.connected()
    holding.say(type="hold", held=True)
    assert holding.request("send", text=RUNS.text, held=True)["error"] is None
    began = time.monotonic()
    holding.close()
    other.until(lambda told: told["type"] == "answer" and told["message"] == "stop")
    assert time.monotonic() - began < HOLD_SECONDS
    other.close()


def test_each_browser_holds_for_itself():
    holds = Holds()
    holds.hold(MINE)
    holds.hold(OTHER)
    holds.let_go(MINE)
    assert holds.rest_seconds() is not None
    holds.let_go(OTHER)
    assert holds.rest_seconds() is None
    assert not holds.is_lost()
