"""What is open beside the programs of the unit, which is only read, or beside another file."""

from __future__ import annotations

import json
import random
from itertools import pairwise
from typing import Any

from machine_page import FEED, content, open_machine
from page_looks import AXE, VIOLATIONS
from page_source import ask_source
from playwright.sync_api import FilePayload, expect
from service_page import ServicePage

LONG = "\\ " + "F1 R W10\n" * 200


def compared(page: ServicePage) -> list[str]:
    """What is told of each motor."""
    page.page.locator("#machine-compare").click()
    rows = page.page.locator("#compared li")
    expect(rows).to_have_count(4)
    expect(page.page.locator("#compared")).not_to_contain_text("asked")
    return rows.all_inner_texts()


def test_programs_that_the_unit_holds_are_the_same_until_they_are_edited(page):
    page.page.locator("#motors label").first.click()
    page.send("\\")
    page.page.locator("#motors label").nth(1).click()
    page.send("\\ C100 S100\nV1000 F4 R { there }")
    kept = ": no program here, and none in the unit"
    words = ["Motor 1: the same here and in the unit", *(f"Motor {n}{kept}" for n in (2, 3, 4))]
    assert compared(page) == words
    assert set(page.sent) <= {"request", "ports"}

    page.write("\\ C100 S100\nV1000 F5 R")
    expect(page.page.locator("#compared")).to_be_hidden()
    place = "command 4, line 2: here F5, in the unit F4"
    assert compared(page)[0] == f"Motor 1: NOT THE SAME: {place}"
    page.write("\\ C100 S100\nV1000 F4")
    assert compared(page)[0].endswith("command 5: here nothing, in the unit R")
    page.write("")
    assert compared(page)[0].endswith("command 1: here nothing, in the unit C100")


def test_a_program_that_went_in_several_messages_is_the_same(page):
    page.send(LONG)
    assert compared(page)[0] == "Motor 1: the same here and in the unit"


def test_what_cannot_be_read_is_not_called_the_same(page):
    page.write("F99999999999 R")
    assert compared(page)[0].startswith("Motor 1: not compared")


def test_a_program_that_is_sent_takes_the_findings_away(page):
    compared(page)
    page.send("\\ F1 R")
    expect(page.page.locator("#compared")).to_be_hidden()


def compare_file(page: ServicePage, data: dict[str, Any] | bytes) -> None:
    """Compare what is open with a file."""
    page.page.locator("#compare-with").select_option("file")
    with page.page.expect_file_chooser() as chooser:
        page.page.locator("#machine-compare").click()
    content = data if isinstance(data, bytes) else json.dumps(data).encode()
    file: FilePayload = {"name": "b.rkm", "mimeType": "application/json", "buffer": content}
    chooser.value.set_files(file)


def test_a_second_machine_file_is_compared_line_by_line_until_something_is_edited(page):
    one = content(gve134={"axes": {}, "probe": {"interrupt": 14, "opens": True}})
    open_machine(page, one)
    found, lines = page.page.locator("#compared li"), page.page.locator("#differences")
    compare_file(page, {**one, "gve134": dict(reversed(one["gve134"].items()))})
    expect(found).to_have_text(["the same here and in b.rkm"])
    expect(lines).to_be_hidden()

    other = content(notes="grease it\noil it", inputs="500,3,0\n", output_names={"1": "horn"})
    other["motors"][0] |= {"program": FEED.replace("F400", "F401"), "steps_per_mm": 201}
    compare_file(page, other)
    parts = ["Names, scales, limits", "Notes", "Inputs in the simulation: ms, input, level",
             "Motor 1 · Program", "GVE134"]  # fmt: skip
    rest = ["all else is the same", "below: - is here, + is in b.rkm"]
    expect(found).to_have_text([*(f"{part}: NOT THE SAME" for part in parts), *rest])
    assert lines.locator("[data-sign='-'], [data-sign='+']").all_text_contents()[:10] == [
        "- Motor 1: 200.5 steps per mm\n", "+ Motor 1: 201 steps per mm\n",
        "- Output 1: lamp\n", "+ Output 1: horn\n",
        "+   2 oil it\n",
        "-   1 # the door\n", "-   2 500,3,1\n", "+   1 500,3,0\n",
        "-   3 F400 R\n", "+   3 F401 R\n",
    ]  # fmt: skip
    page.page.evaluate(AXE.read_text())
    assert page.page.evaluate(VIOLATIONS) == []
    page.page.locator("#plan-inputs").fill("7,1,1")
    expect(lines).to_be_hidden()

    compare_file(page, b"[]")
    expect(page.page.locator("#machine-trouble")).to_contain_text("this is no machine file")
    expect(page.page.locator("#compared")).to_be_hidden()
    page.page.locator("#plan-inputs").fill("")


def test_the_lines_that_differ_are_as_few_as_can_be():
    chance = random.Random(134)
    texts = [[chance.choice("abc") for _ in range(chance.randrange(12))] for _ in range(200)]
    pairs = [*pairwise(texts), (["a"] * 3000, ["b"] * 3000)]
    told = ask_source("line_diff.ts", [["diffLines", *pair] for pair in pairs])
    for (ours, theirs), groups in zip(pairs, told, strict=True):
        lines = [line for group in groups for line in group]
        out = [line["text"] for line in lines if line["there"] is None]
        new = [line["text"] for line in lines if line["here"] is None]
        assert all(ours[line["here"] - 1] == line["text"] for line in lines if line["here"])
        assert all(theirs[line["there"] - 1] == line["text"] for line in lines if line["there"])
        assert len(ours) - len(out) == len(theirs) - len(new) == common(ours, theirs)


def common(ours: list[str], theirs: list[str]) -> int:
    """The length of the longest common subsequence."""
    if not set(ours) & set(theirs):
        return 0
    row = [0] * (len(theirs) + 1)
    for one in ours:
        before = row[:]
        for at, other in enumerate(theirs):
            row[at + 1] = before[at] + 1 if one == other else max(before[at + 1], row[at])
    return row[-1]
