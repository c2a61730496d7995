"""The page and the unit: what is sent, what is seen, and above all Stop."""

from __future__ import annotations

from playwright.sync_api import expect
from service_page import TABLET, ServicePage, shown

RUN = "\\ C100 S100 V2000 A20000 G+"


def test_opening_the_page_sends_nothing_to_the_unit(page):
    page.page.wait_for_timeout(500)
    assert set(page.sent) <= {"ports"}
    assert page.steps() == 0


def test_a_program_that_is_sent_moves_the_virtual_unit_and_the_answer_is_shown(page):
    page.send("\\ C100 S100 V1000 A2000 F300 R")
    expect(page.position(1)).to_have_text("300")
    answer = page.answers.first
    expect(answer).to_contain_text("Set Command")
    expect(answer.locator(".log-message code").last).to_have_text("02 31 00 00")


def test_a_program_with_an_error_is_not_sent_and_the_cursor_goes_there(page):
    page.send("F10 R\nR S0")
    expect(page.answers.first).to_have_class("log-item is-bad")
    page.page.keyboard.insert_text("V")
    assert page.text() == "F10 R\nR VS0"
    assert page.steps() == 0


def test_escape_stops_all_motors_even_from_within_the_editor_and_resume_goes_on(page):
    page.send(RUN)
    page.expect_beyond(500)
    page.page.locator(".cm-content").click()
    page.page.keyboard.press("Escape")
    expect(page.answers.first).to_have_attribute("data-message", "stop")
    stands = page.expect_standing()

    page.page.locator("#resume").click()
    page.expect_beyond(stands)


def test_stop_goes_ahead_of_what_waits(page):
    page.send(RUN)
    page.page.locator("#message").select_option("table")
    for _ in range(30):
        page.page.locator("#send").click()
    page.page.locator("#stop").click()
    page.expect_standing()
    page.expect_sent("stop", 1)


def test_a_reload_in_the_middle_leaves_the_motion_alone_and_sends_nothing(page):
    page.send(RUN)
    page.expect_beyond(100)
    page.sent.clear()
    page.page.reload()
    page.ready()
    page.expect_beyond(page.steps())
    assert set(page.sent) <= {"ports"}


def test_two_browsers_look_at_one_unit_and_one_may_leave(browser, service):
    with shown(browser, service.url) as second:
        with shown(browser, service.url) as first:
            first.send(RUN)
            expect(second.answers.first).to_contain_text("Set Command")
            second.expect_beyond(100)
            assert set(second.sent) <= {"ports"}
        second.expect_beyond(second.steps())
        second.calm()


def test_an_input_of_the_virtual_unit_is_pressed_and_an_output_lights(own_page):
    own_page.send("\\ C100 O05 T03 F50 R")
    own_page.page.locator("#live-inputs button").nth(4).click()
    expect(own_page.position(1)).to_have_text("50")
    expect(own_page.page.locator("#live-inputs button").nth(4)).to_have_attribute("data-level", "1")
    expect(own_page.page.locator("#live-outputs span").nth(2)).to_have_attribute("data-level", "1")


def test_a_program_that_was_read_goes_back_to_the_editor(page):
    page.send("\\ C100 F5 R")
    page.write("F6 R")
    page.page.locator("#message").select_option("program")
    page.send()
    page.answers.first.locator("button").click()
    assert page.text() == "C100F5R"


def test_all_motors_get_the_shown_program_when_the_button_says_so(page):
    page.page.locator("#motors label").first.click()
    page.send("\\ C100 F20 R")
    for motor in (1, 2, 3, 4):
        expect(page.position(motor)).to_have_text("20")


def test_the_speed_of_a_move_is_changed_while_it_runs(page):
    page.send("\\ C100 S100 V200 A20000 G+")
    page.page.locator("#speed").fill("9000")
    page.page.locator("#speed-form button").click()
    page.expect_beyond(9000)


def expect_kept(page: ServicePage) -> None:
    page.page.locator("#speed").fill("900")
    page.page.locator("#speed-form button").click()
    expect(page.answers.first).to_have_attribute("data-message", "speed")
    expect(page.answers.first).to_contain_text("motor 1 keeps its speed: it is in a limit run")
    page.page.locator("#message").select_option("table")
    page.send()
    expect(page.answers.first).not_to_contain_text("900")


def test_a_speed_that_cannot_be_changed_is_not_told_as_changed(page):
    page.send("\\ C100 S100 )1")
    expect(page.state(1)).to_contain_text("moves")
    expect_kept(page)
    page.page.locator("#live-inputs .lamp").nth(2).click()
    page.send("\\ C100 S2000 V8000 A500 N3 G+ F1 R")
    page.expect_beyond(1000)
    page.page.locator("#live-inputs .lamp").nth(2).click()
    expect_kept(page)


def test_reset_asks_before_it_acts(page):
    reset = page.page.locator("#reset")
    reset.click()
    expect(reset).to_have_text("Really reset?")
    assert "reset" not in page.sent
    page.page.wait_for_timeout(600)
    reset.click()
    expect(page.answers.first).to_have_attribute("data-message", "reset")


def test_disconnecting_and_connecting_again_moves_nothing(own_page):
    own_page.send(RUN)
    own_page.page.locator("#connect").click()
    expect(own_page.page.locator("body")).to_have_attribute("data-connected", "false")
    own_page.page.locator("#node").select_option("3")
    own_page.page.locator("#connect").click()
    own_page.ready()
    expect(own_page.page.locator("#state")).to_contain_text("3")
    assert own_page.steps() == 0


def test_who_disconnects_a_motor_that_moves_is_told_that_nothing_stops_it_any_more(own_page):
    connect, left = own_page.page.locator("#connect"), own_page.page.locator("#left-units")
    connect.click()
    expect(connect).to_have_text("Connect")
    expect(left).to_be_hidden()
    connect.click()
    own_page.ready()
    own_page.send("\\ C100 S100 V200 A20000 G+")
    expect(own_page.page.locator(".card").first).to_have_attribute("data-moving", "true")
    connect.click()
    expect(left).to_contain_text("NOT CONNECTED: THIS PAGE CANNOT STOP virtual unit")
    own_page.page.locator("#language").select_option("cs")
    expect(left).to_contain_text("NEPŘIPOJENO: TATO STRÁNKA NEMŮŽE ZASTAVIT virtuální jednotka")
    own_page.page.locator("#language").select_option("en")
    connect.click()
    own_page.ready()
    expect(left).to_be_hidden()


def test_a_port_that_is_not_there_is_named_with_what_to_do(own_page):
    own_page.page.locator("#connect").click()
    own_page.page.locator("#port").select_option("")
    own_page.page.locator("#port-other").fill("socket://127.0.0.1:1")
    own_page.page.locator("#connect").click()
    expect(own_page.page.locator("#banner")).to_contain_text("127.0.0.1:1")


def test_stop_stays_in_sight_wherever_the_page_is_scrolled(browser, service):
    with shown(browser, service.url, size=TABLET) as page:
        page.page.mouse.wheel(0, 5000)
        page.page.wait_for_function("() => window.scrollY > 200")
        expect(page.page.locator("#stop")).to_be_in_viewport(ratio=1)


def test_a_page_without_its_service_says_that_it_cannot_stop_anything(own_page, own_service):
    own_service.end()
    expect(own_page.page.locator("#banner")).to_contain_text("emergency stop")
    own_page.page.keyboard.press("Escape")
    expect(own_page.answers.first).to_contain_text("Not sent")
