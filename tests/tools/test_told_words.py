"""What units and services tell pages is told in Czech, too: all sentences that the sources have."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from page_source import ask_source
from python_texts import texts_of
from rkm04_tools.positioning import state
from rkm04_tools.report import STATES
from rkm04_tools.service.words import Words
from rkm04_tools.status import CAUSES, ERRORS

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
PAGE = TOOLS / "service_page/src"
PYTHON = TOOLS / "rkm04_tools"
HELPER = ROOT / "tests/support/told_words.ts"
SOME = "7"
"""Stands for whatever differs."""
PROSE = re.compile(r"[A-Za-z']+ [a-z']{2,}")
ENGLISH = re.compile(
    r"\b(again|and|answers?|are|at|axes|axis|before|first|for|from|has|here|is|its|it|look|must"
    r"|no|nothing|not|of|or|over|stands?|the|this|unit|was|were|which|with|write)\b"
)
REGISTER = re.compile(r'^[UA]\(\w+, .*SETTING.*"(.*)", "(.*)"\)$', re.MULTILINE)
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`')
COMMENT = re.compile(r"/\*.*?\*/|^\s*//.*?$|^import .*?;$", re.DOTALL | re.MULTILINE)

ALONE: dict[str, list[str]] = {
    "rkm04": [
        "serial_line.ts", "simulator.ts", "unit_answer.ts", "unit_desk.ts", "unit_messages.ts",
        "unit_orders.ts", "unit_plan.ts", "unit_stop.ts",
    ],
    "gve134": [f"gve134/alone/{name}.ts" for name in (
        "acts", "answers", "desk", "jobs", "link", "seen_unit", "sender", "told", "wire", "work",
        "worker",
    )],
    "positioning": [f"positioning/alone/{name}.ts" for name in (
        "acting", "axis_state", "bus", "client", "connection", "desk", "looks", "settings_all",
        "stop", "wire", "worker",
    )],
}  # fmt: skip
"""What the pages without a service say themselves."""

SHARED: dict[str, set[str] | None] = {
    "transport.py": {
        "_connecting_failed", "_opening_failed", "_ports_there_are", "_lost", "read",
    },
    "service/answers.py": None, "service/fields.py": None, "service/http.py": {"bytes_of",
    "object_of", "_report"},
    "service/trouble.py": None, "service/virtual.py": None,
}  # fmt: skip
SERVED: dict[str, dict[str, set[str] | None]] = {
    "rkm04": {
        **SHARED,
        "acting.py": {"change_speed", "_still", "_unmoved", "_does"},
        "speeding.py": {"send_speed_briefly"},
        "line.py": {"_failed", "_look_for", "scan"},
        "line_errors.py": None, "messages.py": None, "report.py": {"state"},
        "sending.py": None, "service/app.py": None, "service/curves.py": None,
        "service/desk.py": None, "service/orders.py": None, "service/talking.py": None,
        "service/together.py": None, "service/turns.py": None, "service/unit_desk.py": None,
        "service/unit_line.py": None, "service/worker.py": None,
    },
    "gve134": {
        **SHARED,
        "gve134/answers.py": None, "gve134/known.py": {"spindle_text"}, "gve134/link.py": None,
        "gve134/link_errors.py": None,
        "gve134/master.py": None, "gve134/probing.py": None,
        "gve134/sending.py": {
            "_between", "_unprobed", "executed_text", "_judge", "_refused", "interrupted",
            "_wait_for_room",
        },
        "gve134/state.py": {"text"}, "gve134/stopping.py": {
            "halted_text", "standing_text",
        },
        "gve134/unit.py": None, "gve134/service/acting.py": None,
        "gve134/service/connection.py": None,
        "gve134/service/desk.py": None, "gve134/service/jobs.py": None,
        "gve134/service/orders.py": None, "gve134/service/worker.py": None,
    },
    "positioning": {
        **SHARED,
        "positioning/line_errors.py": None, "positioning/settings.py": {
            "require_free", "_changed",
        },
        "positioning/state.py": {"error_text", "words"}, "positioning/wire.py": None,
        "positioning/unit.py": {
            "set_many", "store", "_instruct", "control", "_require_taken", "_measure", "_feed",
        },
        "positioning/service/acting.py": None, "positioning/service/connection.py": None,
        "positioning/service/orders.py": None, "positioning/service/stopping.py": None,
        "positioning/service/worker.py": None,
    },
}  # fmt: skip
"""What services say; of some sources these functions only, of others (None) all."""

ASSEMBLED: dict[str, list[str]] = {
    "rkm04": [
        "unit 5 does not answer", "unit 5 does not answer, only the adapter's echo comes back",
        "unit 5 has restarted, the request was not executed",
        "unit 5 has restarted, the request was executed before that or not at all",
        "what comes back from unit 5 is damaged", "unit 5 was not asked",
        "the unit refuses the command Q (flag 2)", "the unit refuses the value after V (flag 1)",
        "motor 1 runs no move: nothing was sent, motor 2 runs no move: nothing was sent",
        "the stop is not confirmed by node 1, node 3 of COM4; use the emergency stop",
        "status 3, state 10", "state 5",
        "motor 1: there is no program in it; nothing was sent to any motor; send it alone",
        "the unit could not store the program (error 1): the memory reports an error; the old "
        "program stays",
    ],
    "gve134": [
        "a.gve:3: C5: INTERRUPTED by sensor plate, H, positions at that moment 1,2,3,4; the axes "
        "stand at X 0  Y 0  Z 0  A 0; stopped, nothing waits (Delete clears it); it is not known "
        "how many vectors were executed, 3 were sent",
        "a.gve: INTERRUPTED by what the unit does not tell; the axes stand at X 0  Y 0  Z 0  A 0",
        "a.gve: the computer or its program slept for 25 s: INTERRUPTED by H; the "
        "axes stand at X 0",
        "5 vectors were executed, 7 were sent", "confirmed by the unit; THE SPINDLE TURNS at 50 %",
        "a.gve:3: L5: refused: not while a vector runs, INTA is set; the 4 vectors before it are "
        "executed (answer F)",
        "a.gve:3: L5: refused: wrong syntax (answer 4)",
        "WX1,2,3,4: its switch was not found, or not let go, within the ways that were given; the "
        "axes stand at X 0  Y 0  Z 0  A 0 (answer D)",
        "a.gve:3: L1: nothing was touched on the way; the axes stand at X 0  Y 0; the unit is at "
        "rest",
        "nothing waits to go on: nothing to go on with (answer 6)",
        "nothing was deleted: the axes move; halt comes first (answer 7)",
        "nothing was moved: no motion: its crystal does not run",
        "nothing was moved; no motion: restarted by its watchdog or a fault (Delete clears it)",
        "Q → 0,12  done", "V5 → C  wrong syntax, INTA is set",
        "the virtual unit: the unit tells that it is moving",
        "the virtual unit HAS RESTARTED: its queue, positions and settings are gone, and what "
        "moved "
        "stood at once; the command under way was executed before that or not at all, and nothing "
        "was sent after it",
        "USB 1234:5678: the unit does not answer; 9 vectors were sent and go on by themselves: "
        "whether the axes move is NOT KNOWN",
        "USB 1234:5678: the unit does not answer; 9 to 41 vectors were sent and go on by "
        "themselves: whether the axes move is NOT KNOWN",
        "the unit does not answer; 0 to 1 vectors were sent and go on by themselves",
        "the unit HAS RESTARTED, its positions count anew; the axes stand at X 0  Y 0  Z 0  A 0; "
        "stopped, the rest of the vectors waits (Go on, or Delete); confirmed by the unit",
    ],
    "positioning": [
        "virtual, unit 1 does not answer; are address, rate and format right, is the unit on, and "
        "are A and B not swapped?",
        "COM3, unit 2 does not answer, only the adapter's echo comes back",
        "COM3, unit 2 HAS RESTARTED; its axes are free, positions count from 0, and what moved "
        "stood at once; the last instruction may have been executed before that; look at the unit",
        "COM3, unit 2: reading register 100: the value is out of its range (exception 3)",
        "COM3, unit 2: writing register 36: STORE has failed; what was stored before still is "
        "(exception 4)",
        "COM3, unit 2: the identification: an exception that this unit does not have (exception 9)",
        "axis 1: 0.000 mm, TAKEN, brakes, homing, capture armed, limit - active, reference active, "
        "error 7: a limit input is active",
        "axis 1: 0.000 mm, 500 mm/min, MOVING", "axis 2: -1.500 mm, FREE",
        "axis 2: POS_MODE was refused: error 3: the axis is not taken: init comes first",
        "axis 1: error 10: a software limit; nothing was moved: init clears it",
        "axis 1 is TAKEN, and settings wait for it; reset comes first",
        "all axes stand: 1 at 10.000 mm, 3 at 0.000 mm", "axes 1, 2 stand: 1 at 10.000 mm",
        "axis 1 stands at 10.000 mm; another master gave axis 1 the permission again, so the "
        "measure was ended there",
        "axis 1 stands at 10.000 mm; another master gave all axes the permission again, so the "
        "measure was ended there",
        "COM3, unit 2, axis 1, 2: it still moves",
        "axis 1 IS NOT HELD: another master, such as a PLC, has given the permission (MP) again; "
        "the measure is ended now, take the permission away there",
        "axes 1, 2 ARE NOT HELD: another master, such as a PLC, has given the permission (MP) "
        "again",
        "all axes ARE NOT HELD: another master, such as a PLC, has given the permission (MP) again",
        "COM3, unit 2 does not answer; it was not told again to move, as that would be late; "
        "whether it has begun to is not known",
        "script.csv:3: no such instruction; write ms,axis,INSTRUCTION,values, for example "
        "10,1,POS_MODE,10000,500",
        "written: axis1 BACKLASH, unit WATCHDOG; not stored yet",
    ],
}  # fmt: skip
"""Sentences that are made of pieces, as pages without a service tell them."""
ASSEMBLED_BY_SERVICES: dict[str, list[str]] = {
    "rkm04": [
        "COM3: unit 5 does not answer, only the adapter's echo comes back; check power, wiring (A, "
        "B) and address (switch S1); rkm04 scan shows who is there",
        "COM3: what comes back from unit 5 is damaged",
        "COM3: unit 5 has restarted, the request was not executed; look at the unit (rkm04 status) "
        "before you send it again",
        "motor 1 (already sent to motor 2, 3): the unit does not know Get Status (message 200); it "
        "has other software",
        "motor 1 (nothing was started): no port is open; connect first",
        "motor 1 keeps its speed: it is in a limit run, or stops; a speed is for moves in progress",
        "motor 1 stands, stopped by K: nothing was sent",
        "motor 1 stands, waiting for input 3 to become 1: nothing was sent, motor 2 brakes: "
        "nothing "
        "was sent; a speed is for moves in progress",
        "motor 2 waits at [ in another program and would start too; nothing was sent to any motor; "
        "reset it, or send without starting together",
        "motor 1 has come to a stand meanwhile: V5 may be in its memory now",
        "motor 1 has not moved while it was watched: nothing was sent",
        "the unit refuses the command Q (flag 2); nothing of it was stored or run",
        "/dev/ttyS9: no such port; there are /dev/ttyS0, /dev/ttyS1",
        "the stop is not confirmed by node 1 of COM3, node 3 of COM4; use the emergency stop",
    ],
    "gve134": [
        "a.gve:3: C5: INTERRUPTED by RefX; the axes stand at X 0  Y 0  Z 0  A 0; stopped, the rest "
        "of the vectors waits; 3 of 9 vectors were executed, 7 were sent",
        "it is not known how many of 9 vectors were executed, 7 were sent",
    ],
    "positioning": [
        "COM3, unit 2 does not answer; is it on, are address, rate and format right, and are A and "
        "B not swapped?",
        "axis 1: POS_MODE was refused: error 15: there was a fault: init comes first (error 7: a "
        "limit input is active; go the other way, or leave the switch by hand)",
        "axis 1: the measure was ended by error 10: a software limit; it stands at 5.000 mm; go "
        "the "
        "other way, or change SOFT_MIN and SOFT_MAX; init comes before the next one",
        "axis 1 is FREE, homing, and takes no feed before a measure: mode gives one",
    ],
}  # fmt: skip
PIECES = {
    "rkm04": {
        "7 does not answer", "7 does not answer, only the adapter's echo comes back",
        "7 has restarted, the request was 7", "7 was not asked",
        "what comes back from 7 is damaged",
        "the command", "the value after", "the unit refuses 7 7 (flag 7)",
        "the unit refuses 7 7 (flag 7); nothing of it was stored or run",
        ", only the adapter's echo comes back", "already sent to motor 7", "nothing was started",
        "7 has restarted, the request was 7; look at the unit (rkm04 status) before you send it "
        "again",
        "7unit 7 does not answer7; check power, wiring (A, B) and address (switch S1); rkm04 scan "
        "shows who is there",
        "7what comes back from unit 7 is damaged; do two units have this address (switch S1), "
        "are A "
        "and B swapped, is the line terminated?",
        "waits at [ in another program and would start too",
        "holds another program, and ] to all motors would be added to it",
        "has come to a stand meanwhile: V7 may be in its memory now",
        "has not moved while it was watched: nothing was sent",
        "keeps its speed: it is in a limit run, or stops",
    },
    "gve134": {
        ", positions at that moment 7", "7; 7 were executed, 7 were sent",
        "; the 7 vectors before it are executed", "it is not known how many vectors",
        "nothing waits to go on", "nothing was deleted", "7 of 7 vectors were executed",
        "7, 7 were sent", "7; 7 vectors were sent and go on by themselves: whether the axes",
        "INTERRUPTED by 77; the axes", "it is not known how many", "move is NOT KNOWN",
        "stand at 7; 7", "nothing was moved: 7",
        "7the axes stand at 7; 7; confirmed by the unit",
    },
    "positioning": {
        "7 does not answer", "7 does not answer, only the adapter's echo comes back",
        "reading register 7", "writing register 7", "the identification",
        "its axes are free, positions count from 0, and what moved stood at once; 7look at the "
        "unit",
        ", only the adapter's echo comes back", "7, axis 7: it still moves",
        "7 does not answer7; 7", "7 does not answer; it was not told again to move, as that would "
        "be late; whether it has begun to is not known", "another master has given it back",
        "axis 7 is not taken: 7",
        "7 HAS RESTARTED: its axes are free, positions count from 0, and what moved stood at once; "
        "7positioning status tells what it is like",
    },
}  # fmt: skip
"""What those are made of."""
PARSED = [
    "F (steps forward) takes a number from 1 to 16000000, found the end of the file",
    "F (steps forward) takes a number from 1 to 16000000, found a blank; nothing may stand between "
    "a command and its number",
    "X (total stop by an input) takes a number from 1 to 8, found no number",
    "C takes 1 to 8 (clear an output), 40 to 58 (switch a function off), 75 (resume), 80 to 95 "
    "(clear a variable) or 100 (zero the position), found 101",
    "G takes 1 to 2000000000 (go to a position), + (run forward without end) or - (run backward "
    "without end), found no number",
    "O takes 1 to 8 (wait until an input is 1) or 80 to 95 (wait until a variable is 1), found 9",
    "I takes the number of an input (1 to 8) or variable (80 to 95), H or L, and a label from 1 to "
    "80, as in I05H10, found 9H1",
    "M (guard the moves by an input that is 1) takes a number from 1 to 8, found 9",
    'unknown command "f"; commands are upper case: F',
    "unknown command (soft hyphen, code 173)",
    "motor 1, line 2, column 3: V100 is below S500; the move runs at V100 throughout",
    "motor 2: the . after it closes L5; an E after the call is not its own; nothing was sent to "
    "any motor; correct it, then send again",
]
"""What the parser makes of its pieces."""
OTHERWISE = {
    # The page has these in words of its own: by the values of an answer, or by its kind.
    "7 commands in 7 message7 sent7", "7 steps made, command 7", "all motors stop",
    "; the program memory was full, commands were lost", "each runs since it arrived",
    "started together", "; each runs since it arrived", "; started together",
    "motor 7: 7 commands stored", "no move in progress", "reset, the program memory is empty",
    "told to go on", "told to store", "units that answer: 7", "the port is closed",
    "to all units: 7; none of them answers, so it is not known who has got it",
    # Notes of failures, which commands tell, and pages do not.
    "what had come of it is forgotten again: the memory of 7 of unit 7 is empty", "all motors",
    # Nobody is told these: faults of the project, and what is looked for in other texts.
    "the line has ended a request by 7", "there is not memory enough for the line",
    "7 is not for the unit", "the program is not there", "there is no next command",
    "could not configure", "exclusively lock", "whether V7 was taken by motor 7",
    "there is no register 7",
    # Another unit's.
    "the stop is not confirmed by 7; use the emergency stop",
}  # fmt: skip


def of_page(path: str) -> Iterator[str]:
    """The texts of a source of the page."""
    text = COMMENT.sub("", (PAGE / path).read_text(encoding="utf-8"))
    for match in LITERAL.finditer(text):
        literal = (match[1] or match[2] or "").replace("\\\\", "\\")
        while literal != (literal := re.sub(r"\$\{[^{}]*\}", SOME, literal)):
            pass
        yield literal


def of_python(path: str, functions: set[str] | None) -> Iterator[str]:
    """The texts of a source in Python."""
    for pieces in texts_of(PYTHON / path, functions):
        yield "".join(SOME if piece is None else piece for piece in pieces)


def of_c(*paths: str) -> Iterator[str]:
    """The texts of sources in C: what is after a command or a sentence has one before it."""
    for path in paths:
        text = (TOOLS / path).read_text(encoding="utf-8")
        text = re.sub(r'"\s*\n\s*"', "", re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))
        text = re.sub(r'%(" PRI\w+( "|)|[a-z])', lambda m: SOME + ('"' if m[2] == "" else ""), text)
        for literal in re.findall(r'"((?:[^"\\]|\\.)*)"', text):
            words = literal.replace("\\\\", "\\").replace('\\"', '"')
            yield f"F1{words}" if words.startswith(" ") else words.removeprefix("; ")


def registers() -> list[str]:
    """Units and words of the settings of a positioning unit."""
    path = ROOT / "firmware/positioning/registers/registers.def"
    rows = REGISTER.findall(path.read_text(encoding="utf-8"))
    assert len(rows) > 15
    return [words for row in rows for words in row if words]


def as_shown(unit: str, *, alone: bool, texts: Iterable[str]) -> dict[str, str]:
    """What the page of a unit makes of texts in Czech."""
    told = sorted(set(texts))
    [shown] = ask_source(HELPER, [["wordsOf", unit, alone, told]])
    return dict(zip(told, shown, strict=True))


def english(shown: dict[str, str]) -> dict[str, str]:
    """Those of which something is English, or was not filled in."""
    return {
        told: words for told, words in shown.items()
        if words == told or ENGLISH.search(words) or re.search(r"[#$]\d", words)
    }  # fmt: skip


def sentences(unit: str, texts: Iterable[str]) -> set[str]:
    """The texts that are sentences."""
    found = {each for each in texts if PROSE.search(each)} - OTHERWISE - PIECES[unit]
    assert len(found) > 40
    return found


@pytest.mark.parametrize("unit", ALONE)
def test_all_that_a_page_without_a_service_says_is_czech_in_czech(unit: str) -> None:
    texts = sentences(unit, (text for path in ALONE[unit] for text in of_page(path)))

    assert english(as_shown(unit, alone=True, texts=[*texts, *ASSEMBLED[unit]])) == {}


@pytest.mark.parametrize("unit", SERVED)
def test_all_that_a_service_says_is_czech_in_czech(unit: str) -> None:
    words = Words(unit)
    told = (text for path, names in SERVED[unit].items() for text in of_python(path, names))
    plain = told if unit == "rkm04" else (words.plain(text).rstrip("; ") for text in told)
    texts = sentences(unit, plain)

    assembled = [*ASSEMBLED[unit], *ASSEMBLED_BY_SERVICES[unit]]
    assert english(as_shown(unit, alone=False, texts=[*texts, *assembled])) == {}


def test_names_that_a_page_brings_along_are_czech_too() -> None:
    names = [*CAUSES, *ERRORS, *STATES.values()]
    shown = as_shown("rkm04", alone=True, texts=[name for name in names if PROSE.search(name)])
    assert english(shown) == {}
    registered = [*state.ERRORS.values(), *state.EXCEPTIONS.values(), *registers()]
    shown = as_shown("positioning", alone=True, texts=registered)
    same = {"ms", "um", "mm/s2", "mm/min/65536", "100 Bd"}
    assert {told: words for told, words in english(shown).items() if told not in same} == {}


PARSER = [
    f"simulator/{name}.c" for name in ("refusal", "words", "lint", "lint_compounds", "lint_paths")
]
OF_COMMANDS = {
    # Of commands of which a number is never wrong, as they have none, or are one of several.
    "append a section to the compound move", "cancel the guards", "do the move", "end of a loop",
    "end of a subroutine", "go to position 0", "hold the program", "release the program",
    "reverse the direction", "run backward without end", "run forward without end",
    "stop the program", "jump if an input or variable is 0", "jump if an input or variable is 1",
    # Pieces of what is among PARSED.
    "F1 to 7, as in I05H10", "no number",
    "the number of an input (1 to 8) or variable (80 to 95), H or L, and a label from 7",
}  # fmt: skip


def test_all_that_the_parser_says_of_a_program_is_czech_too() -> None:
    told = {text for text in of_c(*PARSER) if PROSE.search(text)} - OF_COMMANDS
    assert len(told) > 70
    assert english(as_shown("rkm04", alone=True, texts=[*told, *PARSED])) == {}


def test_what_is_wrong_in_a_script_is_czech_too() -> None:
    paths = ("positioning_host/pos_script.c", "unit_host/inputs.c")
    told = {text for text in of_c(*paths) if PROSE.search(text)}
    assert len(told) > 15
    assert english(as_shown("positioning", alone=True, texts=told)) == {}


def test_what_nobody_knows_stays_as_it_is_told() -> None:
    texts = ["a: b; c, d", "V1000 F400 R", "5 something else", "error that is none"]
    assert as_shown("rkm04", alone=True, texts=texts) == {text: text for text in texts}
