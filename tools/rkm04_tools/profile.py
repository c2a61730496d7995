"""Where the cycles of an interrupt go: the virtual board's profile, with the names of the image.

The virtual board counts the cycles of each instruction for each exception (`--profile`). Here they
are put together by function, by what the compiler has inlined, and by register.
"""

from __future__ import annotations

import csv
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rkm04_tools.objects import binutil
from rkm04_tools.table import table

TIMER = range(0x4000_0000, 0x4000_0400)
TIMER_REGISTERS = {
    0x00: "CR1", 0x0C: "DIER", 0x10: "SR", 0x14: "EGR", 0x18: "CCMR1", 0x1C: "CCMR2",
    0x20: "CCER", 0x24: "CNT", 0x34: "CCR1", 0x38: "CCR2", 0x3C: "CCR3", 0x40: "CCR4",
}  # fmt: skip
STEP_INTERRUPT = 16 + 28
SHOWN_MIN = 0.05
ENTRY, EXIT, OTHER = "entry", "exit", "other"

SYMBOL = re.compile(r"([0-9a-f]+) [tT] (\S+)")
CODE = re.compile(r"\s*([0-9a-f]+):\t(?:[0-9a-f]+ )+\s*\t(.*)")
HEADING = re.compile(r"[0-9a-f]+ <(.+)>:")
HEAD = ("cycles a step", "share", "what")
LISTING_HEAD = ("cycles a step", "times a step", "waits", "address", "instruction", "inlined from")


@dataclass(frozen=True)
class Row:
    """An instruction, or the entry to an exception or the exit from it (`place`)."""

    address: int
    place: str
    count: int
    cycles: int
    bus_cycles: int
    register: int

    @property
    def timer_register(self) -> str:
        """The register of the step timer that it accesses, or nothing."""
        if self.register not in TIMER:
            return ""
        return TIMER_REGISTERS.get(self.register - TIMER.start, f"+{self.register & 0x3FF:02x}")


@dataclass(frozen=True)
class Names:
    """What an image calls its addresses."""

    symbols: Sequence[tuple[int, str]]
    inlined: Mapping[int, tuple[str, str]]
    """Of an address: the innermost function, and FILE:LINE."""
    code: Mapping[int, str]

    def function(self, address: int) -> str:
        """The function that an address lies in, as the linker sees it."""
        before = [name for begin, name in self.symbols if begin <= address]
        return before[-1] if before else "?"


def read(path: Path, exception: int = STEP_INTERRUPT) -> list[Row]:
    """The rows of one exception."""
    rows = []
    with path.open() as file:
        for line in csv.DictReader(file):
            if int(line["exception"]) != exception:
                continue
            place = line["address"] if line["address"] in (ENTRY, EXIT, OTHER) else ""
            address = 0 if place else int(line["address"], 16)
            count, cycles, waits = (int(line[name]) for name in ("count", "cycles", "bus_cycles"))
            rows.append(Row(address, place, count, cycles, waits, int(line["register"] or "0", 16)))
    return rows


def names_of(image: Path, rows: Iterable[Row]) -> Names:
    """Ask the image for the names of all rows."""
    addresses = [row.address for row in rows if not row.place]
    found = [match for line in binutil("nm", image) if (match := SYMBOL.match(line))]
    symbols = sorted((int(match[1], 16) & ~1, match[2]) for match in found if match[2][0] != "$")
    code = {}
    for line in binutil("objdump", "-d", image):
        if match := CODE.match(line):
            code[int(match[1], 16)] = re.sub(r"\s+", " ", match[2].partition("@")[0]).strip()
    return Names(symbols, _inlined(image, addresses), code)


def _inlined(image: Path, addresses: Sequence[int]) -> dict[int, tuple[str, str]]:
    if not addresses:
        return {}
    lines = binutil("addr2line", "-f", "-e", image, *map(hex, addresses))
    places = zip(lines[::2], lines[1::2], strict=True)
    return {
        address: (function, place.partition(" (")[0])
        for address, (function, place) in zip(addresses, places, strict=True)
    }


@dataclass(frozen=True)
class Profile:
    """The rows of the step interrupt, and how many steps they made."""

    rows: Sequence[Row]
    names: Names
    steps: int

    @property
    def cycles(self) -> int:
        """All of them."""
        return sum(row.cycles for row in self.rows)

    def by_function(self) -> dict[str, int]:
        """Cycles of each function that the linker sees; entry and exit too."""
        return self._sum(lambda row: row.place or self.names.function(row.address))

    def by_source(self) -> dict[str, int]:
        """Cycles of each function of the source, inlined or not."""
        return self._sum(lambda row: row.place or self.names.inlined[row.address][0])

    def by_register(self) -> dict[str, int]:
        """Cycles of the instructions that access the step timer, by the register."""
        accesses = [row for row in self.rows if row.timer_register]
        found: dict[str, int] = defaultdict(int)
        for row in accesses:
            found[row.timer_register] += row.cycles
        return _sorted(found)

    @property
    def accesses(self) -> int:
        """How often the step timer was accessed."""
        return sum(row.count for row in self.rows if row.timer_register)

    @property
    def waits(self) -> int:
        """Cycles that accesses have waited for the bus; a part of those by register."""
        return sum(row.bus_cycles for row in self.rows if row.timer_register)

    def _sum(self, name: Callable[[Row], str]) -> dict[str, int]:
        found: dict[str, int] = defaultdict(int)
        for row in self.rows:
            found[name(row)] += row.cycles
        return _sorted(found)

    def a_step(self, number: int) -> float:
        """A number of the whole, for each step."""
        return number / max(self.steps, 1)

    def as_json(self) -> dict[str, Any]:
        """The same sums, in cycles a step."""
        parts = {
            "functions": self.by_function(),
            "sources": self.by_source(),
            "timer_registers": self.by_register(),
        }
        facts = {
            name: {what: round(self.a_step(cycles), 2) for what, cycles in sums.items()}
            for name, sums in parts.items()
        }
        waits = round(self.a_step(self.waits), 2)
        whole = round(self.a_step(self.cycles), 2)
        return {"steps": self.steps, "cycles_a_step": whole, **facts, "timer_waits": waits}

    def text(self) -> str:
        """The tables."""
        parts = [
            ("by function", self.by_function()),
            ("by function of the source", self.by_source()),
            ("instructions that access the step timer", self.by_register()),
        ]
        text = [f"{self.a_step(self.cycles):.1f} cycles a step, {self.steps} steps"]
        for title, sums in parts:
            cells = [
                (f"{self.a_step(cycles):.1f}", f"{100 * cycles / max(self.cycles, 1):.1f} %", what)
                for what, cycles in sums.items()
                if self.a_step(cycles) >= SHOWN_MIN
            ]
            text += ["", f"{title}:", table([HEAD, *cells], "rrl")]
        timer = sum(self.by_register().values())
        accesses = (self.a_step(self.accesses), self.a_step(timer), self.a_step(self.waits))
        told = "step timer: {:.1f} accesses a step, {:.1f} cycles, of which {:.1f} wait for the bus"
        return "\n".join([*text, told.format(*accesses)])

    def listing(self) -> str:
        """Every instruction that was executed, in the order of the image."""
        lines: list[Sequence[str]] = [LISTING_HEAD]
        function = ""
        for row in sorted(self.rows, key=lambda row: row.address):
            if row.place:
                continue
            if (name := self.names.function(row.address)) != function:
                function = name
                lines.append(("", "", "", "", f"<{name}>", ""))
            inlined, place = self.names.inlined[row.address]
            register = f"  [{row.timer_register}]" if row.timer_register else ""
            lines.append(
                (
                    f"{self.a_step(row.cycles):.2f}",
                    f"{self.a_step(row.count):.3f}",
                    f"{self.a_step(row.bus_cycles):.2f}" if row.bus_cycles else "",
                    f"{row.address:08x}",
                    self.names.code.get(row.address, "?") + register,
                    f"{inlined} {place.rpartition('/')[2]}",
                )
            )
        return table(lines, "rrrlll")


def _sorted(sums: Mapping[str, int]) -> dict[str, int]:
    return dict(sorted(sums.items(), key=lambda item: -item[1]))


def of_run(path: Path, image: Path, steps: int) -> Profile:
    """The profile that a run has written."""
    rows = read(path)
    return Profile(rows, names_of(image, rows), steps)
