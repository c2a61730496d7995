"""How long the step interrupt takes at most: the longest ways through the machine code of an image.

All is said of motors in the middle of a motion, from 30 000 steps/s on, none of whose pulses is
late. Then what is predicted on a ramp is one tick off at most: the part of the acceleration that
changes an interval within itself is A^2/v^5 < 0.3 ticks, with A up to 8 000 000 steps/s^2 and v in
steps a tick, and words of 32 bits leave 0.02. So a pulse costs a prediction and a step of a tick.
Only the first pulses of a segment may need a search, of up to 34 rounds (tests/proofs/README.md).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rkm04_tools import board
from rkm04_tools.longest import Facts, Longest, Unknown, functions_of
from rkm04_tools.objects import RAM_CODE, binutil
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_run import Model, Rig
from rkm04_tools.tree import ROOT

HZ = 168_000_000
PULSES_PER_S = 4 * 200_000
TIMES = "hal/stm32/stm32_step_private.h"
LOOK_US = 1
"""Until a look at the counter counts."""
EXCEPTION = 12 + 5 + 10
"""The entry with its vector in the flash, and the return."""

INTERRUPT, SEARCH = "stm32_step_interrupt", "step_generator_search"
NEVER = frozenset((
    "turn", "wait_for_turn", "stop", "channel_heed", "channel_leave_room",
    "step_channel_keep_nothing", "check_loaded", "stm32_fault_stop_output",
))  # fmt: skip
"""What a motor in the middle of its motion does not come to: turns, ends, changes, late pulses."""
POINTERS = ("ask", "append", "begin", "refill")
"""Where the unit is asked for pulses; the compiler puts some into others."""

RAMP = ("step_generator_guess", "step_lay_ramp")
CRUISE = ("step_lay_cruise",)
SEGMENTS = ("channel_lay", "channel_lay_first", "step_lay_goes_on")
PORTIONS = (INTERRUPT,)
ROUNDS = {
    **dict.fromkeys((*RAMP, *CRUISE, *SEGMENTS, *PORTIONS), 0),
    "look": 3,  # and the first: four motors
    "make_good": 0,  # none is late
    "search_from": 34,
}
"""By the function that a loop is in, of the source or of the image; 0: counted by itself."""

QUOTIENT_BITS = 12
"""An interval at 30 000 steps/s and more, in ticks."""
REGISTERS = re.compile(r"\bTIM\d?_[A-Z]|channel->clear|\.compare\b|channel->asks|->mode\b")
"""What accesses a register on APB, in a line of the source."""
RING = re.compile(r"#define IMAGE_STEP_RING_PULSES (\d+)\n")
PLACE = re.compile(r"(.*):(\d+)")


@dataclass(frozen=True)
class Ways:
    """Cycles at most."""

    interrupt: int
    """That serves one motor, which gets one pulse."""
    portion: int
    """Of each further motor in the same interrupt."""
    ramp: int
    """Of each further pulse, on a ramp."""
    cruise: int
    """... at constant speed."""
    segment: int
    """Of each segment that begins."""

    def load(self, pulses_per_s: float, ring: int, pulse: int) -> float:
        """Percent, where each interrupt serves one motor that gets a long portion."""
        portions = portions_of(ring)
        cycles = sum(self.interrupt + (count - 1) * pulse for count in portions)
        return 100 * pulses_per_s * cycles / sum(portions) / HZ

    def last_of_four_us(self, ring: int) -> float:
        """Until the last of four motors that are due at once has its turn, on ramps."""
        first = self.interrupt + (max(portions_of(ring)) - 1) * self.ramp
        return (first + 2 * (self.portion + (_number("LAY_FAST_MAX") - 1) * self.ramp)) / HZ * 1e6


def left_us() -> int:
    """The time in which a motor that is due must have its turn."""
    return _number("LEAD_TICKS") - _number("APPEND_TICKS") - LOOK_US


def portions_of(ring: int) -> list[int]:
    """Of fast pulses with time, once round a ring."""
    bound, large, small = map(int, _found(r"LAY_LONG_MAX = RING_PULSES >= (\d+) \? (\d+) : (\d+),"))
    long = large if ring >= bound else small
    return [long] * (ring // long) + [ring % long] * (ring % long > 0)


def _number(name: str) -> int:
    """Of the driver's numbers, of times the us."""
    return int(_found(rf"\b{name} = (\d+)\b")[0])


def _found(pattern: str) -> tuple[str, ...]:
    match = re.search(pattern, "\n".join(_lines(TIMES)))
    if match is None:
        raise Unknown(f"{TIMES}: {pattern} is not there")
    return match.groups()


def ring_of(unit: str) -> int:
    """Pulses of a unit's ring."""
    (pulses,) = RING.findall(board.image_header(unit))
    return int(pulses)


def ways(image: Path, unit: str, model: Model) -> Ways:
    """Of an image with debug information."""
    code = Code(image, unit, model)
    fast, any_pulse = code.longest(NEVER | {SEARCH}), code.longest(NEVER)
    interrupt = EXCEPTION + fast.named(INTERRUPT)
    any_pulse.named(INTERRUPT)
    return Ways(
        interrupt=interrupt,
        portion=code.round(fast, PORTIONS),
        ramp=code.round(fast, RAMP),
        cruise=code.round(fast, CRUISE),
        segment=code.round(fast, SEGMENTS) + code.round(any_pulse, SEGMENTS),
    )


def figures(rig: Rig) -> Figures:
    """For the bench: what the step interrupt takes of the processor at most, in percent."""
    found, ring = ways(rig.elf, rig.image.unit, rig.model), ring_of(rig.image.unit)
    return {
        "longest_ramps": found.load(PULSES_PER_S, ring, found.ramp),
        "longest_cruise": found.load(PULSES_PER_S, ring, found.cruise),
        "longest_due": found.last_of_four_us(ring),
    }


class Code:
    """The code of an image, and the lines of the source that it is from."""

    def __init__(self, image: Path, unit: str, model: Model) -> None:
        self.functions = functions_of(image)
        self._unit, self._model = unit, model
        addresses = [
            instruction.address
            for function in self.functions.values()
            for instruction in function.code
            if instruction.address in RAM_CODE
        ]
        lines = binutil("addr2line", "-f", "-e", image, *map(hex, addresses))
        places = zip(lines[::2], lines[1::2], strict=True)
        self._places = dict(zip(addresses, places, strict=True))

    def longest(self, never: frozenset[str]) -> Longest:
        """Ways that do not come to some functions."""
        facts = Facts(
            rounds=lambda function, address: _rounds(function, self._places[address][0]),
            called=dict.fromkeys(POINTERS, f"{self._unit}_lay_isr"),
            never=never,
            on_bus=self.is_on_bus,
            source=lambda address: self._places[address][0],
            quotient_bits=QUOTIENT_BITS,
            refill=self._model.refill,
        )
        return Longest(self.functions, facts)

    def round(self, longest: Longest, names: tuple[str, ...]) -> int:
        """Of the longest loop that begins in one of these functions of the source."""
        rounds = longest.round_cycles.items()
        found = [cycles for head, cycles in rounds if self._places[head][0] in names]
        if not found:
            raise Unknown(f"{names[0]}: no loop")
        return max(found)

    def is_on_bus(self, address: int) -> bool:
        """Whether an instruction is of a line of the source that accesses a register on APB."""
        match = PLACE.match(self._places[address][1])
        if match is None or "/hal/stm32/" not in match[1]:
            return False
        lines = _lines(match[1][match[1].rindex("/hal/stm32/") + 1 :])
        return bool(REGISTERS.search(lines[int(match[2]) - 1]))


def _rounds(function: str, source: str) -> int:
    name = function if function in ROUNDS and source not in ROUNDS else source
    if name not in ROUNDS:
        raise Unknown(f"{function}, from {source}: a loop without a bound")
    return ROUNDS[name]


@cache
def _lines(path: str) -> list[str]:
    return (ROOT / path).read_text().splitlines()
