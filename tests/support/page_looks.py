"""What is wrong with the looks of a page: for axe, at the edges, one part over another."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page

AXE = Path(__file__).resolve().parents[2] / "build/service_page/node_modules/axe-core/axe.min.js"
SIZES = ((320, 640), (390, 844), (1024, 768), (1400, 900))

COLOUR_RULES = ["color-contrast", "link-in-text-block"]
COLOURS = {"runOnly": COLOUR_RULES}
"""What axe is to look for where nothing but colours has changed."""
NO_COLOURS = {"rules": {rule: {"enabled": False} for rule in COLOUR_RULES}}
"""Where they have not: they take most of its time."""

VIOLATIONS = """async (options) => {
    const { violations } = await axe.run(document, { resultTypes: ["violations"], ...options });
    return violations
        .filter(({ impact }) => impact === "serious" || impact === "critical")
        .flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html.slice(0, 100)}`));
}"""

OUTSIDE = """() => [...document.querySelectorAll("header *, main *")]
    .filter((part) => !part.closest(".cm-editor, .uplot, .spoken, #code-lines, .drawn"))
    .filter((part) => part.checkVisibility())
    .filter((part) => {
        const { left, right, width } = part.getBoundingClientRect();
        return width > 1 && (left < 0 || right > document.documentElement.clientWidth + 0.5);
    })
    .map((part) => part.outerHTML.slice(0, 80))"""
"""What is not wholly between the left and the right edge of the window."""

OVER = """() => {
    const kinds = ["button", "select", "input", "label", ".hint", "h2", "canvas", ".card"];
    const parts = [...document.querySelectorAll(kinds.map((kind) => `main ${kind}`).join())]
        .filter((part) => !part.closest(".cm-editor, .log-box, #setting-rows"))
        .filter((part) => part.checkVisibility());
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

DRAWN = """() => new Promise((take) =>
    requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(take))))"""
"""Waits until what follows a new size is done, too."""


def check_edges(page: Page) -> None:
    """Fail on what is cut off or lies over something else, in either language."""
    for language in ("cs", "en"):
        page.locator("#language").select_option(language)
        page.evaluate(DRAWN)
        for finds in (OUTSIDE, OVER, CUT):
            assert page.evaluate(finds) == [], (page.viewport_size, language)


def check_looks(page: Page, at_each_width: Callable[[], None] = lambda: None) -> None:
    """Fail on what is wrong at any width: for axe, or at the edges."""
    page.evaluate(AXE.read_text())
    page.emulate_media(color_scheme="light")
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        check_edges(page)
        assert page.evaluate(VIOLATIONS, NO_COLOURS) == [], width
        at_each_width()
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert page.evaluate(VIOLATIONS, COLOURS) == [], scheme
