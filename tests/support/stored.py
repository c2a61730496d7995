"""The memory of stored programs, made from the description in firmware/store/store_record.h alone.

The reference board keeps its two areas in the last two sectors of 128 kB of the flash.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable

FLASH_BYTES = 1 << 20
AREA_BYTES = 1 << 17
AREA_FIRST = FLASH_BYTES - 2 * AREA_BYTES
MAGIC = 0x0134_4B52
SET, UNSET = bytes(4), b"\xff" * 4


def record(motor: int, generation: int, text: bytes, whole: bool = True) -> bytes:
    """A record of a motor (1 to 4), with its whole-mark and without its void-mark."""
    fields = struct.pack("<IIHBB", MAGIC, generation, len(text), motor - 1, 0)
    checked = fields + struct.pack("<I", zlib.crc32(fields + text))
    head = checked + struct.pack("<I", zlib.crc32(checked))
    filled = text + b"\xff" * (-len(text) % 4)
    return 2 * head + filled + (SET if whole else UNSET) + UNSET


def area(generation: int, records: Iterable[bytes]) -> bytes:
    """An area that counts, with its own record first."""
    content = record(1, generation, b"") + b"".join(records)
    return content.ljust(AREA_BYTES, b"\xff")


def flash(first: bytes = b"", second: bytes = b"") -> bytes:
    """The whole flash; the program of the board is put on top of it."""
    areas = first.ljust(AREA_BYTES, b"\xff") + second.ljust(AREA_BYTES, b"\xff")
    return b"\xff" * AREA_FIRST + areas
