"""Answers to Get Status that the C side and the Python side both read: what is told, and its bytes.

Written from firmware/rkm04/docs/messages.md alone. `statuses.py` writes both files,
`--check` compares.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
JSON_FILE = TESTS / "vectors" / "status.json"
C_FILE = TESTS / "support" / "lib" / "status_vectors.h"

GET_STATUS = 200

C_HEAD = """\
/*
 * The answers of tests/vectors/status.json, written by tests/support/statuses.py: change them
 * there.
 */
/* clang-format off */
#ifndef STATUS_VECTORS_H
#define STATUS_VECTORS_H

#include "messages_status.h"

struct status_vector {
    const char *name;
    struct messages_status status;
    const char *answer; /* what follows the message number */
    uint32_t length;
};

static const struct status_vector status_vectors[] = {
"""


@dataclass(frozen=True)
class Vector:
    """Numbers as they are told; the lists of four are of motors 1 to 4."""

    name: str
    inputs: int = 0
    outputs: int = 0
    cause: int = 0
    switches: int = 0
    motors: list[int] = field(default_factory=lambda: [0] * 4)
    errors: list[int] = field(default_factory=lambda: [0] * 4)
    positions_steps: list[int] = field(default_factory=lambda: [0] * 4)
    late_steps: int = 0
    line_counts: list[int] = field(default_factory=lambda: [0] * 12)
    waits: list[int] = field(default_factory=lambda: [0] * 4)

    @property
    def whole(self) -> bytes:
        return bytes([GET_STATUS]) + self.answer

    @property
    def answer(self) -> bytes:
        small = [2, self.inputs, self.outputs, self.cause, self.switches]
        small += [*self.motors, *self.errors]
        wide = b"".join(each.to_bytes(8, "little", signed=True) for each in self.positions_steps)
        counts = [self.late_steps, *self.line_counts]
        numbers = b"".join(each.to_bytes(4, "little") for each in counts)
        return bytes(small) + wide + numbers + bytes(self.waits)

    @property
    def oldest(self) -> bytes:
        """The same in layout 1."""
        return self.whole[:1] + b"\1" + self.whole[2:-4]


VECTORS = [
    Vector("just switched on"),
    Vector("input 1 and output 8", inputs=0x01, outputs=0x80, line_counts=[1] + [0] * 11),
    Vector("after the watchdog", cause=2, switches=0x02),
    Vector("after a reset, no crystal", cause=1, switches=0x11, motors=[0, 16, 0, 0],
           errors=[0, 10, 0, 0]),
    Vector("at work", inputs=0xA5, outputs=0x3C, switches=0x0C, motors=[3, 6 + 64, 9 + 64, 32 + 64],
           positions_steps=[5000, -5, 16_000_000, -(2**40)], late_steps=7,
           line_counts=list(range(100, 112)), waits=[0, 5 + 128, 0, 0]),
    Vector("every error", cause=3, switches=0x02, motors=[16, 17, 16, 16], errors=[1, 2, 9, 10]),
    Vector("every kind of wait", motors=[6, 6, 6, 6], waits=[8, 80 + 128, 96, 97]),
    Vector("the largest and the least", inputs=255, outputs=255, cause=3, switches=31,
           motors=[127] * 4, errors=[10] * 4, positions_steps=[2**63 - 1, -(2**63), -1, 1],
           late_steps=2**32 - 1, line_counts=[2**32 - 1 - each for each in range(12)],
           waits=[255] * 4),
    Vector("bytes that are escaped on the line", inputs=0x7E, outputs=0x7D,
           positions_steps=[0x7E7D7E7D, 0, 0, 0], line_counts=[0x7E] * 12),
]  # fmt: skip


def c_bytes(data: bytes) -> str:
    rows = [data[start : start + 20] for start in range(0, len(data), 20)]
    return "\n     ".join('"' + "".join(f"\\x{byte:02x}" for byte in row) + '"' for row in rows)


def c_number(value: int) -> str:
    # The least one has no literal.
    return "INT64_MIN" if value == -(2**63) else f"INT64_C({value})"


def c_row(vector: Vector) -> str:
    def numbers(values: list[int]) -> str:
        return "{" + ", ".join(map(str, values)) + "}"

    positions = "{" + ", ".join(map(c_number, vector.positions_steps)) + "}"
    half = len(vector.line_counts) // 2
    counts = [f"{each}U" for each in vector.line_counts]
    rows = ", ".join(counts[:half]) + ",\n       " + ", ".join(counts[half:])
    return (
        f'    {{"{vector.name}",\n'
        f"     {{{vector.inputs}, {vector.outputs}, {vector.cause}, {vector.switches},"
        f" {numbers(vector.motors)}, {numbers(vector.errors)},\n"
        f"      {positions}, {vector.late_steps}U,\n"
        f"      {{{rows}}},\n"
        f"      {numbers(vector.waits)}}},\n"
        f"     {c_bytes(vector.answer)}, {len(vector.answer)}}},\n"
    )


def contents() -> dict[Path, str]:
    about = (
        "Answers to Get Status (firmware/rkm04/docs/messages.md), written by statuses.py: "
        "numbers as they are told, and the whole answer in hex."
    )
    rows = [{**asdict(each), "answer": each.whole.hex()} for each in VECTORS]
    text = json.dumps({"about": about, "answers": rows}, indent=1) + "\n"
    return {
        JSON_FILE: text,
        C_FILE: C_HEAD + "".join(map(c_row, VECTORS)) + "};\n\n#endif\n",
    }


def main() -> int:
    if "--check" in sys.argv[1:]:
        return int(any(path.read_text() != text for path, text in contents().items()))
    for path, text in contents().items():
        path.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
