"""Entry of `python -m rkm04_tools.gve134`."""

import sys

from rkm04_tools.starting import hold_interrupts


def run() -> int:
    """Run the command line."""
    hold_interrupts()
    from rkm04_tools.cli import run_tool
    from rkm04_tools.gve134.cli import make_parser

    return run_tool(make_parser(), sys.argv[1:])


if __name__ == "__main__":
    sys.exit(run())
