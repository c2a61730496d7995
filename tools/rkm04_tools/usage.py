"""Judges a command line before the machine is set up for it: python -m rkm04_tools.usage ..."""

import sys

from rkm04_tools.cli import make_parser, read
from rkm04_tools.failure import Failure

if __name__ == "__main__":
    try:
        read(make_parser(), sys.argv[1:])
    except Failure as failure:
        print(f"rkm04: {failure}", file=sys.stderr)
        sys.exit(failure.status)
