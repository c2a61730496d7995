"""The registers of the positioning unit: registers.def, the one list of them, as Python sees it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from rkm04_tools.tree import ROOT

TABLE = ROOT / "firmware/positioning/registers/registers.def"
AXES = 4
AXIS_STEP = 100
"""Axis n has the registers 100 n + ..."""
WORD_BITS, WORD_MAX = 16, 0xFFFF
RATES = (96, 192, 384, 576, 1152)
"""What RATE takes, in 100 Bd."""

ROW = re.compile(
    r'^([UA])\((\w+), (\d+), (\w+), (\w+), (\w+), (-?\d+), (-?\d+), (\d+), "(.*?)", "(.*?)"\)$',
    re.MULTILINE,
)
IMAGE = re.compile(r"^W\((\w+), (\d+), (\d+), ([\d, ]+)\)$", re.MULTILINE)
INSTRUCTION = re.compile(r"^I\((\w+), (\d+)\)$", re.MULTILINE)
BIT = re.compile(r'^B\((\w+), (\w+), (\d+), "(.*)"\)$', re.MULTILINE)
UNITS = {"um": "µm", "mm/s2": "mm/s²", "mm/min/65536": "1/65 536 mm/min"}
HEADING = "| no. | name | type | range | unit | access | delivered | |\n" + "| --- " * 8 + "|\n"


@dataclass(frozen=True)
class Register:
    """A row of the table; `scope` is U for the unit and A for each axis."""

    scope: str
    name: str
    number: int
    type: str
    use: str
    form: str
    least: int
    most: int
    start: int
    unit: str
    text: str

    @property
    def words(self) -> int:
        """How many registers of the line it is."""
        return 2 if self.type.endswith("32") else 1

    @property
    def is_signed(self) -> bool:
        """Whether its values may be negative."""
        return self.type.startswith("I")

    @property
    def is_setting(self) -> bool:
        """Whether STORE keeps it."""
        return self.use == "SETTING"

    def of_words(self, words: Sequence[int]) -> int:
        """The value of its registers, as they come from the line."""
        value = sum(word << WORD_BITS * i for i, word in enumerate(reversed(words)))
        bits = WORD_BITS * self.words
        return value - (1 << bits) if self.is_signed and value >> bits - 1 else value

    def to_words(self, value: int) -> list[int]:
        """Its registers on the line, of a value that it can have."""
        return [value >> WORD_BITS * i & WORD_MAX for i in reversed(range(self.words))]

    @property
    def all_values(self) -> range:
        """The values that its type can have."""
        bits = WORD_BITS * self.words
        return range(-(1 << bits - 1), 1 << bits - 1) if self.is_signed else range(1 << bits)

    def takes(self, value: int) -> bool:
        """Whether the unit takes this value, as far as this register alone tells."""
        if self.form == "RATE":
            return value in RATES
        if self.form == "ZERO_OR" and value == 0:
            return True
        return value in (
            self.all_values if self.form == "ANY" else range(self.least, self.most + 1)
        )

    @property
    def access(self) -> str:
        """What the line may do with it."""
        return {"READ": "r", "SETTING": "w, stored"}.get(self.use, "w")


@dataclass(frozen=True)
class Image:
    """A row of the table of images; `numbers` are those of one axis."""

    name: str
    first: int
    numbers: list[int]


def read_registers(text: str) -> list[Register]:
    """All rows of registers."""
    rows = [
        Register(r[0], r[1], int(r[2]), r[3], r[4], r[5], int(r[6]), int(r[7]), int(r[8]), *r[9:])
        for r in ROW.findall(text)
    ]
    if len(rows) != len(re.findall(r"^[UA]\(", text, re.MULTILINE)):
        raise SystemExit(f"{TABLE.name}: a row has another form than the others")
    return rows


def read_images(text: str) -> list[Image]:
    """All rows of images."""
    return [
        Image(name, int(first), [int(n) for n in numbers.split(",")][: int(count)])
        for name, first, count, numbers in IMAGE.findall(text)
    ]


def number(value: int) -> str:
    """A number as the documents write it."""
    return f"{value:,}".replace(",", " ").replace("-", "−")  # noqa: RUF001


def span(row: Register) -> str:
    """The values that are taken; empty: all of the type, or there is nothing to write."""
    least_to_most = f"{number(row.least)} to {number(row.most)}"
    return {
        "ANY": "",
        "RATE": "five values",
        "ZERO_OR": f"0, {least_to_most}",
        "CODE": f"code {least_to_most}",
        "RECORD": "bits 0 to 3",
    }.get(row.form, least_to_most)


def values_text(row: Register) -> str:
    """The values that are taken, as a message tells them."""
    if row.form == "RATE":
        return f"{', '.join(map(str, RATES[:-1]))} or {RATES[-1]}"
    ends = row.all_values if row.form == "ANY" else range(row.least, row.most + 1)
    return f"{'0, or ' if row.form == 'ZERO_OR' else ''}{ends[0]} to {ends[-1]}"


def line(row: Register) -> str:
    """The row of a register in the document."""
    sign = "+" if row.scope == "A" else ""
    numbers = f"{row.number}, {row.number + 1}" if row.words == 2 else str(row.number)
    delivered = number(row.start) if row.use != "READ" or row.start else ""
    cells = [
        sign + numbers, row.name, row.type.lower(), span(row), UNITS.get(row.unit, row.unit),
        row.access, delivered, row.text.replace(" * ", " · "),
    ]  # fmt: skip
    return f"| {' | '.join(cells)} |".replace("|  |", "| |").replace("|  |", "| |") + "\n"


def image_line(image: Image, rows: list[Register]) -> str:
    """The row of an image in the document."""
    names = [r.name for n in image.numbers for r in rows if r.scope == "A" and r.number == n]
    last = image.first + len(image.numbers) * AXES - 1
    access = next(r.access for r in rows if r.scope == "A" and r.number == image.numbers[0])
    return f"| {image.first} to {last} | {access} | {', '.join(names)} |\n"


def tables(text: str) -> dict[str, str]:
    """The tables of the document, by their names, from the text of registers.def."""
    rows = read_registers(text)
    images = "".join(image_line(image, rows) for image in read_images(text))
    return {
        "unit": HEADING + "".join(line(row) for row in rows if row.scope == "U"),
        "axis": HEADING + "".join(line(row) for row in rows if row.scope == "A"),
        "images": "| no. | access | of axis 1, 2, 3, 4 |\n| --- | --- | --- |\n" + images,
    }


@cache
def registers() -> dict[str, Register]:
    """All registers by their names."""
    return {row.name: row for row in read_registers(TABLE.read_text(encoding="utf-8"))}


@cache
def instructions() -> dict[str, int]:
    """The codes of INSTRUCTION by their names."""
    return {name: int(code) for name, code in INSTRUCTION.findall(TABLE.read_text("utf-8"))}


@cache
def bits() -> dict[str, int]:
    """The bits of STATUS and FLAGS by their names, as masks."""
    found = BIT.findall(TABLE.read_text(encoding="utf-8"))
    return {name: 1 << int(bit) for name, _, bit, _ in found}


@cache
def images() -> dict[str, Image]:
    """All images by their names."""
    return {image.name: image for image in read_images(TABLE.read_text(encoding="utf-8"))}


def read_image(name: str) -> tuple[int, int]:
    """The first number of an image, and how many registers of each axis it has."""
    image = images()[name]
    return image.first, len(image.numbers)


def register_at(number: int) -> Register | None:
    """The register that has this number on the line, in an image too; None: there is none."""
    scope, place = ("A", number % AXIS_STEP) if number >= AXIS_STEP else ("U", number)
    if number >= AXIS_STEP * (AXES + 1):
        places = {
            image.first + i: image.numbers[i % len(image.numbers)]
            for image in images().values()
            for i in range(len(image.numbers) * AXES)
        }
        place = places.get(number, -1)
    rows = (row for row in registers().values() if row.scope == scope)
    return next((row for row in rows if row.number <= place < row.number + row.words), None)
