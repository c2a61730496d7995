"""Who has chosen Czech reads Czech: what units and services answer, and what is wrong."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from alone_page import write, write_alone
from gve_page import GveService
from playwright.sync_api import Browser, Locator, Page, expect
from pos_page import PosService
from service_page import Service, free_port
from unit_page import UnitService

ENGLISH = re.compile(
    r"\b(again|and|answers?|are|axes|axis|before|first|for|from|has|is|its|look|must|not|nothing"
    r"|of|stands?|the|this|unit|was|were|which|with|write)\b"
)
TOLD = """() => {
    const isOurs = (part) => !part.closest("code, pre, script, textarea, .cm-content, .log-bytes");
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const told = [];
    while (walker.nextNode()) {
        const { parentElement, textContent } = walker.currentNode;
        if (isOurs(parentElement)) { told.push(textContent); }
    }
    for (const part of document.querySelectorAll("[title], [aria-label], [placeholder]")) {
        const names = ["title", "aria-label", "placeholder"];
        if (isOurs(part)) { told.push(...names.map((name) => part.getAttribute(name) ?? "")); }
    }
    return told;
}"""
"""All texts of the page, and what is said of its parts."""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_alone(tmp_path_factory.mktemp("czech") / "page").parent


@contextmanager
def shown(browser: Browser, url: str) -> Iterator[Page]:
    """A page in a browser that speaks Czech; at its end nothing on it is English."""
    context = browser.new_context(locale="cs-CZ")
    page = context.new_page()
    faults: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto(url)
    expect(page.locator("html")).to_have_attribute("lang", "cs")
    expect(page.locator("#state")).to_have_attribute("data-kind", "good")
    yield page
    english = [text for text in page.evaluate(TOLD) if ENGLISH.search(text)]
    assert [text for text in english if not NAMES.search(text)] == []
    assert faults == []
    context.close()


NAMES = re.compile(r"^English$|tools/\w+ \w+|^[\w.-]+\.\w{2,4}$")
"""Commands, files and messages have their names."""


def answers(page: Page) -> Locator:
    """The log, the youngest answer first."""
    return page.locator("#log .log-item")


def told(page: Page, words: str | re.Pattern[str]) -> None:
    """Wait for words in the last answer."""
    expect(answers(page).first).to_contain_text(words)


@pytest.mark.parametrize(
    ("script", "inputs", "words"),
    [
        ("10,1,POS_FOO", "", "taková instrukce není; pište ms,osa,INSTRUKCE,hodnoty"),
        ("10,1,POS_MODE", "", "příliš málo hodnot"),
        ("20,1,POS_INIT,0\n10,1,POS_INIT,0", "", "čas jde zpět"),
        ("10,1,POS_INIT,0", "10,9,1", "vstup musí být 1 až 8, pak čárka; pište ms,vstup,úroveň"),
    ],
)
def test_what_is_wrong_in_a_script_is_told_in_czech(browser, written, script, inputs, words):
    with shown(browser, (written / "positioning.html").as_uri()) as page:
        page.locator("#script-text").fill(script)
        page.locator("#script-inputs").fill(inputs)
        page.locator("#script-play").click()
        expect(page.locator("#script-words")).to_contain_text(words)
        page.locator("#script-text").fill("")
        page.locator("#script-inputs").fill("")


def act_on_positioning(page: Page) -> None:
    page.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    page.locator("#danger-confirm").check()
    page.locator("#take-1").click()
    told(page, "osa 1: 0.000 mm, TAKEN (čeká na míru)")
    page.locator("#home-1").click()
    told(page, "osa 1: instrukce POS_HOME byla odmítnuta: chyba 12: vstup k tomu není nastaven")
    page.locator("#release-1").click()
    told(page, "osa 1: 0.000 mm, FREE (nikdo ji nemá)")
    page.locator("#setting-STEPS").fill("2147483647")
    page.locator("#setting-STEPS").blur()
    page.locator("#settings-write").click()
    told(page, "osa 1: 2147483647 STEPS na 10 MICROMETRES: podíl je 1/10000 až 500; nic se nez")
    page.locator("#settings-undo").click()
    page.locator("#settings-store").click()
    told(page, "všechna nastavení jsou uložena")


def act_on_gve134(page: Page) -> None:
    typed = page.locator("#typed")
    for command, words in (
        ("ZZZ", re.compile(r"neznámý příkaz \(odpověď 3\)|nemá příkaz, který takto začíná")),
        ("V1", re.compile(r"parametr je mimo meze \(odpověď 5\)|má být číslo od 10 do 200000")),
        ("G", "G: není v čem pokračovat (odpověď 6)"), ("V1000", "V1000 → 0  provedeno"),
        ("W", "W: stránka na to má tlačítko, nebo to linka dělá sama"),
    ):  # fmt: skip
        page.locator("#danger-confirm").check()
        typed.fill(command)
        typed.press("Enter")
        told(page, words)
    page.keyboard.press("Escape")
    told(page, "potvrzeno jednotkou")


def act_on_rkm04(page: Page) -> None:
    write(page, "C101")
    expect(page.locator("#verdict")).to_contain_text("chyby: 1")
    page.locator(".cm-lintRange-error").hover()
    expect(page.locator(".cm-tooltip")).to_contain_text(
        "C: čeká se 1 až 8 (zrušit výstup), 40 až 58 (zrušit funkci), 75 (obnovení pohybu), 80 až "
        "95 (zrušit proměnnou) nebo 100 (vynulovat polohu), zde je 101"
    )
    page.locator("#send").click()
    told(page, "opravte to a pošlete znovu")
    write(page, "F1 R " * 351)
    expect(page.locator("#verdict")).to_have_attribute("data-kind", "warning")
    page.locator("#send").click()
    told(page, "do paměti se jich vejde 700; nic nebylo odesláno")
    page.locator("#speed-form button").click()
    told(page, "nic nebylo odesláno; rychlost lze změnit jen za pohybu")


ACTS: dict[str, tuple[type[UnitService] | type[Service], Callable[[Page], None]]] = {
    "index": (Service, act_on_rkm04),
    "gve134": (GveService, act_on_gve134),
    "positioning": (PosService, act_on_positioning),
}


@pytest.mark.parametrize("name", ACTS)
def test_a_page_without_a_service_answers_in_czech(browser: Browser, written: Path, name: str):
    _, act = ACTS[name]
    with shown(browser, (written / f"{name}.html").as_uri()) as page:
        act(page)
        page.locator("#connect").click()
        expect(page.locator("#state")).to_have_text("nepřipojeno")
        page.keyboard.press("Escape")
        told(page, "Žádná jednotka není připojena; nejdříve se připojte")


@pytest.mark.parametrize("name", ACTS)
def test_a_page_of_a_service_answers_in_czech_and_brings_the_words_when_they_are_needed(
    browser: Browser, name: str
):
    kind, act = ACTS[name]
    service = kind()
    try:
        with shown(browser, service.url) as page:
            act(page)
            page.locator("#connect").click()
            expect(page.locator("#state")).to_have_text("nepřipojeno")
            page.locator("#port").select_option("")
            page.locator("#port-other").fill(f"socket://127.0.0.1:{free_port()}")
            page.locator("#connect").click()
            told(page, "nikdo tam neposlouchá; spusťte jednotku, nebo zkontrolujte port")
            expect(page.locator("#banner")).to_contain_text("nikdo tam neposlouchá")
            page.locator("#language").select_option("en")
            told(page, "nobody listens there; start the unit, or check the port")
            page.locator("#language").select_option("cs")
            told(page, "nikdo tam neposlouchá")
    finally:
        service.end()
