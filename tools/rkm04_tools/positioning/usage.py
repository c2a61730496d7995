"""Judges a command line before the machine is set up for it, as rkm04_tools.usage does."""

import sys

from rkm04_tools.cli import read
from rkm04_tools.failure import Failure
from rkm04_tools.positioning.cli import make_parser

if __name__ == "__main__":
    try:
        read(make_parser(), sys.argv[1:])
    except Failure as failure:
        print(f"positioning: {failure}", file=sys.stderr)
        sys.exit(failure.status)
