"""Machine files in the page of a GVE134 that needs no service: mm, limits and reference runs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from alone_page import write_alone
from gve_page import GvePage
from page_source import ask_source
from playwright.sync_api import FilePayload, Page, expect
from rkm04_tools.gve134.gcode.axes import mill_of
from rkm04_tools.gve134.gcode.turning import turn_file
from rkm04_tools.machine.machine import Machine
from tab import visited

MILL = Path(__file__).resolve().parents[2] / "tools/examples/gve/mill.rkm"
SOURCE = "gve134/alone/mill.ts"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page as a file."""
    return write_alone(tmp_path_factory.mktemp("alone") / "page").with_name("gve134.html")


@pytest.fixture
def page(tab: Page, written: Path) -> Iterator[GvePage]:
    with visited(GvePage, tab, written.as_uri()) as page:
        yield page.ready()


def opened(page: GvePage, content: dict[str, Any]) -> None:
    """Have it open a machine file."""
    data = json.dumps(content).encode()
    file: FilePayload = {"name": "a.rkm", "mimeType": "application/json", "buffer": data}
    page.at("machine-file").set_input_files(file)


def test_a_machine_brings_mm_and_its_reference_runs(page: GvePage) -> None:
    expect(page.at("home-all")).to_be_disabled()
    page.at("machine-file").set_input_files(MILL)
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.jog("X+")
    expect(page.at("position-X")).to_have_text("1.000 mm")
    assert page.steps("X") == 320
    page.example("circle.gve")
    expect(page.at("scale")).to_contain_text("mm")
    page.page.locator("#inputs button", has_text="Ref Z").click()
    page.at("home-all").click()
    page.doing("reference run: the unit tells nothing until it stands")
    page.page.keyboard.press("Escape")
    expect(page.at("alarm")).to_have_attribute("data-kind", "done")
    page.doing("stopped, nothing waits")


def test_a_reference_run_is_made_to_its_end(page: GvePage) -> None:
    told = json.loads(MILL.read_text())
    told["gve134"]["axes"]["x"]["homing"] = {
        "way_steps": -100_000,
        "speed_steps_per_s": 4000,
        "back_steps": 50_000,
        "back_speed_steps_per_s": 1000,
        "position_steps": -960,
        "opens": False,
    }
    opened(page, told)
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.home("X")
    page.doing("reference run: the unit tells nothing until it stands")
    switch = page.page.locator("#inputs button", has_text="Ref X")
    page.page.wait_for_timeout(500)
    switch.click()
    page.page.wait_for_timeout(1500)
    switch.click()
    expect(page.at("job-words")).to_have_text("home X is done")
    expect(page.at("position-X")).to_have_text("\N{MINUS SIGN}3.000 mm")


def test_its_own_unit_asks_for_the_danger_and_keeps_within_the_machine_too(page: GvePage) -> None:
    page.at("machine-file").set_input_files(MILL)
    expect(page.at("machine-shown")).to_have_text("Small mill")
    page.doing("at rest")
    expect(page.jog_button("X+")).to_be_disabled()
    page.jog("X-")
    expect(page.answers.first).to_contain_text("beyond its limit in the machine file")
    assert page.steps("X") == 0


NO_MACHINES: list[tuple[dict[str, Any], str]] = [
    ({"version": 2}, "was written by later tools; take a later page; not opened"),
    ({"gve134": None}, "its part gve134 is missing"),
    ({"motors": [{"program": ""}] * 4}, "motor 1 is axis X and needs steps_per_mm"),
    ({"colour": 1}, "nothing is known of colour"),
    ({"notes": "a" * 10_000_000}, "larger than 2,000,000 bytes"),
]


def test_what_is_no_machine_for_it_is_refused_in_words(page: GvePage) -> None:
    for change, words in NO_MACHINES:
        told = {**json.loads(MILL.read_text()), **change}
        opened(page, {key: value for key, value in told.items() if value is not None})
        expect(page.at("file-trouble")).to_contain_text(words)
        expect(page.at("machine-shown")).to_have_text("none: positions in pulses")


@pytest.mark.parametrize("axis", [None, "X", "Z", "A"])
@pytest.mark.parametrize("corners", [False, True])
def test_reference_runs_are_those_that_gcode_writes(axis: str | None, corners: bool) -> None:
    told = json.loads(MILL.read_text())
    told["gve134"]["axes"]["y"]["homing"]["opens"] = False
    if corners:
        told["gve134"]["corner_deviation_mm"] = 0.05
    [mill] = ask_source(SOURCE, [["millOf", told]])
    [found] = ask_source(SOURCE, [["homingText", mill, axis]])
    pieces: list[str] = []
    gcode = f"G91 G28 {axis}0" if axis else "G28"
    turned = turn_file([gcode.encode()], "home", mill_of(Machine("a.rkm", told)), pieces.append)

    def commands(text: str) -> list[str]:
        lines = (line.split(" ; ")[0] for line in text.splitlines())
        return [line for line in lines if line.startswith(";@") or not line.startswith(";")]

    assert (found is not None) == turned.is_good
    if found is not None:
        assert commands(found) == commands("".join(pieces))
