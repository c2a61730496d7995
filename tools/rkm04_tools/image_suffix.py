"""What follows the image in a `.bin`: its name, and by what a file that is not whole is known.

It is the DFU suffix of USB DFU 1.1, appendix B, with the name before its fields, as longer suffixes
are allowed: dfu-util checks it and does not write it. For other tools it is 48 bytes of flash after
the image that nothing reads.
"""

from __future__ import annotations

import struct
import sys
import zlib
from pathlib import Path

NAME_BYTES = 32
SUFFIX_BYTES = NAME_BYTES + 16
ANY_RELEASE = 0xFFFF
LOADER_PRODUCT = 0xDF11
LOADER_VENDOR = 0x0483
DFU_RELEASE = 0x0100


def suffixed(image: bytes, name: str) -> bytes:
    """The image and the suffix: the name, zeros after it, and the fields, lowest bytes first."""
    if not 0 < len(name.encode("ascii")) <= NAME_BYTES:
        raise ValueError(f"{name}: the name of an image has 1 to {NAME_BYTES} characters")
    fields = (ANY_RELEASE, LOADER_PRODUCT, LOADER_VENDOR, DFU_RELEASE, b"UFD", SUFFIX_BYTES)
    summed = image + struct.pack(f"<{NAME_BYTES}s4H3sB", name.encode("ascii"), *fields)
    return summed + struct.pack("<I", zlib.crc32(summed) ^ 0xFFFF_FFFF)


def main(arguments: list[str]) -> int:
    """Puts the suffix after the image that is a file."""
    name, file = arguments
    path = Path(file)
    path.write_bytes(suffixed(path.read_bytes(), name))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
