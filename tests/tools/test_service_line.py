"""What browsers do with units: over web sockets, with virtual units in real time."""

from __future__ import annotations

import fcntl
import os
import pty
import signal
import statistics
import time
import tty
from pathlib import Path

import pytest
from served import Served
from service_client import Service, build_with_page

LONG = "\\ S100 V1000 A2000 " + "W16000000 " * 600
"""Takes two to three seconds on the line."""


@pytest.fixture
def start(tmp_path):
    build = build_with_page(tmp_path)
    started = []

    def begin(*arguments: str) -> Service:
        started.append(Service(build, *arguments))
        return started[-1]

    yield begin
    for service in started:
        status, complaint = service.end()
        assert (status, complaint) == (0, "")


@pytest.fixture
def browser(service):
    """A browser at a virtual unit that is as if it were new."""
    browser = service.browser()
    browser.ask("connect", port="virtual", node=1)
    browser.ask("reset")
    browser.say(type="input", input=3, level=0)
    browser.until(
        lambda m: m["type"] == "live" and not any(motor["moving"] for motor in m["motors"])
    )
    browser.request("send", 0, text="\\ C100 C02")
    browser.ask("reset")
    browser.heard.clear()
    yield browser
    browser.close()


@pytest.fixture
def units(tmp_path):
    served = Served("--tcp", "0", "--control", "0", "--node", "3", cwd=tmp_path)
    yield served
    served.end()


def test_it_connects_to_a_unit_of_its_own_and_nothing_moves(start):
    service = start()
    browser = service.browser()
    hello = browser.next("hello")
    browser.connected()
    live = [browser.next("live") for _ in range(3)]

    assert hello["client"] == 1
    assert service.browser().next("hello")["client"] == 2

    assert not any(motor["moving"] for look in live for motor in look["motors"])
    assert browser.request("program")["values"] == {"program": ""}


@pytest.mark.parametrize(
    ("message", "motor", "request_message", "answer_message"),
    [
        ("position", 1, "04 31", "04 31 0A 20 20 20 20 20 20 20 20 20 30"),
        ("program", 2, "05 32", "05 32"),
        ("table", 3, "06 33", "06 33 20 20 30 3B 5B 5D"),
        ("progress", 4, "07 34", "07 34 20 20 20 20 20 30 3B 20 30"),
        ("program", 0, "05 30", "05 30 45 52 52 4F 52 20 43 4F 4D 4D 41 4E 44 21 20"),
        ("table", 0, "06 30", "06 30 45 52 52 4F 52 20 43 4F 4D 4D 41 4E 44 21 20"),
        ("progress", 0, "07 30", "07 30 45 52 52 4F 52 20 43 4F 4D 4D 41 4E 44 21 20"),
        ("store", 1, "03 31", "03 31 00"),
    ],
)
def test_answers_are_the_bytes_of_the_manual(
    browser, message, motor, request_message, answer_message
):
    told = browser.request(message, motor)

    assert told["error"] is None
    assert (told["request_message"], told["answer_message"]) == (request_message, answer_message)
    assert told["request_bytes"].startswith("7E 01 ")
    assert told["answer_bytes"].startswith("7E 81 ")
    assert answer_message in told["answer_bytes"]


def test_a_version_is_told_in_words_values_and_bytes(browser):
    told = browser.request("version", 0)

    assert told["request_message"] == "01"
    assert told["answer_message"].startswith("01 10 ")
    assert bytes.fromhex(told["answer_message"])[2:].decode()[:5] == told["values"]["version"]
    assert told["text"].startswith("version ")


def test_a_program_is_sent_and_its_bytes_are_those_of_the_manual(browser):
    told = browser.request("send", 3, text="C100")
    assert (told["request_message"], told["answer_message"]) == (
        "02 33 43 31 30 30",
        "02 33 00 00",
    )
    assert browser.request("program", 3)["answer_message"] == "05 33 43 31 30 30"


def test_a_program_moves_the_motor_and_a_stop_stops_it(browser):
    browser.request("send", text="\\ S100 V1000 A20000 F16000000 R")
    moving = browser.moves()

    told = browser.ask("stop")
    standing = browser.stands()

    assert told["request_message"] == "02 30 4B"
    assert moving["motors"][0]["position"] < standing["motors"][0]["position"] < 16_000_000
    assert standing["motors"][1]["position"] == 0
    assert browser.ask("resume")["error"] is None
    assert browser.moves()["motors"][0]["position"] >= standing["motors"][0]["position"]


def test_the_live_view_tells_the_speed(browser):
    browser.request("send", text="\\ S2000 V2000 F16000000 R")
    browser.moves()

    looks = [browser.next("live") for _ in range(12)]

    speeds = sorted(look["motors"][0]["speed"] for look in looks[2:])
    assert 1800 < speeds[len(speeds) // 2] < 2200, (
        speeds
    )  # a look may be held up by whatever else runs


def test_a_counter_that_is_written_is_no_motion(browser):
    browser.request("send", text="\\ S1000 F700 R =100000 W200 C100")
    browser.until(lambda m: m["type"] == "live" and m["motors"][0]["position"] == 100_000)
    browser.until(lambda m: m["type"] == "live" and m["motors"][0]["position"] == 0)

    speeds = [m["motors"][0]["speed"] for m in browser.heard if m["type"] == "live"]
    assert 0 < max(speeds) < 1500
    assert min(speeds) == 0


def test_a_speed_and_a_reset_are_sent_to_one_motor(browser):
    browser.request("send", 2, text="\\ S100 V100 A20000 F16000000 R")
    browser.moves(2)

    told = browser.ask("speed", motor=2, value=9000)
    browser.until(lambda m: m["type"] == "live" and m["motors"][1]["speed"] > 5000)
    reset = browser.ask("reset", motor=2)
    browser.stands(2)

    assert told["request_message"] == "02 32 " + b"V9000".hex(" ").upper()
    assert reset["request_message"] == "02 32 5C"
    assert browser.request("program", 2)["values"] == {"program": ""}


def test_a_speed_of_a_motor_that_stands_is_not_sent(browser):
    browser.request("send", 2, text="\\ S100 V100")

    told = browser.ask("speed", motor=2, value=9000)

    assert "motor 2 stands: nothing was sent" in told["error"]["cause"]
    assert browser.request("program", 2)["values"] == {"program": "S100V100"}


def test_inputs_of_the_virtual_unit_can_be_set(browser):
    browser.request("send", text="\\ S1000 O03 T02 F100 R")
    browser.say(type="input", input=3, level=1)

    look = browser.until(lambda m: m["type"] == "live" and m["motors"][0]["position"] == 100)

    assert look["inputs"] == [0, 0, 1, 0, 0, 0, 0, 0]
    assert look["outputs"] == [0, 1, 0, 0, 0, 0, 0, 0]


def test_a_long_program_tells_its_progress(browser):
    number = browser.begin("request", message="send", motor=1, text=LONG)
    told = browser.answer(number)

    values = [m["value"] for m in browser.heard if m["type"] == "progress" and m["id"] == number]
    assert told["values"]["commands"] == 603
    assert values == sorted(values)
    assert (values[0], values[-1]) == (0, 1)
    assert len(values) == told["values"]["messages"] + 1 > 4


def test_a_stop_interrupts_a_long_program_and_goes_ahead_of_what_waits(browser):
    browser.request("send", 2, text="\\ S100 V1000 A20000 F16000000 R")
    browser.moves(2)
    sending = browser.begin("request", message="send", motor=1, text=LONG)
    waiting = [browser.begin("request", message="version", motor=0) for _ in range(3)]
    resuming = browser.begin("resume")
    browser.until(lambda m: m["type"] == "progress" and m["value"] > 0)

    started = time.monotonic()
    stop = browser.begin("stop")
    told = browser.answer(stop)
    seconds = time.monotonic() - started
    browser.stands(2)
    browser.quiet(1.0)

    answers = {m["id"]: m for m in browser.heard if m["type"] == "answer"}
    assert told["error"] is None
    assert seconds < 1.5  # of the three that the whole takes; a frame takes 0.6
    for number in [sending, *waiting, resuming]:
        assert answers[number]["error"]["kind"] == "Stopped"
    assert browser.request("position", 2)["values"] == browser.request("position", 2)["values"]
    assert browser.request("send", 1, text="\\ F1 R")["error"] is None


def test_what_was_asked_too_long_ago_is_refused_but_a_stop_is_not(browser):
    beat = browser.next("beat")["beat"]
    time.sleep(2.1)

    late = browser.request("send", text="\\ F100 R", beat=beat)
    browser.say(type="input", input=3, level=1, beat=beat)
    refused = browser.next("error")
    stopped = browser.ask("stop", beat=beat)
    in_time = browser.request("program", beat=browser.next("beat")["beat"])

    assert late["error"]["kind"] == refused["error"]["kind"] == "Late"
    assert late["request_bytes"] == ""
    assert stopped["error"] is None
    assert in_time["values"] == {"program": ""}
    assert browser.live(lambda m: True)["inputs"][2] == 0


@pytest.mark.parametrize(
    "nodes", [None, 5, "x", [5], [{"port": "x"}], [{"node": "1"}], [{"node": 99}]]
)
def test_a_stop_is_obeyed_whatever_it_says_of_nodes(browser, nodes):
    assert browser.ask("stop", nodes=nodes)["error"] is None


def test_orders_after_a_stop_are_obeyed(browser):
    stop, after = browser.begin("stop"), browser.begin("request", message="version", motor=0)

    assert browser.answer(stop)["error"] is None
    assert browser.answer(after)["error"] is None


def test_two_browsers_see_the_same(service, browser):
    other = service.browser()
    other.connected()
    number = browser.begin("request", message="send", motor=1, text="\\ S100 F5000 R")

    mine, theirs = browser.answer(number), other.next("answer")

    assert mine == theirs
    assert theirs["from"] != other.heard[0]["client"]
    assert other.moves()["motors"][0]["position"] > 0


def test_a_browser_that_comes_and_goes_changes_nothing(service, browser):
    browser.request("send", text="\\ S100 V1000 F16000000 R")
    browser.moves()
    browser.close()
    for _ in range(3):
        service.browser().close()

    again = service.browser()
    assert again.connected()["port"] == "virtual"
    assert again.moves()["motors"][0]["position"] > 0
    assert again.quiet(0.5) == []
    assert again.request("program")["values"]["program"] == "S100V1000F16000000R"


def test_a_wrong_program_is_refused_with_its_place_and_nothing_is_sent(browser):
    told = browser.request("send", text="F100 R\n  Q")

    assert told["error"]["line"] == 2
    assert told["error"]["column"] == 3
    assert told["error"]["cause"] == 'unknown command "Q"'
    assert told["request_bytes"] == ""
    assert browser.request("program")["values"] == {"program": ""}


def test_every_address_of_the_virtual_line_has_a_unit(browser):
    browser.request("send", text="\\ S1000 F7 R")
    browser.until(lambda m: m["type"] == "live" and m["motors"][0]["position"] == 7)

    other = browser.ask("connect", port="virtual", node=16)
    there = browser.request("position")
    browser.ask("connect", port="virtual", node=1)

    assert other["request_bytes"].startswith("7E 10 ")
    assert there["values"] == {"positions": {"1": 0}}
    assert browser.request("position")["values"] == {"positions": {"1": 7}}


def test_what_was_stored_runs_again_after_the_virtual_unit_was_lost(start):
    service = start()
    browser = service.browser()
    browser.connected()
    browser.request("send", text="\\ S1000 F7 R")
    browser.request("store")
    kill_units(service)

    lost = browser.until(lambda m: m["type"] == "state" and not m["connected"])
    refused = browser.request("version", 0)
    browser.ask("connect", port="virtual", node=1)

    assert lost["error"]["kind"] == "PortLost"
    assert refused["error"]["kind"] == "NotConnected"
    browser.until(lambda m: m["type"] == "live" and m["motors"][0]["position"] == 7)


def kill_units(service: Service) -> None:
    """End the virtual units of a service, as a fault would."""
    for task in Path(f"/proc/{service.process.pid}/task").iterdir():
        for child in map(int, (task / "children").read_text().split()):
            os.kill(child, signal.SIGKILL)


def test_after_disconnecting_nothing_is_sent(browser):
    browser.ask("disconnect")

    assert browser.request("version", 0)["error"]["kind"] == "NotConnected"
    assert browser.ask("stop")["error"]["kind"] == "NotConnected"
    assert browser.ask("reset")["request_bytes"] == ""
    assert browser.ask("connect", port="virtual", node=1)["error"] is None


def test_another_line_is_watched_by_its_messages(units, start):
    browser = start("--port", units.place, "--node", "3").browser()
    state = browser.connected()
    browser.request("send", text="\\ S500 V500 F16000000 R")
    look = browser.moves()

    assert (state["port"], state["virtual"], state["node"]) == (units.place, False, 3)
    assert (look["inputs"], look["outputs"]) == ([0] * 8, [0] * 8)
    speeds = [browser.next("live")["motors"][0]["speed"] for _ in range(10)][2:]
    assert 400 < statistics.median(speeds) < 600
    browser.say(type="input", input=1, level=1)
    assert browser.next("error")["error"]["kind"] == "BadRequest"


def test_a_unit_that_vanishes_is_told_and_comes_back_on_demand(units, start, tmp_path):
    browser = start("--port", units.place, "--node", "3").browser()
    browser.connected()
    units.end()

    lost = browser.until(lambda m: m["type"] == "state" and not m["connected"])
    again = browser.ask("connect", port=units.place, node=3)

    assert lost["error"]["kind"] == "PortLost"
    assert again["error"]["kind"] == "PortMissing"
    port = units.place.rpartition(":")[2]
    back = Served("--tcp", port, "--node", "3", cwd=tmp_path)
    assert browser.ask("connect", port=units.place, node=3)["error"] is None
    back.end()


def test_a_silent_unit_is_told_and_the_port_stays_open(units, browser):
    told = browser.ask("connect", port=units.place, node=5)
    assert told["error"]["kind"] == "NoAnswer"

    browser.ask("disconnect")

    (told,) = (m for m in browser.heard if m["type"] == "state" and m["error"] and not m["busy"])
    assert told["connected"]
    assert told["error"]["kind"] == "NoAnswer"


def test_a_stop_does_not_wait_for_a_unit_that_is_silent(units, browser):
    browser.ask("connect", port=units.place, node=5)
    asking = browser.begin("request", message="store", motor=1)
    browser.until(lambda m: m["type"] == "state" and m["busy"] == "store")

    started = time.monotonic()
    told = browser.answer(browser.begin("stop"))

    assert told["error"]["kind"] == "NotConfirmed"
    assert time.monotonic() - started < 2.5  # four attempts of K
    (given_up,) = (m for m in browser.heard if m["type"] == "answer" and m["id"] == asking)
    assert given_up["error"]["kind"] == "Stopped"


@pytest.mark.parametrize(
    ("port", "kind"),
    [
        ("/dev/there-is-none", "PortMissing"),
        ("socket://127.0.0.1:1", "PortMissing"),
        ("socket://nonsense", "Failure"),
        ("/dev/null", "PortError"),
        ("\0", "PortError"),
    ],
)
def test_a_port_that_cannot_be_opened_is_an_error_in_words(browser, port, kind):
    told = browser.ask("connect", port=port, node=1)

    assert told["error"]["kind"] == kind
    assert told["error"]["next"]
    assert browser.ask("connect", port="virtual", node=1)["error"] is None


def test_a_busy_port_is_an_error_in_words(browser):
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    fcntl.flock(theirs, fcntl.LOCK_EX | fcntl.LOCK_NB)
    told = browser.ask("connect", port=os.ttyname(theirs), node=1)
    os.close(ours)
    os.close(theirs)

    assert told["error"]["kind"] == "PortBusy"


def test_ports_are_listed_the_virtual_one_first(browser):
    browser.say(type="ports")
    ports = browser.next("ports")["ports"]

    assert ports[0]["port"] == "virtual"
    assert all(port["label"] for port in ports)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "x",
        "[]",
        "null",
        "{}",
        "[" * 100_000,
        '{"type": 5}',
        '{"type": ["stop"]}',
        '{"type": "connect"}',
        '{"type": "connect", "port": "", "node": 1}',
        '{"type": "connect", "port": "virtual", "node": 0}',
        '{"type": "connect", "port": "virtual", "node": 17}',
        '{"type": "connect", "port": "virtual", "node": "1"}',
        '{"type": "connect", "port": "virtual", "node": true}',
        '{"type": "connect", "port": "spy:///dev/ttyS0?file=/tmp/x", "node": 1}',
        '{"type": "request"}',
        '{"type": "request", "message": "format", "motor": 1}',
        '{"type": "request", "message": ["send"], "motor": 1}',
        '{"type": "request", "message": "send", "motor": 1}',
        '{"type": "request", "message": "send", "motor": 5, "text": "R"}',
        '{"type": "request", "message": "send", "motor": -1, "text": "R"}',
        '{"type": "request", "message": "send", "text": "R"}',
        '{"type": "request", "message": "send", "motor": 1, "text": 7}',
        '{"type": "request", "message": "version", "id": "one"}',
        '{"type": "request", "message": "version", "id": 1e300}',
        '{"type": "speed", "motor": 1, "value": 0}',
        '{"type": "speed", "motor": 1, "value": 16001}',
        '{"type": "speed", "motor": 1}',
        '{"type": "input", "input": 9, "level": 1}',
        '{"type": "input", "input": 1, "level": 2}',
        '{"type": "input"}',
    ],
)
def test_nonsense_is_answered_and_changes_nothing(browser, text):
    browser.say_raw(text)

    told = browser.next("error")["error"]

    assert told["kind"] == "BadRequest"
    assert told["cause"]
    assert browser.request("version", 0)["error"] is None


def test_bytes_end_only_the_browser_that_sends_them(service, browser):
    service.browser().say_raw(b"\x00\x01")

    assert browser.request("version", 0)["error"] is None


def test_a_text_that_is_too_long_is_refused(browser):
    browser.say(type="request", message="send", motor=1, text="R" * 1_000_001)

    assert browser.next("error")["error"]["kind"] == "TooLarge"


def test_a_flood_of_orders_is_refused_in_words_and_a_stop_comes_through(start):
    """Of a service of its own: a stop is for all units that were ever seen."""
    browser = start().browser()
    browser.ask("connect", port="virtual", node=1)
    for _ in range(150):
        browser.say(type="request", message="program", motor=1)

    assert browser.next("error")["error"]["cause"] == "too much is waiting for the line"
    assert browser.ask("stop")["error"] is None
    browser.quiet(0.5)
