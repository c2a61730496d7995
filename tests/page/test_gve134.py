"""The page of a GVE134 unit: jobs, halts, and what must not be overlooked."""

from __future__ import annotations

import gzip
import re
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine
from gve_page import GvePage, GveService, gve_shown
from page_looks import AXE, SIZES, VIOLATIONS, check_edges, check_looks
from playwright.sync_api import Browser, Page, expect
from service_page import NOT_KNOWN
from tab import visited

BUILD = Path(__file__).resolve().parents[2] / "build"
EXAMPLES = Path(__file__).resolve().parents[2] / "tools/examples/gve"
ZIPPED_BYTES_MAX = 34_500
LONG = "V1000\n" + "C100,50\nC-100,50\n" * 200


@pytest.fixture
def service() -> Iterator[GveService]:
    """With a virtual unit."""
    service = GveService()
    yield service
    service.end()


@pytest.fixture
def page(tab: Page, service: GveService) -> Iterator[GvePage]:
    with visited(GvePage, tab, service.url) as page:
        yield page.ready()


@pytest.fixture
def unit() -> FakeGve:
    return FakeGve(vector_s=0.05)


@pytest.fixture
def line(unit: FakeGve) -> Iterator[FakeGveLine]:
    line = FakeGveLine(unit)
    yield line
    line.close()


@pytest.fixture
def line_service(line: FakeGveLine) -> Iterator[GveService]:
    service = GveService("--port", line.port)
    yield service
    service.end()


@pytest.fixture
def line_page(tab: Page, line_service: GveService) -> Iterator[GvePage]:
    with visited(GvePage, tab, line_service.url) as page:
        yield page.ready()


def test_a_job_from_its_file_to_its_end(page: GvePage) -> None:
    page.example("circle.nc")
    expect(page.at("machine-shown")).to_have_text("Small mill")
    expect(page.at("file-facts")).to_contain_text("103 vectors, 0:08")
    expect(page.at("position-X")).to_have_text("0.000 mm")
    assert "start" not in page.sent
    page.at("start").click()
    page.doing("moving")
    expect(page.at("code-line")).to_have_text(re.compile(r"line [345] is executed"))
    expect(page.page.locator("#code-lines [data-now=true]")).to_have_count(1)
    expect(page.at("level")).to_have_text(re.compile(r"\d+ / 128"))
    expect(page.at("canvas")).to_have_attribute("data-made", re.compile(r"\d\d+"))
    expect(page.at("speed-X")).to_have_text(re.compile(r"[1-9][\d.]* mm/s"))
    expect(page.at("job-words")).to_have_text("circle.nc is done")
    page.doing("at rest")
    assert (page.steps("X"), page.steps("Y"), page.steps("Z")) == (3200, 9600, 800)
    expect(page.answers.first).to_contain_text("105 vectors made; the axes stand at X 3200")


def test_a_job_is_halted_by_escape_and_goes_on(page: GvePage) -> None:
    page.open("a.gve", LONG)
    page.at("start").click()
    page.beyond(0, "Y")
    page.page.keyboard.press("Escape")

    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    expect(page.at("alarm")).to_contain_text("HALT is confirmed: the axes stand at X")
    page.doing("stopped, vectors wait")
    expect(page.at("job-words")).to_have_text("a.gve was stopped. Go on, or Delete.")
    expect(page.at("start")).to_be_disabled()
    stands = page.steps("Y")
    page.page.wait_for_timeout(700)
    assert page.steps("Y") == stands
    page.at("go").click()
    page.beyond(stands + 100, "Y")
    page.at("stop").click()
    page.doing("stopped, vectors wait")
    page.at("delete").click()
    page.doing("at rest")
    expect(page.at("job-words")).to_contain_text("a.gve has ended")


def test_the_speed_is_changed_while_the_axes_move(page: GvePage) -> None:
    page.open("a.gve", LONG)
    page.at("start").click()
    page.doing("moving")
    expect(page.at("override-now")).to_have_text("100 %")
    page.at("override").focus()
    for _ in range(10):
        page.page.keyboard.press("ArrowLeft")
    expect(page.at("override-now")).to_have_text(re.compile(r"^(49|5[01]) %"))
    page.doing("moving")
    page.at("override-full").click()
    expect(page.at("override-now")).to_have_text(re.compile(r"^(9[89]|10[0-2]) %"))
    page.page.keyboard.press("Escape")


@pytest.mark.parametrize(
    ("name", "text", "place", "words"),
    [("a.gve", "V500\nC1\nV5\n", "3:2", "V"), ("a.nc", "G21\nG1 X10 F0\n", "2:8", "F0")],
)
def test_a_file_with_errors_shows_their_places_and_cannot_be_started(
    page: GvePage, name: str, text: str, place: str, words: str
) -> None:
    page.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.open(name, text)

    expect(page.page.locator("#problems li")).to_have_count(1)
    expect(page.page.locator("#problems li")).to_contain_text(place)
    expect(page.page.locator("#code-lines mark")).to_have_count(1)
    expect(page.at("file-facts")).to_have_text("1 error: nothing of it can be sent")
    expect(page.at("start")).to_be_disabled()
    assert words in page.page.locator("#problems li").inner_text()


def test_what_is_wrong_in_files_is_told_in_czech_and_in_english_again(page: GvePage) -> None:
    page.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.at("language").select_option("cs")
    page.open("a.nc", "G1 X1 F0\n")
    problem, mark = page.page.locator("#problems li"), page.page.locator("#code-lines mark")
    expect(problem).to_have_text("1:7 F0: posuv musí být větší než 0")
    expect(mark).to_have_attribute("title", "F0: posuv musí být větší než 0")
    machine = {"name": "b.rkm", "mimeType": "text/plain", "buffer": b"{}"}
    page.at("machine-file").set_input_files(machine)  # type: ignore[arg-type]
    expect(page.at("file-trouble")).to_contain_text("b.rkm: není to soubor stroje: chybí")
    page.at("language").select_option("en")
    expect(problem).to_have_text("1:7 F0: a feed is more than 0")
    expect(mark).to_have_attribute("title", "F0: a feed is more than 0")


def test_gcode_without_a_machine_says_what_to_do(page: GvePage) -> None:
    file = {"name": "a.nc", "mimeType": "text/plain", "buffer": b"G1 X10 F600\n"}
    page.at("file").set_input_files(file)  # type: ignore[arg-type]

    expect(page.at("file-trouble")).to_contain_text("open its machine file (.rkm) first")


def drawn(page: GvePage) -> str:
    """What the canvas shows, when nothing more is to be drawn."""
    page.page.wait_for_timeout(300)
    url: str = page.page.evaluate("document.getElementById('canvas').toDataURL()")
    return url


def test_the_path_is_seen_from_above_and_aslant_and_can_be_turned(page: GvePage) -> None:
    page.open("a.gve", "V1000\nC0,0,1000\nC0,0,-1000\n")
    expect(page.at("canvas")).to_have_attribute("data-plan", "2")
    expect(page.at("scale")).not_to_be_empty()
    above = drawn(page)
    page.page.locator("label", has_text=re.compile("^XYZ$")).click()
    expect(page.at("scale")).to_be_empty()
    aslant = drawn(page)
    place = page.at("canvas").bounding_box()
    assert place is not None
    x, y = place["x"] + place["width"] / 2, place["y"] + place["height"] / 2
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    page.page.mouse.move(x + 60, y + 40, steps=4)
    page.page.mouse.up()
    turned = drawn(page)
    page.page.locator("label", has_text=re.compile("^XY$")).click()

    assert len({above, aslant, turned}) == 3
    assert drawn(page) == above


def test_a_machine_file_is_edited_taken_over_and_saved(page: GvePage) -> None:
    expect(page.at("machine-edit")).to_be_disabled()
    page.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.open("a.nc", "G1 X10 F600\n")
    page.at("machine-edit").click()
    expect(page.at("code")).to_be_hidden()
    expect(page.at("machine-text")).not_to_have_value("")
    text = page.at("machine-text").input_value()
    assert text == (EXAMPLES / "mill.rkm").read_text(encoding="utf-8")
    wrong = text.replace('"steps_per_mm": 320', '"steps_per_mm": -320', 1)
    page.at("machine-text").fill(wrong)
    page.at("machine-take").click()
    expect(page.at("machine-trouble")).to_contain_text("steps_per_mm")
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.at("machine-close").click()
    page.at("machine-edit").click()
    expect(page.at("machine-text")).to_have_value(wrong)
    other = text.replace("Small mill", "Fine mill").replace(
        '"steps_per_mm": 320', '"steps_per_mm": 640'
    )
    page.at("machine-text").fill(other)
    page.at("machine-take").click()
    expect(page.at("machine-shown")).to_have_text("Fine mill")
    expect(page.at("machine-trouble")).to_be_hidden()
    with page.page.expect_download() as download:
        page.at("machine-save").click()
    assert download.value.suggested_filename == "mill.rkm"
    assert Path(download.value.path()).read_text(encoding="utf-8") == other
    page.at("machine-close").click()
    expect(page.at("code")).to_be_visible()
    page.at("start").click()
    expect(page.at("job-words")).to_have_text("a.nc is done")
    assert page.steps("X") == 6400


def test_the_machine_file_has_room_at_every_width_and_no_place_in_a_job(page: GvePage) -> None:
    page.example("pocket.nc")
    page.at("machine-edit").click()
    page.page.evaluate(AXE.read_text())
    for width, height in SIZES:
        page.page.set_viewport_size({"width": width, "height": height})
        check_edges(page.page)
    assert page.page.evaluate(VIOLATIONS) == []
    page.at("start").click()
    expect(page.at("code")).to_be_visible()
    expect(page.at("machine-text")).to_be_hidden()
    expect(page.at("machine-edit")).to_be_disabled()
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")


def test_two_windows_see_the_same_and_either_halts(
    page: GvePage, browser: Browser, service: GveService
) -> None:
    page.open("a.gve", LONG)
    page.at("start").click()
    page.beyond(0, "Y")
    with gve_shown(browser, service.url) as second:
        second.ready()
        expect(second.at("file-name")).to_have_text("a.gve")
        expect(second.at("job-words")).to_have_text(re.compile("a.gve runs"))
        expect(second.at("canvas")).to_have_attribute("data-made", re.compile(r"[1-9]\d*"))
        expect(second.page.locator("#code-lines [data-now=true]")).to_have_count(1)
        second.at("stop").click()
        expect(second.at("alarm")).to_have_attribute("data-kind", "done")
        expect(page.at("job-words")).to_contain_text("was stopped")
        second.at("delete").click()
    page.doing("at rest")
    expect(page.at("job-words")).to_contain_text("has ended")


def test_axes_are_moved_by_hand_in_pulses_and_in_mm(page: GvePage) -> None:
    page.jog("Y-")
    expect(page.at("position-Y")).to_have_text("\N{MINUS SIGN}100 ")
    page.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    expect(page.at("jog-speed")).to_have_value("600")
    page.at("jog-step").select_option("0.1")
    page.jog("Y+")
    expect(page.at("steps-Y")).to_have_text("\N{MINUS SIGN}68 pulses")
    page.page.locator(".card").nth(1).get_by_text("= 0").click()
    expect(page.at("position-Y")).to_have_text("0.000 mm")


def test_a_speed_that_the_unit_has_not_moves_nothing_by_hand(page: GvePage) -> None:
    for speed in ("1000000", "5", ""):
        page.at("jog-speed").fill(speed)
        page.jog("X+")
    page.page.wait_for_timeout(300)
    assert "jog" not in page.sent


def test_inputs_outputs_and_spindle(page: GvePage) -> None:
    lamp = page.page.locator("#inputs button").nth(2)
    expect(lamp).to_have_attribute("data-level", "0")
    lamp.click()
    expect(lamp).to_have_attribute("data-level", "1")
    cooling = page.page.locator("#outputs button").nth(2)
    expect(cooling).to_be_disabled()
    expect(cooling).to_have_accessible_name("cooling: not known")
    page.at("outputs-off").click()
    cooling.click()
    expect(cooling).to_have_accessible_name("cooling: on")
    page.at("spindle").fill("30.5")
    page.page.keyboard.press("Enter")
    expect(page.at("spindle-now")).to_have_text("30.5 %")
    expect(page.page.locator("#outputs button").first).to_have_attribute("data-level", "1")


def test_commands_are_typed_and_answered(page: GvePage) -> None:
    page.at("typed").fill("nx1234")
    page.page.keyboard.press("Enter")
    expect(page.answers.first).to_contain_text("NX1234 → 0 done")
    expect(page.at("position-X")).to_have_text("1,234 ")
    page.at("typed").fill("V5")
    page.page.keyboard.press("Enter")
    expect(page.answers.first).to_have_class(re.compile("is-bad"))


def test_homing_says_that_the_unit_is_silent_then_and_can_be_halted(page: GvePage) -> None:
    page.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    page.page.locator("#inputs button").first.click()
    page.home("X")
    page.doing("reference run: the unit tells nothing until it stands")
    page.page.wait_for_timeout(2500)
    expect(page.at("position-X")).to_have_text(NOT_KNOWN)
    expect(page.at("loud")).to_be_hidden()
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    page.doing("stopped, nothing waits")


def test_a_silent_unit_in_a_job_is_told_in_the_largest_letters(
    line_page: GvePage, line: FakeGveLine, unit: FakeGve
) -> None:
    page = line_page
    page.open("a.gve", LONG)
    page.at("start").click()
    page.doing("moving")
    with line.lock:
        unit.mute = True

    expect(page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    size = page.at("loud").evaluate("part => parseFloat(getComputedStyle(part).fontSize)")
    assert size >= 22
    expect(page.at("position-X")).to_have_text(NOT_KNOWN)
    page.doing("not known")
    expect(page.page.locator("#inputs button").first).to_have_attribute("data-level", "unknown")
    expect(page.at("override-now")).to_have_text(f"{NOT_KNOWN} %")
    expect(page.at("start")).to_be_disabled()
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("NOT CONFIRMED")
    assert page.at("alarm").evaluate("part => parseFloat(getComputedStyle(part).fontSize)") >= 26
    page.page.reload()
    expect(page.at("alarm")).to_contain_text("NOT CONFIRMED")
    with line.lock:
        unit.mute = False
    expect(page.at("alarm")).to_be_hidden()
    page.doing(re.compile("stopped|at rest"))


def test_a_unit_that_is_absent_at_the_start_is_told_and_found(
    browser: Browser, line: FakeGveLine, unit: FakeGve
) -> None:
    unit.mute = True
    service = GveService("--port", line.port)
    try:
        with gve_shown(browser, service.url) as page:
            expect(page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
            expect(page.at("banner")).to_contain_text("check power, cable")
            expect(page.at("position-X")).to_have_text(NOT_KNOWN)
            with line.lock:
                unit.mute = False
            page.ready()
            expect(page.at("loud")).to_be_hidden()
            assert set(page.sent) <= {"ports"}
    finally:
        service.end()


def test_a_port_that_is_absent_is_told(browser: Browser, tmp_path: Path) -> None:
    service = GveService("--port", str(tmp_path / "none"))
    try:
        with gve_shown(browser, service.url) as page:
            expect(page.at("loud")).to_contain_text("THE PORT IS NOT THERE")
            expect(page.at("banner")).to_contain_text("no such port")
    finally:
        service.end()


def test_a_unit_that_restarts_in_a_job_is_told_until_somebody_has_noted_it(
    line_page: GvePage, line: FakeGveLine, unit: FakeGve
) -> None:
    page = line_page
    page.open("a.gve", LONG)
    page.at("start").click()
    page.doing("moving")
    with line.lock:
        unit.restart()

    expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
    expect(page.at("job-words")).to_contain_text("a.gve has ended")
    page.ready()
    page.page.reload()
    expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
    page.at("seen").click()
    expect(page.at("loud")).to_be_hidden()


def test_a_unit_that_was_restarted_by_a_fault_is_told(
    line_page: GvePage, line: FakeGveLine, unit: FakeGve
) -> None:
    with line.lock:
        unit.inta = True
        unit.status[6] = 8

    expect(line_page.at("loud")).to_contain_text("NO MOTION")
    line_page.at("delete").click()
    expect(line_page.at("loud")).to_be_hidden()


def test_a_service_that_stands_still_is_noticed_and_clicks_meanwhile_never_act(
    line_page: GvePage, line_service: GveService, unit: FakeGve
) -> None:
    page = line_page
    page.open("a.gve", LONG)
    line_service.tell(signal.SIGSTOP)
    page.at("start").click()
    expect(page.at("banner")).to_contain_text("cannot stop anything")
    expect(page.at("position-X")).to_have_text(NOT_KNOWN)
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_text("HALT NOT CONFIRMED: USE THE EMERGENCY STOP")

    line_service.tell(signal.SIGCONT)
    page.ready()
    page.page.wait_for_timeout(1000)
    assert unit.taken == []
    expect(page.at("alarm")).to_have_text("HALT NOT CONFIRMED: USE THE EMERGENCY STOP")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")


def test_a_service_that_stands_still_in_a_job_is_told_loudly_and_the_job_then_waits(
    line_page: GvePage, line_service: GveService, unit: FakeGve
) -> None:
    page = line_page
    unit.vector_s = 0.05
    page.open("a.gve", f"!7V500\n{LONG}")
    page.at("start").click()
    page.doing("moving")
    line_service.tell(signal.SIGSTOP)
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    line_service.tell(signal.SIGCONT)
    expect(page.at("job-words")).to_contain_text("slept for")
    expect(page.at("loud")).to_be_hidden()
    page.doing("stopped, vectors wait")
    page.at("stop").click()
    expect(page.at("alarm")).to_contain_text("confirmed by the unit; THE SPINDLE TURNS at 50 %")


def test_all_of_it_is_on_one_screen_whatever_the_length_of_the_file(page: GvePage) -> None:
    page.open("a.gve", LONG * 20)
    for name in ("stop", "start", "code", "canvas", "position-A", "outputs-off", "typed"):
        expect(page.at(name)).to_be_in_viewport(ratio=1)
    assert page.page.locator("#code-lines div").count() < 100


def test_everything_is_reached_by_keys(page: GvePage) -> None:
    page.example("circle.nc")
    seen = set()
    for _ in range(70):
        page.page.keyboard.press("Tab")
        seen.add(page.page.evaluate("document.activeElement.id || document.activeElement.name"))

    assert {"stop", "start", "override", "code", "view", "zoom-in", "fit", "jog-step", "typed",
            "danger-confirm", "open", "machine-open", "examples",
            "outputs-off"} <= seen  # fmt: skip


def test_it_looks_right_at_every_width_light_and_dark(page: GvePage) -> None:
    page.example("pocket.nc")

    def stop_is_in_sight() -> None:
        page.page.evaluate("window.scrollTo(0, 3000)")
        expect(page.at("stop")).to_be_in_viewport(ratio=1)
        page.page.evaluate("window.scrollTo(0, 0)")

    check_looks(page.page, stop_is_in_sight)


def test_the_page_is_small() -> None:
    files = (BUILD / "service").glob("gve134.*")
    assert sum(len(gzip.compress(file.read_bytes())) for file in files) < ZIPPED_BYTES_MAX
