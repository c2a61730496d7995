"""The tables of firmware/positioning/docs/registers.md, made from registers.def.

    PYTHONPATH=tools build/venv/bin/python -m checks.registers            compare
    PYTHONPATH=tools build/venv/bin/python -m checks.registers --update   write them anew

Each table stands between `<!-- table NAME -->` and `<!-- end -->`; all else of the document is
written by hand.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLE = ROOT / "firmware/positioning/registers/registers.def"
DOCUMENT = ROOT / "firmware/positioning/docs/registers.md"
AXES = 4

ROW = re.compile(
    r'^([UA])\((\w+), (\d+), (\w+), (\w+), (\w+), (-?\d+), (-?\d+), (\d+), "(.*?)", "(.*?)"\)$',
    re.MULTILINE,
)
IMAGE = re.compile(r"^W\((\w+), (\d+), (\d+), ([\d, ]+)\)$", re.MULTILINE)
PART = re.compile(r"(<!-- table (\w+) -->\n).*?(<!-- end -->\n)", re.DOTALL)
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


def renewed(document: str, text: str) -> str:
    """The document with its tables as registers.def has them."""
    made = tables(text)
    if sorted(match[1] for match in PART.findall(document)) != sorted(made):
        raise SystemExit(f"{DOCUMENT.name}: needs one place each for {', '.join(sorted(made))}")
    return PART.sub(lambda match: match[1] + made[match[2]] + match[3], document)


def main(arguments: list[str]) -> int:
    document = DOCUMENT.read_text(encoding="utf-8")
    made = renewed(document, TABLE.read_text(encoding="utf-8"))
    if arguments == ["--update"]:
        DOCUMENT.write_text(made, encoding="utf-8")
    elif made != document:
        print(f"{DOCUMENT.name} is not what registers.def says; run checks.registers --update")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
