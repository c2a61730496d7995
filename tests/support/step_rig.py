"""The step driver of a built image, function by function, on a timer made of a few rules.

The rules are those of RM0090 18.3.7, 18.3.9 and 18.4 for a compare channel: a match sets the flag
in every mode, the pin rises in mode 1, falls in mode 2, is low in mode 4 and stands high from the
compare value to the counter's wrap in mode 7. Time goes by as the rig says, and while the driver
looks at the counter, so that waits end. The driver's clients are step channels of the image.
"""

from __future__ import annotations

import itertools
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import debug_info
from elftools.elf.elffile import ELFFile
from emulator import symbols
from unicorn import (
    UC_ARCH_ARM,
    UC_HOOK_CODE,
    UC_HOOK_MEM_WRITE,
    UC_MODE_MCLASS,
    UC_MODE_THUMB,
    Uc,
)
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_PRIMASK,
    UC_ARM_REG_R0,
    UC_ARM_REG_R1,
    UC_ARM_REG_R2,
    UC_ARM_REG_SP,
)

FLASH, RAM, MEBIBYTE = 0x0800_0000, 0x2000_0000, 0x10_0000
TIMER, PERIPHERALS = 0x4000_0000, 0x4000_1000
PORTS, PORT_BYTES, BSRR = 0x4002_0000, 0x400, 0x18  # RM0090, table 1 and 8.4.7
RETURN = FLASH + 0xF_0000
CLIENT, SEGMENT, CHANNELS, CHANNEL_BYTES = (
    RAM + 0xE_0000, RAM + 0xE_1000, RAM + 0xE_2000, 0x1000
)  # fmt: skip
DIER, SR, CCMR1, CNT, CCR1 = 0x0C, 0x10, 0x18, 0x24, 0x34
RISE, FALL, LOW, AFTER = 1, 2, 4, 7
WRAP = 1 << 32
MOTORS = 4

TICK_HZ = 84_000_000
QUANTA = 2 * TICK_HZ * TICK_HZ << 7  # of a step: firmware/engine/step/step_scale.h
SEGMENT_LAYOUT = "<QQiIII?7x"  # struct step_segment


@dataclass
class Timer:
    """Registers by offset, pins, and their edges. `now` is the counter, and the turns it has made.

    What a channel shows that comes to mode 7 from another one is not said (18.4.7): what it showed
    before, or, `at_once`, the result of the comparison.
    """

    now: int = 0
    at_once: bool = False
    after: int = 0  # ticks from a look at the counter to what the driver does next
    registers: dict[int, int] = field(default_factory=dict)
    pins: list[bool] = field(default_factory=lambda: [False] * MOTORS)
    edges: list[tuple[int, int, bool]] = field(default_factory=list)  # tick, motor, level
    _below: list[bool] = field(default_factory=lambda: [False] * MOTORS)
    _shown: list[int] = field(default_factory=lambda: [0] * MOTORS)

    @property
    def counter(self) -> int:
        return self.now % WRAP

    def compare(self, motor: int) -> int:
        return self.registers.get(CCR1 + 4 * motor, 0)

    def mode(self, motor: int) -> int:
        word = self.registers.get(CCMR1 + 4 * (motor // 2), 0)
        return word >> (4 + 8 * (motor % 2)) & 7

    def set_pin(self, motor: int, level: bool) -> None:
        if self.pins[motor] != level:
            self.pins[motor] = level
            self.edges.append((self.now, motor, level))

    def advance(self, ticks: int, until_interrupt: bool = False) -> None:
        """Let time go by, from match to match; perhaps only until one raises an interrupt."""
        end = self.now + ticks
        while self.now < end and not (until_interrupt and self.interrupts):
            stops = [0, *(self.compare(motor) for motor in range(MOTORS))]
            ways = ((stop - self.counter - 1) % WRAP + 1 for stop in stops)
            self.now += min(end - self.now, *ways)
            for motor in range(MOTORS):
                if self.compare(motor) == self.counter:
                    self._match(motor)
                self._show(motor)

    def _match(self, motor: int) -> None:
        self.registers[SR] = self.registers.get(SR, 0) | 2 << motor
        if self.mode(motor) in (RISE, FALL):
            self.set_pin(motor, self.mode(motor) == RISE)

    def _show(self, motor: int) -> None:
        mode, below = self.mode(motor), self.counter < self.compare(motor)
        changed = below != self._below[motor] or (self.at_once and mode != self._shown[motor])
        self._below[motor], self._shown[motor] = below, mode
        if mode == LOW:
            self.set_pin(motor, False)
        elif mode == AFTER and changed:
            self.set_pin(motor, not below)

    def read(self, offset: int) -> int:
        if offset == CNT:
            self.advance(1)
            counter = self.counter
            self.advance(self.after)
            return counter
        return self.registers.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if offset == SR:
            self.registers[SR] = self.registers.get(SR, 0) & value
            return
        self.registers[offset] = value
        for motor in range(MOTORS):
            self._show(motor)

    @property
    def interrupts(self) -> bool:
        return bool(self.registers.get(SR, 0) & self.registers.get(DIER, 0))


@cache
def _load(image: Path) -> list[tuple[int, bytes]]:
    with image.open("rb") as file:
        segments = ELFFile(file).iter_segments("PT_LOAD")
        return [(segment["p_vaddr"], segment.data()) for segment in segments]


@cache
def _offset(image: Path, name: str, member: str) -> int:
    return debug_info.offset(image, name, [member])


class StepRig:
    """The driver and four step channels. Ticks go on after the counter's wrap, at 2^32."""

    def __init__(self, image: Path, now: int = 1000, at_once: bool = False) -> None:
        self.symbols = symbols(image)
        self.timer = Timer(now, at_once)
        self._machine = machine = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        machine.mem_map(FLASH, MEBIBYTE)
        machine.mem_map(RAM, MEBIBYTE)
        machine.mem_map(PERIPHERALS, MEBIBYTE)
        machine.mmio_map(TIMER, 0x1000, self._read, None, self._write, None)
        machine.hook_add(UC_HOOK_CODE, self._instruction)
        self.pin_writes: list[tuple[int, tuple[int, int], bool]] = []  # tick, port and pin, level
        ports = {"begin": PORTS, "end": PORTS + 9 * PORT_BYTES - 1}
        machine.hook_add(UC_HOOK_MEM_WRITE, self._pin_write, **ports)
        for address, data in _load(image):
            machine.mem_write(address, data)
        self._in_main = False
        self.call("stm32_step_start", 1)
        for motor in range(MOTORS):
            self.call("step_channel_init", self._channel(motor), motor)
        channels = struct.pack("<4I", *map(self._channel, range(MOTORS)))
        machine.mem_write(CLIENT + _offset(image, "hal_client", "channel"), channels)
        self.call("stm32_step_set_client", CLIENT)
        self.timer.edges.clear()
        self.pin_writes.clear()

    def _pin_write(
        self, _machine: Uc, _access: int, address: int, _size: int, value: int, _data: Any
    ) -> None:
        port, register = divmod(address - PORTS, PORT_BYTES)
        if register == BSRR:
            bits = (value & 0xFFFF) | (value >> 16 & 0xFFFF)
            pin = bits.bit_length() - 1
            self.pin_writes.append((self.timer.now, (port, pin), bool(value & 1 << pin)))

    def _read(self, _machine: Uc, offset: int, _size: int, _data: Any) -> int:
        return self.timer.read(offset)

    def _write(self, _machine: Uc, offset: int, _size: int, value: int, _data: Any) -> None:
        self.timer.write(offset, value)

    def _instruction(self, machine: Uc, _address: int, _size: int, _data: Any) -> None:
        if self._in_main and self.timer.interrupts and not machine.reg_read(UC_ARM_REG_PRIMASK):
            machine.emu_stop()

    @staticmethod
    def _channel(motor: int) -> int:
        return CHANNELS + CHANNEL_BYTES * motor

    def call(self, name: str, *arguments: int) -> int:
        """Call a function as main does: the step interrupt comes in between where it may."""
        machine = self._machine
        registers = (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2)
        for register, value in zip(registers, arguments, strict=False):
            machine.reg_write(register, value % WRAP)
        machine.reg_write(UC_ARM_REG_SP, self.symbols["stm32_stack_top"])
        machine.reg_write(UC_ARM_REG_LR, RETURN | 1)
        address = self.symbols[name]
        self._in_main = True
        while address != RETURN:
            machine.emu_start(address | 1, RETURN)
            address = machine.reg_read(UC_ARM_REG_PC)
            if address != RETURN:
                before = machine.context_save()
                self.interrupt()
                machine.context_restore(before)
        self._in_main = False
        return int(machine.reg_read(UC_ARM_REG_R0))

    def interrupt(self) -> None:
        machine, in_main = self._machine, self._in_main
        self._in_main = False
        machine.reg_write(UC_ARM_REG_SP, self.symbols["stm32_stack_top"] - 0x200)
        machine.reg_write(UC_ARM_REG_LR, RETURN | 1)
        machine.emu_start(self.symbols["stm32_step_interrupt"] | 1, RETURN)
        self._in_main = in_main

    def push(self, motor: int, tick: int, interval: int = TICK_HZ, steps: int = 1) -> None:
        """Queue a segment: `steps` edges, the first one at `tick`."""
        slope = QUANTA // interval
        segment = struct.pack(SEGMENT_LAYOUT, 0, slope, 0, tick % WRAP, interval, steps, False)
        self._machine.mem_write(SEGMENT, segment)
        self.call("step_channel_push", self._channel(motor), SEGMENT)

    def go(self, motor: int) -> None:
        """Arm the first edge of what was queued."""
        self.call("step_channel_run", self._channel(motor))

    def start(self, motor: int, ticks: Sequence[int], backward: bool = False) -> None:
        """Start a move with an edge at each tick, each on a segment of its own."""
        begin = (self._channel(motor), self.timer.counter, int(backward))
        self.call("step_channel_begin", *begin)
        for tick in ticks:
            self.push(motor, tick)
        self.go(motor)

    def start_steady(self, motor: int, tick: int, interval: int, steps: int) -> None:
        """Start a move on one segment."""
        self.call("step_channel_begin", self._channel(motor), self.timer.counter, 0)
        self.push(motor, tick, interval, steps)
        self.go(motor)

    def halt(self, motor: int) -> None:
        self.call("step_channel_halt", self._channel(motor))

    def go_to(self, tick: int) -> None:
        """Let time go by with interrupts held off."""
        self.timer.advance(tick - self.timer.now)

    def run(self, ticks: int, delay: int = 0) -> None:
        """Let time go by; each interrupt comes `delay` ticks after what raises it."""
        end = self.timer.now + ticks
        while self.timer.now < end:
            self.timer.advance(end - self.timer.now, until_interrupt=True)
            if self.timer.interrupts:
                self.timer.advance(delay)
                self.interrupt()

    def rises(self, motor: int) -> list[int]:
        return [tick for tick, m, level in self.timer.edges if m == motor and level]

    def _ways(self, motor: int, level: bool) -> list[int]:
        edges = [(tick, up) for tick, m, up in self.timer.edges if m == motor]
        return [b - a for (a, up), (b, _) in itertools.pairwise(edges) if up == level]

    def highs(self, motor: int) -> list[int]:
        """How long each pulse was high."""
        return self._ways(motor, True)

    def lows(self, motor: int) -> list[int]:
        """How long the pin was low between pulses."""
        return self._ways(motor, False)

    def pulses(self, motor: int) -> int:
        """How many pulses of its move a channel has counted."""
        return self.call("step_channel_pulses", self._channel(motor))

    def is_running(self, motor: int) -> bool:
        return bool(self.call("step_channel_is_running", self._channel(motor)) & 0xFF)

    def word(self, name: str) -> int:
        return int.from_bytes(self._machine.mem_read(self.symbols[name], 4), "little")

    @property
    def late(self) -> int:
        """Edges that were made good."""
        return self.word("stm32_late_steps")

    def take_event(self) -> bool:
        """Whether main was told to look."""
        return bool(self.call("stm32_event_take") & 0xFF)
