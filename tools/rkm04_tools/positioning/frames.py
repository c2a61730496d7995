"""Frames of Modbus RTU to unit 1 and back, as bytes: what is sent to the image of a board."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

NODE = 1
READ, WRITE_ONE, WRITE, EXCHANGE = 3, 6, 16, 23
EXCEPTION = 0x80
HEAD_BYTES, SUM_BYTES = 3, 2
WRITTEN_BYTES, REFUSED_BYTES = 8, 5
"""How long the answers to writes are, and an exception."""
FRAME_BYTES_MAX = 256
BYTE_BITS = 11
GAP_BYTES = 3.5
GAP_MS_MIN = 1.75


def byte_ms(baud: int) -> float:
    """How long a byte takes."""
    return 1000 * BYTE_BITS / baud


def gap_ms(baud: int) -> float:
    """The silence that ends a frame."""
    return max(GAP_MS_MIN, GAP_BYTES * byte_ms(baud))


def sealed(text: bytes) -> bytes:
    """A frame of the unit with its CRC."""
    frame = bytes([NODE]) + text
    rest = 0xFFFF
    for byte in frame:
        rest ^= byte
        for _ in range(8):
            rest = (rest >> 1) ^ 0xA001 if rest & 1 else rest >> 1
    return frame + struct.pack("<H", rest)


def words_of(words: Sequence[int]) -> bytes:
    """Their number of bytes, and they."""
    return struct.pack(f">B{len(words)}H", 2 * len(words), *words)


def read(first: int, count: int) -> bytes:
    """Function 3."""
    return sealed(struct.pack(">BHH", READ, first, count))


def write_one(number: int, word: int) -> bytes:
    """Function 6."""
    return sealed(struct.pack(">BHH", WRITE_ONE, number, word))


def write(first: int, words: Sequence[int]) -> bytes:
    """Function 16."""
    return sealed(struct.pack(">BHH", WRITE, first, len(words)) + words_of(words))


def exchange(first: int, words: Sequence[int], read_first: int, count: int) -> bytes:
    """Function 23: writes, then reads."""
    head = struct.pack(">BHHHH", EXCHANGE, read_first, count, first, len(words))
    return sealed(head + words_of(words))


@dataclass(frozen=True)
class Answer:
    """What a request was answered by; `exception` 0: it was done."""

    words: tuple[int, ...] = ()
    exception: int = 0


def is_whole(heard: bytes) -> bool:
    """Whether as much has come as an answer of this kind has."""
    if len(heard) < HEAD_BYTES:
        return False
    if heard[1] & EXCEPTION:
        return len(heard) >= REFUSED_BYTES
    is_write = heard[1] in (WRITE_ONE, WRITE)
    return len(heard) >= (WRITTEN_BYTES if is_write else HEAD_BYTES + heard[2] + SUM_BYTES)


def answer_of(request: bytes, heard: bytes) -> Answer | None:
    """What a whole answer tells; None: it is none to this request, or damaged."""
    function = request[1]
    if heard != sealed(heard[1:-SUM_BYTES]) or heard[1] & ~EXCEPTION != function:
        return None
    if heard[1] & EXCEPTION:
        return Answer(exception=heard[2])
    if function in (WRITE_ONE, WRITE):
        return Answer()
    return Answer(struct.unpack(f">{heard[2] // 2}H", heard[HEAD_BYTES:-SUM_BYTES]))
