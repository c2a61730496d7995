"""Our register header says what the vendor's description of the family says.

pyOCD's package carries the description of the STM32F429, whose timers, DMA, USART, GPIO, RCC,
flash, watchdog, SYSCFG, EXTI and interrupt controller are those of the STM32F405 (both are in
RM0090). It leaves out the processor's own blocks: those are in the description of an STM32L4, which
has the same processor, and in pyOCD itself.
"""

from __future__ import annotations

import importlib.util
import itertools
import re
import xml.etree.ElementTree as ElementTree
import zipfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

HEADER = Path(__file__).resolve().parents[2] / "hal/stm32/stm32f4.h"
STARTUP = HEADER.with_name("stm32_startup.c")
DEVICE, SAME_CORE = "STM32F429x.svd", "STM32L4x2.svd"

BASE = re.compile(r"^#define (\w+)_BASE (0x[0-9A-F]+)U\b", re.MULTILINE)
REGISTER = re.compile(
    r"^#define (\w+)_(\w+?)(\(\w+\))? (?:STM32_REGISTER|GPIO_REGISTER)"
    r"\(.*?(0x[0-9A-F]+)U(?: \+ 4U \* \(n\))?\)(?:\s*/\*.*)?$",
    re.MULTILINE,
)
BIT = re.compile(r"^#define ([A-Z0-9]+)_([A-Z0-9]+)_(\w+?)(\(n\))? \((?:1U|\(n\)) << (\d+)\)", re.M)
INTERRUPT = re.compile(r"^#define (\w+)_IRQ (\d+)U", re.MULTILINE)

# Where the description has another name than the reference manual.
REGISTERS = {
    ("TIM", "CCMR1"): "CCMR1_Output",
    ("TIM", "CCMR2"): "CCMR2_Output",
    ("DMA", "CR"): "S0CR",
    ("DMA", "NDTR"): "S0NDTR",
    ("DMA", "PAR"): "S0PAR",
    ("DMA", "M0AR"): "S0M0AR",
    ("DMA", "FCR"): "S0FCR",
    ("TIM5", "CCMR2"): "CCMR2_Input",
    ("NVIC", "ISER"): "ISER0",
    ("NVIC", "ICER"): "ICER0",
    ("NVIC", "ISPR"): "ISPR0",
    ("NVIC", "ICPR"): "ICPR0",
    ("NVIC", "IPR"): "IPR0",
    ("SYSCFG", "EXTICR"): "EXTICR1",
    ("SYSCFG", "MEMRMP"): "MEMRM",
    ("DBG", "IDCODE"): "DBGMCU_IDCODE",
}
FIELDS = {
    "TI4_RMP": "IT4_RMP",
    "IWDGRSTF": "WDGRSTF",
    "SW": "SW0",
    "SWS": "SWS0",
    "PLLM": "PLLM0",
    "PLLN": "PLLN0",
    "PLLQ": "PLLQ0",
}
INSTANCES = {"GPIO": "GPIOA", "USART": "USART1", "TIM": "TIM2", "DMA": "DMA1"}
STREAM = re.compile(r"DMA(\d)_STREAM\(n\) \(DMA\1_BASE \+ (0x\w+)U \+ (0x\w+)U \* \(n\)\)")
CORE = {"STK", "SCB", "DWT"}  # blocks of the processor
CORE_REGISTER = re.compile(r"^#define (STK|SCB)_(\w+) STM32_REGISTER\((0x[0-9A-F]+)U\)$", re.M)
CORE_BIT = re.compile(r"^#define (STK|SCB)_([A-Z]+)_([A-Z]+) \(1U << (\d+)\)$", re.M)
CORE_REGISTERS = {("SCB", "CFSR"): "CFSR_UFSR_BFSR_MMFSR"}
NOT_IN_F407 = {
    "GPIOJ", "GPIOK", "DMA2D", "UART7", "UART8", "SPI4", "SPI5", "SPI6", "SAI1", "LTDC",
}  # fmt: skip
RESET_MASK = re.compile(r"ON_(\w+) = (0x[0-9A-F]+),")


@dataclass(frozen=True)
class Register:
    """Its offset, and the place of each field."""

    offset: int
    fields: dict[str, int]


@dataclass(frozen=True)
class Peripheral:
    """Its address and registers."""

    base: int
    registers: dict[str, Register]


@cache
def description(device: str = DEVICE) -> ElementTree.Element:
    package = importlib.util.find_spec("pyocd")
    assert package is not None, "pyocd is not installed: run tools/setup test"
    assert package.submodule_search_locations is not None
    data = Path(package.submodule_search_locations[0]) / "debug/svd/svd_data.zip"
    with zipfile.ZipFile(data) as archive:
        return ElementTree.fromstring(archive.read(device))


def number(element: ElementTree.Element, name: str) -> int:
    return int(element.findtext(name) or "", 0)


@cache
def peripherals(device: str = DEVICE) -> dict[str, Peripheral]:
    elements = {p.findtext("name") or "": p for p in description(device).iter("peripheral")}
    found = {}
    for name, element in elements.items():
        source = elements[element.get("derivedFrom", name)]
        registers = {
            r.findtext("name") or "": Register(
                number(r, "addressOffset"),
                {f.findtext("name") or "": number(f, "bitOffset") for f in r.iter("field")},
            )
            for r in source.iter("register")
        }
        found[name] = Peripheral(number(element, "baseAddress"), registers)
    return found


def described(block: str, register: str) -> Register:
    name = REGISTERS.get((block, register), register)
    return peripherals()[INSTANCES.get(block, block)].registers[name]


def stream_offset(number: int) -> int:
    """Of the first register of a stream of DMA1."""
    return peripherals()["DMA1"].registers[f"S{number}CR"].offset


TEXT = HEADER.read_text()
BASES = [m.groups() for m in BASE.finditer(TEXT)]
REGISTER_ROWS = [(m[1], m[2], m[4]) for m in REGISTER.finditer(TEXT) if m[1] not in CORE]
BIT_ROWS = [(m[1], m[2], m[3], m[5]) for m in BIT.finditer(TEXT) if m[1] not in CORE]
INTERRUPTS = [m.groups() for m in INTERRUPT.finditer(TEXT)]
CORE_REGISTER_ROWS = [m.groups() for m in CORE_REGISTER.finditer(TEXT) if m[2] != "DEMCR"]
CORE_BIT_ROWS = [m.groups() for m in CORE_BIT.finditer(TEXT) if m[2] != "DEMCR"]
RESET_MASKS = [m.groups() for m in RESET_MASK.finditer(STARTUP.read_text())]


@pytest.mark.parametrize(("block", "address"), BASES)
def test_a_block_is_at_its_address(block: str, address: str) -> None:
    assert int(address, 16) == peripherals()[INSTANCES.get(block, block)].base


@pytest.mark.parametrize(("block", "register", "offset"), REGISTER_ROWS)
def test_a_register_is_at_its_offset(block: str, register: str, offset: str) -> None:
    begin = stream_offset(0) if block == "DMA" else 0

    assert begin + int(offset, 16) == described(block, register).offset


@pytest.mark.parametrize(("block", "register", "field", "place"), BIT_ROWS)
def test_a_field_is_at_its_place(block: str, register: str, field: str, place: str) -> None:
    assert int(place) == described(block, register).fields[FIELDS.get(field, field)]


@pytest.mark.parametrize(("name", "value"), INTERRUPTS)
def test_an_interrupt_has_its_number(name: str, value: str) -> None:
    numbers = {i.findtext("name"): number(i, "value") for i in description().iter("interrupt")}
    assert int(value) == numbers[name]


def value_of(name: str) -> int:
    match = re.search(rf"^#define {name} .*?(0x[0-9A-F]+)U", TEXT, re.MULTILINE)
    assert match
    return int(match[1], 16)


@pytest.mark.parametrize(("block", "register", "address"), CORE_REGISTER_ROWS)
def test_a_register_of_the_processor_is_at_its_address(
    block: str, register: str, address: str
) -> None:
    found = peripherals(SAME_CORE)[block]
    name = CORE_REGISTERS.get((block, register), register)
    assert int(address, 16) == found.base + found.registers[name].offset


@pytest.mark.parametrize(("block", "register", "field", "place"), CORE_BIT_ROWS)
def test_a_field_of_the_processor_is_at_its_place(
    block: str, register: str, field: str, place: str
) -> None:
    assert int(place) == peripherals(SAME_CORE)[block].registers[register].fields[field]


def test_reset_key_cycle_counter_and_its_enable_are_those_that_the_debugger_has() -> None:
    core = importlib.import_module("pyocd.coresight.cortex_m").CortexM
    dwt = importlib.import_module("pyocd.coresight.dwt").DWT
    key, reset = core.NVIC_AIRCR_VECTKEY, core.NVIC_AIRCR_SYSRESETREQ

    assert (value_of("SCB_AIRCR_RESET"), value_of("SCB_AIRCR_NO_GROUPS")) == (key | reset, key)
    assert value_of("SCB_DEMCR") == core.DEMCR
    assert f"SCB_DEMCR_TRCENA (1U << {core.DEMCR_TRCENA.bit_length() - 1})" in TEXT
    assert value_of("DWT_CYCCNT") - value_of("DWT_CTRL") == dwt.DWT_CYCCNT - dwt.DWT_CTRL
    assert f"DWT_CTRL_CYCCNTENA (1U << {dwt.DWT_CTRL_CYCCNTENA_MASK.bit_length() - 1})" in TEXT


@pytest.mark.parametrize(("bus", "mask"), RESET_MASKS)
def test_the_start_resets_all_that_there_is(bus: str, mask: str) -> None:
    fields = peripherals()["RCC"].registers[f"{bus}RSTR"].fields
    assert len(RESET_MASKS) == 4
    assert {i for i in range(32) if int(mask, 16) >> i & 1} == {
        place for name, place in fields.items() if name.removesuffix("RST") not in NOT_IN_F407
    }


def test_the_ports_are_one_stride_apart() -> None:
    match = re.search(r"GPIO_STRIDE (0x\w+)U", TEXT)
    assert match
    ports = [peripherals()[f"GPIO{port}"].base for port in "ABCDE"]
    assert [b - a for a, b in itertools.pairwise(ports)] == [int(match[1], 16)] * 4


def test_the_streams_are_one_stride_apart_and_alike() -> None:
    rows = {(int(m[2], 16), int(m[3], 16)) for m in STREAM.finditer(TEXT)}
    ((first, stride),) = rows
    registers = peripherals()["DMA1"].registers
    assert peripherals()["DMA2"].registers == registers
    for number in range(8):
        assert stream_offset(number) == first + stride * number
        for row in ("CR", "NDTR", "PAR", "M0AR", "FCR"):
            mine, other = registers[f"S{number}{row}"], registers[f"S0{row}"]
            assert mine.offset - stream_offset(number) == other.offset - first
            assert mine.fields.items() >= other.fields.items()


@pytest.mark.parametrize("register", sorted({r for block, r, _ in REGISTER_ROWS if block == "TIM"}))
def test_both_timers_have_the_registers_that_they_share(register: str) -> None:
    name = REGISTERS.get(("TIM", register), register)
    one, other = (peripherals()[timer].registers[name] for timer in ("TIM2", "TIM5"))

    assert (one.offset, one.fields) == (other.offset, other.fields)


@pytest.mark.parametrize("channel", range(1, 5))
def test_the_channels_of_a_timer_are_a_stride_apart(channel: int) -> None:
    registers = peripherals()["TIM2"].registers
    places = {
        "CCER": (f"CC{channel}E", 4),
        "SR": (f"CC{channel}IF", 1),
        "DIER": (f"CC{channel}DE", 1),
    }

    assert registers[f"CCR{channel}"].offset == registers["CCR1"].offset + 4 * (channel - 1)
    for register, (field, stride) in places.items():
        fields = registers[register].fields
        assert fields[field] == fields[field.replace(str(channel), "1", 1)] + stride * (channel - 1)


def test_every_definition_of_the_header_is_read() -> None:
    definitions = re.findall(r"^#define (\w+)", TEXT, re.MULTILINE)
    other = {
        "STM32F4_H",
        "STM32_REGISTER",
        "GPIO_STRIDE",
        "GPIO_REGISTER",
        "DMA1_STREAM",
        "DMA2_STREAM",
        "FLASH_KEY_1",
        "FLASH_KEY_2",
    }
    core = {name for name in definitions if name.partition("_")[0] in CORE}
    read = len(BASES) + len(REGISTER_ROWS) + len(BIT_ROWS) + len(INTERRUPTS)
    assert len(definitions) - len(other) - len(core) == read
