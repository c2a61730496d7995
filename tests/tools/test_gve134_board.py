"""The image of the GVE134 unit: what it needs, and `gve134 board`."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from checks import ram_code
from rkm04_tools import board, board_size
from rkm04_tools.failure import Failure
from rkm04_tools.gve134.cli import make_parser
from rkm04_tools.objects import binutil
from rkm04_tools.tree import ROOT

UNIT = "gve134"
STACK_MARGIN_BYTES = 256
NAMES = board.names(UNIT)

compiles = pytest.mark.skipif(
    not shutil.which(board.COMPILER),
    reason=f"{board.COMPILER} is not installed: run tools/setup test",
)


@pytest.fixture(scope="module", params=NAMES)
def image(request: pytest.FixtureRequest) -> board.Image:
    return board.build(request.param, what=UNIT)


def run(*arguments: str) -> int:
    options = make_parser().parse_args(["board", *arguments])
    status: int = options.run(options)
    return status


def shown(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    assert run(*arguments, "--json") == 0
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
def test_what_must_run_from_ram_does(image: board.Image) -> None:
    assert ram_code.main([UNIT, str(image.file("elf"))]) == 0


@compiles
def test_only_its_own_unit_is_in_the_image(image: board.Image) -> None:
    symbols = "\n".join(binutil("nm", image.file("elf")))

    assert " gve134_poll\n" in symbols
    assert "rkm04_" not in symbols


@compiles
def test_the_version_is_baked_in(image: board.Image) -> None:
    assert board.version(UNIT).startswith("IP134/200 ")
    assert board.version(UNIT).encode() in image.file("bin").read_bytes()


@compiles
def test_build_names_the_files_and_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    told = shown(capsys, "build")

    assert told["version"] == board.version(UNIT)
    assert [Path(name).name for name in told["files"]] == [
        f"gve134-f405.{kind}" for kind in ("elf", "hex", "bin")
    ]
    assert all((ROOT / name).is_file() for name in told["files"])


@compiles
def test_size_shows_its_own_budgets(capsys: pytest.CaptureFixture[str]) -> None:
    told = shown(capsys, "size")

    assert told["over"] == []
    assert told["stack"]["budget"] == board_size.budgets(UNIT).stack


@compiles
def test_a_dry_run_flashes_the_image_of_the_unit(capsys: pytest.CaptureFixture[str]) -> None:
    assert "gve134-f405.elf verify reset exit" in " ".join(
        shown(capsys, "flash", "--dry-run")["command"]
    )


def test_pins_are_those_that_the_unit_has(capsys: pytest.CaptureFixture[str]) -> None:
    rows = {row["signal"]: row for row in shown(capsys, "pins")["pins"]}

    assert rows["PWM"]["pin"] == "PB6"
    assert rows["PWM"]["what"] == "TIM4 channel 1, 1 kHz"
    assert rows["LED_8"]["pin"] == "PB7"
    assert not any(signal.startswith("S1_") for signal in rows)


@pytest.mark.parametrize("rate", board.RATES)
def test_each_rate_has_a_folder_of_its_own(rate: int) -> None:
    usual = rate == board.line_bd(UNIT)

    folder = board.image_of("f405", UNIT, rate).folder.name
    assert folder == ("stm32-gve134" if usual else f"stm32-gve134-{rate}")


def test_the_folders_of_rkm04_are_as_they_were() -> None:
    folders = {name: board.image_of(name).folder.name for name in board.names()}

    assert folders.pop("f405") == "stm32"
    assert folders == {name: f"stm32-{name}" for name in folders}


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("f407-discovery", "cannot be a unit gve134: its line is not on USART1"),
        ("skr-pro-1.2", "cannot be a unit gve134: its line is not on USART1"),
        ("nucleo", "nucleo: no such board; there are f405, weact-f405"),
    ],
)
def test_a_board_that_cannot_be_one_is_refused(name: str, why: str) -> None:
    assert name not in NAMES
    with pytest.raises(Failure, match=why):
        run("pins", "--board", name)


def test_a_rate_that_is_none_of_six_is_refused() -> None:
    with pytest.raises(Failure, match="--baud 19200 is none"):
        run("build", "--baud", "19200")
