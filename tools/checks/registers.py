"""The tables of firmware/positioning/docs/registers.md, made from registers.def.

    PYTHONPATH=tools build/venv/bin/python -m checks.registers            compare
    PYTHONPATH=tools build/venv/bin/python -m checks.registers --update   write them anew

Each table stands between `<!-- table NAME -->` and `<!-- end -->`; all else of the document is
written by hand.
"""

from __future__ import annotations

import re
import sys

from rkm04_tools.positioning.table import (
    AXES,
    TABLE,
    Image,
    Register,
    read_images,
    read_registers,
    tables,
)
from rkm04_tools.tree import ROOT

__all__ = [
    "AXES", "DOCUMENT", "ROOT", "TABLE", "Image", "Register", "read_images", "read_registers",
    "renewed", "tables",
]  # fmt: skip

DOCUMENT = ROOT / "firmware/positioning/docs/registers.md"
PART = re.compile(r"(<!-- table (\w+) -->\n).*?(<!-- end -->\n)", re.DOTALL)


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
