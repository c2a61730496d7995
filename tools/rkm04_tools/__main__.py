"""Entry of `python -m rkm04_tools`."""

import sys

from rkm04_tools.starting import hold_interrupts


def run() -> int:
    """Run the command line."""
    hold_interrupts()
    from rkm04_tools.cli import main

    return main(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(run())
