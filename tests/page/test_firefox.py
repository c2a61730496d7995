"""Pages in Firefox: what depends on the browser. All else is tried in Chromium."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from alone_page import write_alone
from firefox import FIREFOX, Firefox, running
from pos_page import PosService
from serial_bridge import SerialBridge
from served import Served

NODE = 3
LONG = "\\ C100 S1000 V1000 A1000 F1000000 R"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> str:
    return write_alone(tmp_path_factory.mktemp("firefox") / "page").as_uri()


@pytest.fixture(scope="module")
def firefox(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Firefox]:
    if not FIREFOX.exists():
        pytest.skip(f"{FIREFOX} is not there: install Debian's package {FIREFOX.name}")
    with running(tmp_path_factory.mktemp("profile")) as firefox:
        yield firefox
        assert firefox.faults == []


def write(firefox: Firefox, text: str) -> None:
    firefox.click(".cm-content")
    firefox.press("Control", "a")
    firefox.type(text)


def state(number: int) -> str:
    return f"#state-{number}"


def stop(firefox: Firefox) -> None:
    """Press Escape while the first motor moves."""
    firefox.wait_for_text(state(1), "moves")
    firefox.press("Escape")
    firefox.wait_for("document.getElementById('alarm').dataset.kind === 'done'")
    firefox.wait_for_text(state(1), "stopped by K")


def test_it_checks_draws_runs_and_stops_and_says_what_to_use_for_a_real_unit(firefox, written):
    firefox.open(written, "delete Navigator.prototype.serial")
    write(firefox, "S100 V20000")
    firefox.wait_for("document.getElementById('verdict').dataset.kind === 'error'")
    write(firefox, LONG)
    firefox.wait_for("document.getElementById('verdict').dataset.kind === 'good'")
    firefox.wait_for("document.getElementById('plan').dataset.pulses === '59999'")

    firefox.click("#send")
    stop(firefox)

    assert "tools/rkm04 service" in firefox.text("#serial-hint")
    assert firefox.evaluate("document.getElementById('serial-hint').checkVisibility()")
    assert not firefox.evaluate("document.getElementById('connection-form').checkVisibility()")


def test_it_speaks_to_a_unit_on_a_serial_port_where_the_browser_has_them(
    firefox, written, tmp_path
):
    unit = Served("--tcp", "0", "--node", str(NODE), cwd=tmp_path)
    bridge = SerialBridge(unit.place)
    try:
        firefox.open(written, bridge.script)
        firefox.wait_for("document.body.dataset.connected === 'true'")
        firefox.click("#connect")
        firefox.wait_for("!document.getElementById('port').disabled")
        firefox.evaluate(f"port.value = 'serial', node.value = '{NODE}'")
        firefox.click("#connect")
        firefox.wait_for_text("#state", f"node {NODE}")

        write(firefox, LONG)
        firefox.click("#send")
        stop(firefox)
        firefox.evaluate("void fakeSerial.pull()")

        firefox.wait_for_text("#banner", "was lost (unplugged)")
    finally:
        bridge.close()
        unit.end()


def test_a_motor_runs_as_long_as_its_button_is_held(firefox, written):
    firefox.open(written)
    firefox.wait_for("document.body.dataset.connected === 'true'")
    firefox.evaluate("document.getElementById('commission').open = true")
    firefox.click("#commission-confirm")
    firefox.wait_for("!document.getElementById('jog-forth').disabled")
    firefox.click("#jog-forth", held_ms=2000)
    firefox.wait_for_text(state(1), "nothing left to run")
    position = "document.getElementById('position-1').textContent.replace(',', '')"
    firefox.wait_for(f"{position} > 300 && {position} < 2000")
    firefox.wait_for("document.querySelectorAll('#log [data-message=stop]').length === 0")


def move_and_stop_axis(firefox: Firefox) -> None:
    firefox.wait_for_text("#state-1", "FREE")
    firefox.click("#way-1")
    firefox.press("Control", "a")
    firefox.type("2000.5")
    firefox.click("#danger-confirm")
    firefox.click("#move-1")
    firefox.wait_for_text("#state-1", "MOVING")
    firefox.wait_for_text("#target-1", "2,000.500 mm")
    firefox.press("Escape")
    firefox.wait_for("document.getElementById('alarm').dataset.kind === 'done'")
    firefox.wait_for_text("#state-1", "READY")
    firefox.wait_for("document.getElementById('curves').dataset.samples > 3")


def test_an_axis_moves_and_stops_in_the_page_that_needs_no_service(firefox, written):
    firefox.open(written.replace("index.html", "positioning.html"))
    firefox.wait_for_text("#serial-hint", "tools/positioning service")
    move_and_stop_axis(firefox)


def test_an_axis_of_a_positioning_unit_moves_and_stops(firefox):
    service = PosService()
    try:
        firefox.open(service.url)
        move_and_stop_axis(firefox)
    finally:
        service.end()


def test_a_job_of_a_gve134_runs_and_halts_in_the_page_that_needs_no_service(firefox, written):
    firefox.open(written.replace("index.html", "gve134.html"), "delete Navigator.prototype.serial")
    firefox.wait_for_text("#live-state", "at rest")
    firefox.wait_for_text("#serial-hint", "tools/gve134 service")
    firefox.evaluate(
        "examples.value = 'circle.gve', examples.dispatchEvent(new Event('change')), 0"
    )
    firefox.wait_for("document.getElementById('canvas').dataset.plan === '103'")
    firefox.wait_for("!document.getElementById('start').disabled")
    firefox.click("#start")
    firefox.wait_for_text("#live-state", "moving")
    firefox.press("Escape")
    firefox.wait_for_text("#alarm", "HALT is confirmed")
    firefox.wait_for_text("#job-words", "was stopped")
