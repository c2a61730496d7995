"""The numbers of registers in tools/plc: positioning.st, openplc.st, README.md; from registers.def.

    PYTHONPATH=tools build/venv/bin/python -m checks.plc            compare
    PYTHONPATH=tools build/venv/bin/python -m checks.plc --update   write them anew

Between `(* made: GROUP NAME, ... *)` and `(* end *)` stand those constants of a group; in the
document, the table stands between `<!-- table requests -->` and `<!-- end -->`.
"""

from __future__ import annotations

import re
import sys

from checks import registers

OPENPLC = registers.ROOT / "tools/plc/openplc.st"
OPENPLC_FIRST = 100  # %IW and %QW of the first register of slave devices
LIBRARY = registers.ROOT / "tools/plc/positioning.st"
DOCUMENT = registers.ROOT / "tools/plc/README.md"
IN_FIRST = 10  # the number, in an axis, of In[0]

INSTRUCTION = re.compile(r"^I\((\w+), (\d+)\)$", re.MULTILINE)
BIT = re.compile(r'^B\((\w+), (\w+), (\d+), "(.*)"\)$', re.MULTILINE)
PART = re.compile(
    r"^( *)\(\* made: (\w+) ([\w, ]+) \*\)\n.*?^ *\(\* end \*\)\n", re.DOTALL | re.MULTILINE
)
TABLE = re.compile(r"(<!-- table requests -->\n).*?(<!-- end -->\n)", re.DOTALL)


def read_instructions(text: str) -> dict[str, int]:
    """The codes of the instructions, by their names."""
    return {name: int(code) for name, code in INSTRUCTION.findall(text)}


def read_bits(text: str) -> dict[str, tuple[str, int]]:
    """The register and the number of each bit, by its name."""
    return {name: (register, int(bit)) for name, register, bit, _ in BIT.findall(text)}


def constants(text: str) -> dict[str, dict[str, str]]:
    """All constants by their groups and names: what stands in ST after the name in the library."""
    axis = [row for row in registers.read_registers(text) if row.scope == "A"]
    return {
        "out": {r.name: f"OUT_{r.name} : INT := {r.number}" for r in axis if r.number < IN_FIRST},
        "in": {
            r.name: f"IN_{r.name} : INT := {r.number - IN_FIRST}"
            for r in axis
            if r.number >= IN_FIRST and r.use == "READ"
        },
        "codes": {
            name: f"DO_{name} : UINT := {code}" for name, code in read_instructions(text).items()
        },
        "bits": {
            name: f"BIT_{name} : WORD := 16#{1 << bit:04X}"
            for name, (_, bit) in read_bits(text).items()
        },
    }


def openplc_lines(text: str) -> dict[str, list[str]]:
    """What OpenPLC needs to see the full image: its words have no arrays, but a variable each."""
    images = {image.name: image for image in registers.read_images(text)}
    lines: dict[str, list[str]] = {"declarations": [], "read": [], "write": []}
    reads = ["Uptime_High", "Uptime_Low"]
    for area, name, array in [("%IW", "FULL_IN", "In"), ("%QW", "FULL_OUT", "Out")]:
        count = len(images[name].numbers)
        cells = [(a, w) for a in range(1, registers.AXES + 1) for w in range(count)]
        names = [f"{array}_{axis}_{word}" for axis, word in cells]
        for place, variable in enumerate(reads + names, OPENPLC_FIRST):
            lines["declarations"].append(f"{variable} AT {area}{place} : WORD")
        for (axis, word), variable in zip(cells, names, strict=True):
            element = f"AXIS_{axis}.{array}[{word}]"
            if array == "In":
                lines["read"].append(f"{element} := {variable}")
            else:
                lines["write"].append(f"{variable} := {element}")
        reads = []
    return lines


def renewed_library(library: str, text: str) -> str:
    """The library with its constants as registers.def has them."""
    groups = constants(text)
    image = openplc_lines(text)

    def part(match: re.Match[str]) -> str:
        indent, group, names = match.groups()
        try:
            if group == "openplc":
                made = image[names]
            else:
                made = [groups[group][name] for name in names.split(", ")]
        except KeyError as missing:
            raise SystemExit(f"{LIBRARY.name}: registers.def has no {group} {missing}") from None
        heading = f"{indent}(* made: {group} {names} *)\n"
        lines = "".join(f"{indent}{line};\n" for line in made)
        return f"{heading}{lines}{indent}(* end *)\n"

    return PART.sub(part, library)


def requests(text: str) -> str:
    """The table of the requests that a master sends in each cycle."""
    images = {image.name: image for image in registers.read_images(text)}
    rows = ["| | what is written | from | what is read, FC 3 | to |", "| --- " * 5 + "|"]
    for axis in range(1, registers.AXES + 1):
        first = 100 * axis
        rows.append(
            f"| axis {axis} alone | {first}, 8 registers | Out of axis {axis} "
            f"| {first + IN_FIRST}, 18 registers | In of axis {axis} |"
        )
    for title, name in [("full image", "FULL"), ("fast image", "FAST")]:
        out, back = images[f"{name}_OUT"], images[f"{name}_IN"]
        cells = [
            f"{image.first}, {len(image.numbers) * registers.AXES} registers"
            for image in (out, back)
        ]
        names = [f"{side}[{span(image, first)}] of axis 1, 2, 3, 4"
                 for side, image, first in [("Out", out, 0), ("In", back, IN_FIRST)]]  # fmt: skip
        rows.append(f"| {title} | {cells[0]} | {names[0]} | {cells[1]} | {names[1]} |")
    return "\n".join(rows) + "\n"


def span(image: registers.Image, first: int) -> str:
    """Which words of Out or In an image shows of each axis."""
    words = [number - first for number in image.numbers]
    runs = [[words[0], words[0]]]
    for word in words[1:]:
        if word == runs[-1][1] + 1:
            runs[-1][1] = word
        else:
            runs.append([word, word])
    return ", ".join(f"{a}..{b}" if a < b else f"{a}" for a, b in runs)


def renewed_document(document: str, text: str) -> str:
    """The document with its table as registers.def has it."""
    if len(TABLE.findall(document)) != 1:
        raise SystemExit(f"{DOCUMENT.name}: needs one place for the table of requests")
    return TABLE.sub(lambda match: match[1] + requests(text) + match[2], document)


def main(arguments: list[str]) -> int:
    text = registers.TABLE.read_text(encoding="utf-8")
    stale = []
    for path, renewed in [
        (LIBRARY, renewed_library), (OPENPLC, renewed_library), (DOCUMENT, renewed_document)
    ]:  # fmt: skip
        before = path.read_text(encoding="utf-8")
        after = renewed(before, text)
        if arguments == ["--update"]:
            path.write_text(after, encoding="utf-8")
        elif after != before:
            stale.append(path.name)
    if stale:
        print(f"{' and '.join(stale)} differ from registers.def; run checks.plc --update")
    return bool(stale)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
