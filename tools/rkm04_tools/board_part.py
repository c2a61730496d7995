"""What a board's part says to the program that writes its flash: how much flash it has."""

from __future__ import annotations

import re

from rkm04_tools.failure import NOT_SO, Failure

FLASH_KB_MIN = 1024
"""Stored programs lie in sectors 10 and 11, the last two of 1 MB."""
SIZE_AT = "0x1fff7a22"
"""RM0090 39.2: kilobytes of flash, a half-word."""

OPENOCD_SIZE = re.compile(rf"^{SIZE_AT}:\s+([0-9a-f]{{4}})\b", re.MULTILINE)
DFU_SECTORS = re.compile(r'alt=0, name="@Internal Flash\s*/0x08000000/([^"]*)"')
DFU_GROUP = re.compile(r"(\d+)\*(\d+)(K?)")


def openocd(probe: str, *actions: str) -> list[str]:
    """A call of OpenOCD; the actions run one after the other."""
    scripts = ["-f", f"interface/{probe}.cfg", "-f", "target/stm32f4x.cfg"]
    return ["openocd", *scripts, "-c", "; ".join(["init", *actions, "shutdown"])]


def look_command(tool: str, probe: str, usb: str) -> list[str]:
    """What asks the part for its size without disturbing it; empty where a tool cannot tell it."""
    if tool == "openocd":
        return openocd(probe, f"mdh {SIZE_AT}")
    return ["dfu-util", "-l", "-d", usb] if tool == "dfu-util" else []


def flash_kb(tool: str, said: str) -> int | None:
    """Read the size from what a tool has said; None if it does not tell."""
    if tool == "openocd":
        match = OPENOCD_SIZE.search(said)
        return int(match[1], 16) if match else None
    match = DFU_SECTORS.search(said)
    if match is None:
        return None
    groups = DFU_GROUP.findall(match[1])
    return sum(int(n) * int(size) * (1024 if kilo else 1) for n, size, kilo in groups) // 1024


def require_room(kilobytes: int | None) -> None:
    """End before anything is written into a part that has no room for stored programs."""
    if kilobytes is not None and kilobytes < FLASH_KB_MIN:
        raise Failure(
            f"this part has {kilobytes} kB of flash, and stored programs need {FLASH_KB_MIN}: "
            "nothing was written; use a part of 1 MB, or give --small to run without them",
            NOT_SO,
        )
