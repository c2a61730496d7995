"""Help in the page: the project's own documents, commands and examples, searched and tried."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

from chance import SEED
from playwright.sync_api import expect
from rkm04_tools.service.checking import check, examples

ROOT = Path(__file__).resolve().parents[2]
TABLE = ROOT / "firmware/rkm04/program/program_opcodes.def"
LANGUAGE = ROOT / "firmware/rkm04/docs/language.md"
CZECH = [
    *(ROOT / f"firmware/rkm04/docs/{name}.cs.md" for name in ("language", "unit")),
    ROOT / "firmware/docs/motion.cs.md",
    *(ROOT / f"firmware/rkm04/docs/{name}.cs.md" for name in ("messages", "line")),
]
PROGRAM = re.compile(r"^```rks\n(.*?)^```$", re.DOTALL | re.MULTILINE)
COMMENT = re.compile(r"\{[^}]*\}")


def opened(page):
    """Show the help."""
    page.page.locator("#help-open").click()
    expect(page.page.locator("#help-search")).to_be_focused()
    expect(page.page.locator("#help-places a").first).to_be_visible()
    page.page.locator("#help-search").fill("")


def seen(page, selector: str):
    """What of it the search has left."""
    return page.page.locator(f"#help-list {selector}:visible")


def test_every_command_of_the_firmware_has_a_meaning_in_both_languages(page):
    rows = len(re.findall(r"^X\(", TABLE.read_text(encoding="ascii"), re.MULTILINE))
    opened(page)
    told = {}
    for language in ("en", "cs"):
        page.page.locator("#language").select_option(language)
        cells = page.page.locator("#help-list #help-commands + table tbody td:last-child")
        expect(cells).to_have_count(rows)
        told[language] = cells.all_inner_texts()
    page.page.locator("#language").select_option("en")
    assert all(told["en"])
    assert all(told["cs"])
    assert [en for en, cs in zip(told["en"], told["cs"], strict=True) if en == cs] == []


def test_the_programs_of_the_language_and_the_examples_can_all_be_tried(page):
    opened(page)
    programs = page.page.locator("#help-list .program code").all_text_contents()
    texts = [each.rstrip("\n") for each in PROGRAM.findall(LANGUAGE.read_text(encoding="utf-8"))]
    assert len(texts) > 5
    assert [each for each in texts if each not in programs] == []
    assert [each["name"] for each in examples() if each["text"] not in programs] == []
    for each in programs:
        errors = [one for one in check(each)["problems"] if one["severity"] == "error"]
        assert errors == [], each


def test_an_example_goes_into_the_editor_and_is_simulated_but_not_sent(page):
    page.write("\\ C100")
    opened(page)
    page.sent.clear()
    page.page.locator("#help-search").fill("program clock")
    part = seen(page, ".help-section").filter(has_text="So a loop does not drift")
    part.locator(".program button").click()
    page.expect_pulses(150)
    assert "L3 R W200 E" in page.text()
    assert "request" not in page.sent
    page.page.keyboard.press("ControlOrMeta+z")
    assert page.text() == "\\ C100"


def test_a_search_leaves_what_has_all_its_words_without_accents_too(page):
    opened(page)
    expect(seen(page, ".help-section")).not_to_have_count(0)
    all_of_them = seen(page, ".help-section").count()
    page.page.locator("#help-search").fill("guards total stops")
    expect(page.page.locator("#help-none")).to_contain_text("sections found")
    assert 0 < seen(page, ".help-section").count() < all_of_them
    for text in seen(page, ".help-section").all_inner_texts():
        assert "guard" in text.lower()
    page.page.locator("#help-search").fill("no such words anywhere")
    expect(page.page.locator("#help-none")).to_have_text("Nothing has all of these words.")
    page.page.locator("#language").select_option("cs")
    page.page.locator("#help-search").fill("konec smycky")
    expect(seen(page, "tbody tr")).not_to_have_count(0)
    page.page.locator("#language").select_option("en")


def test_in_czech_all_documents_are_shown_and_searched_in_it(page):
    opened(page)
    title = page.page.locator("#help-language")
    expect(title).to_have_text("The language")
    page.page.locator("#language").select_option("cs")
    expect(title).to_have_text("Jazyk")
    titles = ["Jazyk", "Jednotka", "Čas každého kroku", "Zprávy", "Linka"]
    expect(page.page.locator("#help-places a[lang]")).to_have_text(titles)
    expect(page.page.locator("#help-places a[lang=en]")).to_have_count(0)
    programs = page.page.locator("#help-list .help-page[lang=cs] .program code")
    shown = [each.rstrip("\n") for each in programs.all_text_contents()]
    texts = [PROGRAM.findall(each.read_text(encoding="utf-8")) for each in CZECH]
    assert shown == [each.rstrip("\n") for each in itertools.chain(*texts)]
    page.page.locator("#help-search").fill("hlidani uroven hrana")
    expect(seen(page, ".help-section")).to_have_count(1)
    expect(seen(page, ".help-section")).to_contain_text("hlídá se úroveň, ne hrana")
    page.page.locator("#language").select_option("en")


def test_every_link_inside_leads_somewhere_in_both_languages(page):
    opened(page)
    for language in ("cs", "en"):
        page.page.locator("#language").select_option(language)
        lost = page.page.evaluate(
            """() => [...document.querySelectorAll("#help a[href^='#']")]
                .map((link) => link.getAttribute("href").slice(1))
                .filter((id) => document.getElementById(id) === null)"""
        )
        assert lost == []
        ids = page.page.evaluate("[...document.querySelectorAll('[id]')].map(({ id }) => id)")
        assert len(ids) == len(set(ids))


def test_commands_are_completed_where_they_are_asked_for(page):
    page.write("")
    page.page.keyboard.type("A")
    page.page.wait_for_timeout(300)
    expect(page.page.locator(".cm-tooltip-autocomplete")).to_have_count(0)
    page.page.keyboard.press("Control+Space")
    options = page.page.locator(".cm-tooltip-autocomplete li")
    expect(options).to_have_count(1)
    expect(options).to_contain_text("acceleration")
    page.page.wait_for_timeout(300)
    page.page.keyboard.press("Enter")
    page.page.keyboard.type("500 ")
    assert page.text() == "A500 "
    page.page.locator("#commands").click()
    rows = len(re.findall(r"^X\(", TABLE.read_text(encoding="ascii"), re.MULTILINE))
    expect(options).to_have_count(rows)
    options.filter(has_text="run backward without end").click()
    assert page.text() == "A500 G-"
    page.page.keyboard.type(" { A")
    page.page.keyboard.press("Control+Space")
    page.page.wait_for_timeout(300)
    expect(options).to_have_count(0)


def test_every_command_that_is_completed_is_one_for_the_parser(page):
    options = page.page.locator(".cm-tooltip-autocomplete li")
    rows = len(re.findall(r"^X\(", TABLE.read_text(encoding="ascii"), re.MULTILINE))
    taken = range(SEED % 4, rows, 4)
    page.write("")
    for index in taken:
        page.page.locator("#commands").click()
        expect(options).to_have_count(rows)
        options.nth(index).click()
        expect(options).to_have_count(0)
        page.page.keyboard.press("ControlOrMeta+End")
        page.page.keyboard.type(" ")
    text = page.text()
    assert len(text.split()) >= len(taken)
    errors = [one for one in check(text)["problems"] if one["severity"] == "error"]
    told = [one["message"] for one in errors]
    flow = ("without", "no label")
    assert [one for one in told if not any(word in one for word in flow)] == [], text
