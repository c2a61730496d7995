"""How the page looks at the widths it is made for, light and dark, and how it is read aloud."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect
from service_page import Service, ServicePage, shown

AXE = Path(__file__).resolve().parents[2] / "build/service_page/node_modules/axe-core/axe.min.js"
SIZES = ((320, 640), (390, 844), (1024, 768), (1400, 900))

VIOLATIONS = """async () => {
    const { violations } = await axe.run(document, { resultTypes: ["violations"] });
    return violations
        .filter(({ impact }) => impact === "serious" || impact === "critical")
        .flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html.slice(0, 100)}`));
}"""

OUTSIDE = """() => [...document.querySelectorAll("header *, main *")]
    .filter((part) => !part.closest(".cm-editor, .uplot, .spoken") && part.checkVisibility())
    .filter((part) => {
        const { left, right, width } = part.getBoundingClientRect();
        return width > 1 && (left < 0 || right > document.documentElement.clientWidth + 0.5);
    })
    .map((part) => part.outerHTML.slice(0, 80))"""
"""What is not wholly between the left and the right edge of the window."""

OVER = """() => {
    const kinds = ["button", "select", "input", "label", ".hint", "h2", "canvas", ".card"];
    const parts = [...document.querySelectorAll(kinds.map((kind) => `main ${kind}`).join())]
        .filter((part) => !part.closest(".cm-editor, .log-box") && part.checkVisibility());
    const boxes = parts.map((part) => part.getBoundingClientRect());
    const found = [];
    parts.forEach((one, i) => parts.forEach((other, j) => {
        const [a, b] = [boxes[i], boxes[j]];
        const isOver = a.left < b.right - 1 && b.left < a.right - 1
            && a.top < b.bottom - 1 && b.top < a.bottom - 1;
        const isInside = one.contains(other) || other.contains(one) || one.closest("#motors");
        if (i < j && isOver && a.width > 0 && b.width > 0 && !isInside) {
            found.push(`${one.outerHTML.slice(0, 60)} over ${other.outerHTML.slice(0, 60)}`);
        }
    }));
    const panels = [...document.querySelectorAll(".panel")];
    const out = panels.filter((panel) => panel.scrollHeight > panel.clientHeight + 1);
    return [...found, ...out.map((panel) => `too little room in ${panel.outerHTML.slice(0, 60)}`)];
}"""
"""What lies over something else, and panels whose content needs more room than they have."""

CUT = """() => [...document.querySelectorAll("main button, main label > b, .lamp, h2, .card-state")]
    .filter((part) => !part.closest(".cm-editor, .spoken") && part.checkVisibility())
    .filter((part) => part.scrollWidth > part.clientWidth + 1 && part.clientWidth > 0)
    .filter((part) => getComputedStyle(part).display !== "inline")
    .map((part) => part.outerHTML.slice(0, 80))"""
"""Words that are cut off."""


@pytest.fixture(scope="module")
def busy_page(browser: Browser, service: Service) -> Iterator[ServicePage]:
    """A page with something of everything: an error, outputs, answers good and bad, units found."""
    with shown(browser, service.url) as page:
        page.page.locator("#log-clear").click()
        page.send("\\ C100 S100 V2000 A4000 T02 F900 R W300 T05 D R")
        page.page.locator("#tab-2").click()
        page.send("\\ C100 S100 V20000 F400 R\n{ a second line }")
        expect(page.page.locator(".cm-lintRange-error")).to_have_count(1)
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
    page.wait_for_timeout(150)
    assert page.evaluate(OUTSIDE) == []
    assert page.evaluate(OVER) == []
    assert page.evaluate(CUT) == []
    page.locator("#language").select_option("en")
