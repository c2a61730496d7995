"""What the document of the positioning unit tells is what tools and firmware have."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rkm04_tools.completion import commands_of, offered
from rkm04_tools.positioning.cli import make_parser
from rkm04_tools.positioning.state import ERRORS, FAULTS
from rkm04_tools.positioning.table import instructions
from served import Served

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "firmware/positioning/docs/unit.md").read_text(encoding="utf-8")
CONTRACT_COMMANDS = (
    "serve scan status watch init mode feed hold go reset move home settings registers sim bench "
    "board completion"
)


def test_the_errors_are_those_that_the_tool_knows():
    rows = re.findall(r"^\| (\d+) \| (refused|fault) \|", PAGE, re.MULTILINE)

    assert {int(number) for number, _ in rows} == set(ERRORS)
    assert {int(number) for number, kind in rows if kind == "fault"} == set(FAULTS)


def test_the_instructions_have_their_codes():
    found = re.findall(r"^\| (POS_\w+) \| (\d+) \|", PAGE, re.MULTILINE)

    assert {name: int(code) for name, code in found} == instructions()


def test_the_first_move_of_the_page_moves(
    pos_serve: Callable[..., Served], capsys: pytest.CaptureFixture[str]
):
    [block] = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert block.count("\n") <= 10

    exec(block.replace("socket://127.0.0.1:5000", pos_serve().place), {})

    assert capsys.readouterr().out == "10000\n"


def test_every_command_is_there_and_offered():
    parser = make_parser()

    assert set(CONTRACT_COMMANDS.split()) <= set(offered(parser, [""]))
    assert offered(parser, ["settings", "res"]) == ["restore"]
    assert all("example:" in (c.epilog or "example:") for _, c in commands_of(parser))


def test_bench_measures_on_this_machine(positioning: Callable[..., Any]):
    told = positioning("bench", "--json").json

    assert set(told) == {
        "simulated_moves_per_s", "simulated_times_real_time", "request_us",
        "moves_per_s_over_the_line",
    }  # fmt: skip
    assert all(value > 0 for value in told.values())
