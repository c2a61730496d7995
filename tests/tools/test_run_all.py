"""What tools/test counts from one C test program."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import pytest
from checks.run_all import Count, count_program


@pytest.mark.parametrize(
    ("status", "output", "count"),
    [
        ("run", "5 Tests 0 Failures 2 Ignored\nOK", Count(3, 0, 2)),
        ("fail", "5 Tests 1 Failures 0 Ignored\nFAIL", Count(4, 1, 0)),
        ("fail", "5 Tests 0 Failures 0 Ignored\nOK\nleaked 8 bytes", Count(5, 1, 0)),
        ("fail", "a.c:1:test_a:PASS\nsegmentation fault", Count(0, 1, 0)),
        ("notrun", "", Count(0, 1, 0)),
        ("run", "not a Unity program", Count(1, 0, 0)),
    ],
)
def test_a_program_counts_its_tests_and_its_crash(status: str, output: str, count: Count) -> None:
    case = ElementTree.Element("testcase", status=status)
    ElementTree.SubElement(case, "system-out").text = output

    assert count_program(case) == count
