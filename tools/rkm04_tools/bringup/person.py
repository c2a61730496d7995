"""The dialogue: a screen for each step, questions of one letter."""

from __future__ import annotations

import io
import sys
from typing import TextIO

from rkm04_tools.failure import NOT_SO
from rkm04_tools.typed import forget_typed

CLEAR = "\033[2J\033[H"
GO, AGAIN, LEAVE, QUIT, YES, NO = "", "r", "s", "q", "y", "n"


class Stopped(Exception):
    """The person has ended it, or nobody answers any more."""

    def __init__(self, status: int = NOT_SO) -> None:
        super().__init__("stopped")
        self.status = status


class Person:
    """Who stands before the board."""

    def __init__(self, out: TextIO) -> None:
        self._out = out
        self._types = False
        if isinstance(sys.stdin, io.TextIOWrapper):  # a byte that is no text is a wrong answer
            sys.stdin.reconfigure(errors="replace")
            self._types = sys.stdin.isatty()

    def screen(self, title: str) -> None:
        """Begin a screen."""
        clear = CLEAR if self._out.isatty() else "\n"
        self.tell(f"{clear}{title}\n{'-' * len(title)}")

    def tell(self, text: str) -> None:
        print(text, file=self._out, flush=True)

    def choose(
        self, question: str, choices: str, enter: str | None = None, status: int = NOT_SO
    ) -> str:
        """One of the letters; `enter` is what an empty line means, `status` that of a stop.

        At a terminal only what is typed from now on counts: nobody confirms what was not shown yet.
        """
        while True:
            if self._types:
                forget_typed()
            print(f"{question} > ", end="", file=self._out, flush=True)
            line = sys.stdin.readline()
            if not line:
                self.tell("")
                raise Stopped(status)
            answer = line.strip().lower()[:1]
            if not answer and enter is not None:
                return enter
            if answer == QUIT:
                raise Stopped(status)
            if answer and answer in choices:
                return answer
            self.tell(f"one of {', '.join(choices)}, {QUIT} (stop here)"
                      + (", or Enter" if enter is not None else ""))  # fmt: skip
