"""The five minutes of the README, sentence by sentence, as a reader takes them."""

from __future__ import annotations

import re
from collections.abc import Callable

from playwright.sync_api import expect
from service_page import ROOT, ServicePage

SECTION = re.compile(r"^## Five minutes with the service program$(.*?)^## ", re.M | re.S)
ITEM = re.compile(r"^\d\. (.*?)(?=^\d\. |^$)", re.M | re.S)


def sentences() -> list[str]:
    """Those of the numbered list, without line ends."""
    section = SECTION.search((ROOT / "README.md").read_text(encoding="utf-8"))
    assert section
    items = [" ".join(item.split()) for item in ITEM.findall(section[1])]
    return [sentence for item in items for sentence in re.split(r"(?<=\.)\s+", item)]


def choose_example(page: ServicePage, name: str) -> None:
    page.page.locator("#examples").select_option(label=name)
    expect(page.page.locator("#file-name")).to_have_text(name)


def change(page: ServicePage, old: str, new: str) -> None:
    """Edit as a reader does: double-click the number, and type."""
    page.page.locator(".cm-line span", has_text=re.compile(rf"^{old[1:]}$")).first.dblclick()
    page.page.keyboard.type(new)
    expect(page.page.locator(".cm-content")).to_contain_text(new)


def seen(page: ServicePage) -> list[float]:
    return [float(edge) for edge in (page.plan.get_attribute("data-range") or "").split()]


def choose_the_loop(page: ServicePage) -> None:
    choose_example(page, "4-loop.rks")


def curves_show_and_nothing_moves(page: ServicePage) -> None:
    page.expect_pulses(5000)
    assert set(page.sent) <= {"ports"}
    assert page.steps() == 0


def make_a_mistake(page: ServicePage) -> None:
    change(page, "V600", "V20000")


def see_it_underlined_and_mend_it(page: ServicePage) -> None:
    expect(page.page.locator(".cm-lintRange-error")).to_have_text("V20000")
    before = page.plan.get_attribute("data-drawn")
    peak = page.page.locator("#plan-motors label").first
    expect(peak).not_to_contain_text("800 steps/s")
    change(page, "V20000", "V800")
    expect(page.page.locator(".cm-lintRange-error")).to_have_count(0)
    expect(peak).to_contain_text("800 steps/s")
    assert page.plan.get_attribute("data-drawn") != before


def zoom_and_unzoom(page: ServicePage) -> None:
    whole = seen(page)
    surface = page.page.locator("#plan-speed .u-over")
    box = surface.bounding_box()
    assert box
    page.page.mouse.move(box["x"] + box["width"] * 0.3, box["y"] + 20)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + box["width"] * 0.6, box["y"] + 20, steps=4)
    page.page.mouse.up()
    assert whole[0] < seen(page)[0] < seen(page)[1] < whole[1]
    surface.dblclick()
    assert seen(page) == whole


def send(page: ServicePage) -> None:
    before = page.answers.count()
    page.page.get_by_role("button", name="Send", exact=True).click()
    expect(page.answers).to_have_count(before + 1)


def see_it_run(page: ServicePage) -> None:
    page.expect_beyond(50)
    curves, live, answers = (page.page.locator(f"#{name}") for name in ("plan", "live", "answers"))
    tops = [(part.bounding_box() or {"y": 0})["y"] for part in (curves, live, answers)]
    assert tops == sorted(tops)
    expect(live.locator(".card").first).to_contain_text(re.compile(r"[1-9]\d* steps/s"))
    for lamps in ("#live-inputs > *", "#live-outputs > *"):
        expect(page.page.locator(lamps)).to_have_count(8)
    expect(page.answers.first).to_contain_text("sent and accepted")
    expect(page.answers.first.locator("code").first).to_contain_text("02 31 5C 43 31 30 30")


def stop(page: ServicePage) -> None:
    page.page.keyboard.press("Escape")
    expect(page.alarm).to_have_attribute("data-kind", "done")
    assert 0 < page.expect_standing() < 1500


def resume(page: ServicePage) -> None:
    stands = page.steps()
    page.page.get_by_role("button", name=re.compile("^Resume")).click()
    page.page.wait_for_function("stands => Number(document.querySelector('#position-1').innerText"
                                ".replace(/[^0-9]/g, '')) !== stands", arg=stands)  # fmt: skip


def store_and_see_a_guard_act(page: ServicePage) -> None:
    page.page.locator("#message").select_option("store")
    send(page)
    expect(page.answers.first).to_contain_text("commands stored: 16")
    page.page.locator("#message").select_option("send")
    choose_example(page, "6-guards.rks")
    send(page)
    page.page.wait_for_function(
        "() => Number(document.querySelector('#position-1').innerText.replace(',', '')) < 200"
    )
    page.expect_beyond(200)
    page.page.locator("#live-inputs button").nth(2).click()
    assert 200 < page.expect_standing() < 4000


STEPS: dict[str, Callable[[ServicePage], None]] = {
    "Under *Examples* choose `4-loop.rks`.": choose_the_loop,
    "The curves on the right show what the program **would** do; nothing moves yet.":
        curves_show_and_nothing_moves,
    "Change `V600` to `V20000`.": make_a_mistake,
    "The mistake is underlined while you type, by the firmware's own parser; make it `V800` and "
    "the curves change.": see_it_underlined_and_mend_it,
    "Drag in a curve to zoom, double-click to see all of it again.": zoom_and_unzoom,
    "*Send*.": send,
    "The unit runs the program; its positions, speeds, inputs and outputs are below the curves, "
    "its answers, as text and as bytes, at the bottom.": see_it_run,
    "Press **Escape**, or the red button: every motor stops down its ramp, ahead of anything else.":
        stop,
    "*Resume* goes on.": resume,
    "*Store Flash* keeps the program without power; *Examples*, `6-guards.rks`, and a click on an "
    "input shows a guard act.": store_and_see_a_guard_act,
}  # fmt: skip


def test_every_sentence_of_the_five_minutes_is_so(own_page):
    assert sentences() == list(STEPS)
    for sentence in sentences():
        STEPS[sentence](own_page)
