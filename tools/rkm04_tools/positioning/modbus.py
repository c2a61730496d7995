"""Requests of Modbus from the function on, and what is in the answers to them."""

from __future__ import annotations

import struct
from collections.abc import Sequence

READ, WRITE_ONE, WRITE, EXCHANGE, IDENTIFY = 3, 6, 16, 23, 43
REFUSED = 0x80
MEI, BASIC = 14, 1
OBJECTS_AT = 7


def read_request(first: int, count: int) -> bytes:
    """Reads registers."""
    return struct.pack(">BHH", READ, first, count)


def write_one_request(number: int, word: int) -> bytes:
    """Writes a register."""
    return struct.pack(">BHH", WRITE_ONE, number, word)


def write_request(first: int, words: Sequence[int]) -> bytes:
    """Writes registers."""
    return struct.pack(">BHH", WRITE, first, len(words)) + _counted(words)


def exchange_request(first: int, words: Sequence[int], read_first: int, count: int) -> bytes:
    """Writes registers, then reads others."""
    head = struct.pack(">BHHHH", EXCHANGE, read_first, count, first, len(words))
    return head + _counted(words)


def identify_request() -> bytes:
    """Asks for all texts of the identification."""
    return bytes([IDENTIFY, MEI, BASIC, 0])


def _counted(words: Sequence[int]) -> bytes:
    return struct.pack(f">B{len(words)}H", 2 * len(words), *words)


def words_in(answer: bytes, count: int) -> list[int] | None:
    """The registers that were read; None: there are not as many."""
    if len(answer) != 2 + 2 * count or answer[1] != 2 * count:
        return None
    return list(struct.unpack(f">{count}H", answer[2:]))


def texts_in(answer: bytes) -> list[str]:
    """The texts of an identification."""
    found, at = [], OBJECTS_AT
    while at + 1 < len(answer):
        end = at + 2 + answer[at + 1]
        found.append(answer[at + 2 : end].decode("ascii", "replace"))
        at = end
    return found
