"""How the page looks at the widths it is made for, light and dark, in both languages."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from page_looks import SIZES, check_edges, check_looks
from playwright.sync_api import Browser, expect
from service_page import Service, ServicePage, shown


@pytest.fixture(scope="module")
def busy_page(browser: Browser, service: Service) -> Iterator[ServicePage]:
    """A page with something of everything: an error, outputs, answers good and bad, units found."""
    with shown(browser, service.url) as page:
        page.page.locator("#log-clear").click()
        page.send("\\ C100 S100 V2000 A4000 T02 F900 R W300 T05 D R")
        page.page.locator("#tab-2").click()
        page.send("\\ C100 S100 V20000 F400 R\n{ a second line }")
        expect(page.page.locator(".cm-lintRange-error")).to_have_count(1)
        page.page.locator("#commission").evaluate("(panel) => (panel.open = true)")
        page.page.locator("#scan").click()
        expect(page.page.locator("#found button")).not_to_have_count(0)
        yield page
        page.calm()


def test_it_looks_right_at_every_width_light_and_dark(busy_page):
    check_looks(busy_page.page)


def test_the_help_has_room_at_every_width(busy_page):
    page = busy_page.page
    page.locator("#help-open").click()
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        check_edges(page)
