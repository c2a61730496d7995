"""Running a motor by hand, ramps, positions, switches; nothing moves longer than it is held."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, WebSocketRoute, expect
from service_page import Service, ServicePage, shown

NODE = 3
HOLDS_MAX, SOON_MS = 4, 3000
FAST = {"start": "200", "speed": "2000", "ramp": "8000", "farthest": "0"}


def opened(page: Page, **fields: str) -> None:
    """Show the panel, confirm the danger, and fill fields in."""
    page.locator("#commission").evaluate("(panel) => (panel.open = true)")
    for name, value in fields.items():
        page.locator(f"#commission-{name}").fill(value)
    if not page.locator("#commission-confirm").is_checked():
        page.locator("#commission-confirm").check()


def middle(page: Page, name: str) -> dict[str, float]:
    """The middle of a part, which is brought into view."""
    page.locator(name).scroll_into_view_if_needed()
    box = page.locator(name).bounding_box()
    assert box
    return {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}


def aim(page: Page, name: str) -> None:
    """Bring the mouse over a part."""
    place = middle(page, name)
    page.mouse.move(place["x"], place["y"])


def hold(page: Page, name: str, held_ms: float = 0) -> None:
    """Hold a button until its motor moves, and so long beyond that.

    A page, a service or a unit that comes too late, as on a busy machine, lets it go: that is safe,
    and it is held again.
    """
    moving = page.locator(".card[data-moving=true]")
    for _ in range(HOLDS_MAX):
        aim(page, name)
        page.mouse.down()
        with contextlib.suppress(AssertionError):
            expect(moving).to_have_count(1, timeout=SOON_MS)
            page.wait_for_timeout(held_ms)
            if moving.count() == 1:
                return
        page.mouse.up()
        expect(page.locator(name)).to_be_enabled()
    raise AssertionError(f"{name} is let go whenever it is held for {held_ms} ms")


@pytest.fixture
def bench(page: ServicePage) -> Iterator[ServicePage]:
    """The page with the panel, ready to move motor 1."""
    opened(page.page, **FAST)
    expect(page.page.locator("#jog-forth")).to_be_enabled()
    yield page
    page.page.mouse.up()
    page.stopped()
    page.page.locator("#commission").evaluate("(panel) => (panel.open = false)")


def expect_cleared(page: ServicePage) -> int:
    """Wait until the motor stands, and has nothing left to go on with; return where."""
    expect(page.page.locator("#commission-motor")).to_be_enabled()  # the reset is on its way
    expect(page.state(1)).to_have_text(re.compile("nothing left"))
    stands = page.expect_standing()
    page.page.locator("#resume").click()
    page.page.wait_for_timeout(300)
    assert page.expect_standing() == stands
    return stands


def test_nothing_can_be_moved_before_the_danger_was_read(page):
    page.page.locator("#commission").evaluate("(panel) => (panel.open = true)")
    for name in ("#jog-back", "#jog-forth", "#step-back", "#step-forth", "#commission-zero"):
        expect(page.page.locator(name)).to_be_disabled()
    page.page.locator("#commission-confirm").check()
    expect(page.page.locator("#jog-forth")).to_be_enabled()
    page.page.reload()
    page.ready()
    expect(page.page.locator("#commission-confirm")).not_to_be_checked()
    expect(page.page.locator("#jog-forth")).to_be_disabled()


@pytest.mark.parametrize(("name", "sign"), [("#jog-forth", 1), ("#jog-back", -1)])
def test_a_motor_runs_as_long_as_its_button_is_held(bench, name, sign):
    hold(bench.page, name, 1500)
    bench.sent.clear()
    bench.page.mouse.up()

    assert sign * expect_cleared(bench) > 200
    assert "stop" not in bench.sent


@pytest.mark.parametrize(
    "let_go",
    [
        lambda page: page.mouse.move(5, 5),
        lambda page: page.evaluate("window.dispatchEvent(new Event('blur'))"),
        lambda page: page.locator("#language").focus(),
        lambda page: page.keyboard.press("a"),
        lambda page: (page.mouse.down(button="right"), page.mouse.up(button="right")),
        lambda page: page.evaluate(
            "Object.defineProperty(document, 'hidden', { value: true, configurable: true });"
            "document.dispatchEvent(new Event('visibilitychange'));"
            "delete document.hidden;"
        ),
    ],
    ids=[
        "the pointer leaves",
        "the window is left",
        "the focus goes",
        "another key",
        "another button",
        "hidden",
    ],
)
def test_whatever_takes_the_button_away_lets_go(bench, let_go):
    hold(bench.page, "#jog-forth")
    let_go(bench.page)
    expect_cleared(bench)


@pytest.mark.parametrize(("key", "sign"), [(" ", 1), ("ArrowRight", 1), ("ArrowLeft", -1)])
def test_keys_hold_the_buttons_too(bench, key, sign):
    bench.page.locator("#jog-forth").focus()
    bench.page.keyboard.down(key)
    bench.page.keyboard.down(key)
    expect(bench.page.locator(".card").first).to_have_attribute("data-moving", "true")
    bench.page.keyboard.up(key)

    assert sign * expect_cleared(bench) > 0


def test_a_finger_holds_a_button_until_it_is_lifted_or_slides_away(browser, service):
    with shown(browser, service.url, touch=True) as page:
        opened(page.page, **FAST)
        expect(page.page.locator("#jog-forth")).to_be_enabled()
        touch = page.page.context.new_cdp_session(page.page)

        def tell(kind: str, *points: dict[str, float]) -> None:
            told = {"type": kind, "touchPoints": list(points)}
            touch.send("Input.dispatchTouchEvent", told)

        moving = page.page.locator(".card").first
        for kind in ("touchEnd", "touchMove"):
            place = middle(page.page, "#jog-forth")
            tell("touchStart", place)
            expect(moving).to_have_attribute("data-moving", "true")
            page.page.wait_for_timeout(1200)
            expect(moving).to_have_attribute("data-moving", "true")
            tell(kind, *([] if kind == "touchEnd" else [{**place, "y": 5.0}]))
            expect_cleared(page)
        tell("touchEnd")
        page.calm()


def test_escape_stops_all_while_a_button_is_held(bench):
    aim(bench.page, "#jog-forth")
    bench.page.mouse.down()
    expect(bench.page.locator(".card").first).to_have_attribute("data-moving", "true")
    bench.page.keyboard.press("Escape")
    expect(bench.alarm).to_have_attribute("data-kind", "done")
    expect_cleared(bench)


def test_a_run_goes_no_farther_than_was_allowed(bench):
    bench.page.locator("#commission-farthest").fill("300")
    expect(bench.page.locator("#commission-reach")).to_contain_text("at most 300 steps")
    aim(bench.page, "#jog-forth")
    bench.page.mouse.down()
    expect(bench.position(1)).to_have_text("300")
    bench.page.wait_for_timeout(300)
    bench.page.mouse.up()

    assert expect_cleared(bench) == 300


def test_where_it_may_go_at_most_is_not_told_nothing_is_moved(bench):
    for text in ("", "-5", "1.5", "99999999"):
        bench.page.locator("#commission-farthest").fill(text)
        aim(bench.page, "#jog-forth")
        bench.page.mouse.down()
        bench.page.wait_for_timeout(500)
        bench.page.mouse.up()
        assert "request" not in bench.sent


def test_a_step_that_is_pressed_twice_is_not_cut_off(bench):
    bench.page.locator("#commission-step").fill("300")
    bench.page.locator("#step-forth").dblclick()
    expect(bench.position(1)).to_have_text("300")
    assert expect_cleared(bench) == 300


def test_steps_go_so_far_in_both_directions(bench):
    bench.page.locator("#commission-step").fill("40")
    bench.page.locator("#step-forth").click()
    expect(bench.position(1)).to_have_text("40")
    expect(bench.page.locator("#step-back")).to_be_enabled()
    bench.page.locator("#step-back").click()
    expect(bench.position(1)).to_have_text("0")


def test_a_browser_that_dies_as_it_lets_go_leaves_nothing_running(browser, service):
    def relay(page: WebSocketRoute) -> None:
        server = page.connect_to_server()

        def forward(text: str | bytes) -> None:
            server.send(text)
            told = json.loads(text)
            if told.get("held") is False or told.get("text") == "K":
                server.close()

        page.on_message(forward)

    with shown(browser, service.url) as page:
        page.page.route_web_socket("**", relay)
        page.page.reload()
        opened(page.page, **FAST)
        expect(page.page.locator("#jog-forth")).to_be_enabled()
        aim(page.page, "#jog-forth")
        page.page.mouse.down()
        page.expect_beyond(100)
        page.page.mouse.up()
        with shown(browser, service.url) as other:
            other.expect_standing()
            other.calm()


def test_a_page_that_is_closed_lets_go(browser, service):
    with shown(browser, service.url) as page:
        opened(page.page, **FAST)
        expect(page.page.locator("#jog-forth")).to_be_enabled()
        aim(page.page, "#jog-forth")
        page.page.mouse.down()
        page.expect_beyond(100)
        page.page.close()
        with shown(browser, service.url) as other:
            other.expect_standing()
            other.calm()


def test_a_page_that_is_too_busy_to_hold_the_button_has_all_motors_stopped(bench):
    aim(bench.page, "#jog-forth")
    bench.page.mouse.down()
    bench.expect_beyond(100)
    bench.page.evaluate(
        """setTimeout(() => { for (const end = Date.now() + 1800; Date.now() < end;); })"""
    )
    stops = bench.page.locator("#log .log-item[data-message=stop]")
    expect(stops.first).to_be_visible()
    stands = expect_cleared(bench)
    bench.page.mouse.up()
    assert bench.expect_standing() == stands


def test_a_unit_that_falls_silent_while_the_button_is_held_is_an_alarm(lines_page, line, unit):
    page = lines_page
    opened(page.page, **FAST)
    expect(page.page.locator("#jog-forth")).to_be_enabled()
    aim(page.page, "#jog-forth")
    page.page.mouse.down()
    page.expect_sent("request", 1)
    del line.units[NODE]
    expect(page.alarm).to_have_attribute("data-kind", "failed")
    expect(page.alarm).to_contain_text("NOT CONFIRMED")
    page.page.mouse.up()
    before = len(line.requests)
    line.units[NODE] = unit
    expect(page.page.locator("#state")).to_have_attribute("data-kind", "good")
    page.page.wait_for_timeout(1000)
    later = [text[2:] for _, _, text in line.requests[before:] if text[:1] == b"\x02"]
    assert set(later) <= {b"K"}, "a stop may have been on its way yet"
    expect(page.page.locator("#jog-forth")).to_be_disabled()


def test_a_run_that_waits_for_a_scan_is_withdrawn_when_the_button_is_let_go(lines_page, unit):
    page = lines_page
    opened(page.page, **FAST)
    expect(page.page.locator("#jog-forth")).to_be_enabled()
    unit.done.clear()
    aim(page.page, "#jog-forth")
    page.page.evaluate("document.getElementById('scan').click()")
    page.page.mouse.down()
    page.expect_sent("request", 2)
    page.page.mouse.up()
    expect(page.page.locator("#log .log-item[data-message=scan]")).to_be_visible()
    expect(page.page.locator("#commission-motor")).to_be_enabled()
    sent = {each[2:] for each in unit.done if each[:1] == b"\x02"}
    assert sent <= {b"K", b"\\"}
    assert "stop" not in page.sent


def test_what_is_left_of_a_run_is_told_unless_its_reset_is_confirmed(lines_page, line, unit):
    page = lines_page.page
    opened(page, **FAST)
    expect(page.locator("#jog-forth")).to_be_enabled()
    unit.answers[b"\x021\\"] = b"\x021\x02\\"
    aim(page, "#jog-forth")
    page.mouse.down()
    lines_page.expect_sent("request", 1)
    unit.states[0] = 3
    expect(page.locator(".card[data-moving=true]")).to_have_count(1)
    page.mouse.up()
    lines_page.expect_sent("request", 2)
    unit.states[0] = 0

    expect(page.locator("#log .log-item").first).to_contain_text("the unit refuses")
    expect(page.locator("#commission-why")).to_contain_text("may still be in motor 1")


def test_the_ramp_is_told_as_the_firmware_plans_it(bench):
    opened(bench.page, start="100", speed="1000", ramp="2000", trial="5000")
    words = bench.page.locator("#ramp-words")
    expect(words).to_contain_text("reaches 1,000 steps/s after 0.451 s and 248 steps")
    expect(words).to_contain_text("takes 5.405 s")
    bench.page.locator("#commission-trial").fill("100")
    expect(words).to_contain_text("too few for V")
    bench.page.locator("#commission-speed").fill("20000")
    expect(words).to_contain_text("takes a number from 1 to 16000")
    expect(bench.page.locator("#jog-forth")).to_be_disabled()


def test_positions_settings_and_searches_go_into_the_program_and_nowhere_else(bench):
    bench.write("\\ C100\n")
    bench.sent.clear()
    opened(bench.page, start="100", speed="1000", ramp="2000", input="3", search="300", away="80")
    bench.page.locator("#commission-settings").click()
    bench.page.locator("#homing-run").select_option(")")
    bench.page.locator("#homing-twice").check()
    bench.page.locator("#homing-form button").click()
    expect(bench.page.locator("#homing-words")).to_contain_text("in the program")
    bench.page.locator("#commission-teach").click()
    text = re.sub(r" *\{[^}]*\}", "", bench.text())
    assert text.split() == ["\\", "C100", "S100", "V1000", "A2000", "S300", "V1000", "A2000", ")3",
                            "B80", "R", "S30", ")3", "=80", "H", "H"]  # fmt: skip
    expect(bench.page.locator("#verdict")).to_have_attribute(
        "data-kind", re.compile("good|warning")
    )
    assert "request" not in bench.sent


def test_the_service_gives_up_waiting_for_a_silent_browser(own_service: Service, browser):
    """The time is the service's own; a hold that is renewed goes on."""
    with shown(browser, own_service.url) as page:
        opened(page.page, **FAST)
        hold(page.page, "#jog-forth", 2500)
        page.page.mouse.up()
        expect_cleared(page)
