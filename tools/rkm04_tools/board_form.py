"""The form of a board header: what the compiler, the linker's offset and the tools read alike.

The compiler reads C; the tools and the build read lines. So a header has no #if, and nothing in a
comment that could be taken for a line of it; every name is one that a board has, and stands once.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from difflib import get_close_matches

from rkm04_tools.board_header import COMMENT, PIN, TAKEN, read_board, without_comments

LEVELS = ("STEP", "DIR", "BI", "BO", "LED", "S1", "ENABLE", "PWM")
VALUES = {
    "BOARD_PACKAGE", "BOARD_CRYSTAL_MHZ", "BOARD_USART", "BOARD_STEP_CLASS", "BOARD_LOADER_BYTES",
    "BOARD_SLOW_CRYSTAL", "BOARD_SUPPLY_MIN_MV", "BOARD_DETECT_LEVEL", "BOARD_FLASH_BYTES",
    "BOARD_BROWN_OUT_LEVEL", *(f"BOARD_{kind}_LEVEL" for kind in LEVELS), "BOARD_ENABLE_READY_US",
    "BOARD_ENABLE_IDLE_MS", "BOARD_STEP_HIGH_NS", "BOARD_STEP_LOW_NS", "BOARD_DIR_SETUP_NS",
    "BOARD_DIR_HOLD_NS",
}  # fmt: skip
PINS = "BOARD_PINS"
OTHERS = {"BOARD_TAKEN", "BOARD_PULLED_UP"}
"""Lists of pins without a signal."""
APART = {
    "BOARD_ENABLE_PINS": re.compile(r"EN_\w+"),
    "BOARD_CAPTURE_PINS": re.compile(r"CAPTURE"),
    "BOARD_PWM_PINS": re.compile(r"PWM"),
    "BOARD_MORE_LED_PINS": re.compile(r"LED_[5-9]"),
}
"""Lists of pins that only some boards have, and the signals in them; all others are in PINS."""
LISTS = {PINS, *APART, *OTHERS}

HIDDEN = re.compile(
    r"#\s*(?:define|undef|include|if|ifdef|ifndef|elif|else|endif)\b\s*\w*"
    r'|\bX\s*\(\s*\w+\s*,\s*\w+\s*,\s*[\d"][^)\n]*\)?'
)
DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w*)[ \t]*(\w*)(?:\\\n|.)*", re.MULTILINE)
END = ("endif", "")
LIST = re.compile(r"^#define (\w+)\(X\)((?:\\\n|.)*)", re.MULTILINE)


def _comment_errors(text: str) -> Iterator[str]:
    for comment in COMMENT.finditer(text):
        held = None if comment[1] else HIDDEN.search(comment[0])
        if held:
            yield f"`{held[0]}` is in a comment, where the build may take it for real: take it out"


def _inside(code: str) -> list[tuple[str, str]]:
    """All directives and what they name, without the #ifndef around all."""
    found = [(m[1], m[2]) for m in DIRECTIVE.finditer(code)]
    guard = found[0][1] if found else ""
    if found[:2] == [("ifndef", guard), ("define", guard)] and END in found:
        found.remove(END)
        return found[2:]
    return found


def _line_errors(code: str) -> Iterator[str]:
    for word, _ in _inside(code):
        if word != "define":
            yield f"#{word}: a board header has only #define, inside of one #ifndef around all"
    if rest := DIRECTIVE.sub("", code).split():
        yield f"`{' '.join(rest[:8])}` is neither a #define nor a comment"


def _name_errors(code: str) -> Iterator[str]:
    names = Counter(name for word, name in _inside(code) if word == "define")
    for name, count in names.items():
        if name not in VALUES | LISTS:
            near = get_close_matches(name, sorted(VALUES | LISTS), 1)
            hint = f", but {near[0]} is" if near else ""
            yield f"{name} is not a name that a board has{hint}"
        if count > 1:
            yield f"{name} is defined twice"


def _value_errors(text: str, code: str) -> Iterator[str]:
    read, lists = read_board(text).values, {found[1] for found in LIST.finditer(code)}
    defined = {name for word, name in _inside(code) if word == "define"}
    for name in sorted(defined & VALUES - set(read)):
        yield f"{name} must be one plain value, from #define at the margin to the line's end"
    for name in sorted(defined & LISTS - lists):
        yield f"{name} must be `#define {name}(X)` at the margin, and rows"


def _row_errors(name: str, rows: str) -> Iterator[str]:
    row = TAKEN if name in OTHERS else PIN
    if rest := row.sub("", rows).replace("\\\n", "").strip():
        form = 'X(PORT, NUMBER, "WHAT")' if name in OTHERS else "X(SIGNAL, PORT, NUMBER, USE)"
        yield f"{name}: `{rest}` is not {form}"
    for signal, *_ in PIN.findall(rows):
        place = next((each for each, own in APART.items() if own.fullmatch(signal)), PINS)
        if name != place:
            yield f"{signal} belongs in {place}, not in {name}"


def _pin_errors(code: str) -> Iterator[str]:
    for found in LIST.finditer(code):
        if found[1] in LISTS:
            yield from _row_errors(found[1], found[2])
    for signal, count in Counter(m[1] for m in PIN.finditer(code)).items():
        if count > 1:
            yield f"{signal} has two pins"


def form_errors(text: str) -> Iterator[str]:
    """What is read in one way here and in another one there, or not at all."""
    code = without_comments(text)
    yield from _comment_errors(text)
    yield from _line_errors(code)
    yield from _name_errors(code)
    yield from _value_errors(text, code)
    yield from _pin_errors(code)
