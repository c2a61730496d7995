"""The unit of a page answers as one that is compiled for this machine, at any time."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from chance import SEED
from rkm04_tools.messages import (
    ALL_MOTORS,
    GET_POSITION,
    GET_PROGRESS,
    GET_STATUS,
    GET_TABLE,
    MOTORS,
    SET_COMMAND,
    STORE_FLASH,
    parse_positions,
    request,
)
from rkm04_tools.status import parse_status
from wasm_build import build_wasm

ROOT = Path(__file__).resolve().parents[2]
NATIVE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin"
MS = 1_000_000
SECOND = 1000 * MS
PROGRAMS = (
    "S100V800A2000F1000R", "S2000V16000A60000F200000RB200000R", "L3F500RW200DRW1000E",
    "F300YF200R", "T03F70RO1F5RT13", "\\C100", "K", "C75", "V3000",
)  # fmt: skip


def native(lines: str) -> list[str]:
    return subprocess.check_output([NATIVE / "session-probe"], input=lines, text=True).splitlines()


def in_wasm(lines: str) -> list[str]:
    node = Path(sys.executable).with_name("node")
    script, unit = ROOT / "tests/support/wasm_session.mjs", build_wasm() / "rkm04-unit.wasm"
    command: list[str | Path] = [node, "--no-warnings", script, unit]
    return subprocess.check_output(command, input=lines, text=True).splitlines()


def ask(message: bytes) -> str:
    return f"ask {message.hex()}\n"


def command(motor: int, text: str) -> str:
    return ask(request(SET_COMMAND, motor, text.encode("ascii")))


def drawn(chance: random.Random, moments: int) -> Iterator[str]:
    """A session: at any moments orders, inputs and questions, and what all motors do then."""
    now = 0
    for _ in range(moments):
        now += chance.choice((1, chance.randrange(MS), chance.randrange(700 * MS)))
        yield f"at {now}\n"
        motor = chance.choice((ALL_MOTORS, *MOTORS))
        yield chance.choice(
            (
                command(motor, chance.choice(PROGRAMS)),
                f"in {chance.randrange(1, 9)} {chance.randrange(2)}\n",
                ask(request(chance.choice((GET_TABLE, GET_PROGRESS, STORE_FLASH)), motor)),
            )
        )
        yield ask(bytes([GET_STATUS])) + ask(request(GET_POSITION, ALL_MOTORS))


def test_the_same_session_gives_the_same_bytes():
    lines = "".join(drawn(random.Random(SEED), 400))

    told = native(lines)

    assert in_wasm(lines) == told
    states = [parse_status(bytes.fromhex(line)) for line in told if line.startswith("c8")]
    assert len(states) == 400
    assert sum(any(motor.moving for motor in state.motors) for state in states) > 50


def positions(lines: Sequence[str]) -> list[list[int]]:
    found = [bytes.fromhex(line) for line in lines[:-1]]
    head = request(GET_POSITION, ALL_MOTORS)
    return [parse_positions(each, ALL_MOTORS) for each in found if each.startswith(head)]


WHERE = ask(request(GET_POSITION, ALL_MOTORS))


def test_a_caller_that_is_late_by_less_than_a_second_is_caught_up_with():
    lines = (
        command(1, "S1000V1000A1000F100000R") + f"at {SECOND // 10}\n{WHERE}at {SECOND}\n{WHERE}"
    )

    told = in_wasm(lines)

    assert [each[0] for each in positions(told)] == pytest.approx([100, 1000], abs=2)
    assert told[-1] == f"{SECOND} 0"


def test_time_stands_where_nobody_has_called_for_long():
    moves = command(1, "S1000V1000A1000F100000R") + f"at {SECOND // 2}\n{WHERE}"

    told = in_wasm(f"{moves}at {60 * SECOND}\n{WHERE}at {60 * SECOND + SECOND // 2}\n{WHERE}")

    assert [each[0] for each in positions(told)] == pytest.approx([500, 500, 1000], abs=2)
    assert told[-1] == f"{SECOND} {59 * SECOND + SECOND // 2}"


def test_programs_that_come_at_the_same_time_start_on_the_same_tick():
    long = "\\" + "V1000" * 300 + "S1000V1000A1000F100000R"
    lines = command(1, "\\S1000V1000A1000F100000R") + command(3, long)
    lines += "".join(f"at {ms * MS}\n{WHERE}" for ms in range(20, 400, 7))

    found = positions(native(lines))

    assert found[-1][0] > 300
    assert all(each[2] == each[0] for each in found)
