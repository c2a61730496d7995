"""`registers`: the table of all registers for spreadsheets, documents, PLC programs and scripts."""

from __future__ import annotations

import csv
import io
import json
from argparse import Namespace
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from rkm04_tools.failure import DONE
from rkm04_tools.positioning.table import (
    AXES,
    AXIS_STEP,
    TABLE,
    Register,
    bits,
    instructions,
    read_images,
    registers,
    tables,
)

HEAD = (
    "number", "count", "axis", "name", "type", "access", "form", "least", "most", "delivered",
    "unit", "text",
)  # fmt: skip
PREFIX = "POS_"


@dataclass(frozen=True)
class Place:
    """A register of the line: one of the unit (axis 0), or of one axis."""

    register: Register
    axis: int

    @property
    def number(self) -> int:
        """Its number in the frame."""
        return self.register.number + AXIS_STEP * self.axis


def places() -> Iterator[Place]:
    """All registers, those of the unit first, but for the images."""
    rows = registers().values()
    yield from (Place(row, 0) for row in rows if row.scope == "U")
    for axis in range(1, AXES + 1):
        yield from (Place(row, axis) for row in rows if row.scope == "A")


def run(options: Namespace) -> int:
    """Print the table in the form that is asked for."""
    print(FORMS[options.form](), end="")
    return DONE


def _cells(place: Place) -> tuple[str | int, ...]:
    row = place.register
    bounded = row.form in ("RANGE", "FACTOR", "ZERO_OR", "CODE")
    least, most = (row.least, row.most) if bounded else ("", "")
    return (
        place.number, row.words, place.axis or "", row.name, row.type.lower(), row.access,
        row.form.lower() if row.access != "r" else "", least, most, row.start, row.unit, row.text,
    )  # fmt: skip


def as_csv() -> str:
    """A row for each register of the line."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(HEAD)
    rows.writerows(map(_cells, places()))
    return text.getvalue()


def as_json() -> str:
    """The same rows as objects, with codes, bits and images."""
    rows = [dict(zip(HEAD, _cells(place), strict=True)) for place in places()]
    images = {
        image.name: {"first": image.first, "of_each_axis": image.numbers}
        for image in read_images(TABLE.read_text(encoding="utf-8"))
    }
    told = {"registers": rows, "images": images, "instructions": instructions(), "bits": bits()}
    return f"{json.dumps(told, indent=2)}\n"


def as_md() -> str:
    """The tables of the document."""
    made = tables(TABLE.read_text(encoding="utf-8"))
    names = ("unit", "axis", "images")
    heads = {"unit": "The unit", "axis": "Axis n: 100 · n + ...", "images": "Images"}
    return "\n".join(f"## {heads[name]}\n\n{made[name]}" for name in names)


def as_st() -> str:
    """Constants in Structured Text: numbers of registers, codes and bits."""
    of_unit = [(row.name, "UINT", row.number) for row in registers().values() if row.scope == "U"]
    of_axis = [
        (f"AXIS_{row.name}", "UINT", row.number) for row in registers().values() if row.scope == "A"
    ]
    images = [(f"{i.name}", "UINT", i.first) for i in read_images(TABLE.read_text("utf-8"))]
    lines = [f"  {PREFIX}{name} : {kind} := {value};" for name, kind, value in of_unit + images]
    lines += [f"  {PREFIX}AXIS_STEP : UINT := {AXIS_STEP}; (* axis n: n times this more *)"]
    lines += [f"  {PREFIX}{name} : {kind} := {value};" for name, kind, value in of_axis]
    lines += [f"  CODE_{name} : WORD := {code};" for name, code in instructions().items()]
    lines += [f"  BIT_{name} : WORD := 16#{mask:04X};" for name, mask in bits().items()]
    head = "(* Registers of the positioning unit; numbers as in the frame, from 0. *)\n"
    body = "\n".join(lines)
    return f"{head}VAR_GLOBAL CONSTANT\n{body}\nEND_VAR\n"


FORMS: dict[str, Callable[[], str]] = {"csv": as_csv, "md": as_md, "st": as_st, "json": as_json}
