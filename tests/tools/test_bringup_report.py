"""`bringup`: what the report of a walk says of what was bad."""

from __future__ import annotations

import json
from datetime import datetime

from bringup_bench import NAME, FakeLine, Hands, whole
from rkm04_tools.bringup import command
from rkm04_tools.bringup.findings import DONE, Part, Report, compared
from rkm04_tools.bringup.plan import STEPS

SUPPLY = b"supply_mv %d\ndetector_good 1\n"


def test_what_was_bad_below_a_pin_is_told_with_the_name_of_the_pin():
    seen = [
        compared("BO_1 at PB8", "on, alone", "on, alone", good=True),
        compared("  read at the pins", "none is on", "BO_1 only", good=False),
        compared("BO_2 at PB9", "not so", "on, alone", good=False),
    ]
    report = Report("f405", "x", [Part("outputs", DONE, seen)])

    assert report.result() == "BAD: outputs (BO_1 at PB8: read at the pins), outputs (BO_2 at PB9)"


def test_what_was_bad_before_a_step_was_repeated_stays_in_the_report(tool, monkeypatch):
    low, good = (whole(SUPPLY % millivolts, b"v") for millivolts in (2900, 3300))
    monkeypatch.setattr(command, "open_transport", lambda _: FakeLine(low, low, good))
    walk = ["s" if step.name != "supply" else "\nr\nr\n" for step in STEPS]
    monkeypatch.setattr("sys.stdin", Hands("\n".join(["y", *walk]).split("\n")))

    report = json.loads(tool("bringup", "--port", "x", "--json").out)

    rows = next(each["seen"] for each in report["steps"] if each["name"] == "supply")
    assert [(row["what"], row["seen"], row["verdict"]) for row in rows] == [
        ("supply at the part", "3.300 V", "good"),
        ("voltage detector", "good", "good"),
        ("bad before", "supply at the part: 2.900 V", "note"),
    ]
    assert report["good"]


def test_the_report_tells_when_the_walk_was(tool, monkeypatch, tmp_path):
    monkeypatch.setattr(command, "open_transport", lambda _: FakeLine(NAME))
    monkeypatch.setattr("sys.stdin", Hands(["y", "", "", "q"]))
    begin = datetime.now().astimezone().replace(microsecond=0)

    tool("bringup", "--port", "x", "--report", tmp_path / "report.txt")

    head, _, _ = (tmp_path / "report.txt").read_text().partition("\n")
    when = datetime.fromisoformat(head.removeprefix("bring-up of f405 at x, "))
    assert begin <= when <= datetime.now().astimezone()
