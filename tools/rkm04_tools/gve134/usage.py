"""Judges a command line before the machine is set up for it, as rkm04_tools.usage does."""

import sys

from rkm04_tools.cli import read
from rkm04_tools.failure import Failure
from rkm04_tools.gve134.cli import make_parser

if __name__ == "__main__":
    try:
        read(make_parser(), sys.argv[1:])
    except Failure as failure:
        print(f"gve134: {failure}", file=sys.stderr)
        sys.exit(failure.status)
