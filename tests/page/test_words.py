"""Languages, and what the page is for those who use the keyboard or listen to it."""

from __future__ import annotations

from playwright.sync_api import expect
from service_page import TABLET, shown


def test_the_language_is_that_of_the_browser_until_another_is_chosen(browser, service):
    with shown(browser, service.url, locale="cs-CZ") as page:
        send = page.page.locator("#send")
        expect(send).to_have_text("Poslat")
        page.page.locator("#language").select_option("en")
        expect(send).to_have_text("Send")
        page.page.reload()
        page.ready()
        expect(send).to_have_text("Send")
        expect(page.page.locator("html")).to_have_attribute("lang", "en")


def test_answers_and_errors_are_in_the_language_too(browser, service):
    with shown(browser, service.url, locale="cs-CZ") as page:
        page.send("\\ C100 F5 R")
        expect(page.answers.first).to_contain_text("odesláno a přijato")
        page.write("V20000")
        page.page.locator(".cm-lintRange-error").hover()
        expect(page.page.locator(".cm-tooltip")).to_contain_text("čeká se číslo od 1 do 16000")
        page.page.locator("#language").select_option("en")
        expect(page.answers.first).to_contain_text("sent and accepted")


def test_stop_is_the_second_stop_of_the_tab_key(page):
    page.page.keyboard.press("Tab")
    page.page.keyboard.press("Tab")
    expect(page.page.locator("#stop")).to_be_focused()
    page.page.keyboard.press("Enter")
    expect(page.answers.first).to_have_attribute("data-message", "stop")


def test_a_program_is_sent_without_a_mouse(page):
    page.write("\\ C100 F30 R")
    page.page.locator("#send").focus()
    page.page.keyboard.press("Enter")
    expect(page.position(1)).to_have_text("30")
    expect(page.page.locator("#spoken")).to_contain_text("sent and accepted")


def test_tabs_are_changed_by_the_arrow_keys(page):
    page.page.locator("#tab-1").focus()
    page.page.keyboard.press("ArrowRight")
    expect(page.page.locator("#tab-2")).to_be_focused()
    expect(page.page.locator("#tab-2")).to_have_attribute("aria-selected", "true")


def test_a_tablet_needs_no_scrolling_sideways(browser, service):
    for size in (TABLET, (768, 1024)):
        with shown(browser, service.url, size=size) as page:
            wide = page.page.evaluate("document.documentElement.scrollWidth - innerWidth")
            assert wide <= 0
