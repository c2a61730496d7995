"""The image of the positioning unit: what it needs, and `positioning board`."""

from __future__ import annotations

import json
import shutil
from typing import Any

import pytest
from rkm04_tools import board, board_size
from rkm04_tools.objects import binutil
from rkm04_tools.positioning.cli import make_parser

UNIT = "positioning"
STACK_MARGIN_BYTES = 256

compiles = pytest.mark.skipif(
    not shutil.which(board.COMPILER),
    reason=f"{board.COMPILER} is not installed: run tools/setup test",
)


@pytest.fixture(scope="module")
def image() -> board.Image:
    return board.build(board.DEFAULT_BOARD, what=UNIT)


def shown(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    options = make_parser().parse_args(["board", *arguments, "--json"])
    assert options.run(options) == 0
    return json.loads(capsys.readouterr().out)


@compiles
def test_the_image_is_within_its_budgets(image: board.Image) -> None:
    sizes = board_size.measure(image.file("elf"), image.folder, UNIT)
    budgets = board_size.budgets(UNIT)

    assert sizes.flash <= budgets.flash
    assert sizes.ram <= budgets.ram
    assert sizes.stack <= budgets.stack


@compiles
def test_the_stack_has_a_margin(image: board.Image) -> None:
    region, _ = board_size.sections(image.file("elf"))[".stack"]

    assert board_size.budgets(UNIT).stack + STACK_MARGIN_BYTES <= region


@compiles
def test_only_its_own_unit_is_in_the_image(image: board.Image) -> None:
    symbols = "\n".join(binutil("nm", image.file("elf")))

    assert " positioning_poll\n" in symbols
    assert "rkm04_" not in symbols
    assert "gve134_" not in symbols


@compiles
def test_build_and_flash_are_of_this_unit(
    image: board.Image, capsys: pytest.CaptureFixture[str]
) -> None:
    assert shown(capsys, "build")["version"] == "01.00"
    command = " ".join(shown(capsys, "flash", "--dry-run")["command"])
    assert f"{image.name}.elf verify reset exit" in command


def test_pins_are_those_that_the_unit_has(capsys: pytest.CaptureFixture[str]) -> None:
    signals = {row["signal"] for row in shown(capsys, "pins")["pins"]}

    assert {"STEP_1", "DIR_4", "BI_8", "LED_4"} <= signals
    assert any(signal.startswith("S1_") for signal in signals)
