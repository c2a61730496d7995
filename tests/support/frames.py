"""The frames that the tests of the unit and of the tools share.

    frames.py           writes frames.json and the C table made of it
    frames.py --check   says whether both are what this file makes

It is the second implementation of the envelope, written from firmware/rkm04/docs/line.md: the one
in C has to agree with it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
JSON_FILE = TESTS / "vectors/frames.json"
C_FILE = TESTS / "support/lib/frame_vectors.h"

FLAG, ESCAPE, ESCAPED = 0x7E, 0x7D, 0x20
NODE = 3
"""The unit that the frames come to."""

CHECKED = [b"123456789", b"", b"\0", b"\xff\xff", bytes(range(256))]
"""Bytes whose FCS is told."""

C_HEAD = """\
/*
 * The frames of tests/vectors/frames.json, written by tests/support/frames.py: change them there.
 */
/* clang-format off */
#ifndef FRAME_VECTORS_H
#define FRAME_VECTORS_H

#include <stdint.h>

#include "link_receiver.h"

enum {{ VECTOR_NODE = {node} }};

struct fcs_vector {{
    const char *bytes;
    uint32_t length;
    uint16_t fcs;
}};

struct frame_vector {{
    const char *name;
    const char *message;
    uint32_t message_length;
    const char *frame;
    uint32_t frame_length;
    uint8_t address;
    uint8_t number;
}};

struct dropped_vector {{
    const char *name;
    const char *bytes;
    uint32_t length;
    enum link_count count; /* what is counted */
}};
"""


def fcs16(data: bytes) -> int:
    register = 0xFFFF
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ (0x8408 if register & 1 else 0)
    return register ^ 0xFFFF


def escape(data: bytes) -> bytes:
    special = (FLAG, ESCAPE)
    return b"".join(
        bytes([ESCAPE, byte ^ ESCAPED]) if byte in special else bytes([byte]) for byte in data
    )


def unescape(body: bytes) -> bytes:
    content, escaping = bytearray(), False
    for byte in body:
        if byte == ESCAPE:
            escaping = True
        else:
            content.append(byte ^ ESCAPED if escaping else byte)
            escaping = False
    return bytes(content)


def with_fcs(data: bytes) -> bytes:
    return data + fcs16(data).to_bytes(2, "little")


def enclose(content: bytes) -> bytes:
    return bytes([FLAG]) + escape(content) + bytes([FLAG])


def frame(address: int, number: int, message: bytes) -> bytes:
    return enclose(with_fcs(bytes([address, number]) + message))


def search(wanted: Callable[[int, int], bool]) -> bytes:
    """A message to node 3, number 1, whose FCS has these bytes, low and high."""
    for value in count():
        message = b"4%d" % value
        low, high = fcs16(bytes([NODE, 1]) + message).to_bytes(2, "little")
        if wanted(low, high):
            return message
    raise AssertionError


def good_frames() -> list[tuple[str, int, int, bytes]]:
    return [
        ("version, the first of a session", NODE, 1, b"\x01"),
        ("set command without a number", NODE, 0, b"\x023C100"),
        ("set command", NODE, 2, b"\x022S100 V1000 A2000 F5000 R B2000 R H"),
        ("the last number", NODE, 255, b"\x040"),
        ("broadcast", 0, 9, b"\x020]"),
        ("another unit", 16, 3, b"\x041"),
        ("an answer of this unit", 0x80 | NODE, 1, b"\x01\x1001.01,22.11.2026"),
        ("an answer of another unit", 0x90, 3, b"\x041\x0a         0"),
        ("a refusal", 0xC0 | NODE, 2, b"\x01"),
        ("a node that there is not", 17, 3, b"\x01"),
        ("a reserved bit of the address", 0x20 | NODE, 3, b"\x01"),
        ("the number is a flag", NODE, FLAG, b"\x01"),
        ("the number is an escape", NODE, ESCAPE, b"\x01"),
        ("the message is a flag", NODE, 4, bytes([FLAG])),
        ("the message is an escape", NODE, 4, bytes([ESCAPE])),
        ("flags and escapes", NODE, 4, bytes([ESCAPE, FLAG, ESCAPE, ESCAPE, FLAG, FLAG])),
        ("bytes that look escaped", NODE, 4, bytes([0x5E, 0x5D, ESCAPE, 0x5E, 0x5D])),
        ("zeros", NODE, 4, bytes(20)),
        ("ones", NODE, 4, b"\xff" * 20),
        ("every value of a byte", NODE, 5, bytes(range(255, -1, -1))),
        ("FCS low is a flag", NODE, 1, search(lambda low, high: low == FLAG)),
        ("FCS high is a flag", NODE, 1, search(lambda low, high: high == FLAG)),
        ("FCS low is an escape", NODE, 1, search(lambda low, high: low == ESCAPE)),
        ("FCS high is an escape", NODE, 1, search(lambda low, high: high == ESCAPE)),
        ("both of FCS are special", NODE, 1,
         search(lambda low, high: low == FLAG and high == ESCAPE)),
    ]  # fmt: skip


def dropped_frames() -> list[tuple[str, bytes, str]]:
    whole = frame(NODE, 1, b"\x01")
    content = with_fcs(bytes([NODE, 1, 1]))
    wrong = bytes([*content[:-1], content[-1] ^ 0x10])
    swapped = content[:-2] + content[:-3:-1]
    flag = bytes([FLAG])
    escaped = bytes([ESCAPE, NODE ^ ESCAPED])
    return [
        ("one bit is wrong", enclose(wrong), "FCS"),
        ("FCS high byte first", enclose(swapped), "FCS"),
        ("FCS not inverted", enclose(content[:-2] + bytes(~b & 0xFF for b in content[-2:])), "FCS"),
        ("a byte is missing", enclose(content[:2] + content[3:] + b"\x01"), "FCS"),
        ("the closing flag comes early", enclose(content[:-1] + b"\0"), "FCS"),
        ("aborted", flag + content + bytes([ESCAPE, FLAG]), "ABORT"),
        ("aborted at once", flag + bytes([ESCAPE, FLAG]), "ABORT"),
        ("an escape escaped", flag + content[:2] + bytes([ESCAPE, ESCAPE]) + flag, "ESCAPE"),
        ("another byte escaped", flag + escaped + content[1:] + flag, "ESCAPE"),
        ("no message", enclose(with_fcs(bytes([NODE, 1]))), "SHORT"),
        ("no number", enclose(with_fcs(bytes([NODE]))), "SHORT"),
        ("FCS alone", enclose(with_fcs(b"")), "SHORT"),
        ("one byte", enclose(b"\x01"), "SHORT"),
        ("no opening flag", whole[1:], "STRAY"),
        ("no opening flag, 7F instead", b"\x7f" + whole[1:], "STRAY"),
        ("a byte before the address", enclose(b"\0" + content), "FCS"),
    ]  # fmt: skip


def vectors() -> dict[str, object]:
    return {
        "about": "Frames of the line (firmware/rkm04/docs/line.md), bytes in hex; written by "
        "frames.py. 'frames' are whole; those for 'node' and for all nodes are requests to it, the "
        "others it ignores. From 'dropped' it takes nothing and counts what is named.",
        "node": NODE,
        "fcs": [{"bytes": data.hex(), "fcs": f"{fcs16(data):04x}"} for data in CHECKED],
        "frames": [
            {
                "name": name,
                "address": address,
                "number": number,
                "message": message.hex(),
                "frame": frame(address, number, message).hex(),
            }
            for name, address, number, message in good_frames()
        ],
        "dropped": [
            {"name": name, "bytes": data.hex(), "count": what}
            for name, data, what in dropped_frames()
        ],
    }


def c_bytes(data: bytes) -> str:
    rows = [data[start : start + 20] for start in range(0, len(data), 20)] or [b""]
    return "\n     ".join('"' + "".join(f"\\x{byte:02x}" for byte in row) + '"' for row in rows)


def c_table(kind: str, name: str, rows: list[str]) -> str:
    body = "".join(f"    {{{row}}},\n" for row in rows)
    return f"\nstatic const struct {kind} {name}[] = {{\n{body}}};\n"


def c_file() -> str:
    fcs = [f"{c_bytes(data)}, {len(data)}, 0x{fcs16(data):04x}" for data in CHECKED]
    frames = []
    for name, address, number, message in good_frames():
        whole = frame(address, number, message)
        frames.append(
            f'"{name}", {c_bytes(message)}, {len(message)},\n     {c_bytes(whole)}, {len(whole)},'
            f" {address}, {number}"
        )
    dropped = [
        f'"{name}", {c_bytes(data)}, {len(data)}, LINK_COUNT_{what}'
        for name, data, what in dropped_frames()
    ]
    return (
        C_HEAD.format(node=NODE)
        + c_table("fcs_vector", "fcs_vectors", fcs)
        + c_table("frame_vector", "frame_vectors", frames)
        + c_table("dropped_vector", "dropped_vectors", dropped)
        + "\n#endif\n"
    )


def contents() -> dict[Path, str]:
    return {JSON_FILE: json.dumps(vectors(), indent=1) + "\n", C_FILE: c_file()}


def main() -> int:
    if "--check" in sys.argv[1:]:
        stale = [path for path, text in contents().items() if path.read_text() != text]
        for path in stale:
            print(f"{path.relative_to(TESTS.parent)} is not what frames.py makes")
        return 1 if stale else 0
    for path, text in contents().items():
        path.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
