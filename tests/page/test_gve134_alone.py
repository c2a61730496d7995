"""The page of a GVE134 without a service: its files, its virtual unit, and a real line."""

from __future__ import annotations

import contextlib
import json
import random
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alone_page import write_alone
from chance import SEED
from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine
from gve_drawn import drawn_file
from gve_page import GvePage
from page_looks import AXE, CUT, DRAWN, OUTSIDE, OVER, SIZES, VIOLATIONS
from playwright.sync_api import Browser, Page, WebSocket, expect
from rkm04_tools import static_pages
from rkm04_tools.gve134.answers import encoded
from rkm04_tools.gve134.service import alone
from rkm04_tools.gve134.service.files import read_file
from serial_bridge import SerialBridge
from served import GVE_COMMAND, Served
from service_page import NOT_KNOWN
from tab import visited
from unit_page import unit_shown

NAME = "gve134.html"
PORT = "USB 0403:6001"
LONG = "V1000\n" + "C100,50\nC-100,50\n" * 200
BAD = "V1000\nC1,2,3,4,5\nL10,0 ; \N{LATIN SMALL LETTER E WITH ACUTE}\nQX\n\n*E3\n"
COLOUR = "(part) => getComputedStyle(part).color"
READ = """async (files) => {
    const brought = JSON.parse(document.getElementById("alone").textContent);
    const script = new Blob([brought.worker], { type: "text/javascript" });
    const worker = new Worker(URL.createObjectURL(script));
    const bytes = Uint8Array.from(atob(brought.program), (c) => c.charCodeAt(0));
    worker.postMessage({ kind: "program", bytes });
    const told = [];
    const plain = (value) => ({ ...value, rows: [...value.rows], course: null });
    return new Promise((take) => {
        worker.onmessage = ({ data }) => {
            told.push("opened" in data ? plain(data.opened) : data);
            told.length === files.length && take(told);
        };
        files.forEach(([name, text], id) => worker.postMessage({ kind: "read", id, name, text }));
    });
}"""


class LinePage(GvePage):
    """A page whose web socket is its line."""

    def _listen(self, socket: WebSocket) -> None:
        pass


class BadBridge(SerialBridge):
    """A line on which some packets of a job are damaged, and some answers to them are lost."""

    DAMAGED, UNANSWERED = (1, 4), (2, 6)
    packets = 0
    loses = False

    def to_unit(self, data: bytes) -> bytes:
        self.packets += b"*S" in data
        self.loses = b"*S" in data and self.packets in self.UNANSWERED
        if b"*S" in data and self.packets in self.DAMAGED:
            return data[:40] + bytes([data[40] ^ 1]) + data[41:]
        return data

    def to_page(self, data: bytes) -> bytes:
        return b"" if self.loses else data


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The pages in a folder of their own."""
    return write_alone(tmp_path_factory.mktemp("alone") / "page").parent


@pytest.fixture
def page(tab: Page, written: Path) -> Iterator[GvePage]:
    with visited(GvePage, tab, (written / NAME).as_uri()) as page:
        yield page.ready()


def test_files_are_to_it_what_they_are_to_the_service(page: GvePage) -> None:
    chance = random.Random(SEED)
    files = [(each["name"], each["text"]) for each in alone.brought()["examples"]]
    files += [
        ("bad.gve", BAD),
        ("none.gve", ""),
        *((f"{n}.gve", drawn_file(chance)) for n in range(20)),
    ]
    told: list[dict[str, Any]] = page.page.evaluate(READ, files)

    for (name, text), found in zip(files, told, strict=True):
        ours = read_file(name, text.encode(), None)
        state = json.loads(json.dumps(ours.as_json()))
        assert {**found["state"], "number": 0} == {**state, "number": 0}
        assert (found["text"], found["problems"], found["more"]) == (text, ours.problems, ours.more)
        rows = np.frombuffer(ours.rows(), "<f4")
        assert np.array_equal(np.array(found["rows"], "<f4"), rows, equal_nan=True), name


def test_a_job_runs_on_the_unit_in_the_page_and_halts_before_anything_else(page: GvePage) -> None:
    asked: list[str] = []
    page.page.on("request", lambda request: asked.append(request.url.split(":")[0]))
    expect(page.at("state")).to_contain_text("virtual unit")
    page.example("circle.gve")
    expect(page.at("file-facts")).to_contain_text("103 vectors, 0:08")
    expect(page.at("canvas")).to_have_attribute("data-plan", "103")
    page.doing("at rest")
    page.at("start").click()
    page.doing("moving")
    expect(page.at("connect")).to_be_disabled()
    expect(page.at("code-line")).to_have_text(re.compile(r"line \d+ is executed"))
    expect(page.at("level")).to_have_text(re.compile(r"\d+ / 128"))
    page.beyond(5000)
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("HALT is confirmed: the axes stand at X")
    page.doing("stopped, vectors wait")
    expect(page.at("job-words")).to_contain_text("was stopped. Go on, or Delete.")
    stood = page.steps("X"), page.steps("Y")
    page.at("go").click()
    page.doing("moving")
    expect(page.at("alarm")).to_be_hidden(timeout=1000)
    page.at("override").fill("200")
    expect(page.at("override-now")).to_have_text(re.compile(r"(19|20)\d(\.\d)? %"))
    expect(page.at("job-words")).to_have_text("circle.gve is done")
    assert stood != (3200, 9600)
    assert (page.steps("X"), page.steps("Y"), page.steps("Z")) == (3200, 9600, 800)
    expect(page.at("canvas")).to_have_attribute("data-made", re.compile(r"\d\d\d+"))
    expect(page.answers.first).to_contain_text("105 vectors made; the axes stand at X 3200")
    assert set(asked) <= {"data", "blob", "file"}


def test_errors_have_their_places_and_what_needs_the_service_is_said(page: GvePage) -> None:
    page.open("bad.gve", BAD)
    expect(page.at("file-facts")).to_contain_text("nothing of it can be sent")
    expect(page.page.locator("#problems li").first).to_contain_text("2:")
    expect(page.at("start")).to_be_disabled()
    page.at("language").select_option("cs")
    czech = "2:10 C: počet parametrů je nejvýše 4; příklad: C"
    expect(page.page.locator("#problems li").first).to_contain_text(czech)
    page.at("language").select_option("en")
    gcode = {"name": "a.nc", "mimeType": "text/plain", "buffer": b"G1 X1 F100"}
    page.at("file").set_input_files(gcode)  # type: ignore[arg-type]
    trouble = page.at("file-trouble")
    expect(trouble).to_contain_text("tools/gve134 gcode")
    expect(trouble).to_contain_text("not opened, what is here stays")
    assert trouble.evaluate(COLOUR) != page.at("file-name").evaluate(COLOUR)
    expect(page.at("alone-hint")).to_contain_text("service: G-code, ports over a network")
    page.open("large.gve", "N\n" + "C100,50\nC-100,50\nC9,9,9\n" * 20_000)
    expect(page.at("file-facts")).to_contain_text("60,000 vectors")
    expect(page.at("canvas")).to_have_attribute("data-plan", "15000")
    expect(page.at("scale")).to_contain_text("of 4 corners of the plan one is drawn")
    links = page.page.locator("#pages a")
    wanted = [each.name for each in static_pages.PAGES]
    assert [link.get_attribute("href") for link in links.all()] == wanted
    expect(page.page.locator("#pages [aria-current=page]")).to_have_text("GVE134")


def test_hands_inputs_outputs_and_commands(page: GvePage) -> None:
    page.jog("X+")
    expect(page.at("position-X")).to_have_text("100")
    page.at("spindle").fill("30")
    page.page.locator("#spindle-form button").click()
    expect(page.at("spindle-now")).to_have_text("30 %")
    page.at("outputs-off").click()
    lamp = page.page.locator("#outputs button", has_text="cooling")
    lamp.click()
    expect(lamp).to_have_attribute("aria-label", re.compile("on"))
    typed = page.at("typed")
    for text, answer in (("p4", "P4 → 0,100,0,0,0  done"), ("*S", "the page has a button"),
                         ("\N{EURO SIGN}", "no command of the unit"), ("V0", "V0: ")):  # fmt: skip
        typed.fill(text)
        typed.press("Enter")
        expect(page.answers.first).to_contain_text(answer)
    for text in ("SW2,00", "SW0,01"):
        typed.fill(text)
        typed.press("Enter")
        expect(page.answers.first).to_contain_text(f"{text} → 0  done")
    page.open("long.gve", f"!7V500\n{LONG}")
    page.at("start").click()
    page.doing("moving")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("confirmed by the unit; THE SPINDLE TURNS at 50 %")
    page.at("go").click()
    page.doing("moving")
    page.page.locator("#inputs button", has_text="Ref X").click()
    page.page.locator("#inputs button", has_text="Ref X").click()
    expect(page.at("job-words")).to_contain_text("INTERRUPTED by RefX")
    page.at("delete").click()
    page.doing("at rest")
    typed.fill("J")
    typed.press("Enter")
    expect(page.answers.first).to_contain_text("J → 0  done")
    expect(page.at("position-X")).to_have_text("0")


@pytest.mark.parametrize("coupled", ["FF", "03"])
def test_a_probe_goes_back_to_where_it_was_touched(page: GvePage, coupled: str) -> None:
    probe = "SW3,00\nSW1,80\nA1\nV1000\nL0,0,-20000\n;@probe\nC0,0,10\n"
    page.open("probe.gve", f"EW0C,{coupled}\n{probe}")
    page.at("start").click()
    expect(page.at("steps-Z")).to_have_text(re.compile(r"\d{3} pulses"))
    page.page.locator("#inputs button", has_text="plate").click()
    expect(page.at("job-words")).to_have_text("probe.gve is done")
    page.doing("at rest")
    z, a = page.steps("Z"), page.steps("A")
    page.at("typed").fill("PL")
    page.at("typed").press("Enter")
    along = z - 10 if coupled == "03" else 0
    expect(page.answers.first).to_contain_text(f"PL → 0,0,0,{z - 10},{along}  done")
    assert z < 0
    assert a == (z if coupled == "03" else 0)


def test_what_the_unit_has_done_is_told_in_the_language_of_the_page(page: GvePage) -> None:
    page.at("language").select_option("cs")
    page.jog("X+")
    expect(page.answers.first).to_contain_text("osy jedou o X 100")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_contain_text("HALT je potvrzen: osy stojí na X")
    expect(page.answers.first).to_contain_text("v klidu")
    expect(page.answers.first).to_contain_text("potvrzeno jednotkou")
    page.at("language").select_option("en")
    expect(page.answers.first).to_contain_text("confirmed by the unit")


Lined = Callable[[SerialBridge], tuple[GvePage, SerialBridge]]


@pytest.fixture
def lined(browser: Browser, written: Path) -> Iterator[Lined]:
    """Opens a page with a serial port, and a bridge at its other end."""
    with contextlib.ExitStack() as stack:

        def begin(bridge: SerialBridge) -> tuple[GvePage, SerialBridge]:
            stack.callback(bridge.close)
            page = stack.enter_context(unit_shown(LinePage, browser, "about:blank"))
            page.page.add_init_script(bridge.script)
            page.page.goto((written / NAME).as_uri())
            connect(page.ready())
            return page, bridge

        yield begin


@pytest.fixture
def place(tmp_path: Path) -> Iterator[str]:
    """Where a unit is served."""
    unit = Served("--tcp", "0", cwd=tmp_path, command=GVE_COMMAND)
    yield unit.place
    unit.end()


def connect(page: GvePage) -> None:
    page.at("connect").click()
    expect(page.at("port")).to_be_enabled()
    page.at("port").select_option("serial")
    page.at("connect").click()
    expect(page.at("state")).to_contain_text(PORT)
    page.ready()


def test_a_real_unit_on_a_bad_line_makes_every_pulse(place: str, lined: Lined) -> None:
    bridge = BadBridge(place)
    page, _ = lined(bridge)
    expect(page.at("rate")).to_be_disabled()
    expect(page.page.locator("#inputs button").first).to_be_disabled()
    assert page.page.evaluate("fakeSerial.opened[0].baudRate") == 115200
    page.example("circle.gve")
    page.at("start").click()
    expect(page.at("job-words")).to_have_text("circle.gve is done", timeout=60_000)
    assert (page.steps("X"), page.steps("Y"), page.steps("Z")) == (3200, 9600, 800)
    assert bridge.packets >= max(bridge.UNANSWERED)
    assert bridge.sent.count(b"!0>") >= len(bridge.DAMAGED + bridge.UNANSWERED)


def test_a_cable_that_is_pulled_in_a_job_is_told_and_nothing_happens_later(
    place: str, lined: Lined
) -> None:
    page, bridge = lined(SerialBridge(place))
    page.open("long.gve", LONG)
    page.at("start").click()
    page.doing("moving")
    page.at("stop").click()
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    page.at("go").click()
    page.doing("moving")
    page.page.evaluate("void fakeSerial.pull()")
    expect(page.at("loud")).to_contain_text("THE PORT IS NOT THERE")
    expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
    expect(page.at("job-words")).to_contain_text("has ended: USB 0403:6001 was lost")
    page.at("stop").click()
    expect(page.at("alarm")).to_contain_text("HALT NOT CONFIRMED: USE THE EMERGENCY STOP")
    bridge.wait_until_free()
    bridge.sent = b""
    page.page.wait_for_timeout(1500)
    assert bridge.sent == b""
    connect_again(page)
    page.at("stop").click()
    expect(page.at("alarm")).to_contain_text("HALT is confirmed")
    assert b"!0C" not in bridge.sent


def test_a_unit_that_restarts_or_falls_silent_in_a_job_is_told_loudly(lined: Lined) -> None:
    unit = FakeGve(vector_s=0.05)
    line = FakeGveLine(unit)
    try:
        page, _ = lined(SerialBridge(line.port))
        page.open("long.gve", LONG)
        page.at("start").click()
        page.doing("moving")
        with line.lock:
            unit.restart()
        expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
        expect(page.at("job-words")).to_contain_text("long.gve has ended")
        expect(page.at("start")).to_be_disabled()
        page.at("seen").click()
        expect(page.at("loud")).to_be_hidden()
        page.at("start").click()
        page.doing("moving")
        with line.lock:
            unit.mute = True
        expect(page.at("loud")).to_contain_text("WHETHER THE AXES MOVE IS NOT KNOWN")
        expect(page.at("position-X")).to_have_text(NOT_KNOWN)
        page.page.keyboard.press("Escape")
        expect(page.at("alarm")).to_contain_text("NOT CONFIRMED")
        taken = len(unit.taken)
        with line.lock:
            unit.mute = False
        expect(page.at("alarm")).to_contain_text("HALT is confirmed")
        page.doing(re.compile("stopped|at rest"))
        assert len(unit.taken) == taken
    finally:
        line.close()


def test_checksums_that_another_program_switches_off_are_no_restart(lined: Lined) -> None:
    unit = FakeGve(vector_s=0.05)
    line = FakeGveLine(unit)
    try:
        page, _ = lined(SerialBridge(line.port))
        page.open("long.gve", f"!7V400\n{LONG}")
        page.at("start").click()
        page.doing("moving")
        with line.lock:
            unit.take(encoded("%-", sums=True))
        words = page.at("job-words")
        expect(words).to_contain_text("another program has switched its checksums off")
        expect(words).to_contain_text("whether the axes move is NOT KNOWN")
        expect(page.at("spindle-now")).to_have_text("\N{EN DASH}")
        page.page.keyboard.press("Escape")
        expect(page.at("alarm")).to_contain_text("HALT is confirmed")
        page.doing("stopped, vectors wait")
        expect(page.at("loud")).to_be_hidden()
        page.at("language").select_option("cs")
        expect(words).to_contain_text("jiný program vypnul její kontrolní součty")
    finally:
        line.close()


def test_a_pause_in_which_another_program_has_used_the_unit_ends_the_job(lined: Lined) -> None:
    unit = FakeGve(vector_s=0.05)
    line = FakeGveLine(unit)
    try:
        page, _ = lined(SerialBridge(line.port))
        page.open("a.gve", "C5\n;@pause put in tool 2\nC7\n")
        page.at("start").click()
        expect(page.at("resume")).to_be_visible()
        with line.lock:
            unit.take(encoded("L640,0,0,0", sums=True))
        page.at("resume").click()
        expect(page.at("job-words")).to_contain_text(
            "has counted commands that were not sent from here"
        )
        assert unit.taken == [(5, 0, 0, 0), (640, 0, 0, 0)]
    finally:
        line.close()


SLEEP = "(ms) => { const now = Date.now.bind(Date); Date.now = () => now() + ms; }"


def test_after_a_sleep_of_the_computer_a_job_waits_for_somebody(place: str, lined: Lined) -> None:
    page, bridge = lined(SerialBridge(place))
    page.open("long.gve", LONG)
    page.at("start").click()
    page.doing("moving")
    for worker in page.page.workers:
        worker.evaluate(SLEEP, 25_000)
    expect(page.at("job-words")).to_contain_text("slept for 25 s: INTERRUPTED by H")
    page.doing("stopped, vectors wait")
    page.at("language").select_option("cs")
    expect(page.at("job-words")).to_contain_text("jeho program spal 25 s: PŘERUŠENO: H")
    page.at("language").select_option("en")
    bridge.sent = b""
    page.page.wait_for_timeout(500)
    assert b"!0C" not in bridge.sent
    page.at("go").click()
    page.doing("moving")
    expect(page.at("job-words")).to_have_text("long.gve runs")
    page.page.keyboard.press("Escape")
    page.doing("stopped, vectors wait")


def test_what_is_loud_covers_nothing_of_the_page(lined: Lined) -> None:
    unit = FakeGve()
    line = FakeGveLine(unit)
    try:
        page, _ = lined(SerialBridge(line.port))
        page.page.evaluate("void fakeSerial.pull()")
        page.at("stop").click()
        expect(page.at("alarm")).to_contain_text("NOT CONFIRMED")
        page.page.evaluate(DRAWN)
        assert page.page.evaluate(OVER) == []
    finally:
        line.close()


def test_a_unit_that_has_restarted_while_its_port_was_gone_is_told(lined: Lined) -> None:
    unit = FakeGve()
    unit.positions[0] = 5
    line = FakeGveLine(unit)
    try:
        page, _ = lined(SerialBridge(line.port))
        page.page.evaluate("void fakeSerial.pull()")
        with line.lock:
            unit.restart()
        connect_again(page)
        expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
    finally:
        line.close()


def test_a_unit_that_restarts_at_an_h_of_the_file_gets_nothing_more(lined: Lined) -> None:
    unit = FakeGve(restarts_at="H")
    unit.positions[1] = 5
    line = FakeGveLine(unit)
    try:
        page, _ = lined(SerialBridge(line.port))
        page.open("halts.gve", "C5\nH\nD\nC7\n")
        page.at("start").click()
        expect(page.at("loud")).to_contain_text("THE UNIT HAS RESTARTED")
        expect(page.at("job-words")).to_contain_text("halts.gve has ended")
        assert unit.taken == [(5, 0, 0, 0)]
    finally:
        line.close()


def connect_again(page: GvePage) -> None:
    expect(page.at("connect")).to_have_text("Connect")
    page.at("connect").click()
    page.ready()


def test_it_looks_right_at_every_width_and_axe_finds_nothing_serious(page: GvePage) -> None:
    page.example("pocket.gve")
    page.page.evaluate(AXE.read_text())
    for width, height in SIZES:
        page.page.set_viewport_size({"width": width, "height": height})
        for language in ("cs", "en"):
            page.at("language").select_option(language)
            page.page.wait_for_timeout(200)
            for look in (OUTSIDE, OVER, CUT):
                assert page.page.evaluate(look) == [], (width, language)
            assert page.page.evaluate("document.documentElement.scrollWidth") <= width
    for scheme in ("light", "dark"):
        page.page.emulate_media(color_scheme=scheme)
        assert page.page.evaluate(VIOLATIONS) == []
    assert page.at("serial-hint").is_hidden() == page.page.evaluate("'serial' in navigator")
