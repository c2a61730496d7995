"""Draws scripts for units with hypothesis: programs, inputs that change, messages at any time.

Programs are drawn by the grammar of the language and biased to what is interesting: few inputs,
variables and labels, so that they meet; short moves with ramps; loops, subroutines, guards,
compound moves; now and then a command anywhere, which may well be an error.
"""

from __future__ import annotations

from typing import TypeVar

from hypothesis import strategies as st
from language_signals import MS
from program_probe import Edge, Request, Script

EPOCH_BITS = 62
TAIL_MS = 1500
"""How long a script goes on after its last message."""

LONG_TEXT = 1000
"""Of so many characters and more a program goes without notes, so that it fits a message."""

Text = st.SearchStrategy[str]


T = TypeVar("T")


def _weighted(*choices: tuple[int, st.SearchStrategy[T]]) -> st.SearchStrategy[T]:
    """Draw from strategies in proportion to their weights; st.one_of drops doubles."""
    drawn = [i for i, (weight, _) in enumerate(choices) for _ in range(weight)]
    return st.sampled_from(drawn).flatmap(lambda i: choices[i][1])


def _numbered(letter: str, *numbers: st.SearchStrategy[int]) -> Text:
    return st.one_of(*numbers).map(lambda n: f"{letter}{n}")


def _from(low: int, *highs: int) -> st.SearchStrategy[int]:
    return st.one_of(*(st.integers(low, high) for high in highs))


INPUTS = st.one_of(st.integers(1, 3), st.integers(1, 8))
VARIABLES = st.one_of(st.integers(80, 82), st.integers(80, 95))
SOURCES = st.one_of(INPUTS, VARIABLES)
LABELS = st.one_of(st.integers(1, 4), st.integers(1, 80))
SPEEDS = st.one_of(_from(1, 50, 400, 2000, 16_000), st.sampled_from([1, 100, 2000, 16_000]))

SETTING = st.one_of(
    _numbered("S", _from(1, 100, 600, 2000)),
    _numbered("V", SPEEDS),
    _numbered("A", _from(1, 3000, 60_000), st.just(60_000)),
    _numbered("F", _from(1, 5, 60, 400)),
    _numbered("B", _from(1, 5, 60, 400)),
    st.just("D"),
)
WAIT = _weighted(
    (6, _numbered("W", _from(1, 3, 60, 400))),
    (1, _numbered("O", SOURCES)),
    (2, _numbered("Z", SOURCES)),
)
OUTPUT = st.one_of(
    _numbered("T", st.integers(1, 8), VARIABLES),
    _numbered("C", st.integers(1, 8), VARIABLES),
    _numbered("T", st.integers(42, 58)),
    _numbered("C", st.integers(42, 58)),
    st.sampled_from(["T41", "C41"]),
    st.just("C100"),
    _numbered("=", st.integers(-300, 300)),
)
GUARD = st.one_of(
    _numbered("M", INPUTS), _numbered("N", INPUTS), st.just("U"), _numbered("X", INPUTS)
)
JUMP = st.one_of(
    st.tuples(st.sampled_from("HL"), SOURCES, LABELS).map(lambda t: f"I{t[1]}{t[0]}{t[2]}"),
    _numbered("J", LABELS),
    _numbered("'", LABELS),
)
MOVE = _weighted(
    (6, st.just("R")),
    (3, _numbered("G", st.integers(1, 300))),
    (3, st.just("H")),
    (1, st.sampled_from(["G+", "G-"])),
    (1, _numbered(")", INPUTS)),
    (1, _numbered("(", INPUTS)),
)
ANYTHING = st.one_of(
    SETTING, WAIT, OUTPUT, GUARD, JUMP, MOVE,
    _numbered("@", LABELS), _numbered("L", st.integers(1, 4)),
    st.sampled_from(["E", ".", "Y", "[", "]", "K", "C75", "\\"]),
)  # fmt: skip


def _joined(*parts: Text) -> Text:
    return st.tuples(*parts).map(" ".join)


def _several(part: Text, most: int) -> Text:
    return st.lists(part, min_size=1, max_size=most).map(" ".join)


SECTION = _joined(
    _numbered("V", SPEEDS),
    _numbered("A", _from(100, 3000, 60_000)),
    _numbered("F", _from(1, 5, 60, 200)),
    st.just("Y"),
)
COMPOUND = _joined(
    st.sampled_from(["", "T51", "T52 T58"]),
    _several(SECTION, 11),
    st.sampled_from(["R", "D R", "R D R"]),
)
SHORT_MOVE = _joined(st.sampled_from("FB"), st.just("")).flatmap(
    lambda letter: _numbered(letter.strip(), _from(1, 3, 60, 300)).map(lambda f: f"{f} R")
)
GUARDED = _joined(
    st.one_of(_numbered("M", INPUTS), _numbered("N", INPUTS)),
    st.one_of(SHORT_MOVE, MOVE),
    st.sampled_from(["U", ""]),
)
AGAIN = st.sampled_from(["D R", "R D R", "D R D R", "L3 R D E", "D Y R", "R V90 R", "H"])
"""What was set up before is run again, turned round, or with other settings."""

SIMPLE = _weighted(
    (4, SETTING),
    (2, WAIT),
    (3, OUTPUT),
    (2, GUARD),
    (4, MOVE),
    (6, SHORT_MOVE),
    (6, AGAIN),
    (4, GUARDED),
    (4, COMPOUND),
)


def _nested(inner: Text) -> Text:
    body = _several(inner, 4)
    loop = st.tuples(_from(1, 3, 9), body).map(lambda t: f"L{t[0]} {t[1]} E")
    skip = st.tuples(SOURCES, st.sampled_from("HL"), st.integers(5, 40), body).map(
        lambda t: f"I{t[0]}{t[1]}{t[2]} {t[3]} @{t[2]}"
    )
    call = st.tuples(st.integers(41, 60), st.integers(61, 80), body).map(
        lambda t: f"'{t[0]} J{t[1]} @{t[0]} {t[2]} . @{t[1]}"
    )
    again = st.tuples(st.integers(1, 4), body, WAIT).map(lambda t: f"@{t[0]} {t[1]} {t[2]} J{t[0]}")
    left = st.tuples(st.integers(1, 4), body, SOURCES, st.sampled_from("HL"), body, WAIT).map(
        lambda t: f"@{t[0]} L5 {t[1]} I{t[2]}{t[3]}{t[0] + 4} {t[4]} E @{t[0] + 4} {t[5]} J{t[0]}"
    )
    return _weighted((3, loop), (1, skip), (1, call), (1, again), (1, left))


STATEMENT = st.recursive(SIMPLE, _nested, max_leaves=12)
START = _joined(
    st.sampled_from(["", "\\", "\\C100"]),
    _numbered("S", _from(50, 600)),
    _numbered("V", _from(50, 2000, 16_000)),
    _numbered("A", _from(500, 9000, 60_000)),
    _numbered("F", _from(1, 60, 400)),
)
PROGRAM = _joined(START, st.lists(STATEMENT, min_size=2, max_size=10).map(" ".join))
DEEP = st.sampled_from(
    [
        "L2 " * 8 + "T1 " + "E " * 8,
        "L2 " * 9,
        "'1 J9 @1 '2 . @2 '3 . @3 '4 . @4 '5 . @5 '6 . @6 T3 . @9 T4",
        "'1 @1 T1 '1",
        "[ T1 W5 ] [ T2",
    ]
)
FILLER = st.builds(
    lambda part, commands, tail: f"{part} " * (commands // len(part.split())) + tail,
    st.sampled_from(["D D @3", "S9 W1 S8", "@7", "'9 J8 @9 . @8", "T1 C1 A9", "L2 E", "D"]),
    st.one_of(st.integers(300, 1050), st.integers(690, 710)),
    st.sampled_from(["", "J3", "T2", "'7", "E", "]"]),
)
"""Enough of a program to fill the memory, or to come near it."""

LATER = _weighted(
    (10, st.sampled_from(["K", "C75", "K", "C75", "\\", "]", "R", "G+", "G-"])),
    (2, st.sampled_from(["T41", "C41"])),
    (6, _numbered("V", SPEEDS)),
    (3, _several(ANYTHING, 3)),
    (3, _joined(st.just("\\"), PROGRAM)),
    (1, st.sampled_from(["T40", "C40"])),
    (1, FILLER),
)


@st.composite
def _dressed(draw: st.DrawFn, program: str) -> bytes:
    """Write a program down in one of the ways in which it can be written."""
    gaps = draw(st.sampled_from([" ", "", "\r\n", "\t{ note }", "{}"]))
    text = program.replace(" ", gaps if len(program) < LONG_TEXT else "").encode("ascii")
    call = draw(st.sampled_from([b"'", b'"', b"`", b"\xb4"]))
    return text.replace(b"'", call)


@st.composite
def _spoilt(draw: st.DrawFn, program: str) -> bytes:
    """Put a wrong byte somewhere into a program, or cut it off."""
    text = program.encode("ascii")
    at = draw(st.integers(0, len(text)))
    middle = bytes(draw(st.lists(st.integers(0, 255), max_size=1)))
    return text[:at] + middle + text[at + draw(st.integers(0, 1)) :]


def _texts(program: Text) -> st.SearchStrategy[bytes]:
    return program.flatmap(lambda p: _weighted((11, _dressed(p)), (1, _spoilt(p))))


def _set(motor: int, text: bytes) -> bytes:
    return b"\x02%d" % motor + text


MOTOR = st.sampled_from([1, 1, 1, 1, 2, 0])
MESSAGE = _weighted(
    (5, st.builds(_set, MOTOR, _texts(LATER))),
    (1, st.sampled_from([b"\x041", b"\x040", b"\x051", b"\x071"])),
)
GAP_TICKS = st.one_of(
    st.integers(MS, 20 * MS), st.integers(MS, 300 * MS), st.integers(MS, 1500 * MS)
)


MAIN = _weighted(
    (16, PROGRAM),
    (4, _several(ANYTHING, 9)),
    (3, _joined(START, DEEP)),
    (1, _joined(START, st.sampled_from(["W90", "[", "O1"]), FILLER)),
)


@st.composite
def scripts(draw: st.DrawFn) -> Script:
    """Draw a whole script: one to three motors with programs, then messages and inputs."""
    tick = draw(st.sampled_from([0, 1, MS]))
    motors = draw(st.sampled_from([(1,), (1,), (1, 2), (1, 2, 3)]))
    requests = [Request(tick, _set(motor, draw(_texts(MAIN)))) for motor in motors]
    for _ in range(draw(st.integers(0, 6))):
        tick += draw(GAP_TICKS)
        requests.append(Request(tick, draw(MESSAGE)))
    end = tick + TAIL_MS * MS
    edges, at, levels = [], 0, dict.fromkeys(range(1, 9), 0)
    for _ in range(draw(st.integers(0, 12))):
        at += draw(GAP_TICKS)
        number = draw(INPUTS)
        levels[number] = 1 - levels[number]
        if at < end:
            edges.append(Edge(at, number, levels[number]))
    return Script(tuple(requests), tuple(edges), end, draw(st.integers(0, (1 << EPOCH_BITS) - 1)))
