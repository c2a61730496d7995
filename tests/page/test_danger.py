"""Motion by hand on the pages of a GVE134 and a positioning unit, after the danger."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from gve_page import GvePage, GveService, gve_shown
from playwright.sync_api import Browser, expect
from pos_page import PosPage, PosService, pos_shown

EXAMPLES = Path(__file__).resolve().parents[2] / "tools/examples/gve"


@pytest.fixture
def gve(browser: Browser) -> Iterator[GvePage]:
    """With a virtual unit."""
    service = GveService()
    try:
        with gve_shown(browser, service.url) as page:
            yield page.ready()
    finally:
        service.end()


@pytest.fixture
def service() -> Iterator[PosService]:
    """With a virtual unit."""
    service = PosService()
    yield service
    service.end()


@pytest.fixture
def pos(browser: Browser, service: PosService) -> Iterator[PosPage]:
    with pos_shown(browser, service.url) as page:
        yield page.ready()


def test_no_axis_of_a_gve134_is_moved_by_hand_before_the_danger_was_confirmed(gve: GvePage) -> None:
    gve.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    expect(gve.at("machine-shown")).to_have_text("Small mill")
    home = gve.page.locator("#axes").get_by_role("button", name="Home").first
    moving = [gve.jog_button("X-"), gve.jog_button("X+"), home, gve.at("home-all")]
    for button in moving:
        expect(button).to_be_disabled()
    expect(gve.at("stop")).to_be_enabled()
    for text in ("L100", " !0c100", "g", "sw6,00"):
        gve.at("typed").fill(text)
        gve.page.keyboard.press("Enter")
        expect(gve.answers.first).to_contain_text(f"{text.strip()} sets axes in motion")
        expect(gve.at("typed")).to_have_value(text)
    assert set(gve.sent) <= {"ports"}
    gve.page.keyboard.press("Escape")
    expect(gve.at("alarm")).to_have_attribute("data-kind", "done")
    gve.at("delete").click()

    gve.at("danger-confirm").focus()
    gve.page.keyboard.press("Space")
    for button in moving:
        expect(button).to_be_enabled()
    gve.at("typed").fill("L100")
    gve.page.keyboard.press("Enter")
    expect(gve.at("steps-X")).to_have_text("100 pulses")


def test_another_connection_of_a_gve134_asks_for_the_danger_anew(gve: GvePage) -> None:
    gve.confirm_danger()
    expect(gve.jog_button("X+")).to_be_enabled()
    gve.at("connect").click()
    expect(gve.at("danger-confirm")).not_to_be_checked()
    gve.at("danger-confirm").check()
    gve.at("connect").click()
    gve.ready()
    gve.doing("at rest")
    expect(gve.at("danger-confirm")).not_to_be_checked()
    expect(gve.jog_button("X+")).to_be_disabled()
    gve.confirm_danger()
    gve.page.reload()
    gve.ready()
    expect(gve.at("danger-confirm")).not_to_be_checked()
    expect(gve.jog_button("X+")).to_be_disabled()


def test_a_line_that_is_given_up_while_the_axes_of_a_gve134_move_is_told(gve: GvePage) -> None:
    gve.confirm_danger()
    gve.at("typed").fill("L100000")
    gve.page.keyboard.press("Enter")
    gve.beyond(100)
    gve.at("connect").click()
    expect(gve.at("left-units")).to_contain_text("THIS PAGE CANNOT STOP virtual unit")
    expect(gve.at("left-units")).to_contain_text("WHETHER IT MOVES IS NOT KNOWN")
    gve.at("connect").click()
    gve.ready()
    expect(gve.at("left-units")).to_be_hidden()


def test_the_rest_of_a_motion_by_hand_goes_on_only_after_the_danger_was_confirmed(
    gve: GvePage,
) -> None:
    gve.confirm_danger()
    gve.at("typed").fill("L100000")
    gve.page.keyboard.press("Enter")
    gve.beyond(100)
    gve.page.keyboard.press("Escape")
    gve.doing("stopped, vectors wait")
    expect(gve.at("go")).to_be_enabled()
    gve.page.reload()
    gve.ready()
    gve.doing("stopped, vectors wait")
    expect(gve.at("go")).to_be_disabled()
    expect(gve.at("delete")).to_be_enabled()
    gve.confirm_danger()
    gve.at("go").click()
    gve.doing("moving")


def test_a_jog_beyond_the_positions_of_the_machine_file_is_refused_in_words(gve: GvePage) -> None:
    gve.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    expect(gve.at("machine-shown")).to_have_text("Small mill")
    gve.jog("X-")
    expect(gve.answers.first).to_contain_text(
        "nothing was moved: X would go to \N{MINUS SIGN}1 mm, beyond its limit in the machine "
        "file, 0 mm; where its position is not true, home it"
    )
    gve.jog("Z+")
    expect(gve.answers.first).to_contain_text("Z would go to 1 mm, beyond its limit")
    gve.at("language").select_option("cs")
    gve.jog("Z+")
    expect(gve.answers.first).to_contain_text("Z by jela na 1 mm, za svou mez")
    assert "jog" not in gve.sent


def test_a_jog_up_to_its_limit_is_made_and_so_is_one_back_from_beyond_it(gve: GvePage) -> None:
    gve.at("machine-file").set_input_files(EXAMPLES / "mill.rkm")
    gve.at("typed").fill("NX95840")
    gve.page.keyboard.press("Enter")
    expect(gve.at("position-X")).to_have_text("299.500 mm")
    gve.at("jog-step").select_option("0.1")
    gve.confirm_danger()
    for _ in range(8):
        gve.jog_button("X+").click(click_count=3)
        gve.page.wait_for_timeout(100)
        gve.doing("at rest")
        assert gve.steps("X") <= 96_000
    expect(gve.at("position-X")).to_have_text("300.000 mm")
    expect(gve.answers.first).to_contain_text("beyond its limit in the machine file")
    gve.at("typed").fill("NX97000")
    gve.page.keyboard.press("Enter")
    expect(gve.at("steps-X")).to_have_text("97,000 pulses")
    gve.jog("X-")
    expect(gve.at("steps-X")).to_have_text("96,968 pulses")


def test_no_axis_of_a_positioning_unit_is_moved_by_hand_before_the_danger_was_confirmed(
    pos: PosPage,
) -> None:
    pos.page.locator("#axis-1 summary").click()
    pos.at("take-1").click()
    pos.doing("TAKEN")
    moving = [pos.at(f"{name}-1") for name in ("move", "measure", "home")]
    for button in moving:
        expect(button).to_be_disabled()
    expect(pos.at("hold-1")).to_be_enabled()
    expect(pos.at("stop")).to_be_enabled()
    pos.at("danger-confirm").focus()
    pos.page.keyboard.press("Space")
    for button in moving:
        expect(button).to_be_enabled()
    pos.at("measure-1").click()
    pos.doing("READY")
    expect(pos.at("go-1")).to_be_enabled()


def test_an_axis_is_held_and_slowed_but_not_sped_up_before_it(
    pos: PosPage, browser: Browser, service: PosService
) -> None:
    pos.move("1000", "600")
    pos.doing("MOVING")
    with pos_shown(browser, service.url) as second:
        second.ready()
        second.doing("MOVING")
        expect(second.at("go-1")).to_be_disabled()
        second.at("feed-value-1").fill("1200")
        second.page.keyboard.press("Enter")
        second.page.wait_for_timeout(700)
        assert "control" not in second.sent
        second.at("feed-value-1").fill("300")
        second.page.keyboard.press("Enter")
        expect(second.at("speed-1")).to_have_text("300 mm/min")
        second.at("hold-1").click()
        second.doing("READY")
        expect(second.at("go-1")).to_be_disabled()
        second.confirm_danger()
        second.at("go-1").click()
        second.doing("MOVING")
        second.page.keyboard.press("Escape")
        expect(second.at("alarm")).to_have_attribute("data-kind", "done")


def test_another_connection_of_a_positioning_unit_asks_for_the_danger_anew(pos: PosPage) -> None:
    pos.confirm_danger()
    expect(pos.at("move-1")).to_be_enabled()
    pos.at("connect").click()
    expect(pos.at("danger-confirm")).not_to_be_checked()
    pos.at("danger-confirm").check()
    pos.at("connect").click()
    pos.ready()
    expect(pos.at("danger-confirm")).not_to_be_checked()
    expect(pos.at("move-1")).to_be_disabled()
