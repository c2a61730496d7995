"""Proves that what must run from RAM does: while the flash is written or erased it answers no read.

    python -m checks.ram_code UNIT IMAGE.elf

The linker leaves its relocations in the image. None of those in the section .ram may refer to the
flash, neither to code nor to constants, but for what only plans of paths call; and what begins
there, interrupts, faults and flash.c, must lie in it. So nothing that these may ever call or read
lies in the flash.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator

from rkm04_tools.objects import RAM_CODE, binutil

SECTION = ".rel.ram"
FLASH = range(0x0800_0000, 0x0810_0000)
REFERENCES_MIN = 100  # fewer mean that the image was linked without them

# What the vector table has, what interrupts call through a pointer, and what waits for the flash.
ENTRIES = [
    *(f"stm32_{name}_interrupt" for name in ("step", "tick", "edge", "line", "plan")),
    *("stm32_fault_entry", "stm32_fault_stop"),
    *("hal_flash_read", "hal_flash_write_word", "hal_flash_erase"),
]
UNIT_ENTRIES = {
    "rkm04": ["rkm04_lay_isr", "rkm04_tick_isr", "rkm04_plan_isr"],
    # Its flash is written only while the axes stand, and then nothing is planned.
    "gve134": ["gve134_lay_isr", "gve134_tick_isr"],
    "positioning": ["positioning_lay_isr", "positioning_tick_isr"],
}

# Only plans of paths call these. They lie in RAM for speed alone: the flash is written at a stand.
PLANS = {"find_before", "find_between", "find_early", "keep_before"}

RELOCATION = re.compile(r"([0-9a-f]{8})\s+[0-9a-f]+\s+(R_ARM_\w+)\s+([0-9a-f]{8})\s+(\S+)")
SYMBOL = re.compile(r"([0-9a-f]+) [tT] (\S+)")


def references(lines: list[str]) -> Iterator[tuple[str, int]]:
    """Every symbol that the section refers to, with its address."""
    section = ""
    for line in lines:
        if match := re.match(r"Relocation section '(\S+)'", line):
            section = match[1]
        elif section == SECTION and (match := RELOCATION.match(line)):
            yield match[4], int(match[3], 16)


def find_errors(unit: str, relocations: list[str], symbols: list[str]) -> Iterator[str]:
    found = list(references(relocations))
    if len(found) < REFERENCES_MIN:
        yield f"only {len(found)} relocations in {SECTION}; link with -Wl,-q"
    in_flash = {name for name, address in found if address in FLASH}
    for name in sorted(in_flash - PLANS):
        yield f"code in RAM refers to {name}, which lies in the flash"
    addresses = {match[2]: int(match[1], 16) for line in symbols if (match := SYMBOL.match(line))}
    for name in [*ENTRIES, *UNIT_ENTRIES[unit]]:
        if name not in addresses:
            yield f"{name} is not in the image"
        elif addresses[name] not in RAM_CODE:
            yield f"{name} lies in the flash"


def main(arguments: list[str]) -> int:
    unit, image = arguments
    status = 0
    for error in find_errors(unit, binutil("readelf", "-rW", image), binutil("nm", image)):
        print(f"ram-code: {error}", file=sys.stderr)
        status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
