"""Instructions a pulse of the step path, counted on the code that the ARM compiler makes.

Compiles the stages step and motion of firmware/engine for Cortex-M4, runs them in the Unicorn CPU
emulator and counts every executed instruction of `step_generator_next` (the next tick of one pulse)
and of `step_channel_lay_isr` (the whole work of a question of the backend for pulses, but for the
backend itself), where one pulse is laid at a time and where many are laid at once. These are
counts, not cycles: exact, and the same on every machine.

    python tests/support/arm_count.py [--json]
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from elftools.elf.elffile import ELFFile
from elftools.elf.sections import SymbolTableSection
from unicorn import UC_ARCH_ARM, UC_HOOK_CODE, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_R0,
    UC_ARM_REG_R1,
    UC_ARM_REG_R2,
    UC_ARM_REG_R3,
    UC_ARM_REG_SP,
)

ROOT = Path(__file__).resolve().parents[2]
COMPILER = "arm-none-eabi-gcc"
FLAGS = ["-std=c11", "-O2", "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft"]
CODE, RAM, RETURN = 0x0800_0000, 0x2000_0000, 0x0810_0000
MEMORY = 0x20_0000
GENERATOR, QUESTION = "find_next", "step_channel_lay_isr"
GOAL = 60
PULSES_MAX = 3000
MANY = 16
"""Pulses laid at once, while as many wait."""

# What the moves show: start speed, speed, acceleration, steps.
MOVES = {
    "cruise V16000": (2000, 2000, 60000, 3000),
    "ramps S100 V3000 A2000": (100, 3000, 2000, 1000),
    "ramps S2000 V16000 A60000": (2000, 16000, 60000, 3000),
    "ramps S1000 V200000 A1000000": (1000, 200000, 1000000, 3000),
    "from a stand S1 V16000 A60000": (1, 16000, 60000, 1000),
}


class Missing(Exception):
    """The compiler for ARM is not there."""


STEP_PATH = ("base/base_[tw]i*.c", "engine/step/*.c", "engine/motion/*.c")


def link(folder: Path, bench: str, names: Sequence[str] = STEP_PATH) -> Path:
    """Links sources of firmware/ without libraries of ours, code at CODE and data at RAM."""
    sources = [path for name in names for path in (ROOT / "firmware").glob(name)]
    stages = {path.parent for path in sources}
    includes = [f"-I{path}" for path in [*stages, ROOT / "hal" / "include"]]
    target = folder / "bench.elf"
    options = ["-nostartfiles", f"-Wl,-Ttext={CODE:#x},-Tdata={RAM:#x},-e,bench_begin"]
    command = [COMPILER, *FLAGS, *includes, *options, "-o", str(target)]
    command += [str(ROOT / "tests/support/arm" / bench), *map(str, sources)]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True)
    except FileNotFoundError as error:
        raise Missing(f"{COMPILER} is not installed: run tools/setup test") from error
    return target


@dataclass
class Counter:
    """Executed instructions by function; those of a callee count for its callers too."""

    machine: Uc
    symbols: dict[str, tuple[int, int]]
    counts: dict[str, list[int]] = field(default_factory=dict)
    executed: int = 0
    open: list[tuple[str, int, int]] = field(default_factory=list)

    def watch(self, name: str) -> None:
        self.counts[name] = []

    def on_code(self, _machine: Uc, address: int, _size: int, _data: object) -> None:
        while self.open and address == self.open[-1][1]:
            name, _, before = self.open.pop()
            self.counts[name].append(self.executed - before)
        for name in self.counts:
            if address == self.symbols[name][0]:
                back = self.machine.reg_read(UC_ARM_REG_LR) & ~1
                self.open.append((name, back, self.executed))
        self.executed += 1

    def call(self, name: str, *arguments: int) -> int:
        registers = (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3)
        for register, value in zip(registers, arguments, strict=False):
            self.machine.reg_write(register, value)
        self.machine.reg_write(UC_ARM_REG_SP, RAM + MEMORY - 16)
        self.machine.reg_write(UC_ARM_REG_LR, RETURN | 1)
        self.machine.emu_start(self.symbols[name][0] | 1, RETURN)
        while self.open:
            watched, _, before = self.open.pop()
            self.counts[watched].append(self.executed - before)
        return int(self.machine.reg_read(UC_ARM_REG_R0))


def functions(elf: ELFFile) -> Iterator[tuple[str, tuple[int, int]]]:
    """Names of the functions with address and size."""
    for section in elf.iter_sections():
        if isinstance(section, SymbolTableSection):
            for symbol in section.iter_symbols():
                if symbol["st_info"]["type"] == "STT_FUNC":
                    yield symbol.name, (symbol["st_value"] & ~1, symbol["st_size"])


def load(path: Path) -> Counter:
    """A machine with the program in it."""
    machine = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
    machine.mem_map(CODE, MEMORY)
    machine.mem_map(RAM, MEMORY)
    with path.open("rb") as file:
        elf = ELFFile(file)
        for segment in elf.iter_segments():
            if segment["p_type"] == "PT_LOAD" and segment["p_filesz"]:
                machine.mem_write(segment["p_vaddr"], segment.data())
        counter = Counter(machine, dict(functions(elf)))
    machine.hook_add(UC_HOOK_CODE, counter.on_code)
    machine.reg_write(UC_ARM_REG_PC, CODE)
    return counter


def begin_move(counter: Counter, move: tuple[int, int, int, int]) -> int:
    """Plans a move and has its first pulse laid; returns how many pulses to measure."""
    counter.counts.clear()
    counter.call("bench_begin", *move)
    while counter.call("bench_feed") & 0xFF:
        pass
    counter.call("bench_run")
    return min(move[3] - 2, PULSES_MAX)


def count_single(counter: Counter, move: tuple[int, int, int, int]) -> dict[str, list[int]]:
    """The counts of each function, pulse by pulse, where one is laid at a time."""
    pulses = begin_move(counter, move)
    counter.watch(GENERATOR)
    counter.watch(QUESTION)
    for _ in range(pulses):
        counter.call("bench_next")
        counter.call("bench_lay", 1)
    return counter.counts


def count_many(counter: Counter, move: tuple[int, int, int, int]) -> list[float]:
    """The instructions of each question for many pulses, for each pulse that was laid."""
    pulses = begin_move(counter, move)
    counter.watch(QUESTION)
    laid: list[int] = []
    while sum(laid) < pulses - MANY:
        laid.append(counter.call("bench_lay", MANY))
    return [count / many for count, many in zip(counter.counts[QUESTION], laid, strict=True)]


def summary(counts: Sequence[float]) -> dict[str, float]:
    return {
        "median": statistics.median(counts),
        "mean": round(statistics.fmean(counts), 1),
        "max": round(max(counts), 1),
    }


def measure() -> dict[str, object]:
    """Counts for all moves; the figure is the mean of the generator over the ramps."""
    with tempfile.TemporaryDirectory() as folder:
        counter = load(link(Path(folder), "arm_bench.c"))
    rows = []
    worst = 0.0
    for name, move in MOVES.items():
        counts = count_single(counter, move)
        generator = summary(counts[GENERATOR])
        worst = max(worst, generator["mean"])
        row = {"move": name, "generator": generator, "single": summary(counts[QUESTION])}
        rows.append({**row, "many": summary(count_many(counter, move))})
    return {"goal": GOAL, "generator_worst_mean": worst, "moves": rows}


def table(result: dict[str, object]) -> str:
    lines = [
        f"{'':32}{'next tick':>24}{'laid one at a time':>24}{f'laid {MANY} at once':>24}",
        f"{'instructions a pulse':32}" + "  median    mean     max" * 3,
    ]
    rows = result["moves"]
    assert isinstance(rows, list)
    for row in rows:
        cells = "".join(
            f"{row[part]['median']:8.0f}{row[part]['mean']:8.1f}{row[part]['max']:8.0f}"
            for part in ("generator", "single", "many")
        )
        lines.append(f"{row['move']:32}{cells}")
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description="Counts instructions a pulse on Cortex-M4.")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    try:
        result = measure()
    except Missing as missing:
        print(f"arm_count: {missing}", file=sys.stderr)
        return 1
    print(json.dumps(result) if options.json else table(result))
    return 0


if __name__ == "__main__":
    sys.exit(main())
