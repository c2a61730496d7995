"""Flash, RAM and the deepest stack of an image, beside their budgets.

The stack is proved from what the compiler wrote beside the objects (-fcallgraph-info=su): the
deepest chain of main and, on top of it, one interrupt of each priority with the frame that the
processor pushes. The fault handlers begin a stack of their own.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

from rkm04_tools.objects import RAM_CODE, Graph, binutil, short
from rkm04_tools.tree import ROOT

BUDGETS = ROOT / "hal/stm32/budgets.json"

# Calls through a pointer, which the compiler does not see: who calls, and what. An image has one
# unit.
POINTER_CALLS = {
    **{function: {"{unit}_lay_isr"} for function in ("ask", "append", "begin", "refill")},
    "stm32_tick_interrupt": {"{unit}_tick_isr"},
    "stm32_edge_interrupt": {"{unit}_tick_isr"},
    "look_at_inputs": {"{unit}_tick_isr"},
    "stm32_plan_interrupt": {"{unit}_plan_isr"},
    "group_set_speeds": {"{unit}_speed_of"},
    "messages_answer": {
        *("answer_version", "answer_set_command", "answer_store_flash", "answer_get_position"),
        *("answer_get_command", "answer_get_table", "answer_get_progress", "answer_get_status"),
    },
}
# Folders of the build whose objects are not of the image.
OTHERS = {"CompilerIdC", "rkm04_bench.dir", "paths_image.dir"}
UNITS = ("rkm04", "gve134", "positioning")
INDIRECT = "__indirect_call"

# Functions of the compiler's libraries come without figures; these are above what their code pushes
# (memcpy 12 bytes; a division 16 and another 32 in what it calls) in any release.
LIBRARY_FRAMES = {
    "memcmp": 32,
    "memcpy": 32,
    "memset": 32,
    "strlen": 32,
    "__aeabi_uldivmod": 96,
    "__aeabi_ldivmod": 96,
    "__assert_func": 0,
}

# Main, then the interrupts from the lowest priority to the highest; those of one priority come one
# after the other.
LEVELS = (
    ("main",),
    ("stm32_plan_interrupt",),
    ("stm32_tick_interrupt", "stm32_edge_interrupt"),
    ("stm32_line_interrupt", "stm32_step_refill_interrupt"),
    ("stm32_step_interrupt",),
)
# What boards have whose STEP pins an interrupt writes.
SOME_BOARDS = {"stm32_step_refill_interrupt"}
RESET_FRAME = 32  # of the code that calls main
# Eight words and one to align them (PM0214 2.3.7); a fault pushes one more before its stack is new.
EXCEPTION_FRAME = 36

FLASH = range(0x0800_0000, 0x0802_0000)
RAM = (RAM_CODE, range(0x1000_0000, 0x1001_0000), range(0x2000_0000, 0x2002_0000))
LOADED = (".first_vectors", ".main_only", ".ram", ".text")


class Unknown(Exception):
    """A call whose stack is not known."""


@dataclass(frozen=True)
class Sizes:
    """Bytes; the stack is the deepest that can be needed."""

    flash: int
    ram: int
    stack: int


def call_graph(folder: Path, unit: str = "") -> Graph:
    """Everything that was compiled for the image; of a unit, without what is of the others."""
    graph = Graph()
    others = {("firmware", other) for other in UNITS if unit and other != unit}
    for path in sorted(folder.rglob("*.ci")):
        if not OTHERS.intersection(path.parts) and not others.intersection(pairwise(path.parts)):
            graph.add_calls(path)
    return graph


def deepest(function: str, graph: Graph, path: tuple[str, ...] = (), unit: str = "rkm04") -> int:
    """The deepest stack below and with a function."""
    name = short(function)
    if function in path:
        raise Unknown(f"recursion through {name}")
    if function not in graph.frames:
        if name in LIBRARY_FRAMES:
            return LIBRARY_FRAMES[name]
        raise Unknown(f"nothing is known of {name}, called by {short(path[-1]) if path else '-'}")
    callees = set(graph.calls.get(function, set()))
    if INDIRECT in callees:
        if name not in POINTER_CALLS:
            raise Unknown(f"{name} calls through a pointer; add it to POINTER_CALLS")
        callees.remove(INDIRECT)
        named = {call.format(unit=unit) for call in POINTER_CALLS[name]}
        callees |= {known for known in graph.frames if short(known) in named}
    below = [deepest(callee, graph, (*path, function), unit) for callee in sorted(callees)]
    return graph.frames[function] + max(below, default=0)


def stack_parts(graph: Graph, unit: str) -> dict[str, int]:
    """What each priority needs, frames included."""
    absent = SOME_BOARDS - graph.frames.keys()
    parts = {
        level[0]: max(deepest(root, graph, unit=unit) for root in level if root not in absent)
        + EXCEPTION_FRAME
        for level in LEVELS
    }
    parts["main"] += RESET_FRAME
    return parts


def sections(image: Path) -> dict[str, tuple[int, int]]:
    """Size and address of each section that the image has in memory."""
    found = {}
    for line in binutil("size", "-A", image):
        name, *rest = line.split() or [""]
        if name.startswith(".") and len(rest) == 2:
            size, address = map(int, rest)
            if any(address in memory for memory in (FLASH, *RAM)):
                found[name] = (size, address)
    return found


def measure(image: Path, folder: Path, unit: str = "rkm04") -> Sizes:
    found = sections(image)
    return Sizes(
        flash=sum(found[name][0] for name in LOADED),
        ram=sum(size for size, address in found.values() if address not in FLASH),
        stack=sum(stack_parts(call_graph(folder, unit), unit).values()),
    )


def budgets(unit: str = "rkm04") -> Sizes:
    values = json.loads(BUDGETS.read_text())
    values |= values.get(unit, {})
    return Sizes(**{name: values[f"{name}_bytes"] for name in asdict(Sizes(0, 0, 0))})
