"""`--target` and `--board` of `sim`, of the tools that take both."""

from __future__ import annotations

import argparse
from pathlib import Path

from rkm04_tools import board
from rkm04_tools.failure import Failure
from rkm04_tools.tree import require_checkout

TARGET = "--target stm32"


def add_arguments(command: argparse.ArgumentParser, unit: str) -> None:
    """Add both."""
    command.add_argument(
        "--target", choices=["host", "stm32"], default="host",
        help="what runs the file: the simulator, or the image of a board (default: host)",
    )  # fmt: skip
    command.add_argument(
        "--board", metavar="NAME",
        help=f"with {TARGET}: one of {', '.join(board.names(unit))} "
        f"(default: {board.DEFAULT_BOARD})",
    )  # fmt: skip


def is_board(options: argparse.Namespace) -> bool:
    """Whether the image of a board is meant, which must be possible here."""
    if options.target == "stm32":
        require_checkout(TARGET)
        return True
    if options.board is not None:
        raise Failure(f"--board needs {TARGET}")
    return False


def require_no(files: dict[str, Path | None]) -> None:
    """Refuse files that only the simulator can write; by the names of their options."""
    for name, path in files.items():
        if path:
            raise Failure(f"--{name}: not with {TARGET}; leave one of the two away")
