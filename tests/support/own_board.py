"""A board of one's own, in a copy of the tree."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from rkm04_tools.board import Image
from rkm04_tools.tree import ROOT

NAME = "own"


def configured(folder: Path, text: str) -> Path:
    """A board with this header is ready to be built in a folder; returns its header."""
    for part in ("CMakeLists.txt", "CMakePresets.json", "firmware", "tools", "tests"):
        (folder / part).symlink_to(ROOT / part)
    shutil.copytree(ROOT / "hal", folder / "hal")
    header = folder / "hal" / "stm32" / "boards" / NAME / "board.h"
    header.parent.mkdir()
    header.write_text(text)
    ready = ["cmake", "--preset", "stm32", f"-DFIRMWARE_BOARD={NAME}"]
    subprocess.run(ready, cwd=folder, capture_output=True, check=True)
    return header


def built(folder: Path, text: str) -> Image:
    """The image of a board with this header."""
    configured(folder, text)
    command = ["cmake", "--build", "--preset", "stm32", "--target", "unit_image"]
    subprocess.run(command, cwd=folder, capture_output=True, check=True)
    return Image(NAME, folder / "build" / "stm32")
