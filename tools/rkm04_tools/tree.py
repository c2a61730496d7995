"""Where the files of the project are: in a checkout, or inside the installed package.

A wheel (tools/wheels) brings those that the commands read, in the folders of a checkout.
"""

from __future__ import annotations

from pathlib import Path

from rkm04_tools.failure import Failure

BROUGHT = Path(__file__).resolve().parent / "tree"
IS_INSTALLED = BROUGHT.is_dir()
ROOT = BROUGHT if IS_INSTALLED else Path(__file__).resolve().parents[2]


def require_checkout(what: str) -> None:
    """Refuse what needs the sources and compilers, where there is only the installed package."""
    if IS_INSTALLED:
        raise Failure(
            f"{what} needs the sources, and this is an installed package; clone the project, "
            "then start it from tools/ there"
        )
