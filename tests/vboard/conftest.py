"""Compiles small images, written from the manuals of the part, and runs them on the board."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import pytest
from rkm04_tools import board
from step_acts import SHORT, Acts, MakeActs
from step_trials import TryTrains
from step_trials import try_trains as try_on_board
from virtual_board import VirtualBoard

ROOT = Path(__file__).resolve().parents[2]
IMAGES = Path(__file__).parent / "images"
COMPILER = "arm-none-eabi-gcc"
FLAGS = [
    "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft", "-std=gnu11", "-O2", "-g", "-Wall", "-Wextra",
    "-Werror", "-nostdlib", "-ffreestanding", "-fno-tree-loop-distribute-patterns",
]  # fmt: skip


@dataclass
class Run:
    """What a run said and wrote."""

    status: int
    told: str
    summary: dict[str, Any]
    folder: Path

    @property
    def result(self) -> list[int]:
        """What the image left in its array."""
        words = self.summary["watch"]["result"]
        assert self.summary["ended"] == "reached", self.summary["error"]
        assert words[31] == 0, f"unexpected exception {words[31] & 0x1FF}"
        return list(words)

    @cached_property
    def steps(self) -> list[tuple[int, ...]]:
        """Tick, motor and position of each pulse."""
        lines = (self.folder / "steps.csv").read_text().splitlines()[2:]
        return [tuple(map(int, line.split(","))) for line in lines]

    def vector(self, name: str) -> dict[str, int]:
        """The statistics of an exception."""
        return next(v for v in self.summary["vectors"] if name in (v["name"], str(v["number"])))

    @property
    def log(self) -> list[tuple[float, str]]:
        """Milliseconds and bytes that the image has sent."""
        lines = (self.folder / "log.txt").read_text().splitlines()
        return [(float(ms), byte) for ms, byte in map(str.split, lines)]


RunImage = Callable[..., Run]


@pytest.fixture(scope="session")
def program() -> Path:
    """The virtual board, where the build has put it."""
    path = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host") / "bin" / "rkm04-vboard"
    if not path.is_file():
        pytest.skip("the virtual board is not built: libunicorn or libcapstone is missing")
    return path


@pytest.fixture(scope="session")
def build_image(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Compile an image once."""
    if shutil.which(COMPILER) is None:
        pytest.skip(f"{COMPILER} is missing")
    folder = tmp_path_factory.mktemp("images")

    def build(name: str, defines: Sequence[str] = ()) -> Path:
        elf = folder / f"{'-'.join([name, *defines])}.elf"
        if not elf.exists():
            sources = [IMAGES / "start.c", IMAGES / f"{name}.c"]
            options = [*FLAGS, *(f"-D{each}" for each in defines), "-T", IMAGES / "image.ld"]
            command = [COMPILER, *options, *sources, "-lgcc", "-o", elf]
            subprocess.run(list(map(str, command)), check=True)
        return elf

    return build


@pytest.fixture
def run_image(tmp_path: Path, program: Path, build_image: Callable[..., Path]) -> RunImage:
    """Run an image; text for `pins`, `line`, `inputs` becomes a file."""

    def run(
        name: str, *options: str, pins: str = "", line: str = "", inputs: str = "",
        defines: Sequence[str] = (), seconds: float = 1,
    ) -> Run:  # fmt: skip
        arguments = ["--elf", str(build_image(name, defines)), "--end-at", "test_end"]
        arguments += ["--for", str(seconds), "--watch", "result", *options]
        for option, text in (("pins", pins), ("line-script", line), ("inputs", inputs)):
            if text:
                (tmp_path / option).write_text(text)
                arguments += [f"--{option}", str(tmp_path / option)]
        arguments += ["--steps", str(tmp_path / "steps.csv"), "--vcd", str(tmp_path / "wave.vcd")]
        arguments += ["--line-log", str(tmp_path / "log.txt")]
        done = subprocess.run(
            [program, *arguments], capture_output=True, text=True, timeout=60, check=False
        )
        summary = json.loads(done.stdout) if done.stdout else {}
        return Run(done.returncode, done.stderr, summary, tmp_path)

    return run


@pytest.fixture(scope="session")
def image() -> board.Image:
    """The image of the reference board."""
    return board.build(board.DEFAULT_BOARD)


@pytest.fixture
def unit(
    program: Path, image: board.Image, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> VirtualBoard:
    """The reference board on the virtual board."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    return VirtualBoard(program, image, tmp_path)


@pytest.fixture
def make_acts(program: Path, tmp_path: Path) -> MakeActs:
    """Make a list of acts for the step driver of a board whose counter begins somewhere."""

    def make(name: str = SHORT, start: int = 0, half_period: bool = False) -> Acts:
        return Acts(program, tmp_path, name, start, half_period)

    return make


@pytest.fixture
def try_trains(program: Path, tmp_path: Path) -> TryTrains:
    """Run trains of one kind on a board."""
    return partial(try_on_board, program, tmp_path)
