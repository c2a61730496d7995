"""The words of a line of G-code: letters with their numbers, and the places of what is none.

No parser from elsewhere is used. Of those that there are (gcodeparser, pygcode, tree-sitter-gcode,
nc-gcode-interpreter) none tells the column of a word that a machine refuses; most pass over what
they do not know (`G1 X1 garbage` is `G1 X1` to them), read `X1 . 5` as X1 or `F1e3` as F1, or keep
positions in single precision.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

NUMBER = r"[+-]?(?:[0-9]++(?:\.[0-9]*+)?|\.[0-9]++)"
WORD = re.compile(rf"([A-Za-z])[ \t]*({NUMBER})")
WHOLE = re.compile(rf"(?:[ \t]*+[A-Za-z][ \t]*+{NUMBER})*+[ \t]*+")
COMMENT = re.compile(r"\([^()]*+\)|;.*")
CHUNK = re.compile(r"[^ \t]+")
LINE_LETTERS_MAX = 1000
"""The longest line, in characters: far more than any block has."""

TEXT_SHOWN_MAX = 20
O_WORD = re.compile(r"[ \t]*(?:[Nn][0-9]+[ \t]*)?()[Oo][ \t]*(?:<[^>]*>?|[0-9]+)[ \t]*[A-Za-z].*")
O_WORDS = (
    "subprograms, loops and branches (o... sub, call, while, if) are LinuxCNC's and not known "
    "here; let the CAM program write them out, as it does for grbl"
)
CAM = "let the CAM program write grbl's G-code"
DIALECTS = (
    (r"[Ll]-?[0-9]+(?:,-?[0-9]+){1,3}|[Cc]-?[0-9]+(?:,-?[0-9]+){1,3}",
     "this is a vector file; name it .gve"),
    (r"[0-9]+ (?:BEGIN|END|BLK|TOOL|CYCL|CALL|LBL|STOP|CC|CR?|L|FN)\b.*",
     f"this is Heidenhain's dialect; {CAM}"),
    (r"(?:IF|WHILE|GOTO|DO|END|ELSE|THEN|ENDIF|FOR|REPEAT|LOOP|DEF|PROC)[0-9]*\b.*",
     "conditions, loops and jumps are not known here; let the CAM program write them out"),
    (r"[A-Z]{3,}[0-9]*\(.*", f"calls with parameters are Siemens' dialect; {CAM}"),
    (r"[A-Z]+_[A-Z0-9_]+\b.*", f"named commands are Klipper's, a 3D printer's; {CAM}"),
    (r"(?:IN|SP[0-9]|P[UDA][-0-9,]*);.*", f"this is HPGL, a plotter's language; {CAM}"),
    (r"M(?:117|118)\b.*", "M117 and M118 show texts of 3D printers; remove them"),
    (r"<.*", "this is XML or HTML, as SVG is; let a CAM program make G-code of it"),
)  # fmt: skip
DIALECT = [
    (re.compile(rf"[ \t]*(?:N[0-9]+[ \t]+)?(?=(?:{form})[ \t]*$)"), why) for form, why in DIALECTS
]
FOREIGN = {
    "#": "parameters (#) are not known here; write numbers",
    "[": "expressions ([ ]) are not known here; write numbers",
    "]": "expressions ([ ]) are not known here; write numbers",
    ",": "numbers have a point, no comma",
    "=": "assignments (=) are of another dialect; write numbers",
    "/": "blocks that may be skipped (/) are not known here; remove the / or the line",
    "*": "checksums (*) are of 3D printers; remove them",
    "$": "commands of a controller ($) do not belong in a program",
    "%": "% stands alone in its line",
    "(": "a comment that does not end; write )",
    ")": "a ) without its (",
    ":": "labels (:) are of another dialect",
    '"': "texts in quotes are of another dialect",
}

Pair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Trouble:
    """Something wrong in a line; the column counts from 1."""

    column: int
    message: str


@dataclass(frozen=True, slots=True)
class Line:
    """Letters, as capitals, with the texts of their numbers; comments, joined; what is wrong."""

    words: list[Pair]
    comment: str
    troubles: list[Trouble]


def read_line(text: str) -> Line:
    """Take a line apart, without its end."""
    if len(text) > LINE_LETTERS_MAX:
        message = f"the line is longer than {LINE_LETTERS_MAX} characters; is this G-code?"
        return Line([], "", [Trouble(LINE_LETTERS_MAX + 1, message)])
    comment = ""
    code = text
    if "(" in text or ";" in text:
        comment = " ".join(filter(None, (_said(match[0]) for match in COMMENT.finditer(text))))
        code = without_comments(text)
    upper = code.upper() if code.isascii() else code
    if WHOLE.fullmatch(upper):
        return Line(WORD.findall(upper), comment, [])
    if upper.strip(" \t") == "%":
        return Line([("%", "")], comment, [])
    if match := O_WORD.fullmatch(code):
        return Line([], comment, [Trouble(match.end(1) + 1, O_WORDS)])
    for form, why in DIALECT:
        if match := form.match(code) or form.match(text):
            return Line([], comment, [Trouble(match.end() + 1, why)])
    return Line([], comment, _troubles(code))


def columns_of(text: str) -> list[int]:
    """The columns of the words of a line."""
    return [match.start() + 1 for match in WORD.finditer(without_comments(text))]


def without_comments(text: str) -> str:
    """The line with blanks in place of comments, so that columns stay."""
    return COMMENT.sub(lambda match: " " * len(match[0]), text)


def _said(comment: str) -> str:
    return (comment[1:] if comment[0] == ";" else comment[1:-1]).strip()


def _troubles(code: str) -> list[Trouble]:
    """What is no word; one trouble for each run of such characters up to a blank."""
    found: list[Trouble] = []
    place = 0
    while place < len(code):
        if code[place] in " \t":
            place += 1
        elif match := WORD.match(code, place):
            place = match.end()
        else:
            chunk = CHUNK.match(code, place)
            end = chunk.end() if chunk and code[place] != "(" else len(code)
            found.append(Trouble(place + 1, _what(code[place:end], code[end:].lstrip(" \t"))))
            place = end
    return found


def _what(chunk: str, after: str) -> str:
    first = chunk[0]
    if first in FOREIGN:
        return FOREIGN[first]
    if first.isascii() and first.isalpha():
        following = (chunk[1:] or after)[:1]
        if following and following in "#[=":
            return FOREIGN[following]
        return f"{first.upper()} without a number, found {_shown(chunk)}"
    if first in "+-.0123456789":
        return f"a number without a letter: {_shown(chunk)}"
    return f"no word of G-code: {_shown(chunk)}"


def _shown(chunk: str) -> str:
    text = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in chunk)
    return text if len(text) <= TEXT_SHOWN_MAX else f"{text[:TEXT_SHOWN_MAX]}…"
