"""What is told of files has its words in Czech, too: all sentences that the sources have."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from gcode_bad import BAD
from gcode_played import content, mill, play
from page_source import ask_source
from python_texts import texts_of
from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import mill_of
from rkm04_tools.gve134.gcode.block import FOREIGN_G, FOREIGN_LETTERS
from rkm04_tools.gve134.gcode.words import FOREIGN
from rkm04_tools.gve134.service.files import read_file
from rkm04_tools.machine.machine import Machine, parse_machine
from rkm04_tools.positioning.settings import read_values, stored_places, text_of
from rkm04_tools.positioning.unit import LAYOUT

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
GCODE = "rkm04_tools/gve134/gcode"
PROSE = re.compile(r"[a-z']+ [a-z']{2,}")
"""What has two words is a sentence, or a part of one."""
OF_FUNCTIONS: dict[str, set[str] | None] = {
    **dict.fromkeys(
        (f"{GCODE}/{name}.py" for name in ("arcs", "block", "modal", "motions", "outputs", "path",
                                           "program", "turning", "words", "writer")),
    ),
    f"{GCODE}/axes.py": None,
    "rkm04_tools/gve134/job.py": {"job_of"},
    "rkm04_tools/gve134/service/files.py": {"read_file", "_read_gcode"},
    "rkm04_tools/machine/words.py": None,
    "rkm04_tools/machine/machine.py": {
        "parse_machine", "_parsed", "_plain", "_once", "_refuse", "_require_version", "_crossed",
        "_crossed_axis",
    },
    "rkm04_tools/positioning/settings.py": {"read_values", "_once", "_values_of"},
    "rkm04_tools/source.py": {"why_no_text"},
}  # fmt: skip
"""Sources with sentences, and the functions that have them; None: all."""
OTHERS = re.compile(r"^;|^put in tool|^correct it$")
"""Lines of vector files, texts of their pauses, and what a simulation adds."""
ENGLISH = re.compile(r"\b(the|is|are|of|not|and|with|must|has|its|for|from|takes|found|here)\b")
WITHOUT_CONTENT = [
    "more than 10000000 bytes; that is no program",
    "the file has no name, or one of more than 200 characters",
    "there is no such example; reload the page",
    "pocket.nc: cannot be read (Permission denied); is the clone whole?",
    "another file was opened meanwhile; look at that",
    "no machine file is open; open one (.rkm) first",
    "a.nc is not done; go on with it, or halt and delete it",
]
"""What the service tells of a file whatever is in it."""

VECTORS = """\
X
7V5
!7Z
L
L1,2,3,4,5
VL1,2,3,4,5
T5,6
VK1
NQ5
WX0,10,1,10
ER100
EUW00,123456789
EFW10,1.
V9
*E0
*S
C1
A5
*E1
*S
*E1
@5.1234567 H
@5
!3H
;@probe
;@later
*S
"""
PROGRAMS = [
    *(f"{letter}1" for letter in FOREIGN_LETTERS), *(f"G0 X1 {sign}" for sign in FOREIGN),
    *(f"G{code / 10:g}" for codes in FOREIGN_G for code in codes),
    "G0 G1", "G4 G28", "G17 G18", "G20 G21", "G90 G91", "G93 G94", "G40 G40", "G49 G49", "G54 G54",
    "G64 G64", "G91.1 G91.1", "M0 M1", "M3 M4", "M6 M6", "M7 M7", "M8 M8", "M9 M9", "M98", "M104",
    "G64 P0.1", "G0 " + "X" * 2000, "o100 sub", "TURN_ON X=1", "CYCLE1(5)", "U1", "B5",
    "F300\nG20\nG1 X1", "G93\nG1 X1", "G0 D1", "G38.2 Z-10 F50\nG0 Z0", "G28\nG0 X400",
    "G28\nG0 X-400", "G4 P500", "M30\nG0 X1", "S50 M3", "S50 M3\nT1 M6\nG1 X1 F100", "(nothing)",
    "G1 F3000 Z1\nZ2", "F4000 G2 X0.2 I0.1", "G0 X1 ž", "G20\nG1 F182 X1",
]  # fmt: skip


def refusal(act: Callable[..., object], *given: Any) -> str:
    """Why something is refused."""
    with pytest.raises(Failure) as failure:
        act(*given)
    return str(failure.value)


def changed(value: Any, *place: str | int) -> dict[str, Any]:
    """The machine file of the examples with another value somewhere; None: without it."""
    told = deepcopy(content())
    part: Any = told
    for each in place[:-1]:
        part = part[each]
    if value is None:
        del part[place[-1]]
    else:
        part[place[-1]] = value
    return told


def of_programs() -> Iterator[str]:
    """Errors and warnings of G-code."""
    bare = content()
    del bare["gve134"]["axes"]["a"], bare["gve134"]["spindle"], bare["gve134"]["probe"]
    for axis in bare["gve134"]["axes"].values():
        del axis["homing"]
    turning = content()
    turning["gve134"]["axes"]["a"]["homing"] = {
        "way_steps": 9, "speed_steps_per_s": 10, "back_steps": 9, "back_speed_steps_per_s": 10,
    }  # fmt: skip
    turning["motors"][3]["limits"] = {"position_min_steps": 0, "position_max_steps": 5}
    played = [play(program) for program in (*(each[0] for each in BAD), *PROGRAMS)]
    played.append(play("G0 A1\nM3\nS5\nG38.2 Z-1 F50\nG28", mill(bare)))
    fine = changed(1e6, "motors", 0, "steps_per_mm")
    played.append(play("G0 X9999", mill(fine)))
    played.append(play("G0 X9", mill(changed(1e-9, "motors", 0, "steps_per_mm"))))
    played.append(play("G28 A0\nG0 A90\nG0 A-90", mill(turning)))
    for each in played:
        yield from (message for _, _, message in each.errors)
        yield from (message for _, message in each.warnings)


def of_vectors() -> Iterator[str]:
    """Errors of vector files."""
    texts = [VECTORS, "L" + "0" * 79, "*S\n" + "C1\n" * 129 + "*E128"]
    for text in texts:
        yield from (each.message for each in host.check(text).errors)


def of_files() -> Iterator[str]:
    """Files that cannot be read."""
    for name in ("a.gve", "a.nc"):
        yield refusal(read_file, name, bytes(100), None)
        yield refusal(read_file, name, "G0 X1".encode("utf-16"), None)
        yield refusal(read_file, name, "G0 X1 Y1".encode("utf-16-le"), None)
    yield refusal(read_file, "a.nc", b"G0 X1", None)
    yield refusal(read_file, "a.gve", b"@5 V1000", None)


def of_machines() -> Iterator[str]:
    """Machine files."""
    texts = [
        b"", b"{", b'{"a" 1}', b'{"a": 1 "b": 2}', b'{"a', b'"\x01"', b'"\\x"', b'"\\u12"', b"{} 1",
        b"[1,]", b"[" * 100_000, b'{"a": 1, "a": 2}', b'{"a": NaN}', b'{"a": "\\ud800"}',
        b'{"a": ' + b"9" * 5000 + b"}", b"\xff", b"{}",
    ]  # fmt: skip
    told = [
        changed(2, "version"), changed("1", "version"), changed(5, "name"), changed("", "name"),
        changed("n" * 101, "name"), changed(None, "name"), changed([], "motors"),
        changed(1, "nmae"), changed(1, "gve134", "spindle", "rpms"),
        changed({}, "motors"), changed("8", "motors", 0, "steps_per_mm"),
        changed(0, "motors", 0, "steps_per_mm"), changed(1, "motors", 0, "steps_per_degree"),
        changed(3, "gve134", "probe", "interrupt"), changed(99, "gve134", "probe", "interrupt"),
        changed(1, "gve134", "probe", "opens"),
        changed(1.5, "motors", 0, "limits", "position_min_steps"),
        changed(1_000_000, "motors", 0, "limits", "position_min_steps"),
        changed(0, "gve134", "axes", "x", "homing", "way_steps"),
        changed(1000, "motors", 0, "limits", "speed_max_steps_per_s"),
        changed(20_000, "gve134", "axes", "x", "homing", "speed_steps_per_s"),
        changed({str(each): 1 for each in range(30)}, "input_names"),
        changed([{"a": None} for _ in range(30)], "motors"),
    ]  # fmt: skip
    for data in (*texts, *(json.dumps(each).encode() for each in told)):
        yield refusal(parse_machine, data, "a.rkm")
    for each in (changed(None, "gve134"), changed(None, "motors", 0, "steps_per_mm"),
                 changed(None, "motors", 3, "steps_per_degree")):  # fmt: skip
        yield refusal(mill_of, Machine("a.rkm", each))


def of_settings() -> Iterator[str]:
    """Files of settings of a positioning unit."""
    values: dict[str, dict[str, int]] = {}
    for place in stored_places():
        part = f"axis{place.axis}" if place.axis else "unit"
        values.setdefault(part, {})[place.register.name] = place.register.least
    text = text_of(values)
    for each in (
        text[:-3], "[]", text.replace(f'"layout": {LAYOUT}', '"layout": 99'),
        text.replace('"axis4"', '"axis5"'), text.replace('"BACKLASH"', '"BACKLESS"', 1),
        re.sub('"BACKLASH": [0-9]+', '"BACKLASH": 70000', text, count=1),
        text.replace('"RATE"', '"RATE": 1, "RATE"'),
    ):  # fmt: skip
        yield refusal(read_values, each, "a.json")


@cache
def messages() -> list[str]:
    """All that bad files are told."""
    found = [*of_programs(), *of_vectors(), *of_files(), *of_machines(), *of_settings()]
    return sorted({*found, *WITHOUT_CONTENT})


def of_python(path: str, functions: set[str] | None) -> Iterator[list[str]]:
    """The sentences of a source, in pieces between what differs."""
    for pieces in texts_of(TOOLS / path, functions):
        yield [piece or "" for piece in pieces]


def of_c(name: str) -> Iterator[list[str]]:
    """The same of a source in C."""
    text = (TOOLS / "gve134_host" / name).read_text(encoding="utf-8")
    text = re.sub(r'%\d*" PRI\w+( ")?', lambda match: "%u" if match[1] else '%u"', text)
    for literal in re.findall(r'"((?:[^"\\]|\\.)*)"', text):
        if "{" not in literal:
            yield re.split(r"%(?:\.\*)?[a-z]", literal)


def sentences() -> Iterator[list[str]]:
    """All sentences that a file can be told."""
    for path, functions in OF_FUNCTIONS.items():
        yield from of_python(path, functions)
    for name in ("gve_check.c", "gve_file.c"):
        yield from of_c(name)


def test_every_sentence_of_the_sources_is_among_those_that_are_tried() -> None:
    told = "\n".join(messages())
    wanted = [
        pieces for pieces in sentences()
        if any(map(PROSE.search, pieces)) and not OTHERS.search("".join(pieces).lstrip(": "))
    ]  # fmt: skip
    missing = [
        pieces for pieces in wanted
        if not re.search(".{0,99}".join(re.escape(each) for each in pieces if each), told)
    ]  # fmt: skip

    assert len(wanted) > 150
    assert missing == []


def test_everything_that_a_service_tells_of_a_file_is_told_in_czech() -> None:
    shown = ask_source("file_words.ts", [["wordsOf", each, "cs"] for each in messages()])

    left = {
        told: words for told, words in zip(messages(), shown, strict=True)
        if words == told or ENGLISH.search(words) or re.search(r"\$\d", words)
    }  # fmt: skip
    assert left == {}


def test_other_languages_and_what_is_not_known_stay_as_they_are_told() -> None:
    told = "V takes a number from 10 to 200000 as parameter 1, found 9"
    asked = [["wordsOf", told, "en"], ["wordsOf", told, "cs"], ["wordsOf", "a: b; c", "cs"]]

    assert ask_source("file_words.ts", asked) == [
        told, "V: parametr 1 má být číslo od 10 do 200000, zde je 9", "a: b; c",
    ]  # fmt: skip
