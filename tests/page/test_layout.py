"""How the page looks at the widths it is made for, light and dark, and how it is read aloud."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from page_looks import AXE, CUT, OUTSIDE, OVER, SIZES, VIOLATIONS
from playwright.sync_api import Browser, expect
from service_page import Service, ServicePage, shown

DRAWN = """() => new Promise((take) =>
    requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(take))))"""
"""Waits until what follows a new size is done, too."""


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
        page.page.locator("#help-open").click()
        page.page.locator("#scan").click()
        expect(page.page.locator("#found button")).not_to_have_count(0)
        yield page
        page.calm()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_serious_is_found_by_axe_at_any_width(busy_page, scheme):
    page = busy_page.page
    page.emulate_media(color_scheme=scheme)
    if page.evaluate("typeof axe") == "undefined":
        page.evaluate(AXE.read_text())
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate(VIOLATIONS) == [], width


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("language", ["en", "cs"])
def test_nothing_is_cut_off_or_lies_over_something_else(busy_page, size, language):
    page = busy_page.page
    page.locator("#language").select_option(language)
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.evaluate(DRAWN)
    assert page.evaluate(OUTSIDE) == []
    assert page.evaluate(OVER) == []
    assert page.evaluate(CUT) == []
    page.locator("#language").select_option("en")
