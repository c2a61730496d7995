"""Every page, with all that can be opened in it: by the keyboard, in Czech, narrow, and for axe."""

from __future__ import annotations

import contextlib
import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from alone_page import write_alone
from gve_page import GveService, gve_shown
from page_looks import AXE, COLOURS, NO_COLOURS, VIOLATIONS
from playwright.sync_api import Browser, Keyboard, Page, expect
from pos_page import PosService, pos_shown
from service_page import Service, shown
from tab import DESK

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "tools/service_page/src"
ESBUILD = ROOT / "build/service_page/node_modules/esbuild/lib/main.js"
FOLDERS = {
    "service": "", "alone": "", "gve134": "gve134", "positioning": "positioning",
    "gve134 alone": "gve134", "positioning alone": "positioning",
}  # fmt: skip
PAGES = {"alone": "index.html"} | {
    f"{name} alone": f"{name}.html" for name in ("gve134", "positioning")
}
SAME = {
    "Motor", "Port", "Program", "Start", "Stop", "STOP", "HALT", "Esc", "Version",
    "Reset", "Reset \\",
    "Set Command", "Store Flash", "Get Position", "Get Command", "Get Tabul Run", "Get Pozic Run",
    "Motor {motor}", "motor {motor}", "motor {motor}: {value}", "Ref X", "Ref Y", "Ref Z", "Ref A",
    "n", "mm/min", "{speed} mm/min", "{speed} {unit}/s", "max. {speed}", "mm, °",
    "{position} {unit}", "RKM04", "GVE134",
}  # fmt: skip
"""What is the same in Czech: names of the original's messages, signs, and words that both have."""
PHONE = (360, 740)
WIDTHS = (320, 641, 900, 1024, 1251)
"""On both sides of where the layout changes."""
TABS_MAX = 900
TABS_AT_ONCE = 20
OPEN = """() => {
    document.querySelectorAll("details").forEach((each) => (each.open = true));
    return new Promise((take) => setTimeout(take, 800));
}"""
CONTROLS = """() => {
    const kinds = "a[href], button, input, select, textarea, summary, [tabindex], .cm-content";
    const seen = [...document.querySelectorAll(kinds)].filter((part) =>
        part.checkVisibility() && !part.matches(":disabled, [tabindex='-1'], [type=file]"));
    const radios = new Map();
    const wanted = seen.filter((part) => {
        if (part.type !== "radio") { return true; }
        const isFirst = !radios.has(part.name);
        radios.set(part.name, part);
        return isFirst;
    });
    wanted.forEach((part) => (part.dataset.wanted = part.type === "radio" ? part.name : "yes"));
    return wanted.length;
}"""
"""Marks what the Tab key must reach, of radio buttons one in each group."""
STICKS_OUT = """() => {
    const scrolls = (part) => part && (getComputedStyle(part).overflowX !== "visible"
        || scrolls(part.parentElement));
    return [...document.querySelectorAll("main *:not(svg *)")]
        .filter((part) => part.clientWidth > 0 && part.scrollWidth > part.clientWidth + 1)
        .filter((part) => !scrolls(part)).map((part) => part.outerHTML.slice(0, 100));
}"""
"""What is wider than its box, but for what can be scrolled."""
DROP = """() => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File(["S100"], "a.rks"));
    const given = { bubbles: true, cancelable: true, dataTransfer };
    const isLeftAlone = (kind) => !document.body.dispatchEvent(new DragEvent(kind, given));
    return ["dragover", "drop"].every(isLeftAlone);
}"""
"""Whether the browser leaves a file alone that is dropped beside everything."""
NOTE_REACHED = """() => document.addEventListener("focusin", ({ target }) => {
    if (target.type === "radio") {
        document.querySelectorAll(`[data-wanted="${target.name}"]`)
            .forEach((each) => delete each.dataset.wanted);
    }
    delete target.dataset.wanted;
})"""
LEFT = """() => [...document.querySelectorAll("[data-wanted]")]
    .map((part) => part.outerHTML.slice(0, 100))"""
TEXTS = """() => {
    const told = new Set();
    const others = "[lang=en]:not(html), .cm-content, code, script, option[value=en]";
    const isOurs = (part) => !part.closest(others);
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
        const { parentElement, textContent } = walker.currentNode;
        const shown = parentElement.closest("select") ?? parentElement;
        if (textContent.trim() && isOurs(parentElement) && shown.checkVisibility()) {
            told.add(textContent.trim());
        }
    }
    for (const part of document.querySelectorAll("[title], [aria-label], [placeholder]")) {
        for (const name of ["title", "aria-label", "placeholder"]) {
            isOurs(part) && part.hasAttribute(name) && told.add(part.getAttribute(name).trim());
        }
    }
    told.add(document.title);
    return [...told].filter((text) => text !== "");
}"""

Opened = Callable[[], contextlib.AbstractContextManager[Page]]


@contextlib.contextmanager
def _service(browser: Browser) -> Iterator[Page]:
    service = Service()
    try:
        with shown(browser, service.url) as page:
            yield page.page
    finally:
        service.end()


@contextlib.contextmanager
def _alone(browser: Browser, folder: Path, name: str) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 1400, "height": 900})
    try:
        page = context.new_page()
        page.goto(write_alone(folder / "alone").with_name(PAGES[name]).as_uri())
        expect(page.locator("#state")).to_have_attribute("data-kind", "good")
        yield page
    finally:
        context.close()


@contextlib.contextmanager
def _unit(browser: Browser, name: str) -> Iterator[Page]:
    service = GveService() if name == "gve134" else PosService()
    show = gve_shown if name == "gve134" else pos_shown
    try:
        with show(browser, service.url) as page:
            yield page.ready().page
    finally:
        service.end()


@pytest.fixture(scope="module", params=list(FOLDERS))
def whole(
    request: pytest.FixtureRequest, browser: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[str, Page]]:
    """A page with all its parts opened."""
    name: str = request.param
    if name in PAGES:
        way = _alone(browser, tmp_path_factory.mktemp("alone"), name)
    else:
        way = _service(browser) if name == "service" else _unit(browser, name)
    with way as page:
        page.evaluate(OPEN)
        yield name, page


@cache
def words_of(name: str) -> dict[str, dict[str, str]]:
    """The words of a page by language."""
    script = ROOT / "tests/support/page_words.mjs"
    node = Path(sys.executable).with_name("node")
    told: dict[str, dict[str, str]] = json.loads(
        subprocess.check_output([node, script, ESBUILD, SOURCES / FOLDERS[name]], text=True)
    )
    return told


@pytest.mark.parametrize("name", ["service", "gve134", "positioning"])
def test_every_word_is_there_in_both_languages_with_the_same_places_to_fill(name: str) -> None:
    words = words_of(name)
    assert words["en"].keys() == words["cs"].keys()
    places = re.compile(r"\{\w+\}")
    for key, text in words["en"].items():
        assert sorted(set(places.findall(text))) == sorted(set(places.findall(words["cs"][key]))), (
            key
        )
        if re.search(r"[^\W\d_]", text) and text not in SAME:
            assert words["cs"][key].strip() not in ("", text), key


def test_no_text_stays_english_when_czech_is_chosen(whole: tuple[str, Page]) -> None:
    name, page = whole
    words = words_of(name)
    page.locator("#language").select_option("cs")
    page.evaluate(OPEN)
    told: list[str] = page.evaluate(TEXTS)
    page.locator("#language").select_option("en")
    same = set(words["en"].values()) & set(words["cs"].values())
    english = [
        text for text in words["en"].values() if text not in same and re.search("[a-z]", text)
    ]
    patterns = [re.sub(r"\\\{\w+\\\}", ".+", re.escape(text)) for text in english]
    whole_ones = re.compile("|".join(patterns))
    assert len(told) > 30
    assert [text for text in told if whole_ones.fullmatch(text)] == []


def test_a_file_that_is_dropped_does_not_take_the_place_of_the_page(
    whole: tuple[str, Page],
) -> None:
    _, page = whole
    assert page.evaluate(DROP)


@pytest.mark.parametrize("inserts", [Keyboard.type, Keyboard.insert_text], ids=["keys", "paste"])
def test_a_decimal_comma_is_a_point(
    whole: tuple[str, Page], inserts: Callable[[Keyboard, str], None]
) -> None:
    _, page = whole
    field = page.locator("input[type=number]:visible:enabled").first
    before = field.input_value()
    field.select_text()
    inserts(page.keyboard, "1,5")
    assert field.input_value() == "1.5"
    field.fill(before)


def test_the_tab_key_reaches_every_control_and_leaves_it(whole: tuple[str, Page]) -> None:
    _, page = whole
    page.evaluate("document.activeElement.blur()")
    assert page.evaluate(CONTROLS) > 20
    page.evaluate(NOTE_REACHED)
    for _ in range(0, TABS_MAX, TABS_AT_ONCE):
        for _ in range(TABS_AT_ONCE):
            page.keyboard.press("Tab")
        if page.evaluate(LEFT) == []:
            break
    assert page.evaluate(LEFT) == []


def test_nothing_sticks_out_of_its_box_at_any_width(whole: tuple[str, Page]) -> None:
    _, page = whole
    before = page.viewport_size
    for language in ("cs", "en"):
        page.locator("#language").select_option(language)
        page.evaluate(OPEN)
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate(STICKS_OUT) == [], (language, width)
    assert before
    page.set_viewport_size(before)


def test_a_telephone_needs_no_scrolling_sideways(whole: tuple[str, Page]) -> None:
    _, page = whole
    before = page.viewport_size
    page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
    for language in ("cs", "en"):
        page.locator("#language").select_option(language)
        page.evaluate(OPEN)
        assert page.evaluate("document.documentElement.scrollWidth") <= PHONE[0], language
        page.evaluate("window.scrollTo(0, 3000)")
        stop = page.locator("#stop, #halt").first
        expect(stop).to_be_in_viewport(ratio=1)
    assert before
    page.set_viewport_size(before)


def test_axe_finds_nothing_serious_with_all_parts_open(whole: tuple[str, Page]) -> None:
    _, page = whole
    page.evaluate(OPEN)
    page.evaluate(AXE.read_text())
    before = page.viewport_size
    assert before
    page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
    assert page.evaluate(VIOLATIONS, NO_COLOURS) == []
    page.set_viewport_size({"width": DESK[0], "height": DESK[1]})
    assert page.evaluate(VIOLATIONS) == []
    page.emulate_media(color_scheme="dark")
    assert page.evaluate(VIOLATIONS, COLOURS) == []
    page.emulate_media(color_scheme="light")
    page.set_viewport_size(before)
