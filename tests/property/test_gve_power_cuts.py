"""Power cuts of a GVE134 unit at every write of its flash: all old or all new, in their order."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator

import pytest
from gve_course import Mismatch
from gve_model import compare
from gve_probe import Probe
from gve_record import Session
from gve_sessions import READY_MS, Writer
from gve_state import delivered
from gve_words import single

WRITES = 4
CUTS_MAX = 500
WORDS = (0x00, 0x04, 0x0C, 0x10, 0x14, 0x40, 0xF8, 0xFC)
"""Where something may have been written."""


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


def any_write(rng: random.Random) -> tuple[str, int, bytes]:
    """A command that writes, the address and what is there after it."""
    at = rng.choice((0x01, 0x05, 0x10, 0x11, 0x12, 0x40, 0xF8, 0xFC, 0xFD))
    if rng.random() < 0.5 or at in (0x01, 0x05, 0xFD):
        value = rng.choice((0x00, 0x03, 0x0F, 0xAC, 0xFF))
        return f"EW{at:02X},{value:02X}", at, bytes([value])
    if rng.random() < 0.5:
        word = rng.getrandbits(32)
        return f"EUW{at:02X},{word:X}", at, struct.pack("<I", word)
    text = f"{rng.uniform(-1000, 1000):.3f}"
    return f"EFW{at:02X},{text}", at, struct.pack("<I", single(text))


def spoken(texts: list[str]) -> Session:
    """A session of these commands."""
    writer = Writer("power cut")
    writer.pause(READY_MS)
    for text in texts:
        writer.send(f"!0{text}\r")
        writer.pause(60)
    return writer.written()


READING = spoken(
    [f"EUR{at:02X}" for at in WORDS] + ["P4", "SR6", "L5,-3", "O0,FA", "EW20,77", "ER20"]
)


@pytest.mark.parametrize("seed", range(3))
def test_a_power_cut_at_any_write_leaves_what_was_answered_and_all_or_nothing_of_the_next(
    probe: Probe, seed: int
) -> None:
    writes = [any_write(random.Random(f"{seed} {number}")) for number in range(WRITES)]
    memories = [bytes(delivered())]
    for _, at, data in writes:
        memories.append(memories[-1][:at] + data + memories[-1][at + len(data) :])
    writing = spoken([text for text, _, _ in writes])
    reached = 0
    for cut in range(1, CUTS_MAX):
        done = probe.run_cut(writing, cut, READING)
        while True:
            try:
                compare(READING, done, memories[reached])
            except Mismatch:
                reached += 1
                assert reached < len(memories), f"cut {cut}: neither old nor new"
            else:
                break
        if memories[reached] == memories[-1]:
            break
    assert memories[reached] == memories[-1]
