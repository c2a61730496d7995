"""Entry of `python -m rkm04_tools`."""

import sys

from rkm04_tools.starting import begin_signals


def run() -> int:
    """Run the command line."""
    begin_signals()
    from rkm04_tools.cli import main

    return main(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(run())
