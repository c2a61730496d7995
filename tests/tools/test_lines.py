"""The masters of lines in C, as the tools in Python have them."""

from __future__ import annotations

import re
from enum import IntEnum

import pytest
from rkm04_tools import line_master, lines
from rkm04_tools.gve134 import master as gve_master
from rkm04_tools.positioning import master as pos_master
from rkm04_tools.tree import ROOT


@pytest.mark.parametrize(
    ("spoken", "header", "prefix"),
    [
        (line_master.End, "master/master.h", "MASTER_"),
        (gve_master.End, "gve134_master/gve_master.h", "GVE_MASTER_"),
        (gve_master.Kind, "gve134_master/gve_master.h", "GVE_MASTER_"),
        (pos_master.End, "positioning_master/pos_master.h", "POS_MASTER_"),
    ],
)
def test_a_master_is_spoken_to_by_the_numbers_of_its_header(
    spoken: type[IntEnum], header: str, prefix: str
) -> None:
    name = f"{prefix.lower()}{spoken.__name__.lower()}"
    text = (ROOT / "tools" / header).read_text(encoding="utf-8")
    (told,) = re.findall(rf"enum {name} \{{(.*?)\}};", text, re.DOTALL)
    names = re.findall(rf"^ *{prefix}(\w+),", told, re.MULTILINE)
    assert [each.name for each in spoken] == names[: len(spoken)]


def numbers_of(header: str, prefix: str) -> dict[str, int]:
    """The enumerators of a header that count from 0, without their prefix."""
    text = (ROOT / "tools" / header).read_text(encoding="utf-8")
    lists = re.findall(r"enum \w+ \{(.*?)\};", text, re.DOTALL)
    names = [re.findall(rf"^ *{prefix}(\w+),", told, re.MULTILINE) for told in lists]
    return {name: number for told in names for number, name in enumerate(told)}


@pytest.mark.parametrize(
    ("script", "header", "prefix", "least"),
    [
        ("serial_line.ts", "master/master.h", "MASTER_", 2),
        ("gve134/alone/wire.ts", "gve134_master/gve_master.h", "GVE_MASTER_", 9),
        ("gve134/alone/link.ts", "gve134_master/gve_master.h", "GVE_MASTER_", 2),
        ("positioning/alone/master.ts", "positioning_master/pos_master.h", "POS_MASTER_", 5),
    ],
)
def test_a_page_speaks_to_a_master_by_the_numbers_of_its_header(
    script: str, header: str, prefix: str, least: int
) -> None:
    text = (ROOT / "tools/service_page/src" / script).read_text(encoding="utf-8")
    numbers = numbers_of(header, prefix)
    told = dict(re.findall(r"^(?:export )?const ([A-Z_]+) = (\d+);$", text, re.MULTILINE))
    spoken = {name: int(number) for name, number in told.items() if name in numbers}
    assert len(spoken) >= least
    assert spoken == {name: numbers[name] for name in spoken}


@pytest.mark.parametrize("unit", ["rkm04", "gve134", "positioning"])
def test_a_module_of_a_page_has_the_functions_that_the_page_calls(unit: str) -> None:
    sources = (ROOT / "tools/service_page/src").rglob("*.ts")
    text = "".join(path.read_text(encoding="utf-8") for path in sources)
    made = (ROOT / "tools/lines/CMakeLists.txt").read_text(encoding="utf-8")
    (exports,) = re.findall(
        rf"^add_lines\({unit} .*?EXPORTS (.*?)\)", made, re.DOTALL | re.MULTILINE
    )
    assert set(re.findall(rf"lines_{unit}_(\w+): \(", text)) == set(exports.split())


@pytest.mark.parametrize("unit", ["rkm04", "gve134", "positioning"])
def test_as_much_is_handed_in_as_there_is_room_for(unit: str) -> None:
    header = (ROOT / f"tools/lines/lines_{unit}.h").read_text(encoding="utf-8")
    assert f"LINES_{unit.upper()}_HEARD_BYTES = {lines.HEARD_BYTES}" in header
