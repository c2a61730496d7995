"""An own board, in a copy of the tree: what becomes of its header when it is built."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
from pathlib import Path

import pytest
from own_board import configured
from rkm04_tools import board

HEADER = (board.BOARDS / "f405" / "board.h").read_text()
LED = "X(LED_2, C, 9, OUT)"

pytestmark = pytest.mark.skipif(
    not shutil.which(board.COMPILER), reason=f"{board.COMPILER} is not installed"
)


def test_nothing_that_could_be_flashed_is_made_of_pins_that_are_wrong(tmp_path: Path) -> None:
    header = configured(tmp_path, HEADER.replace(LED, LED.replace("9", "8")))

    done = subprocess.run(
        ["cmake", "--build", "--preset", "stm32"], cwd=tmp_path, capture_output=True, text=True
    )

    assert done.returncode != 0
    assert f"{header}: PC8 is used twice: LED_1 and LED_2" in done.stderr + done.stdout
    assert not list(tmp_path.glob("build/stm32/bin/*"))


def test_bring_up_tells_the_header_as_it_is_and_not_as_it_was_configured(tmp_path: Path) -> None:
    header = configured(tmp_path, HEADER)
    header.write_text(HEADER.replace(LED, LED.replace("9", "13")))

    asked = ["ninja", "-C", "build/stm32", "build.ninja"]
    subprocess.run(asked, cwd=tmp_path, capture_output=True, check=True)

    asked[3:] = ["-t", "commands", "bringup_image"]
    done = subprocess.run(asked, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert hashlib.sha1(header.read_bytes()).hexdigest()[:8] in done.stdout
