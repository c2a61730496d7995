"""The blocks of tools/plc/positioning.st, run as they stand there, in a modelled PLC."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from checks.plc import LIBRARY
from plc_cycle import Line, Plc
from st_program import Blocks

POWER_CYCLES = 40


@pytest.fixture(scope="session")
def plc_blocks() -> Blocks:
    """The blocks of the library."""
    return Blocks(LIBRARY.read_text(encoding="utf-8"))


@pytest.fixture
def make_plc(plc_blocks: Blocks) -> Callable[..., Plc]:
    """A PLC on a line of its own."""

    def make(seed: int = 0, **line: Any) -> Plc:
        return Plc(plc_blocks, line=Line(**line), seed=seed)

    return make


@pytest.fixture
def plc(make_plc: Callable[..., Plc]) -> Plc:
    """A PLC whose unit answers, and whose axis 1 has power."""
    made = make_plc()
    made.power()
    return made
