"""A block: a line of G-code with its words sorted by what they are for."""

from __future__ import annotations

from functools import cache

from rkm04_tools.gve134.gcode.words import Pair

NUMBER_MAX = 1_000_000.0
"""The largest number of a word: a kilometre in mm. Up to it a double has nine decimals."""

MOTION, NOTHING, PLANE, UNITS, DISTANCE, FEED_MODE = (
    "motion", "what is done once", "plane", "units", "distance", "feed mode",
)  # fmt: skip
RAPID, LINEAR, CLOCKWISE, COUNTER, PROBE, NO_MOTION = 0, 10, 20, 30, 382, 800
DWELL, HOME, OFFSET, NO_OFFSET = 40, 280, 920, 921
TAKES_AXES = (HOME, OFFSET, NO_OFFSET)
"""With one of these a block has no motion."""

GROUPS: dict[int, str] = {
    **dict.fromkeys((RAPID, LINEAR, CLOCKWISE, COUNTER, PROBE, NO_MOTION), MOTION),
    **dict.fromkeys((DWELL, HOME, OFFSET, NO_OFFSET), NOTHING),
    **dict.fromkeys((170, 180, 190), PLANE),
    **dict.fromkeys((200, 210), UNITS),
    **dict.fromkeys((900, 910), DISTANCE),
    **dict.fromkeys((930, 940), FEED_MODE),
    400: "cutter", 490: "tool length", 540: "system", 640: "path", 911: "centres",
}  # fmt: skip
"""Ten times the number, and the group of which a block has one at most.

Those of the last line ask for what is so anyway.
"""

FOREIGN_G = {
    (410, 420): "compensation of the cutter's radius is not known; let the CAM program compensate",
    (430, 431): "tool lengths are not known; set Z with G92 after a tool change",
    (100,): "G10 is not known; set positions with G92",
    (530,): "machine positions are not known; use G28 and G92",
    (550, 560, 570, 580, 590): "one coordinate system is known; set it with G92",
    (610, 611): "exact stops are not known; corners are slowed by the machine file's jumps",
    (50, 51): "splines are not known; let the CAM program write lines and arcs",
    (290,): "G29 is of 3D printers",
    (383, 384, 385): "of the probing motions G38.2 is known",
    (901,): "centres of arcs (I, J, K) count from the start of the arc (G91.1)",
    (330, 331, 760): "threads are not known: the spindle does not tell its angle",
    (960, 970, 950): "the spindle's speed is in turns a minute, feeds in mm a minute (G94)",
    (730, 810, 820, 830, 840, 850, 860, 870, 880, 890): "canned cycles are not known; "
    "let the CAM program write single moves",
}
M_GROUPS: dict[int, str] = {
    **dict.fromkeys((0, 1, 2, 30), "stop"),
    **dict.fromkeys((3, 4, 5), "spindle"),
    6: "tool", 7: "mist", 8: "flood", 9: "cooling off",
}  # fmt: skip
LETTERS = frozenset("ABCFGIJKMNPRSTXYZ")
FOREIGN_LETTERS = {
    "E": "E is of 3D printers, and no exponent of a number",
    "O": "programs with numbers and subprograms (O) are not known; let one file be one program",
    "B": "the machine has no axis B", "C": "the machine has no axis C",
    "U": "the machine has no axis U", "V": "the machine has no axis V",
    "W": "the machine has no axis W",
    "H": "tool lengths (H) are not known; set Z with G92 after a tool change",
    "D": "compensation of the cutter's radius (D) is not known",
    "L": "repeats (L) are not known", "Q": "Q is of canned cycles, which are not known",
}  # fmt: skip


class Block:
    """What a line asks for, and what is wrong with it: the index of the word, and why."""

    __slots__ = ("codes", "commands", "faults", "places", "values")

    def __init__(self) -> None:
        self.codes: dict[str, int] = {}
        """By group, ten times the number of G."""
        self.commands: dict[str, int] = {}
        """By group, the number of M."""
        self.values: dict[str, float] = {}
        """By letter, all but G, M and N."""
        self.places: dict[str, int] = {}
        """The index of the word, by letter or group."""
        self.faults: list[tuple[int, str]] = []


def read_block(words: list[Pair]) -> Block:
    """Sort the words of a line."""
    block = Block()
    values, places = block.values, block.places
    for index, (letter, text) in enumerate(words):
        if letter == "G":
            _take_code(block, index, text)
        elif letter == "M":
            _take_command(block, index, text)
        elif letter == "N":
            if index:
                block.faults.append((index, "a line's number stands at its beginning"))
            elif text[0] in "+-":
                block.faults.append((index, f"N{text}: a line's number has no sign"))
        elif letter in values:
            block.faults.append((index, f"{letter} stands twice in the line"))
        elif letter in "BCEO" or letter not in LETTERS:
            block.faults.append((index, FOREIGN_LETTERS[letter]))
        else:
            value = float(text)
            if not -NUMBER_MAX <= value <= NUMBER_MAX:
                block.faults.append((index, f"{letter} takes numbers up to {NUMBER_MAX:.0f}"))
            else:
                values[letter] = value
                places[letter] = index
    return block


def _take_code(block: Block, index: int, text: str) -> None:
    code = _code(text)
    group = GROUPS.get(code)
    if group is None:
        block.faults.append((index, _unknown_g(code, text)))
    elif group in block.codes:
        block.faults.append((index, f"G{text}: the line has another G of its group ({group})"))
    else:
        block.codes[group] = code
        block.places[group] = index


def _take_command(block: Block, index: int, text: str) -> None:
    command = _code(text)
    number = command // 10
    group = M_GROUPS.get(number) if command % 10 == 0 and command >= 0 else None
    if group is None:
        kind = "; M codes from 82 on are of 3D printers" if number >= 82 else ""
        if number in (97, 98, 99):
            kind = "; subprograms are not: let the CAM program write them out"
        block.faults.append((index, f"M{text} is not known; M0 to M9 and M30 are{kind}"))
    elif group in block.commands:
        block.faults.append((index, f"M{text}: the line has another M of its group ({group})"))
    else:
        block.commands[group] = number
        block.places[group] = index


@cache
def _code(text: str) -> int:
    """Ten times the number; -1: it has more than one decimal, or is too large."""
    tenfold = round(float(text) * 10) if len(text) < 10 else -1
    return tenfold if tenfold >= 0 and abs(tenfold / 10 - float(text)) < 1e-9 else -1


def _unknown_g(code: int, text: str) -> str:
    for codes, words in FOREIGN_G.items():
        if code in codes:
            return f"G{text}: {words}"
    return f"G{text} is not known"
