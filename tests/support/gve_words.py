"""The language of the GVE134 unit: names, parameters and the codes of what is wrong with them.

Written from the contract alone. A text is what stands between the address and the CR, without a
checksum; a command is a name and its parameters as numbers, or a code 3, 4 or 5.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from exact import Fraction

UNKNOWN, SYNTAX, BOUNDS = 3, 4, 5
STEPS_MAX = 2**31 - 1
SPEED_MIN, SPEED_MAX = 10, 200_000
AXES = "XYZA"
TEXT_MAX = 80
"""Characters between the `!` and the CR."""

EXPONENT_MAX = 400
"""Beyond it a single is 0 or too large, whatever its digits are in a line."""


@dataclass(frozen=True)
class Command:
    """A command that is right in itself."""

    name: str
    args: tuple[int, ...] = ()


class Refused(Exception):
    """What is wrong with a text."""

    def __init__(self, code: int) -> None:
        """Keep the code."""
        super().__init__(code)
        self.code = code


Field = Callable[[str], int]
"""Reads a parameter; raises `Refused`."""


def decimal(least: int, most: int) -> Field:
    """Return the reader of a decimal number."""

    def read(text: str) -> int:
        if not re.fullmatch(r"-?[0-9]+", text):
            raise Refused(SYNTAX)
        number = int(text)
        if not least <= number <= most:
            raise Refused(BOUNDS)
        return number

    return read


def hexadecimal(most: int, digits: int = 2) -> Field:
    """Return the reader of a hexadecimal number."""

    def read(text: str) -> int:
        if not re.fullmatch(r"[0-9A-Fa-f]+", text):
            raise Refused(SYNTAX)
        if len(text) > digits or int(text, 16) > most:
            raise Refused(BOUNDS)
        return int(text, 16)

    return read


def single(text: str) -> int:
    """Read a float; return the bits of the single."""
    found = re.fullmatch(r"(-?)([0-9]+)(?:\.([0-9]+))?(?:[Ee](-?[0-9]+))?", text)
    if not found:
        raise Refused(SYNTAX)
    sign, whole, part, exponent = found.groups()
    shift = int(exponent or 0) - len(part or "")
    digits = int(whole + (part or ""))
    shift = max(-EXPONENT_MAX, min(EXPONENT_MAX, shift))
    bits = nearest_single(digits * Fraction(10) ** shift)
    return bits | (0x80000000 if sign else 0)


def nearest_single(number: Fraction) -> int:
    """Return the bits of the single that is nearest to a number from 0 on, ties to even."""
    if number == 0:
        return 0
    power = max(-149, number.numerator.bit_length() - number.denominator.bit_length() - 24)
    scaled = number / Fraction(2) ** power
    while round(scaled) >= 2**24 and scaled >= Fraction(2**24):
        power, scaled = power + 1, scaled / 2
    while scaled < 2**23 and power > -149:
        power, scaled = power - 1, scaled * 2
    mantissa = round(scaled)
    if mantissa == 2**24:
        mantissa, power = 2**23, power + 1
    bits = mantissa if mantissa < 2**23 else (power + 150 << 23) + mantissa - 2**23
    if bits >= 0x7F800000:
        raise Refused(BOUNDS)
    return bits


def single_text(bits: int) -> str:
    """Write a single as C's `%.9G`."""
    number = struct.unpack("<f", struct.pack("<I", bits))[0]
    if number != number:
        return "NAN"
    return f"{number:.9G}"


STEPS = decimal(-STEPS_MAX, STEPS_MAX)
SPEED = decimal(SPEED_MIN, SPEED_MAX)
BYTE, QUAD = hexadecimal(0xFF), hexadecimal(0xFC)

FIELDS: dict[str, tuple[Field, ...]] = {
    "?": (),
    "Q": (),
    "T": (decimal(1, 24),),
    "$": (decimal(1, STEPS_MAX),),
    "A": (decimal(1, 8000),),
    "V": (SPEED,),
    "B": (SPEED,),
    "VK": (),
    "VN": (),
    "VL": (SPEED,) * 4,
    "VJ": (decimal(0, SPEED_MAX),) * 4,
    "XA": (),
    "XU": (),
    "XD": (),
    "XM": (decimal(1, 1000),),
    "P": (),
    "PF": (),
    "P4": (),
    "PL": (),
    "H": (),
    "G": (),
    "D": (),
    "K": (),
    "R": (),
    "SR": (decimal(0, 7),),
    "SW": (decimal(0, 6), BYTE),
    "F": (),
    "I1": (),
    "I2": (),
    "O": (decimal(0, 0), BYTE),
    "ER": (BYTE,),
    "EUR": (QUAD,),
    "EFR": (QUAD,),
    "EW": (BYTE, BYTE),
    "EUW": (QUAD, hexadecimal(2**32 - 1, 8)),
    "EFW": (QUAD, single),
    "@": (),
    ">": (),
    "%+": (),
    "%-": (),
    "*S": (),
    "*E": (decimal(0, 128),),
    "J": (),
}
WAY = decimal(-STEPS_MAX, STEPS_MAX)
RUN = (WAY, SPEED, decimal(1, STEPS_MAX), SPEED)
SPINDLE: dict[str, tuple[Field, ...]] = {
    "V": (decimal(0, 1000),),
    **{name: FIELDS[name] for name in ("?", "Q", ">", "@", "J", "%+", "%-")},
    **{name: FIELDS[name] for name in FIELDS if name[0] == "E"},
}


def read_all(readers: Sequence[Field], parts: list[str]) -> tuple[int, ...]:
    """Read parameters; wrong syntax anywhere comes before what is out of bounds."""
    if len(parts) != len(readers):
        raise Refused(SYNTAX)
    numbers, codes = [], []
    for reader, part in zip(readers, parts, strict=True):
        try:
            numbers.append(reader(part))
        except Refused as refused:
            codes.append(refused.code)
    if codes:
        raise Refused(min(codes))
    return tuple(numbers)


def split(text: str) -> list[str]:
    """Return parameters; none for nothing."""
    return text.split(",") if text else []


def axis_and(text: str) -> tuple[int, list[str]]:
    """Return an axis and what follows it; a comma may stand between."""
    if not text or text[0].upper() not in AXES:
        raise Refused(SYNTAX)
    rest = text[1:].removeprefix(",") if text[1:] != "," else ","
    return AXES.index(text[0].upper()), split(rest)


def name_of(address: int, text: str) -> str:
    """Return the name of the command of a text; empty: it is none."""
    names = (name for name in (*FIELDS, *"LCNW") if text.upper().startswith(name))
    name = max(names, key=len, default="")
    return name if address == 0 or name in SPINDLE else ""


def read_command(address: int, text: str) -> Command:
    """Read a text; raises `Refused`."""
    name = name_of(address, text)
    if not name:
        raise Refused(UNKNOWN)
    rest = text[len(name) :]
    if address != 0:
        return Command(name, read_all(SPINDLE[name], split(rest)))
    if name in "LC":
        parts = split(rest)
        if not 1 <= len(parts) <= 4:
            raise Refused(SYNTAX)
        args = read_all((STEPS,) * len(parts), parts)
        return Command(name, args + (0,) * (4 - len(parts)))
    if name == "N":
        if not rest:
            return Command("N")
        axis, parts = axis_and(rest)
        return Command("N", (axis, *read_all((STEPS,), parts)))
    if name == "W":
        axis, parts = axis_and(rest)
        args = read_all(RUN, parts)
        if args[0] == 0:
            raise Refused(BOUNDS)
        return Command("W", (axis, *args))
    return Command(name, read_all(FIELDS[name], split(rest)))


def checksum(text: str) -> str:
    """Return the sum of a text that ends with the comma before it."""
    return f"{sum(text.encode('latin-1')) % 256:02X}"


def with_sum(text: str) -> str:
    """Add the comma and the sum to a request or an answer."""
    return f"{text},{checksum(text + ',')}"
