"""The programs of all motors at once, all units of a line at once, and who is on it."""

from __future__ import annotations

import time

import pytest
from served import Served
from service_client import Service, build_with_page

RUN = "\\ C100 S100 V1000 A2000 F300 R"
LONG = "\\ C100 S500 " + "W1 F1 R " * 220
"""More than one message."""


@pytest.fixture
def browser(service):
    """A browser at a virtual unit without programs."""
    browser = service.browser()
    browser.ask("connect", port="virtual", node=1)
    browser.request("send", 0, text="\\ C100")
    browser.ask("reset")
    browser.heard.clear()
    yield browser
    browser.close()


def send_all(browser, together: bool, **texts: str):
    programs = {name[1:]: text for name, text in texts.items()}
    return browser.ask("request", message="send_all", texts=programs, together=together)


def programs(browser) -> list[str]:
    return [browser.request("program", motor)["values"]["program"] for motor in (1, 2, 3, 4)]


def positions(browser) -> list[int]:
    return list(browser.request("position", 0)["values"]["positions"].values())


def until_at(browser, *wanted: int) -> None:
    end = time.monotonic() + 20
    while positions(browser) != list(wanted):
        assert time.monotonic() < end, positions(browser)


def test_each_motor_gets_its_own_program_and_runs_it(browser):
    told = send_all(browser, False, m4="\\ C100 F4 R", m1="\\ C100 F1 R", m2="\\ C100 B2 R")

    assert told["error"] is None
    assert told["values"]["sent"] == {"1": 3, "2": 3, "4": 3}
    assert programs(browser) == ["C100F1R", "C100B2R", "", "C100F4R"]
    until_at(browser, 1, -2, 0, 4)


def test_one_error_and_nothing_is_sent_to_any_motor(browser):
    for together in (False, True):
        told = send_all(browser, together, m1=RUN, m3="F10 R\n S0", m4=RUN)

        assert told["error"]["cause"].startswith("motor 3: S (start/stop speed)")
        assert told["error"]["next"].startswith("nothing was sent to any motor")
        assert (told["error"]["motor"], told["error"]["line"], told["error"]["column"]) == (3, 2, 2)
        assert told["request_bytes"] == ""
        assert programs(browser) == [""] * 4


def test_programs_that_start_together_wait_after_a_bracket_for_all(tmp_path):
    units = Served("--tcp", "0", "--node", "3", "--control", "0", cwd=tmp_path)
    service = Service(build_with_page(tmp_path), "--port", units.place, "--node", "3")
    browser = service.browser()
    browser.connected()
    try:
        told = send_all(
            browser, True, m1=LONG, m2="\\ C100 S10 V10 F1 R", m3="\\ C100 S10 V10 F2 R"
        )
        assert told["error"] is None
        assert told["values"]["together"] is True
        until_at(browser, 220, 1, 2, 0)
        assert programs(browser)[1:] == ["[C100S10V10F1R]", "[C100S10V10F2R]", "]"]
    finally:
        assert service.end() == (0, "")
        units.end()


def test_nothing_starts_before_all_have_their_program(browser):
    """The release is the last message, to all motors, and comes when they stand."""
    browser.request("send", 2, text="\\ S100 V2000 A1000 F16000000 R")
    browser.until(lambda m: m["type"] == "live" and abs(m["motors"][1]["speed"]) > 1500)

    told = send_all(browser, True, m1="\\ C100 F5 R", m2="\\ C100 F6 R")

    assert told["request_message"] == "02 30 5D"
    frames = told["request_bytes"]
    assert frames.index("5C 5B 43") < frames.index("02 32 5C 5B") < frames.rindex("02 30 5D")
    browser.until(lambda m: m["type"] == "live" and m["motors"][0]["position"] == 5)
    until_at(browser, 5, 6, 0, 0)
    looks = [m["motors"] for m in browser.heard if m["type"] == "live"]
    assert all(motors[1]["position"] < 10 for motors in looks if motors[0]["position"] == 5)


def test_a_motor_that_waits_in_another_program_is_not_started_with_the_others(browser):
    browser.request("send", 4, text="\\ C100 [ F9 R")

    told = send_all(browser, True, m1=RUN, m2=RUN)

    assert "motor 4 waits at [" in told["error"]["cause"]
    assert programs(browser)[:2] == ["", ""]
    assert send_all(browser, True, m1="\\ C100 F1 R", m4="\\ C100 F2 R")["error"] is None
    until_at(browser, 1, 0, 0, 2)


def test_a_program_of_another_motor_is_not_changed_by_the_start_of_others(browser):
    """`]` to all motors would be stored in it, in a full memory in place of its label."""
    full = "\\ @1 " + "W1 " * 698 + "J1"
    browser.request("send", 2, text=full)
    held = programs(browser)[1]

    told = send_all(browser, True, m1=RUN, m3=RUN)

    assert "motor 2 holds another program" in told["error"]["cause"]
    assert "nothing was sent to any motor" in told["error"]["next"]
    assert programs(browser) == ["", held, "", ""]


def test_one_program_alone_touches_no_other_motor(browser):
    browser.request("send", 4, text="\\ C100 [ F9 R")

    told = send_all(browser, True, m1="\\ C100 F1 R")

    assert (told["error"], told["request_message"]) == (None, "02 31 5D")
    until_at(browser, 1, 0, 0, 0)
    assert programs(browser) == ["[C100F1R]", "", "", "C100[F9R"]


def test_programs_that_start_together_do_not_overwrite_what_has_not_run(browser):
    browser.request("send", 2, text="\\ @1 " + "W1 " * 650 + "J1")
    held = programs(browser)[1]

    told = send_all(browser, True, m1=RUN, m2="W1 " * 100)

    assert told["error"]["cause"].startswith("motor 2: ")
    assert "has room for 44 more" in told["error"]["cause"]
    assert programs(browser) == ["", held, "", ""]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("\\ [ F1 R ]", "motor 2: the program has [ or ] of its own"),
        ("\\ " + "F1 " * 699, "motor 2: the memory has no room for [ and ]"),
        ("K", "motor 2: K is no program"),
    ],
)
def test_what_cannot_wait_for_the_others_is_refused_before_anything_is_sent(browser, text, words):
    told = send_all(browser, True, m1=RUN, m2=text)

    assert words in told["error"]["cause"]
    assert "nothing was sent to any motor" in told["error"]["next"]
    assert programs(browser) == [""] * 4


def test_a_program_is_stored_only_if_it_is_the_one_in_the_memory(browser):
    browser.request("send", text="\\ F1 R")

    refused = browser.request("store", text="\\ F2 R")
    assert refused["error"]["kind"] == "UnitRefused"
    assert refused["request_bytes"] == ""
    assert browser.request("store", text="\\ F1 R")["values"] == {"stored": {"1": 2}}


def test_all_motors_are_stored_each_with_its_own_program(browser):
    send_all(browser, False, m1="\\ C100 F1 R", m2="\\ C100 F2 R", m3="\\ W5")

    told = browser.request("store", 0)

    assert told["values"] == {"stored": {"1": 3, "2": 3, "3": 1, "4": 0}}
    assert (told["request_message"], told["answer_message"]) == ("03 30", "03 30 00")


def test_all_units_of_the_line_get_a_program_and_nothing_is_known_of_it(browser):
    told = browser.request("send", 2, text="\\ C100 F7 R", everywhere=True)

    assert (told["node"], told["error"]) == (0, None)
    assert "none of them answers" in told["text"]
    assert told["request_bytes"].startswith("7E 00 ")
    assert told["answer_bytes"] is None
    for node in (1, 9, 16):
        browser.ask("connect", port="virtual", node=node)
        until_at(browser, 0, 7, 0, 0)


def test_all_units_store_when_they_are_told_to(browser):
    told = browser.request("store", 1, everywhere=True)

    assert (told["node"], told["request_message"]) == (0, "03 31")
    assert told["values"]["everywhere"] is True


def test_a_question_to_all_units_is_refused(browser):
    browser.say(type="request", message="position", motor=1, everywhere=True)

    assert "none of them answers" in browser.next("error")["error"]["cause"]


def test_a_scan_tells_who_is_there_and_only_asks(tmp_path):
    units = Served("--tcp", "0", "--node", "3", "--node", "11", cwd=tmp_path)
    service = Service(build_with_page(tmp_path), "--port", units.place, "--node", "3")
    browser = service.browser()
    browser.connected()
    try:
        told = browser.ask("request", message="scan")

        assert [(each["node"], each["remark"]) for each in told["values"]["found"]] == [
            (3, ""),
            (11, ""),
        ]
        assert told["text"] == "units that answer: 3, 11"
        assert all(each["version"] and each["date"] for each in told["values"]["found"])
        values = [m["value"] for m in browser.heard if m["type"] == "progress"]
        assert (len(values), values[-1]) == (17, 1)
        assert browser.request("program", 1)["values"] == {"program": ""}
    finally:
        assert service.end() == (0, "")
        units.end()


@pytest.mark.parametrize("text", ["K", "C75", "V500", " K { stop } "])
def test_what_acts_only_alone_goes_alone_to_the_motor_that_is_chosen(browser, text):
    wanted = text.split("{")[0].strip()

    told = browser.request("send", 3, text=text)

    assert told["error"] is None
    assert told["request_message"] == "02 33 " + wanted.encode().hex(" ").upper()


def test_a_motor_is_stopped_and_goes_on_alone_by_texts(browser):
    send_all(browser, False, m1="\\ C100 S500 V500 G+", m2="\\ C100 S500 V500 G+")
    browser.moves(2)
    browser.request("send", 1, text="K")
    browser.stands(1)
    browser.moves(2)

    browser.request("send", 1, text="C75")
    browser.moves(1)


@pytest.mark.parametrize(
    "told",
    [
        {"message": "send_all"},
        {"message": "send_all", "texts": {}},
        {"message": "send_all", "texts": {"5": "R"}},
        {"message": "send_all", "texts": {"1": ""}},
        {"message": "send_all", "texts": {"1": 5}},
        {"message": "send_all", "texts": ["R"]},
        {"message": "send_all", "texts": {"1": "R"}, "together": 1},
        {"message": "send", "motor": 1, "text": "R", "everywhere": "yes"},
    ],
)
def test_nonsense_is_answered_and_nothing_is_sent(browser, told):
    browser.say(type="request", **told)

    assert browser.next("error")["error"]["kind"] == "BadRequest"
    assert programs(browser) == [""] * 4
