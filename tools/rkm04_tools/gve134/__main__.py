"""Entry of `python -m rkm04_tools.gve134`."""

import sys

from rkm04_tools.starting import begin_signals


def run() -> int:
    """Run the command line."""
    begin_signals()
    from rkm04_tools.cli import run_tool
    from rkm04_tools.gve134.cli import make_parser

    return run_tool(make_parser(), sys.argv[1:])


if __name__ == "__main__":
    sys.exit(run())
