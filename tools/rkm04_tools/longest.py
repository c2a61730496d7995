"""The longest way through a function of an image, in cycles of a Cortex-M4.

It is found in the machine code: blocks from branch to branch, loops by their bounds, calls by the
longest way through what is called. An instruction costs what the virtual board counts
(tools/vboard/README.md), with the dearest operands and, on the bus, the dearest neighbours.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from rkm04_tools.objects import RAM_CODE, binutil

MULTIPLY_ADD, MEMORY = 2, 2
DIVISION_LEAST, DIVISION_BITS_PER_10 = 2, 32
BUS = 10 + 11
"""An access to APB1, and a transfer of the DMA or another write that goes first."""

CONDITIONS = "eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le"
HEADING = re.compile(r"([0-9a-f]+) <(.+)>:")
CODE = re.compile(r"\s*([0-9a-f]+):\t(\S+)(?:\t([^@]*))?")
TARGET = re.compile(r"([0-9a-f]+) <([^+>]+)(?:\+0x[0-9a-f]+)?>")
BRANCH = re.compile(rf"b({CONDITIONS})?|(cbn?z)")
RETURN = re.compile(rf"(bx|pop|ldm\w*?)({CONDITIONS})?")
INDEXED = re.compile(r"\[\w+, *(r\d|ip|lr|sl|fp)")
PIPELINED = re.compile(r"ldr(s?[bh])?")
END = -1
"""Where a return leads."""


class Unknown(Exception):
    """The way cannot be told; why."""


@dataclass(frozen=True)
class Instruction:
    """One of a function; its mnemonic is without the width."""

    address: int
    name: str
    operands: str

    @cached_property
    def target(self) -> int | None:
        """Where a direct branch or call leads."""
        match = TARGET.search(self.operands)
        return int(match[1], 16) if match else None

    @cached_property
    def is_branch(self) -> bool:
        """Whether it goes elsewhere, and does not come back."""
        return bool(BRANCH.fullmatch(self.name))

    @cached_property
    def is_call(self) -> bool:
        """Direct or by a register."""
        return self.name in ("bl", "blx")

    @cached_property
    def is_return(self) -> bool:
        """Whether it ends the function."""
        writes_pc = bool(re.search(r"\bpc\b", self.operands))
        return bool(RETURN.fullmatch(self.name)) and (writes_pc or self.name.startswith("bx"))

    @cached_property
    def is_conditional(self) -> bool:
        """Whether a branch or a return may not be taken."""
        match = BRANCH.fullmatch(self.name) or RETURN.fullmatch(self.name)
        return bool(match and (match[match.lastindex or 0] in CONDITIONS.split("|") or match[2]))

    @property
    def is_memory(self) -> bool:
        """Whether it loads or stores one word or less."""
        return bool(re.match(r"(ldr|str)", self.name))

    def follows_load(self, before: Instruction | None) -> bool:
        """Whether it is pipelined with the one before: a load that does not give its address."""
        if before is None or not PIPELINED.fullmatch(before.name):
            return False
        loaded = before.operands.partition(",")[0]
        return not re.search(rf"\[{loaded}\b", self.operands)

    def cycles(self, before: Instruction | None, refill_cycles: int, quotient_bits: int) -> int:
        """At most, without the bus, after the one before it in its block."""
        refill = refill_cycles if self.is_branch or self.is_call or self.is_return else 0
        if match := re.search(r"\{(.*)\}", self.operands):
            return 1 + _registers(match[1]) + refill
        if re.match(r"(ldrd|strd)", self.name):
            return MEMORY + 1
        if self.name.startswith("str") and not INDEXED.search(self.operands):
            return 1
        if self.is_memory:
            return MEMORY - self.follows_load(before)
        if re.match(r"[us]div", self.name):
            return DIVISION_LEAST - (-10 * quotient_bits // DIVISION_BITS_PER_10)
        if re.match(r"(mla|mls|[us]mlal|umaal)", self.name):
            return MULTIPLY_ADD
        return 1 + refill


def _registers(text: str) -> int:
    count = 0
    for part in text.split(","):
        low, _, high = part.strip().partition("-")
        count += int(high[1:]) - int(low[1:]) + 1 if high else 1
    return count


@dataclass
class Function:
    """Its instructions, in their order."""

    name: str
    code: list[Instruction] = field(default_factory=list)

    @cached_property
    def blocks(self) -> dict[int, list[Instruction]]:
        """By address, each up to what may go elsewhere."""
        starts = {instruction.target for instruction in self.code if instruction.is_branch}
        found: dict[int, list[Instruction]] = {}
        block: list[Instruction] = []
        for instruction in self.code:
            if not block or instruction.address in starts:
                block = found[instruction.address] = []
            block.append(instruction)
            if instruction.is_branch or instruction.is_return:
                block = []
        return found


def functions_of(image: Path) -> dict[int, Function]:
    """All of an image, by address."""
    found: dict[int, Function] = {}
    function = Function("")
    for line in binutil("objdump", "-d", "--no-show-raw-insn", image):
        if match := HEADING.fullmatch(line.strip()):
            function = found.setdefault(int(match[1], 16), Function(match[2]))
        elif (match := CODE.match(line)) and not match[2].startswith("."):
            name = re.sub(r"\.[nw]$", "", match[2])
            operands = (match[3] or "").strip()
            function.code.append(Instruction(int(match[1], 16), name, operands))
    for function in found.values():
        while function.code and function.code[-1].name == "nop":
            function.code.pop()
    return {address: function for address, function in found.items() if function.code}


@dataclass(frozen=True)
class Facts:
    """What the machine code does not tell."""

    rounds: Callable[[str, int], int]
    """How often the loop of a function that begins at an address is gone round at most."""
    called: Mapping[str, str]
    """What is called by a pointer, by the source's function."""
    never: frozenset[str]
    """What is not called on the ways in question."""
    on_bus: Callable[[int], bool]
    """Whether an instruction accesses a register on APB."""
    source: Callable[[int], str]
    """The function of the source that an instruction is from."""
    quotient_bits: int
    """Of a division, at most."""
    refill: int
    """What a taken branch costs more, cycles."""


Edges = Mapping[int, Mapping[int, int]]


class Longest:
    """The longest ways through an image; what has been found is kept."""

    def __init__(self, functions: Mapping[int, Function], facts: Facts) -> None:
        self._functions, self._facts = functions, facts
        self._found: dict[int, int | None] = {}
        self._under_way: set[int] = set()
        self.round_cycles: dict[int, int] = {}
        """Of one round of each loop, by the address of its begin."""

    def named(self, name: str) -> int:
        """Through the one function of that name."""
        addresses = [
            address for address, function in self._functions.items() if function.name == name
        ]
        if len(addresses) != 1:
            raise Unknown(f"{name}: {len(addresses)} in the image")
        if (cycles := self.of(addresses[0])) is None:
            raise Unknown(f"{name}: never returns")
        return cycles

    def of(self, address: int) -> int | None:
        """From a function's first instruction to its return; None: these ways do not return."""
        function = self._functions.get(address)
        if function is None:
            raise Unknown(f"{address:#x}: no function")
        if function.name in self._facts.never:
            return None
        if address not in RAM_CODE:
            raise Unknown(f"{function.name}: not in RAM")
        if address in self._under_way:
            raise Unknown(f"{function.name}: recursion")
        if address not in self._found:
            self._under_way.add(address)
            starts = list(function.blocks)
            edges = {
                start: self._edges(function, start, after)
                for start, after in zip(starts, [*starts[1:], None], strict=True)
            }
            ways = self._ways(function.name, set(edges), starts[0], edges)
            self._found[address] = ways.get(END)
            self._under_way.remove(address)
        return self._found[address]

    def prices(self, address: int) -> dict[int, int]:
        """What each instruction of a function costs at most, without what it calls."""
        return {
            instruction.address: self._price(before, instruction)
            for block in self._functions[address].blocks.values()
            for before, instruction in zip([None, *block], block, strict=False)
        }

    def _edges(self, function: Function, start: int, after: int | None) -> dict[int, int]:
        """The places that come after a block, and what it costs until then."""
        block = function.blocks[start]
        costs = [self._cost(*pair) for pair in zip([None, *block], block, strict=False)]
        if None in costs:
            return {}
        cycles, last = sum(cost for cost in costs if cost is not None), block[-1]
        found: dict[int, int] = {}
        if last.is_return:
            found[END] = cycles
        elif last.is_branch and last.target in function.blocks:
            found[last.target or 0] = cycles
        elif last.is_branch and (rest := self.of(last.target or 0)) is not None:
            found[END] = cycles + rest
        if last.is_conditional or not (last.is_branch or last.is_return):
            if after is None:
                raise Unknown(f"{function.name}: goes on after its end")
            found[after] = max(found.get(after, 0), cycles)
        return found

    def _cost(self, before: Instruction | None, instruction: Instruction) -> int | None:
        facts, address = self._facts, instruction.address
        cycles = self._price(before, instruction)
        if instruction.name.startswith("tb"):
            raise Unknown(f"{facts.source(address)}: a table of branches")
        if not instruction.is_call:
            return cycles
        if (target := instruction.target) is None:
            name = facts.called.get(facts.source(address))
            if name is None:
                raise Unknown(f"{facts.source(address)}: a call that is not known")
            return cycles + self.named(name)
        called = self.of(target)
        return None if called is None else cycles + called

    def _price(self, before: Instruction | None, instruction: Instruction) -> int:
        facts = self._facts
        waits = instruction.is_memory and facts.on_bus(instruction.address)
        return instruction.cycles(before, facts.refill, facts.quotient_bits) + waits * BUS

    def _ways(self, name: str, nodes: set[int], begin: int, edges: Edges) -> dict[int, int]:
        """The longest way from `begin` to each place outside `nodes`."""
        longest = {begin: 0}
        for component in _components(nodes, begin, edges):
            heads = [node for node in component if node in longest]
            rounds = []
            for head in heads:
                is_loop = len(component) > 1 or head in edges[head]
                ways = self._loop(name, set(component), head, edges) if is_loop else edges[head]
                rounds += [self.round_cycles.pop(head)] if is_loop else []
                for node, cycles in ways.items():
                    longest[node] = max(longest.get(node, 0), longest[head] + cycles)
            if rounds:
                self._keep_round(heads, max(rounds))
        return {node: way for node, way in longest.items() if node not in nodes}

    def _keep_round(self, heads: Sequence[int], cycles: int) -> None:
        """A loop that may be come to at some places is kept as one, by the first."""
        for head in heads:
            self.round_cycles.pop(head, None)
        self.round_cycles[heads[0]] = cycles

    def _loop(self, name: str, nodes: set[int], head: int, edges: Edges) -> dict[int, int]:
        """From the begin of a loop to the places after it."""
        opened = {
            node: {(~head if to == head else to): cost for to, cost in edges[node].items()}
            for node in nodes
        }
        ways = self._ways(name, nodes, head, opened)
        self.round_cycles[head] = ways.pop(~head)
        rounds = self._facts.rounds(name, head)
        return {to: way + rounds * self.round_cycles[head] for to, way in ways.items()}


def _components(nodes: Iterable[int], begin: int, edges: Edges) -> list[Sequence[int]]:
    """What is reached from `begin` within the nodes: what is by cycles, in order (Tarjan)."""
    inside = set(nodes)
    order: dict[int, int] = {begin: 0}
    low: dict[int, int] = {begin: 0}
    stack = [begin]
    work = [(begin, [to for to in edges[begin] if to in inside])]
    found: list[Sequence[int]] = []
    while work:
        node, left = work[-1]
        if left:
            to = left.pop()
            if to not in order:
                order[to] = low[to] = len(order)
                stack.append(to)
                work.append((to, [next_ for next_ in edges[to] if next_ in inside]))
            elif to in stack:
                low[node] = min(low[node], order[to])
            continue
        work.pop()
        if work:
            low[work[-1][0]] = min(low[work[-1][0]], low[node])
        if low[node] == order[node]:
            place = stack.index(node)
            found.append(stack[place:])
            del stack[place:]
    return found[::-1]
