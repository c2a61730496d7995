"""The step driver of a built image, function by function, on a timer made of a few rules.

The rules are those of RM0090 18.3.7 and 18.4 for a compare channel: a match sets the flag in every
mode, the pin rises in mode 1, falls in mode 2 and is low in mode 4. The counter stands still but
for what the rig says, and for one tick at each look at it, so that waits end.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from elftools.elf.elffile import ELFFile
from emulator import symbols
from unicorn import UC_ARCH_ARM, UC_HOOK_CODE, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_R0,
    UC_ARM_REG_R1,
    UC_ARM_REG_SP,
)

FLASH, RAM, MEBIBYTE = 0x0800_0000, 0x2000_0000, 0x10_0000
TIMER, PERIPHERALS = 0x4000_0000, 0x4000_1000
RETURN, CLIENT = FLASH + 0xF_0000, FLASH + 0xF_1000
DIER, SR, CCMR1, CNT, CCR1 = 0x0C, 0x10, 0x18, 0x24, 0x34
RISE, FALL, LOW = 1, 2, 4
WRAP = 1 << 32


@dataclass
class Timer:
    """Registers by offset, pins, and their edges."""

    registers: dict[int, int] = field(default_factory=dict)
    counter: int = 0
    pins: list[bool] = field(default_factory=lambda: [False] * 4)
    edges: list[tuple[int, int, bool]] = field(default_factory=list)  # tick, motor, level

    def mode(self, motor: int) -> int:
        word = self.registers.get(CCMR1 + 4 * (motor // 2), 0)
        return word >> (4 + 8 * (motor % 2)) & 7

    def set_pin(self, motor: int, level: bool) -> None:
        if self.pins[motor] != level:
            self.pins[motor] = level
            self.edges.append((self.counter, motor, level))

    def advance(self, ticks: int, until_interrupt: bool = False) -> None:
        """Let time go by, from match to match; perhaps only until one raises an interrupt."""
        while ticks > 0 and not (until_interrupt and self.interrupts):
            compares = [self.registers.get(CCR1 + 4 * motor, 0) for motor in range(4)]
            way = min(ticks, *((compare - self.counter - 1) % WRAP + 1 for compare in compares))
            ticks -= way
            self.counter = (self.counter + way) % WRAP
            for motor in range(4):
                if compares[motor] == self.counter:
                    self._match(motor)

    def _match(self, motor: int) -> None:
        self.registers[SR] = self.registers.get(SR, 0) | 2 << motor
        if self.mode(motor) in (RISE, FALL):
            self.set_pin(motor, self.mode(motor) == RISE)

    def read(self, offset: int) -> int:
        if offset == CNT:
            self.advance(1)
            return self.counter
        return self.registers.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if offset == SR:
            self.registers[SR] = self.registers.get(SR, 0) & value
            return
        self.registers[offset] = value
        for motor in range(4):
            if self.mode(motor) == LOW:
                self.set_pin(motor, False)

    @property
    def interrupts(self) -> bool:
        return bool(self.registers.get(SR, 0) & self.registers.get(DIER, 0))


class StepRig:
    """The driver, with a client that asks for the ticks in `wanted`, motor by motor."""

    def __init__(self, image: Path, counter: int = 1000) -> None:
        self.symbols = symbols(image)
        self.timer = Timer(counter=counter)
        self.wanted: dict[int, list[int]] = {motor: [] for motor in range(4)}
        self.served: list[int] = []
        self._machine = machine = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        machine.mem_map(FLASH, MEBIBYTE)
        machine.mem_map(RAM, MEBIBYTE)
        machine.mem_map(PERIPHERALS, MEBIBYTE)
        machine.mmio_map(TIMER, 0x1000, self._read, None, self._write, None)
        with image.open("rb") as file:
            for segment in ELFFile(file).iter_segments("PT_LOAD"):
                machine.mem_write(segment["p_vaddr"], segment.data())
        machine.mem_write(CLIENT, b"\x70\x47")  # bx lr
        machine.hook_add(UC_HOOK_CODE, self._client, begin=CLIENT, end=CLIENT)
        self.call("stm32_step_start", 1)
        client = [0, CLIENT | 1, 0]
        self._machine.mem_write(RAM + 0xF_0000, b"".join(w.to_bytes(4, "little") for w in client))
        self.call("stm32_step_set_client", RAM + 0xF_0000)
        self.timer.edges.clear()

    def _read(self, _machine: Uc, offset: int, _size: int, _data: Any) -> int:
        return self.timer.read(offset)

    def _write(self, _machine: Uc, offset: int, _size: int, value: int, _data: Any) -> None:
        self.timer.write(offset, value)

    def _client(self, machine: Uc, _address: int, _size: int, _data: Any) -> None:
        """Goes on in hal_step_arm if there is a tick left, else returns that there is nothing."""
        motor = machine.reg_read(UC_ARM_REG_R1)
        self.served.append(motor)
        if self.wanted[motor]:
            machine.reg_write(UC_ARM_REG_R0, motor)
            machine.reg_write(UC_ARM_REG_R1, self.wanted[motor].pop(0) % WRAP)
            machine.reg_write(UC_ARM_REG_PC, self.symbols["hal_step_arm"] | 1)
        else:
            machine.reg_write(UC_ARM_REG_R0, 0)

    def call(self, name: str, *arguments: int) -> int:
        machine = self._machine
        for register, value in zip((UC_ARM_REG_R0, UC_ARM_REG_R1), arguments, strict=False):
            machine.reg_write(register, value % WRAP)
        machine.reg_write(UC_ARM_REG_SP, self.symbols["stm32_stack_top"])
        machine.reg_write(UC_ARM_REG_LR, RETURN | 1)
        machine.emu_start(self.symbols[name] | 1, RETURN)
        return int(machine.reg_read(UC_ARM_REG_R0))

    def run(self, ticks: int, delay: int = 0) -> None:
        """Let time go by; each interrupt comes `delay` ticks behind what raises it."""
        end = self.timer.counter + ticks
        while 0 < (left := end - self.timer.counter) <= ticks:
            self.timer.advance(left, until_interrupt=True)
            if self.timer.interrupts:
                self.timer.advance(delay)
                self.call("stm32_step_interrupt")

    def rises(self, motor: int) -> list[int]:
        return [tick for tick, m, level in self.timer.edges if m == motor and level]

    def widths(self, motor: int) -> list[int]:
        """How long each pulse was high."""
        ticks = [tick for tick, m, _ in self.timer.edges if m == motor]
        return [b - a for a, b in zip(ticks[::2], ticks[1::2], strict=False)]

    @property
    def late(self) -> int:
        address = self.symbols["stm32_late_steps"]
        return int.from_bytes(self._machine.mem_read(address, 4), "little")
