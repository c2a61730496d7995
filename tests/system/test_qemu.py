"""The image of the board in a plain emulator: it starts, answers, and survives faults."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import emulator
import pytest
from emulator import PC, SP, Emulator
from rkm04_tools import board

VERSION = b"\1"
ANSWER = b"\1\x10" + board.version().encode()
UNMAPPED = 0x6000_0000

MAGIC, CAUSE_FAULT = 0x4641_5554, 3
HARD_FAULT = 3  # a fault of any kind that has no handler of its own
FORCED = 1 << 30
INSTRUCTION_BUS_ERROR, STACKING_ERROR = 1 << 8, 1 << 12  # PM0214 4.4.13
RECORD_WORDS = 8

pytestmark = pytest.mark.skipif(bool(emulator.missing()), reason=emulator.missing() or "-")


@pytest.fixture(scope="session")
def image() -> Path:
    """That of the board, but all in SRAM: the emulator has no other memory, and puts none at 0."""
    image = board.build(board.DEFAULT_BOARD, "flat_image")
    return image.file("elf").with_name(f"{image.name}-flat.elf")


@pytest.fixture
def unit(image: Path) -> Iterator[Emulator]:
    with emulator.emulator(image) as running:
        assert running.ask_until_answered(VERSION) == ANSWER
        yield running


def fault_record(unit: Emulator, image: Path) -> list[int]:
    """What the fault handler has kept: magic, cause, exception, CFSR, HFSR, BFAR, pc, count."""
    unit.gdb.stop()
    record = unit.gdb.read_words(emulator.symbols(image)["stm32_fault_record"], RECORD_WORDS)
    unit.gdb.go()
    return record


def provoke(unit: Emulator, image: Path, register: int, value: int) -> None:
    """Change a register where main has nothing to do and is about to sleep."""
    unit.gdb.stop_at(emulator.symbols(image)["stm32_event_sleep"])
    unit.gdb.set_register(register, value)
    unit.gdb.go()


def test_the_image_starts_without_a_crystal_and_tells_its_version(unit: Emulator) -> None:
    assert unit.ask_repeatedly(VERSION, 77) == ANSWER


def test_an_answer_of_many_bytes_comes_whole(unit: Emulator) -> None:
    program = b"S100V1000A2000F5000" * 20

    assert unit.ask_repeatedly(b"\x022[" + program, 2) == b"\x022\0\0"
    assert unit.ask_repeatedly(b"\x052", 3) == b"\x052[" + program


def test_the_unit_still_answers_after_a_while(unit: Emulator) -> None:
    time.sleep(3)

    assert unit.ask_repeatedly(VERSION, 78) == ANSWER


def test_there_is_no_fault_when_all_is_well(unit: Emulator, image: Path) -> None:
    magic, cause, *_, count = fault_record(unit, image)

    assert magic == MAGIC
    assert cause != CAUSE_FAULT
    assert count == 0


def test_a_stack_overflow_ends_in_the_handler_and_the_unit_starts_again(
    unit: Emulator, image: Path
) -> None:
    provoke(unit, image, SP, emulator.symbols(image)["stm32_stack_bottom"] + 8)

    assert unit.ask_until_answered(VERSION) == ANSWER
    _, cause, exception, status, _, _, pc, count = fault_record(unit, image)
    assert (cause, exception, count) == (CAUSE_FAULT, HARD_FAULT, 1)
    assert status & STACKING_ERROR
    assert pc == 0  # the frame is not to be read


def test_a_bus_fault_ends_in_the_handler_and_the_unit_starts_again(
    unit: Emulator, image: Path
) -> None:
    provoke(unit, image, PC, UNMAPPED)

    assert unit.ask_until_answered(VERSION) == ANSWER
    _, cause, exception, status, hard, _, pc, count = fault_record(unit, image)
    assert (cause, exception, count) == (CAUSE_FAULT, HARD_FAULT, 1)
    assert status & INSTRUCTION_BUS_ERROR
    assert hard & FORCED
    assert pc == UNMAPPED


def test_faults_are_counted(unit: Emulator, image: Path) -> None:
    for _ in range(2):
        provoke(unit, image, PC, UNMAPPED)
        assert unit.ask_until_answered(VERSION) == ANSWER

    assert fault_record(unit, image)[-1] == 2
