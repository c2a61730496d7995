"""The page of a positioning unit as one file that needs no service: its own unit, and a line."""

from __future__ import annotations

import contextlib
import json
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from alone_page import write_alone
from noisy_line import NoisyLine
from page_looks import AXE, CUT, OUTSIDE, OVER, SIZES, VIOLATIONS
from playwright.sync_api import Browser, WebSocket, expect
from pos_page import PosPage
from rkm04_tools.positioning.settings import read_values
from rkm04_tools.positioning.unit import open_unit
from serial_bridge import SerialBridge
from served import POSITIONING_COMMAND, Served
from service_page import NOT_KNOWN
from tab import DESK, PATIENCE_SECONDS

NODE, SEED = 3, 5
WRITE_REGISTERS, WRITE_AND_READ = 16, 23
GETS_THROUGH = 3
IMAGE_OUT = bytes([3, 1, 244])
AXIS_1, CLOCK = bytes([3, 0, 110]), bytes([3, 0, 0, 0, 28])
"""What requests begin with that read what axes were told, an axis, and the unit with its clock."""
SOON_SECONDS = 2
ENGLISH = re.compile(r"\b(the|is|of|to|in|as|at|steps|limit|from|never)\b")
ANSWER_SECONDS = 0.05
"""After so long an answer has come to all that hear it."""
CHOICE_MS = 3000
BUSY_MS = 8000
"""After so long what was asked for has come to nothing: this machine was too busy for the line."""
"""Longer than what the page asks for is good for otherwise."""
NOT_CONFIRMED = "STOP NOT CONFIRMED: USE THE EMERGENCY STOP"


class AlonePage(PosPage):
    """It has no service; the web socket of a fake serial port has bytes."""

    def _listen(self, socket: WebSocket) -> None:
        pass


Open = Callable[..., AlonePage]


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("alone")
    return write_alone(folder).with_name("positioning.html").as_uri()


@pytest.fixture
def open_page(browser: Browser, written: str) -> Iterator[Open]:
    """Open the page from its file, after a script; nothing but that file is asked for."""
    width, height = DESK
    context = browser.new_context(viewport={"width": width, "height": height}, locale="en-GB")
    context.set_default_timeout(PATIENCE_SECONDS * 1000)
    asked: set[str] = set()
    context.on("request", lambda request: asked.add(request.url.split(":")[0]))
    opened: list[AlonePage] = []

    def begin(script: str = "") -> AlonePage:
        context.add_init_script(script)
        opened.append(AlonePage(context.new_page(), written))
        return opened[-1]

    yield begin
    context.close()
    assert [page.faults for page in opened] == [[]] * len(opened)
    assert asked <= {"file", "data", "blob"}


@pytest.fixture
def page(open_page: Open) -> AlonePage:
    return open_page().ready()


def test_its_own_unit_moves_is_held_and_stopped(page: AlonePage) -> None:
    page.doing("FREE")
    expect(page.at("state")).to_contain_text("virtual unit · 1.00")
    expect(page.page.locator("#pages a[aria-current]")).to_have_text("Positioning")
    expect(page.at("alone-hint")).to_contain_text("What needs tools/positioning service")

    page.move("62.5", "3000")
    page.doing("MOVING")
    expect(page.at("target-1")).to_contain_text("to 62.500 mm · 6,250 steps ·")
    page.at("hold-1").click()
    expect(page.at("alarm")).to_contain_text("Hold is confirmed: axis 1 stands at")
    page.doing("READY")
    expect(page.bit("MP")).to_have_attribute("data-level", "0")
    page.at("go-1").click()
    page.doing("REACHED")
    expect(page.at("position-1")).to_have_text("62.500 mm")
    expect(page.at("steps-1")).to_have_text("6,250 steps")
    for name, level in (("JEDE", 0), ("POL", 1), ("DISP", 1), ("PROG", 1), ("ERR", 0)):
        expect(page.bit(name)).to_have_attribute("data-level", str(level))
    expect(page.at("curves")).to_have_attribute("data-samples", re.compile(r"[1-9]\d+"))

    page.move("-1000", axis=2)
    page.doing("MOVING", 2)
    page.at("feed-value-2").fill("1500")
    page.page.keyboard.press("Enter")
    expect(page.at("speed-2")).to_have_text("1,500 mm/min")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("STOP is confirmed: all axes stand: 1 at 62.500 mm")
    page.doing("READY", 2)

    page.at("script-example").select_option(label="hold.csv")
    page.at("script-play").click()
    expect(page.at("script-words")).to_have_text(
        "0.933 s, 9 lines: the script is over and the axes stand"
    )
    expect(page.at("script-axes")).to_contain_text("Axis 1: 25.000 mm, 2,500 steps; moves: 2")
    expect(page.at("script-told")).to_have_text(
        "line 9: axis 1: 11.490 mm, READY · stands, has a measure"
    )
    page.at("script-text").fill("0,1,POS_MODE")
    expect(page.at("script-words")).to_have_text("Changed since it was played")
    page.at("script-play").click()
    expect(page.at("script-words")).to_contain_text("script.csv:1: too few values")
    page.doing("READY", 2)


def test_its_settings_limits_and_reference(page: AlonePage) -> None:
    page.at("take-1").click()
    page.doing("TAKEN")
    expect(page.setting("LIMIT_PLUS")).to_be_disabled()
    expect(page.at("settings-words")).to_contain_text("Axis 1 is taken or moves")
    page.part("axis3")
    page.setting("LIMIT_PLUS").fill("3")
    page.setting("STEPS").fill("1600")
    page.setting("MICROMETRES").fill("5000")
    page.at("settings-write").click()
    words = "written: axis3 LIMIT_PLUS, axis3 STEPS, axis3 MICROMETRES; not stored yet"
    expect(page.answers.first).to_contain_text(words)
    page.move("1000", axis=3)
    page.doing("MOVING", 3)
    page.page.get_by_role("button", name="BI3").click()
    page.doing("FAULT", 3)
    expect(page.at("trouble-3")).to_contain_text("Error 7: a limit input is active.")
    page.at("take-3").click()
    expect(page.at("trouble-3")).to_be_empty()

    page.page.locator("#axis-4 summary").click()
    page.at("method-4").select_option("37")
    page.at("reference-4").fill("25.5")
    page.at("home-4").click()
    expect(page.at("position-4")).to_have_text("25.500 mm")
    page.at("capture-4").click()
    expect(page.at("trouble-4")).to_contain_text("Error 12")
    expect(page.answers.first).to_contain_text(
        "POS_CAPTURE was refused: error 12: the input for it"
    )

    page.page.evaluate(AXE.read_text())
    for width, height in (SIZES[0], SIZES[-1]):
        page.page.set_viewport_size({"width": width, "height": height})
        for finds in (VIOLATIONS, OUTSIDE, OVER, CUT):
            assert page.page.evaluate(finds) == [], width


def test_its_settings_are_stored_saved_and_opened(page: AlonePage, tmp_path: Path) -> None:
    page.part("axis3")
    page.setting("STEPS").fill("1600")
    page.at("settings-write").click()
    expect(page.at("facts")).to_contain_text("settings are not as stored")
    page.at("settings-store").click()
    expect(page.at("facts")).not_to_contain_text("not as stored")
    with page.page.expect_download() as download:
        page.at("settings-save").click()
    content = Path(download.value.path()).read_text()
    assert read_values(content, "file")["axis3"]["STEPS"] == 1600
    file = tmp_path / "other.json"
    other = json.loads(content)
    other["settings"]["axis3"]["STEPS"] = 800
    file.write_text(json.dumps(other))
    page.at("settings-file").set_input_files(file)
    expect(page.at("settings-write")).to_have_text("Write (1)")
    page.at("settings-undo").click()
    other["settings"]["axis1"]["BACKLASH"] = 6
    other["settings"]["axis3"]["STEPS"] = 5001
    file.write_text(json.dumps(other))
    page.at("settings-file").set_input_files(file)
    page.at("settings-write").click()
    why = "axis3: 5001 STEPS in 10 MICROMETRES: the quotient is 1/10000 to 500; nothing was written"
    expect(page.answers.first).to_contain_text(why)
    expect(page.at("settings-write")).to_have_text("Write (2)")
    page.at("settings-undo").click()
    other["settings"]["axis3"]["STEPS"] = 0
    for text, why in (
        ("{", "it is no JSON"), ("{}", "it is of another kind"),
        (json.dumps(other), "axis3 STEPS has no value of its range"),
        (json.dumps({**other, "version": 2}), "it is of another version"),
    ):  # fmt: skip
        file.write_text(text)
        page.at("settings-file").set_input_files(file)
        expect(page.at("settings-words")).to_contain_text(f"other.json: {why}")
    page.at("settings-deliver").click()
    page.at("settings-deliver").click()
    expect(page.answers.first).to_contain_text("the delivered settings are in force")


def test_what_the_unit_and_its_table_say_is_in_the_language_of_the_page(page: AlonePage) -> None:
    page.at("language").select_option("cs")
    for part in ("unit", "axis1"):
        page.part(part)
        for row in page.page.locator("#setting-rows .setting").all():
            assert not ENGLISH.search(row.locator("small").inner_text())
    expect(page.at("move-1")).to_be_disabled()
    page.confirm_danger()
    page.at("move-1").click()
    expect(page.answers.first).to_contain_text(re.compile(r"osa 1: [\d.]+ mm"))
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("všechny osy stojí: 1 na")
    expect(page.answers.first).to_contain_text("všechny osy stojí: 1 na")
    page.at("connect").click()
    expect(page.answers.first).to_contain_text("port je uzavřen")  # a hold would go before it
    page.at("hold-1").click()
    expect(page.answers.first).to_contain_text("Žádná jednotka není připojena")
    page.at("language").select_option("en")
    expect(page.answers.first).to_contain_text("no port is open; connect first")


def connect(page: AlonePage) -> None:
    """Choose the serial port, and its unit."""
    page.at("port").select_option("serial")
    page.at("node").select_option(str(NODE))
    page.at("connect").click()


def go(page: AlonePage, mm: str, state: str) -> None:
    """Begin a motion, and ask again where the line was given up, as a user would."""
    for _ in range(3):
        page.move(mm)
        with contextlib.suppress(AssertionError):
            expect(page.at("state-1")).to_have_text(re.compile(f"^{state} "), timeout=BUSY_MS)
            return
    page.doing(state)


class Line:
    """A unit on a line with echo and some noise, and the serial port of a page at its other end."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.started: list[float] = []
        self.units = [self._serve()]
        self.noisy = NoisyLine(self.units[0].place, SEED, probability=0.01, echo=True)
        self.bridge = SerialBridge(self.noisy.port)

    def _serve(self) -> Served:
        self.started.append(time.monotonic())
        more = ("--tcp", "0", "--node", str(NODE), "--unpaced")
        return Served(*more, cwd=self.folder, command=POSITIONING_COMMAND)

    def restart(self) -> None:
        """The unit falls silent and starts anew."""
        self.units.append(self._serve())
        self.noisy.restarted_as = self.units[-1].place

    def close(self) -> None:
        self.bridge.close()
        self.noisy.close()
        for unit in self.units:
            unit.end()


@pytest.fixture
def line(tmp_path: Path) -> Iterator[Line]:
    line = Line(tmp_path)
    yield line
    line.close()


@pytest.fixture
def line_page(open_page: Open, line: Line) -> AlonePage:
    """The page, on the line."""
    page = open_page(line.bridge.script).ready()
    page.at("connect").click()
    connect(page)
    expect(page.at("state")).to_have_text(f"USB 0403:6001 #{NODE} · 1.00")
    return page


def test_it_speaks_to_a_unit_on_a_serial_port(line_page: AlonePage, line: Line) -> None:
    page, bridge = line_page, line.bridge
    [form] = page.page.evaluate("fakeSerial.opened")
    assert (form["baudRate"], form["parity"], form["stopBits"]) == (19_200, "even", 1)
    expect(page.page.get_by_role("button", name="BI3")).to_be_disabled()

    go(page, "1000", "MOVING")
    bridge.silent = True
    expect(page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    expect(page.at("position-1")).to_have_text(NOT_KNOWN)
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)
    bridge.silent = False
    page.ready()
    page.at("hold-1").click()
    expect(page.answers.first).to_contain_text("axis 1 stands at")
    expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    page.doing("READY")

    page.at("go-1").click()
    page.doing("MOVING")
    page.page.evaluate("fakeSerial.pull()")
    expect(page.at("loud")).to_contain_text("THE PORT IS NOT THERE")
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    expect(page.at("banner")).to_contain_text("was lost (unplugged)")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)
    connect(page)
    page.ready()
    page.doing("MOVING")
    expect(page.at("loud")).to_be_hidden()
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    page.doing("READY")


def test_a_stop_goes_out_to_a_unit_that_was_never_heard(open_page: Open, line: Line) -> None:
    with open_unit(line.units[0].place, NODE) as other:
        axis = other.axis(1)
        axis.init()
        axis.mode(1000, 500)
        axis.control(600)
        line.bridge.silent = True
        page = open_page(line.bridge.script).ready()
        page.at("connect").click()
        connect(page)
        expect(page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
        page.page.keyboard.press("Escape")
        expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)
        assert not axis.read().moves
        page.page.reload()
        page.ready()
        expect(page.at("alarm")).to_be_hidden()
        page.at("connect").click()
        connect(page)
        expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)


def test_a_stop_that_another_master_undoes_again_and_again_is_not_confirmed(
    line_page: AlonePage, line: Line, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = line_page
    go(page, "1000", "MOVING")
    with open_unit(line.units[0].place, NODE) as other:

        def to_unit(data: bytes) -> bytes:
            if data[1:4] == IMAGE_OUT:
                line.bridge.silent = True
                other.wire.write(105, [1, 600, 0])
                time.sleep(ANSWER_SECONDS)
                line.bridge.silent = False
            return data

        monkeypatch.setattr(line.bridge, "to_unit", to_unit)
        page.page.keyboard.press("Escape")
        expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)
        expect(page.answers.first).to_contain_text("axis 1 IS NOT HELD: another master, such as")
    page.doing("TAKEN")


def test_a_motion_that_took_too_long_on_a_bad_line_does_not_begin(
    line_page: AlonePage, line: Line, monkeypatch: pytest.MonkeyPatch
) -> None:
    page, asked = line_page, [b""]

    def to_unit(data: bytes) -> bytes:
        """From the first instruction on what is sent for the third time gets through."""
        if data[1] == WRITE_AND_READ or asked[0]:
            asked[:] = [*asked, data] if data == asked[-1] else [data]
        return data if len(asked) >= GETS_THROUGH or not asked[0] else b""

    monkeypatch.setattr(line.bridge, "to_unit", to_unit)
    page.move("1000")
    expect(page.answers.first).to_contain_text("it was not told to move")
    monkeypatch.undo()
    page.ready()
    page.doing("READY")
    expect(page.at("position-1")).to_have_text("0.000 mm")


def test_a_user_may_take_their_time_to_choose_a_port(open_page: Open, line: Line) -> None:
    page = open_page(line.bridge.script).ready()
    page.at("connect").click()
    page.page.evaluate(f"fakeSerial.choice_ms = {CHOICE_MS}")
    connect(page)
    expect(page.at("state")).to_have_text(f"USB 0403:6001 #{NODE} · 1.00")


def test_a_unit_on_a_line_that_restarts_is_told(line_page: AlonePage, line: Line) -> None:
    page = line_page
    go(page, "1000", "MOVING")
    line.restart()
    expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
    page.ready()
    page.doing("FREE")
    expect(page.at("move-1")).to_be_disabled()
    page.at("seen").click()
    expect(page.at("loud")).to_be_hidden()
    go(page, "1", "REACHED")
    expect(page.at("position-1")).to_have_text("1.000 mm")


def test_a_restart_in_the_middle_of_a_look_is_told_however_long_the_line_rests_then(
    line_page: AlonePage, line: Line, monkeypatch: pytest.MonkeyPatch
) -> None:
    def to_unit(data: bytes) -> bytes:
        if data[1:4] == AXIS_1 and len(line.started) == 1:
            line.restart()
        if data[1:6] == CLOCK and len(line.started) > 1:
            before, now = line.started
            is_younger = time.monotonic() - now < now - before + SOON_SECONDS
            return b"" if is_younger else data
        return data

    go(line_page, "1000", "MOVING")
    monkeypatch.setattr(line.bridge, "to_unit", to_unit)
    expect(line_page.at("loud")).to_contain_text("THE UNIT DOES NOT ANSWER")
    expect(line_page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")


def test_settings_whose_writing_was_cut_short_are_read_again(
    line_page: AlonePage, line: Line, monkeypatch: pytest.MonkeyPatch
) -> None:
    page, bridge = line_page, line.bridge

    def to_unit(data: bytes) -> bytes:
        bridge.silent = bridge.silent or data[1] == WRITE_REGISTERS
        return data

    expect(page.setting("BACKLASH")).to_be_enabled()
    page.setting("BACKLASH").fill("5")
    monkeypatch.setattr(bridge, "to_unit", to_unit)
    page.at("settings-write").click()
    expect(page.answers.first).to_contain_text("does not answer")
    monkeypatch.undo()
    bridge.silent = False
    page.ready()
    expect(page.at("settings-words")).to_have_text("")
    expect(page.setting("BACKLASH")).to_have_value("5")


def test_what_a_browser_has_not_is_told(open_page: Open) -> None:
    page = open_page("delete Navigator.prototype.serial").ready()
    expect(page.at("serial-hint")).to_contain_text("or take tools/positioning service")
    assert page.page.locator("#port option").all_inner_texts() == [
        "virtual unit in this page (no hardware)"
    ]

    page = open_page("delete globalThis.WebAssembly")
    expect(page.at("alone-none")).to_contain_text("no WebAssembly")
    expect(page.at("move-1")).to_be_disabled()
    expect(page.at("connect")).to_be_disabled()
    expect(page.at("script")).to_be_hidden()
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text(NOT_CONFIRMED)
