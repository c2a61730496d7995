"""The page of a positioning unit: motion, stops, settings, and what must not be overlooked."""

from __future__ import annotations

import gzip
import json
import re
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from page_looks import check_looks
from playwright.sync_api import Browser, Page, expect
from pos_page import PosPage, PosService, pos_shown
from relay import Relay
from rkm04_tools.positioning.settings import read_values
from rkm04_tools.positioning.unit import open_unit
from served import POSITIONING_COMMAND, Served
from service_page import NOT_KNOWN
from tab import visited

BUILD = Path(__file__).resolve().parents[2] / "build"
ZIPPED_BYTES_MAX = 59_000
Serve = Callable[..., Served]


@pytest.fixture
def service() -> Iterator[PosService]:
    """With a virtual unit."""
    service = PosService()
    yield service
    service.end()


@pytest.fixture
def page(tab: Page, service: PosService) -> Iterator[PosPage]:
    with visited(PosPage, tab, service.url) as page:
        yield page.ready()


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """Start units that end with the test."""
    started: list[Served] = []

    def start(place: str = "--tcp") -> Served:
        more = ("--control", "0", "--unpaced")
        started.append(Served(place, "0", *more, cwd=tmp_path, command=POSITIONING_COMMAND))
        return started[-1]

    yield start
    for served in started:
        served.end()


@pytest.fixture
def relay(serve: Serve) -> Iterator[Relay]:
    relay = Relay(serve().place)
    yield relay
    relay.close()


@pytest.fixture
def line_service(relay: Relay) -> Iterator[PosService]:
    service = PosService("--port", relay.port)
    yield service
    service.end()


@pytest.fixture
def line_page(tab: Page, line_service: PosService) -> Iterator[PosPage]:
    with visited(PosPage, tab, line_service.url) as page:
        yield page.ready()


def test_an_axis_moves_to_its_measure_and_its_bits_tell(page: PosPage) -> None:
    page.doing("FREE")
    assert set(page.sent) <= {"ports"}
    page.move("62.5", "1200")
    page.doing("MOVING")
    expect(page.bit("JEDE")).to_have_attribute("data-level", "1")
    expect(page.at("target-1")).to_contain_text("to 62.500 mm · 6,250 steps ·")
    expect(page.at("speed-1")).to_have_text(re.compile(r"[1-9][\d,.]* mm/min"))
    page.doing("REACHED")
    expect(page.at("position-1")).to_have_text("62.500 mm")
    expect(page.at("steps-1")).to_have_text("6,250 steps")
    for name, level in (("JEDE", 0), ("POL", 1), ("DISP", 1), ("PROG", 1), ("ERR", 0), ("MP", 1)):
        expect(page.bit(name)).to_have_attribute("data-level", str(level))
    page.at("release-1").click()
    page.doing("FREE")


def test_a_measure_waits_for_go_and_a_position_is_gone_to(page: PosPage) -> None:
    expect(page.at("measure-2")).to_be_disabled()
    page.at("take-2").click()
    page.doing("TAKEN", 2)
    page.at("kind-2").select_option("position")
    page.at("way-2").fill("-3")
    page.confirm_danger()
    page.at("measure-2").click()
    page.doing("READY", 2)
    expect(page.at("asked-2")).to_have_text("asked: 0 mm/min, permitted")
    page.at("go-2").click()
    page.doing("REACHED", 2)
    expect(page.at("position-2")).to_have_text("\N{MINUS SIGN}3.000 mm")
    expect(page.bit("SMER", 2)).to_have_attribute("data-level", "1")


def test_a_hold_is_confirmed_and_go_goes_on(page: PosPage) -> None:
    page.move("100")
    page.beyond(1)
    page.at("hold-1").click()
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    expect(page.at("alarm")).to_contain_text("Hold is confirmed: axis 1 stands at")
    page.doing("READY")
    expect(page.at("asked-1")).to_have_text("asked: 600 mm/min, NOT permitted")
    expect(page.bit("MP")).to_have_attribute("data-level", "0")
    stands = page.mm()
    page.page.wait_for_timeout(700)
    assert page.mm() == stands
    page.at("go-1").click()
    page.beyond(stands + 1)


def test_escape_stops_all_axes(page: PosPage) -> None:
    page.move("1000")
    page.move("1000", axis=3)
    page.beyond(1, 3)
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("STOP is confirmed: all axes stand: 1 at")
    page.doing("READY", 1)
    page.doing("READY", 3)
    expect(page.at("feed-value-3")).to_have_value("600")
    page.at("go-3").click()
    page.doing("MOVING", 3)
    page.at("stop").click()
    page.doing("READY", 3)


def test_the_feed_slider_acts_in_motion_and_waits_elsewhere(page: PosPage) -> None:
    page.at("take-1").click()
    page.doing("TAKEN")
    slider = page.at("feed-1")
    slider.focus()
    for _ in range(3):
        page.page.keyboard.press("ArrowRight")
    assert "control" not in page.sent
    page.move("1000", "600")
    page.doing("MOVING")
    before = slider.input_value()
    slider.focus()
    page.page.keyboard.press("PageDown")
    assert int(slider.input_value()) < int(before)
    expect(page.at("speed-1")).to_have_text(re.compile(r"^[1-4]?\d\d?(\.\d)? mm/min"))
    expect(slider).to_have_attribute("aria-valuetext", re.compile(r"mm/min"))
    page.at("feed-value-1").fill("1500")
    page.page.keyboard.press("Enter")
    expect(page.at("speed-1")).to_have_text("1,500 mm/min")
    page.page.keyboard.press("Escape")


def test_an_error_tells_its_cause_and_init_clears_it(page: PosPage) -> None:
    page.setting("LIMIT_PLUS").fill("3")
    page.at("settings-write").click()
    expect(page.answers.first).to_contain_text("written: axis1 LIMIT_PLUS")
    page.move("1000")
    page.doing("MOVING")
    page.page.get_by_role("button", name="BI3").click()
    page.doing("FAULT")
    expect(page.at("trouble-1")).to_contain_text("Error 7: a limit input is active.")
    expect(page.bit("LIMIT_PLUS")).to_have_attribute("data-level", "1")
    expect(page.at("move-1")).to_be_disabled()
    page.at("take-1").click()
    expect(page.at("trouble-1")).to_be_empty()
    page.move("-1")
    page.doing("REACHED")


def test_homing_and_capture(page: PosPage) -> None:
    page.page.locator("#axis-1 summary").click()
    page.at("method-1").select_option("37")
    page.at("reference-1").fill("25.5")
    page.confirm_danger()
    page.at("home-1").click()
    expect(page.at("position-1")).to_have_text("25.500 mm")
    expect(page.bit("REFERENCED")).to_have_attribute("data-level", "1")
    page.at("capture-1").click()
    expect(page.at("trouble-1")).to_contain_text("Error 12")
    page.at("release-1").click()
    page.doing("FREE")
    page.setting("CAPTURE").fill("8")
    page.setting("REFERENCE").fill("2")
    page.at("settings-write").click()
    expect(page.answers.first).to_contain_text("axis1 REFERENCE")
    page.at("capture-1").click()
    expect(page.bit("ARMED")).to_be_visible()
    page.page.get_by_role("button", name="BI8").click()
    expect(page.at("captured-1")).to_have_text("25.500 mm (capture 1)")
    page.at("method-1").select_option("19")
    page.at("home-1").click()
    expect(page.bit("HOMING")).to_be_visible()
    home_switch = page.page.get_by_role("button", name="BI2")
    home_switch.click()
    expect(home_switch).to_have_attribute("data-level", "1")
    page.page.wait_for_timeout(500)  # the axis turns, and is on its way back to the switch's edge
    home_switch.click()
    page.doing("REACHED")
    expect(page.at("position-1")).to_have_text("25.500 mm")


def test_settings_are_edited_written_stored_saved_and_opened(page: PosPage, tmp_path: Path) -> None:
    page.part("axis2")
    page.setting("STEPS").fill("1600")
    page.setting("MICROMETRES").fill("5000")
    page.setting("HIGHEST_FEED").fill("1200.5")
    expect(page.at("settings-words")).to_contain_text("Changed and not written: Axis 2.")
    page.at("settings-write").click()
    expect(page.answers.first).to_contain_text("axis2 STEPS")
    expect(page.at("facts")).to_contain_text("settings are not as stored")
    page.at("settings-store").click()
    expect(page.at("facts")).not_to_contain_text("not as stored")
    with page.page.expect_download() as download:
        page.at("settings-save").click()
    content = Path(download.value.path()).read_text()
    assert read_values(content, "file")["axis2"]["HIGHEST_FEED"] == round(1200.5 * 65_536)

    other = json.loads(content)
    other["settings"]["unit"]["WATCHDOG"] = 500
    other["settings"]["axis2"]["STEPS"] = 800
    file = tmp_path / "other.json"
    file.write_text(json.dumps(other))
    page.at("settings-file").set_input_files(file)
    expect(page.at("settings-write")).to_have_text("Write (2)")
    expect(page.setting("STEPS")).to_have_value("800")
    page.at("settings-undo").click()
    expect(page.setting("STEPS")).to_have_value("1600")
    file.write_text("{}")
    page.at("settings-file").set_input_files(file)
    expect(page.at("settings-words")).to_contain_text("it is of another kind")
    page.at("language").select_option("cs")
    page.at("settings-file").set_input_files(file)
    expect(page.at("settings-words")).to_contain_text("je jiného druhu; nic se nezapsalo")
    page.at("language").select_option("en")
    page.at("settings-deliver").click()
    expect(page.at("settings-deliver")).to_have_text("Sure? For all axes")
    page.at("settings-deliver").click()
    expect(page.setting("STEPS")).to_have_value("1")
    page.part("unit")
    expect(page.setting("RATE")).to_have_value("192")


def test_a_file_of_settings_may_begin_with_the_mark_that_windows_editors_write(
    page: PosPage, tmp_path: Path
) -> None:
    with page.page.expect_download() as download:
        page.at("settings-save").click()
    other = json.loads(Path(download.value.path()).read_text())
    other["settings"]["unit"]["WATCHDOG"] = 500
    file = tmp_path / "marked.json"
    file.write_text(json.dumps(other, indent=2), encoding="utf-8-sig", newline="\r\n")
    page.at("settings-file").set_input_files(file)
    expect(page.at("settings-write")).to_have_text("Write (1)")


def test_settings_wait_for_axes_that_are_taken(page: PosPage) -> None:
    page.setting("BACKLASH").fill("20")
    page.at("take-1").click()
    expect(page.at("settings-words")).to_contain_text("Axis 1 is taken or moves")
    expect(page.at("settings-write")).to_be_disabled()
    expect(page.at("settings-store")).to_be_disabled()
    expect(page.setting("STEPS")).to_be_disabled()
    page.part("axis2")
    expect(page.setting("STEPS")).to_be_enabled()
    page.part("unit")
    expect(page.setting("WATCHDOG")).to_be_disabled()
    page.at("release-1").click()
    page.at("settings-write").click()
    expect(page.answers.first).to_contain_text("written: axis1 BACKLASH")


def test_what_is_no_value_is_not_sent(page: PosPage) -> None:
    page.setting("LIMIT_PLUS").fill("9")
    expect(page.setting("LIMIT_PLUS")).to_have_attribute("aria-invalid", "true")
    expect(page.at("settings-write")).to_be_disabled()
    page.at("way-1").fill("")
    page.confirm_danger()
    page.at("move-1").click()
    assert set(page.sent) <= {"ports"}


def test_curves_have_what_was_made_and_what_was_asked(page: PosPage) -> None:
    page.move("20")
    page.doing("REACHED")
    expect(page.at("curves")).to_have_attribute("data-samples", re.compile(r"[1-9]\d+"))
    for name in ("curve-speed", "curve-position"):
        drawn = page.page.evaluate(
            """name => {
                const canvas = document.querySelector(`#${name} canvas`);
                const { width, height } = canvas;
                const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
                return data.reduce((sum, value) => sum + (value > 0 ? 1 : 0), 0);
            }""",
            name,
        )
        assert drawn > 1000


def test_two_windows_see_the_same_and_either_stops(
    page: PosPage, browser: Browser, service: PosService
) -> None:
    page.move("1000")
    page.beyond(1)
    with pos_shown(browser, service.url) as second:
        second.ready()
        second.doing("MOVING")
        second.at("stop").click()
        page.doing("READY")


def test_a_silent_unit_in_motion_is_told_in_the_largest_letters(
    line_page: PosPage, relay: Relay
) -> None:
    page = line_page
    page.move("1000")
    page.beyond(1)
    relay.muted = True

    expect(page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    size = page.at("loud").evaluate("part => parseFloat(getComputedStyle(part).fontSize)")
    assert size >= 22
    expect(page.at("position-1")).to_have_text(NOT_KNOWN)
    expect(page.at("state-1")).to_have_text("not known")
    expect(page.bit("JEDE")).to_have_attribute("data-level", "unknown")
    expect(page.at("move-2")).to_be_disabled()
    expect(page.setting("STEPS")).to_be_disabled()
    expect(page.at("hold-1")).to_be_enabled()
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_text("STOP NOT CONFIRMED: USE THE EMERGENCY STOP")
    assert page.at("alarm").evaluate("part => parseFloat(getComputedStyle(part).fontSize)") >= 26
    page.page.reload()
    expect(page.at("alarm")).to_have_text("STOP NOT CONFIRMED: USE THE EMERGENCY STOP")
    relay.muted = False
    page.ready()
    expect(page.at("loud")).to_be_hidden()
    page.doing("MOVING")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")


def test_a_cable_that_is_pulled_in_motion_is_told_and_seen_again(
    line_page: PosPage, relay: Relay
) -> None:
    page = line_page
    page.move("1000")
    page.beyond(1)
    relay.cut()

    expect(page.at("loud")).to_contain_text("THE PORT IS NOT THERE")
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    expect(page.at("banner")).to_contain_text("It is opened again when it is there")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_text("STOP NOT CONFIRMED: USE THE EMERGENCY STOP")
    relay.mend()
    page.ready()
    page.doing("MOVING")
    expect(page.at("loud")).to_be_hidden()


def test_a_line_that_is_given_up_in_motion_is_told(line_page: PosPage) -> None:
    page = line_page
    page.move("1000")
    page.beyond(1)
    page.at("connect").click()
    expect(page.at("left-units")).to_contain_text("NOT CONNECTED: THIS PAGE CANNOT STOP")
    page.at("connect").click()
    page.ready()
    expect(page.at("left-units")).to_be_hidden()


def test_a_unit_that_is_absent_at_the_start_is_told_and_found(
    browser: Browser, relay: Relay
) -> None:
    relay.muted = True
    service = PosService("--port", relay.port)
    try:
        with pos_shown(browser, service.url) as page:
            expect(page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
            expect(page.at("loud")).not_to_contain_text("MOVE")
            expect(page.at("position-1")).to_have_text(NOT_KNOWN)
            relay.muted = False
            page.ready()
            expect(page.at("loud")).to_be_hidden()
            assert set(page.sent) <= {"ports"}
    finally:
        service.end()


def test_a_port_that_is_absent_is_told(browser: Browser, tmp_path: Path) -> None:
    service = PosService("--port", str(tmp_path / "none"))
    try:
        with pos_shown(browser, service.url) as page:
            expect(page.at("loud")).to_contain_text("THE PORT IS NOT THERE")
            expect(page.at("banner")).to_contain_text("no such port")
    finally:
        service.end()


def test_a_unit_that_restarts_in_motion_is_told_until_somebody_has_noted_it(
    line_page: PosPage, relay: Relay, serve: Serve
) -> None:
    page = line_page
    page.move("1000")
    page.beyond(1)
    relay.to(serve().place)

    expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
    page.ready()
    page.doing("FREE")
    expect(page.at("move-1")).to_be_disabled()
    page.page.reload()
    expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
    page.confirm_danger()
    expect(page.at("move-1")).to_be_disabled()
    page.at("seen").click()
    expect(page.at("loud")).to_be_hidden()
    expect(page.at("move-1")).to_be_enabled()


def test_another_master_is_told(browser: Browser, serve: Serve) -> None:
    place = serve("--modbus-tcp").place
    service = PosService("--port", place)
    try:
        with pos_shown(browser, service.url) as page, open_unit(place) as other:
            page.ready()
            other.axis(2).init()
            expect(page.at("loud")).to_contain_text("ANOTHER MASTER GIVES ORDERS TO AXIS 2")
            expect(page.at("trouble-2")).to_contain_text("ANOTHER MASTER")
            expect(page.at("loud")).to_be_hidden()
    finally:
        service.end()


def test_a_service_that_stands_still_is_noticed_and_clicks_meanwhile_never_act(
    line_page: PosPage, line_service: PosService
) -> None:
    page = line_page
    page.confirm_danger()
    line_service.tell(signal.SIGSTOP)
    page.at("move-1").click()
    expect(page.at("banner")).to_contain_text("cannot stop anything")
    expect(page.at("position-1")).to_have_text(NOT_KNOWN)
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_text("STOP NOT CONFIRMED: USE THE EMERGENCY STOP")

    line_service.tell(signal.SIGCONT)
    page.ready()
    page.page.wait_for_timeout(1000)
    page.doing("FREE")
    expect(page.at("alarm")).to_have_text("STOP NOT CONFIRMED: USE THE EMERGENCY STOP")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")


def test_everything_is_reached_by_keys(page: PosPage) -> None:
    page.at("take-1").click()
    page.doing("TAKEN")
    page.confirm_danger()
    seen = set()
    for _ in range(110):
        page.page.keyboard.press("Tab")
        seen.add(page.page.evaluate("document.activeElement.id || document.activeElement.name"))

    assert {"stop", "connect", "hold-1", "feed-1", "feed-value-4", "way-2", "move-1", "take-3",
            "part", "danger-confirm", "setting-rows", "log-clear",
            "settings-open"} <= seen  # fmt: skip


def test_it_looks_right_at_every_width_light_and_dark(page: PosPage) -> None:
    page.move("-2147483")
    page.page.locator("#axis-1 summary").click()

    def stop_is_in_sight() -> None:
        page.page.evaluate("window.scrollTo(0, 3000)")
        expect(page.at("stop")).to_be_in_viewport(ratio=1)
        page.page.evaluate("window.scrollTo(0, 0)")

    check_looks(page.page, stop_is_in_sight)
    page.page.keyboard.press("Escape")


def test_the_page_is_small() -> None:
    files = (BUILD / "service").glob("positioning.*")
    assert sum(len(gzip.compress(file.read_bytes())) for file in files) < ZIPPED_BYTES_MAX
