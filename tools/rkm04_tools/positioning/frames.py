"""Frames of Modbus RTU to unit 1 and back, as bytes: what is sent to the image of a board."""

from __future__ import annotations

from collections.abc import Sequence

from rkm04_tools.positioning import master, modbus

NODE = 1
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
    return master.sealed(bytes([NODE]) + text)


def read(first: int, count: int) -> bytes:
    """Function 3."""
    return sealed(modbus.read_request(first, count))


def write(first: int, words: Sequence[int]) -> bytes:
    """Function 16."""
    return sealed(modbus.write_request(first, words))


def exchange(first: int, words: Sequence[int], read_first: int, count: int) -> bytes:
    """Function 23: writes, then reads."""
    return sealed(modbus.exchange_request(first, words, read_first, count))
