"""What is behind the page of a positioning unit: stops, silence, restarts, two masters."""

from __future__ import annotations

import json
import signal
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from pos_desk import MM_MIN, PosDesk
from relay import Relay, expect_reset
from rkm04_tools.positioning.service import stopping
from rkm04_tools.positioning.service.orders import read_order
from rkm04_tools.positioning.settings import read_values
from rkm04_tools.positioning.unit import Unit, open_unit
from rkm04_tools.service import turns
from rkm04_tools.service.trouble import BadRequest
from rkm04_tools.service.unit_orders import Connect
from served import Served

JEDE = 0x100
Serve = Callable[..., Served]


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(turns, "LOOK_AGAIN_SECONDS", 0.2)


@pytest.fixture
def served(pos_serve: Serve) -> Served:
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


@pytest.fixture
def shared(pos_serve: Serve) -> Iterator[tuple[PosDesk, Unit]]:
    """A desk, and another master of the same unit, through a gateway."""
    place = pos_serve("--unpaced", speed="1", place="--modbus-tcp").place
    desk = PosDesk(place)
    desk.connected()
    with open_unit(place) as other:
        yield desk, other
    desk.close()


def moving(desk: PosDesk, mm: float = 1000, axis: int = 1, **more: float) -> None:
    assert desk.move(mm, axis=axis, **more)["error"] is None
    desk.axis(lambda a: a["status"] & JEDE and abs(a["position_um"]) > 100, axis)


# ---- motion ----


def test_connecting_only_reads(desk: PosDesk, served: Served) -> None:
    desk.live()
    assert [axis["state"] for axis in desk.live()["axes"]] == ["FREE"] * 4
    assert not any(served.control().order("?")["moving"])


def test_a_motion_takes_the_axis_and_arrives(desk: PosDesk) -> None:
    told = desk.move(5, feed=6000)

    assert told["text"].startswith("axis 1: 0.")
    assert desk.axis(lambda a: a["state"] == "REACHED")["position_um"] == 5000


def test_a_measure_waits_for_feed_and_permission(desk: PosDesk) -> None:
    assert "error 3" in desk.ask("measure", axis=2, um=100, accel=500)["error"]["cause"]
    desk.ask("take", axis=2)
    assert "error 6" in desk.ask("measure", axis=2, um=100, accel=0)["error"]["cause"]
    desk.ask("measure", axis=2, um=-4000, accel=500)
    assert desk.axis(number=2)["state"] == "READY"
    desk.ask("control", axis=2, feed=6000 * MM_MIN, permitted=True)
    reached = desk.axis(lambda a: a["state"] == "REACHED", 2)
    assert (reached["position_um"], reached["feed"]) == (-4000, 6000 * MM_MIN)


def test_a_feed_acts_in_motion_and_is_refused_where_the_unit_takes_none(desk: PosDesk) -> None:
    assert "not taken" in desk.ask("control", axis=1, feed=MM_MIN)["error"]["cause"]
    desk.ask("take", axis=1)
    assert "takes no feed" in desk.ask("control", axis=1, feed=MM_MIN)["error"]["cause"]
    moving(desk)
    desk.ask("control", axis=1, feed=1200 * MM_MIN)
    assert desk.axis(lambda a: a["speed"] == 1200 * MM_MIN)["state"] == "MOVING"


def test_a_hold_keeps_the_rest_of_the_way_and_other_axes_go_on(desk: PosDesk) -> None:
    moving(desk)
    moving(desk, axis=2)
    told = desk.ask("hold", axis=1)

    assert told["text"].startswith("axis 1 stands at ")
    held = desk.axis()
    assert (held["state"], held["permitted"], held["feed"]) == ("READY", False, 600 * MM_MIN)
    assert held["position_um"] + held["way_left_um"] == 1_000_000
    assert desk.axis(number=2)["state"] == "MOVING"
    desk.ask("control", axis=1, permitted=True)
    assert desk.axis(lambda a: a["status"] & JEDE)["position_um"] >= held["position_um"]


def test_a_stop_holds_all_axes_with_feed_0(desk: PosDesk) -> None:
    moving(desk)
    moving(desk, -1000, axis=4)
    told = desk.ask("halt")

    assert told["text"].startswith("all axes stand: 1 at ")
    assert desk.now["halt"] is None
    axes = desk.live()["axes"]
    assert [(a["state"], a["permitted"], a["feed"]) for a in axes] == [
        ("READY", False, 0), ("FREE", False, 0), ("FREE", False, 0), ("READY", False, 0),
    ]  # fmt: skip


def test_a_stop_goes_ahead_of_what_waits(desk: PosDesk) -> None:
    moving(desk)
    numbers = [desk.say("take", axis=3) for _ in range(20)]
    stop = desk.say("halt")
    answers = [desk.until(lambda m: m["type"] == "answer") for _ in range(21)]

    kinds = {m["id"]: m["error"]["kind"] if m["error"] else "done" for m in answers}
    assert set(kinds) == {*numbers, stop}
    done = [number for number in numbers if kinds[number] == "done"]
    assert done == numbers[: len(done)] != numbers
    assert {kinds[number] for number in numbers[len(done) :]} == {"Stopped"}


def test_a_stop_of_all_goes_ahead_of_a_hold_that_still_brakes(desk: PosDesk) -> None:
    desk.ask("measure", axis=1, um=10**9, accel=4, feed=2000 * MM_MIN, absolute=False)
    moving(desk, axis=2)
    desk.axis(lambda a: a["speed"] > 300 * MM_MIN)
    hold = desk.say("hold", axis=1)
    desk.state(lambda m: m["halt"] == "asked")
    desk.say("halt")

    assert desk.axis(lambda a: not a["status"] & JEDE, 2)["permitted"] is False
    assert desk.now["halt"] == "asked"
    assert desk.ask("take", axis=2)["error"]["kind"] == "Stopped"
    assert desk.answer(hold)["text"].startswith("all axes stand")


def test_homing_here_and_to_a_switch(desk: PosDesk, served: Served) -> None:
    desk.ask("home", axis=1, method=37, um=7000, accel=0, feed=0)
    assert desk.axis(lambda a: a["flags"] & 1)["position_um"] == 7000
    assert desk.ask("write", values={"axis2": {"REFERENCE": 3}})["error"] is None
    desk.ask("home", axis=2, method=21, um=-500, accel=2000, feed=600 * MM_MIN)
    desk.axis(lambda a: a["flags"] & 64 and a["position_um"] < -1000, 2)
    control = served.control()
    control.order("3=1")
    desk.axis(lambda a: a["speed"] == 0 or not a["status"] & 0x200, 2)
    control.order("3=0")
    reached = desk.axis(lambda a: a["state"] == "REACHED", 2)
    assert (reached["position_um"], reached["flags"] & 1) == (-500, 1)


def test_a_limit_input_is_told_and_cleared_by_init_alone(desk: PosDesk, served: Served) -> None:
    desk.ask("write", values={"axis1": {"LIMIT_PLUS": 4}})
    moving(desk)
    served.control().order("4=1")
    fault = desk.axis(lambda a: a["error"] == 7)
    assert (fault["state"], fault["feed"], fault["by_other"]) == ("FAULT", 0, False)
    desk.axis(lambda a: not a["status"] & JEDE)
    assert "error 7" in desk.move(1)["error"]["cause"]
    desk.ask("take", axis=1)
    assert desk.axis()["error"] == 0
    assert desk.move(-1)["error"] is None


def test_the_watchdog_acts_when_nobody_looks_any_more_and_not_before(
    relay: Relay, served: Served
) -> None:
    desk = PosDesk(relay.port)
    try:
        desk.connected()
        assert desk.ask("write", values={"unit": {"WATCHDOG": 3000}})["error"] is None
        moving(desk)
        time.sleep(4.0)
        assert desk.axis()["state"] == "MOVING"
    finally:
        desk.close()
    served.control().wait_for("stands", lambda state: not state["moving"][0])
    with open_unit(relay.port) as unit:
        assert unit.axis(1).read().error == 8


def test_units_are_reached_by_a_pty_too(pos_serve: Serve, tmp_path: Path) -> None:
    desk = PosDesk(pos_serve("--unpaced", place="--pty", at=str(tmp_path / "unit")).place)
    try:
        desk.connected()
        assert desk.move(1)["error"] is None
        assert desk.axis(lambda a: a["state"] == "REACHED")["position_um"] == 1000
    finally:
        desk.close()


def test_an_address_that_cannot_be_is_wrong_usage(positioning: Callable[..., Any]) -> None:
    result = positioning("service", "--no-browser", "--node", "17")
    assert (result.status, result.err.count("\n")) == (2, 1)


# ---- settings ----


def test_settings_are_refused_while_their_axis_is_taken(desk: PosDesk) -> None:
    desk.ask("take", axis=1)
    for order, told in (
        ("write", {"values": {"axis1": {"STEPS": 5}}}),
        ("write", {"values": {"unit": {"WATCHDOG": 0}}}),
        ("store", {}), ("deliver", {}),
    ):  # fmt: skip
        cause = desk.ask(order, **told)["error"]["cause"]
        assert "taken" in cause or "settings wait" in cause, order
    assert desk.ask("write", values={"axis2": {"STEPS": 5}})["error"] is None


def test_settings_are_written_read_back_and_stored(desk: PosDesk) -> None:
    wanted = {
        "axis3": {"STEPS": 1600, "MICROMETRES": 5000, "SOFT_MIN": -100},
        "unit": {"RATE": 1152},
    }
    told = desk.ask("write", values=wanted)

    assert "axis3 STEPS" in told["text"]
    found = desk._desk.greetings()[2]
    assert found["values"]["axis3"]["STEPS"] == 1600
    assert read_values(found["file"], "file")["unit"]["RATE"] == 1152
    assert desk.live()["unit"]["condition"] & 4
    assert desk.ask("store")["error"] is None
    assert not desk.live()["unit"]["condition"] & 4
    assert desk.ask("deliver")["error"] is None
    assert desk._desk.greetings()[2]["values"]["unit"]["RATE"] == 192


# ---- what is late, silent, absent, restarted, or another's ----


def test_old_clicks_are_refused_but_not_an_old_stop(desk: PosDesk) -> None:
    moving(desk)
    desk.late = True
    for kind, told in (("take", {"axis": 2}), ("control", {"axis": 1, "feed": 1}), ("store", {})):
        assert desk.ask(kind, **told)["error"]["kind"] == "Late"
    assert desk.ask("hold", axis=1)["error"] is None
    assert desk.axis(number=2)["state"] == "FREE"


def test_a_silent_unit_is_told_and_nothing_asked_meanwhile_happens_later(
    desk: PosDesk, relay: Relay
) -> None:
    moving(desk)
    relay.muted = True
    number = desk.say("take", axis=2)
    assert desk.answer(number)["error"]["kind"] == "NoAnswer"
    later = desk.say("measure", axis=3, um=5000, accel=500, feed=MM_MIN, absolute=False)
    assert desk.now["doubt"]
    relay.muted = False
    assert desk.answer(later)["error"]["kind"] in ("Unsent", "NoAnswer", "Late")
    state = desk.state(lambda m: m["error"] is None and not m["doubt"])
    assert state["connected"]
    assert desk.axis(number=3)["state"] == "FREE"


@pytest.mark.parametrize("order", ["halt", "hold"])
def test_a_stop_that_is_not_confirmed_is_told_until_one_is(
    desk: PosDesk, relay: Relay, monkeypatch: pytest.MonkeyPatch, order: str
) -> None:
    monkeypatch.setattr(stopping, "STOP_SECONDS", 0.8)
    moving(desk)
    relay.muted = True
    number = desk.say(order, axis=1)
    desk.state(lambda m: m["halt"] == "asked")
    assert desk.answer(number)["error"]["kind"] == "NotConfirmed"
    relay.muted = False
    desk.live()
    assert desk.now["halt"] == "failed"
    assert desk.ask(order, axis=1)["error"] is None
    assert desk.now["halt"] is None


def test_a_stop_gets_through_as_soon_as_the_unit_is_back(desk: PosDesk, relay: Relay) -> None:
    moving(desk)
    relay.muted = True
    number = desk.say("halt")
    time.sleep(1.5)
    relay.muted = False

    assert desk.answer(number)["text"].startswith("all axes stand")


def test_on_a_bad_line_a_stop_is_confirmed_by_axes_that_stand(pos_serve: Serve) -> None:
    served = pos_serve("--unpaced", "--noise", "2000", "--loss", "2000", speed="1")
    desk = PosDesk(served.place)
    try:
        desk.connected()
        moving(desk)
        assert desk.ask("halt")["text"].startswith("all axes stand: 1 at ")
        assert not any(served.control().order("?")["moving"])
    finally:
        desk.close()


def test_what_was_not_answered_is_not_sent_later_by_a_port_that_keeps_it(
    desk: PosDesk,
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        port = f"socket://127.0.0.1:{silent.getsockname()[1]}"
        assert desk.ask("connect", port=port, node=1)["error"]["kind"] == "NoAnswer"
        expect_reset(silent)


def test_a_stop_without_a_port_is_not_confirmed(desk: PosDesk) -> None:
    desk.ask("disconnect")

    assert desk.ask("halt")["error"]["kind"] == "NotConnected"
    assert desk.now["halt"] == "failed"


def test_a_cable_that_is_pulled_in_motion_is_told_and_the_port_comes_back_by_itself(
    desk: PosDesk, relay: Relay
) -> None:
    moving(desk)
    relay.cut()
    state = desk.state(lambda m: m["away"])
    assert state["error"]["kind"] in ("PortLost", "PortMissing")
    assert desk.ask("take", axis=2)["error"]["kind"] == "NotConnected"
    relay.mend()
    desk.state(lambda m: m["connected"] and m["version"])
    axes = desk.live()["axes"]
    assert (axes[0]["state"], axes[1]["state"]) == ("MOVING", "FREE")
    assert not desk.now["restarted"]


def test_a_restarted_unit_is_told_until_noted_and_gets_no_orders(
    desk: PosDesk, relay: Relay, pos_serve: Serve
) -> None:
    moving(desk)
    time.sleep(0.5)
    relay.to(pos_serve("--unpaced", speed="1").place)
    desk.state(lambda m: m["restarted"])
    assert "take note" in desk.ask("take", axis=1)["error"]["next"]
    assert desk.axis()["state"] == "FREE"
    desk.ask("seen")
    assert desk.ask("take", axis=1)["error"] is None


def test_a_restart_while_the_port_was_away_is_noticed_although_the_unit_runs_for_longer(
    desk: PosDesk, relay: Relay, pos_serve: Serve
) -> None:
    desk.ask("take", axis=3)
    desk.axis(lambda a: a["state"] == "TAKEN", 3)
    relay.cut()
    desk.state(lambda m: m["away"])
    time.sleep(1.0)
    other = pos_serve("--unpaced", speed="1").place
    time.sleep(2.0)
    relay.to(other)  # started after the first one, but its UPTIME has gone beyond what was seen
    relay.mend()

    assert desk.state(lambda m: m["restarted"])["connected"]


def test_a_unit_whose_time_stood_has_not_restarted(desk: PosDesk, served: Served) -> None:
    desk.ask("take", axis=3)
    desk.axis(lambda a: a["state"] == "TAKEN", 3)
    served.process.send_signal(signal.SIGSTOP)
    desk.state(lambda m: m["error"] is not None)
    time.sleep(1.5)
    served.process.send_signal(signal.SIGCONT)
    desk.state(lambda m: m["error"] is None)
    desk.live()
    assert not desk.now["restarted"]


def test_a_stop_is_confirmed_by_a_unit_that_has_restarted(
    desk: PosDesk, relay: Relay, pos_serve: Serve
) -> None:
    moving(desk)
    time.sleep(1.0)
    other = pos_serve("--unpaced", speed="1").place
    relay.muted = True
    number = desk.say("halt")
    relay.to(other)
    relay.muted = False

    assert desk.answer(number)["text"] == "all axes stand"
    assert desk.now["restarted"]
    assert desk.now["halt"] is None


def test_a_unit_that_is_absent_at_the_start_is_found_when_it_comes(relay: Relay) -> None:
    relay.muted = True
    desk = PosDesk(relay.port)
    try:
        assert desk.state(lambda m: m["error"] is not None)["error"]["kind"] == "NoAnswer"
        assert desk.now["seen_ago_s"] is None
        relay.muted = False
        assert desk.connected()["version"] == "1.00"
    finally:
        desk.close()


def test_a_port_that_is_absent_is_told_and_so_is_an_address_without_a_unit(
    tmp_path: Path, relay: Relay
) -> None:
    for port, node, kind in (
        (str(tmp_path / "none"), 1, "PortMissing"),
        (relay.port, 9, "NoAnswer"),
    ):
        desk = PosDesk(port, node)
        try:
            assert desk.state(lambda m: m["error"] is not None)["error"]["kind"] == kind
        finally:
            desk.close()


def test_another_master_is_told_and_its_requests_are(shared: tuple[PosDesk, Unit]) -> None:
    desk, other = shared
    desk.ask("take", axis=1)
    assert not desk.axis()["by_other"]
    other.axis(2).init()
    assert desk.axis(lambda a: a["by_other"], 2)["state"] == "TAKEN"
    assert not desk.axis()["by_other"]
    for _ in range(50):
        other.axis(1).read()
    assert desk.live(lambda m: m["unit"]["others"])["unit"]["others"] > 1


# ---- what a page says ----


def test_ports_of_modbus_tcp_can_be_named() -> None:
    told = {"type": "connect", "port": "modbus://127.0.0.1:502", "node": 16}
    assert read_order(json.dumps(told))[0] == Connect("modbus://127.0.0.1:502", 16)


@pytest.mark.parametrize(
    "told",
    [
        {"type": "hold", "axis": 0}, {"type": "hold", "axis": 5}, {"type": "take"},
        {"type": "control", "axis": 1, "feed": -1}, {"type": "control", "axis": 1, "feed": 1 << 32},
        {"type": "control", "axis": 1, "permitted": 1},
        {"type": "measure", "axis": 1, "um": -(2**31), "accel": 1},
        {"type": "measure", "axis": 1, "um": 1.5, "accel": 1},
        {"type": "measure", "axis": 1, "um": 1, "accel": 65_536},
        {"type": "home", "axis": 1, "method": 20, "um": 0, "accel": 1, "feed": 1},
        {"type": "write"}, {"type": "write", "values": {}},
        {"type": "write", "values": {"axis5": {}}},
        {"type": "write", "values": {"axis1": {"WATCHDOG": 10}}},
        {"type": "write", "values": {"unit": {"STEPS": 10}}},
        {"type": "write", "values": {"axis1": {"STEPS": 0}}},
        {"type": "write", "values": {"axis1": {"STEPS": True}}},
        {"type": "write", "values": {"axis1": {"POSITION": 1}}},
        {"type": "input", "input": 9, "level": 1}, {"type": "connect", "port": "x", "node": 0},
        {"type": "connect", "port": "spy:///dev/x?file=/tmp/y", "node": 1}, {"type": "jog"},
    ],
)  # fmt: skip
def test_what_is_not_possible_is_refused(told: dict[str, object]) -> None:
    with pytest.raises(BadRequest):
        read_order(json.dumps(told))
