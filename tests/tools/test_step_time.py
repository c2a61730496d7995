"""The longest ways through the step interrupt: of small code, and against the virtual board."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from rkm04_tools import board, longest, profile, step_time, target_run, virtual_board
from rkm04_tools.longest import Facts, Longest, Unknown
from rkm04_tools.objects import RAM_CODE
from rkm04_tools.target_run import GATE, Move

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
APB = range(0x4000_0000, 0x4002_0000)

needs_compiler = pytest.mark.skipif(
    not shutil.which(board.COMPILER), reason="the compiler for ARM is missing"
)
needs_board = pytest.mark.skipif(
    not (BUILD / "bin" / virtual_board.PROGRAM).is_file(), reason="the virtual board is missing"
)

CODE = """
        .syntax unified
        .thumb
        .thumb_func
        .type plain, %function
plain:  add r0, r1
        bx lr
        .type loop, %function
        .thumb_func
loop:   subs r0, #1
        bne loop
        bx lr
        .type either, %function
        .thumb_func
either: cbz r0, 1f
        udiv r0, r1, r2
        b 2f
1:      nop
2:      bx lr
        .type caller, %function
        .thumb_func
caller: push {r4, lr}
        bl either
        bl plain
        pop {r4, pc}
        .type again, %function
        .thumb_func
again:  push {lr}
        bl again
        pop {pc}
        .type pointer, %function
        .thumb_func
pointer: push {lr}
        blx r3
        pop {pc}
        .type table, %function
        .thumb_func
table:  tbb [pc, r0]
        bx lr
        .type middle, %function
        .thumb_func
middle: cbz r0, 2f
1:      subs r0, #1
2:      cbz r1, 3f
        subs r1, #1
        b 1b
3:      bx lr
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("longest")
    (folder / "code.s").write_text(CODE)
    image: Path = folder / "code.elf"
    subprocess.run(
        [board.COMPILER, "-mcpu=cortex-m4", "-nostdlib", "-Wl,-Ttext=0x400", "-Wl,-e,plain",
         "-o", image, folder / "code.s"],
        check=True,
    )  # fmt: skip
    return image


def of_small(image: Path, name: str, never: frozenset[str] = frozenset(), rounds: int = 9) -> int:
    facts = Facts(
        rounds=lambda function, address: rounds,
        called={"pointed": "plain"},
        never=never,
        on_bus=lambda address: False,
        source=lambda address: "pointed" if name == "pointer" else "?",
        quotient_bits=32,
        refill=3,
    )
    return Longest(longest.functions_of(image), facts).named(name)


@needs_compiler
@pytest.mark.parametrize(
    ("name", "cycles"),
    [
        ("plain", 1 + 4),
        ("loop", 10 * (1 + 4) + 4),
        ("either", 4 + 12 + 4 + 4),
        ("caller", 3 + 4 + 24 + 4 + 5 + 3 + 3),
        ("pointer", 2 + 4 + 5 + 2 + 3),
        ("middle", 4 + 1 + 4 + 9 * (1 + 4 + 1 + 4) + 4),
    ],
)
def test_the_longest_way_counts_the_dearer_branch_all_rounds_and_what_is_called(
    small, name, cycles
):
    assert of_small(small, name) == cycles


@needs_compiler
def test_a_way_to_what_is_never_called_does_not_count(small):
    with pytest.raises(Unknown, match="never returns"):
        of_small(small, "caller", frozenset({"plain"}))


@needs_compiler
@pytest.mark.parametrize(
    ("name", "why"),
    [("again", "recursion"), ("table", "table of branches"), ("absent", "0 in the image")],
)
def test_what_cannot_be_told_is_an_error(small, name, why):
    with pytest.raises(Unknown, match=why):
        of_small(small, name)


@needs_compiler
@needs_board
def test_nothing_takes_longer_on_the_virtual_board_than_the_longest_ways_say(tmp_path):
    """Four motors up to 200 000 steps/s and down again, each instruction of the step interrupt."""
    rig = target_run.rig(tmp_path)
    moves = [Move(20_000, 30_000, 200_000, 4_000_000)] * 4

    ran = rig.run_moves(moves, "--profile", str(tmp_path / "profile.csv"))

    rows = [row for row in profile.read(ran.profile_file) if not row.place]
    assert target_run.ended_well(ran, moves)
    code = step_time.Code(rig.bench_elf, "rkm04", GATE)
    assert not [row for row in rows if row.register in APB and not code.is_on_bus(row.address)]
    assert not too_long(code, rows)
    ways = step_time.ways(rig.bench_elf, "rkm04", GATE)
    portions = sum(row.count for row in rows if row.address == entry_of(code, "refill"))
    step = ran.step_interrupt
    others = portions - step["count"]
    at_most = (
        step["count"] * ways.interrupt + others * ways.portion + ran.pulses * ways.ramp
        + 12 * ways.segment
    )  # fmt: skip
    assert at_most / 3 < step["cycles"] < at_most


def too_long(code: step_time.Code, rows: list[profile.Row]) -> list[str]:
    """Blocks that took longer than they are priced; a profile counts IT and its block as one."""
    found, by_address = code.longest(step_time.NEVER), {row.address: row for row in rows}
    wrong = []
    for address, function in code.functions.items():
        prices = found.prices(address) if address in RAM_CODE else {}
        for start, block in function.blocks.items():
            ran = [by_address[one.address] for one in block if one.address in by_address]
            if ran and sum(row.cycles for row in ran) > ran[0].count * sum(
                prices[one.address] for one in block
            ):
                wrong.append(f"{function.name} {start:#x}")
    return wrong


def entry_of(code: step_time.Code, name: str) -> int:
    (address,) = [at for at, function in code.functions.items() if function.name == name]
    return address
