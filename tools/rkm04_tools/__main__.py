"""Entry of `python -m rkm04_tools`."""

import sys


def run() -> int:
    """Run the command line; an interruption while it is being loaded ends it quietly too."""
    try:
        from rkm04_tools.cli import main

        return main(sys.argv[1:])
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(run())
