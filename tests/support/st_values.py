"""Types and values of Structured Text, as far as tools/plc/positioning.st uses them.

Stricter than a PLC: a number that does not fit its type is an error here, not a wrap.
"""

from __future__ import annotations

import math
import re

INTEGERS = {
    "INT": (-(2**15), 2**15 - 1),
    "UINT": (0, 2**16 - 1),
    "DINT": (-(2**31), 2**31 - 1),
    "UDINT": (0, 2**32 - 1),
}
BITS = {"WORD": 16, "DWORD": 32}
ELEMENTARY = {"BOOL", "LREAL", *INTEGERS, *BITS}
LITERAL = "a number without a type"

CONVERSION = re.compile(r"^([A-Z]+)_TO_([A-Z]+)$")


class Unsuitable(Exception):
    """The text is no Structured Text that can be run here, or a value does not fit."""


def fitted(kind: str, value: int) -> int:
    """A value, which must fit the type."""
    least, most = INTEGERS[kind] if kind in INTEGERS else (0, 2 ** BITS[kind] - 1)
    if not least <= value <= most:
        raise Unsuitable(f"{value} does not fit {kind}")
    return value


def nearest(kind: str, value: float) -> int:
    """A real as an integer, halves to even."""
    if not math.isfinite(value):
        raise Unsuitable(f"{value} has no {kind}")
    return fitted(kind, round(value))


def shifted(bits: int, value: int, places: int) -> int:
    """A bit string shifted to the left, or with negative places to the right."""
    moved: int = value << places if places >= 0 else value >> -places
    return moved & ((1 << bits) - 1)


def converted(source: str, target: str, code: str) -> str:
    """The Python code of a conversion."""
    whole = {*INTEGERS, *BITS}
    if source == "LREAL" and target in INTEGERS:
        return f"nearest({target!r}, {code})"
    if source in INTEGERS and target == "LREAL":
        return f"float({code})"
    if source in BITS and target in BITS:
        return f"({code} & {2 ** BITS[target] - 1})"
    if source in whole and target in BITS:
        return f"({code} & {2 ** BITS[target] - 1})"
    if source in BITS and target in INTEGERS:
        least, most = INTEGERS[target]
        bits = (most - least).bit_length()
        if bits == BITS[source]:
            return f"(({code} + {-least}) % {2**bits} - {-least})" if least else code
    raise Unsuitable(f"a conversion from {source} to {target}")


def initial(kind: str) -> object:
    """What a variable of an elementary type is at the start."""
    return {"BOOL": False, "LREAL": 0.0}.get(kind, 0)
