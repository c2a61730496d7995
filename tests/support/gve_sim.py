"""Runs `gve134 sim` inside a test."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rkm04_tools.cli import run_tool
from rkm04_tools.gve134.cli import make_parser

NAME = "a.gve"


@dataclass(frozen=True)
class Played:
    """What a simulation printed, with the file called a.gve, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)

    @property
    def lines(self) -> list[str]:
        return self.out.splitlines()

    @property
    def answers(self) -> list[tuple[int, str]]:
        """Line and answer of those that are told, in JSON."""
        return [(each["line"], each["answer"]) for each in self.json["answers"]]

    def axis(self, name: str) -> Any:
        """What is told of an axis, in JSON."""
        return next(axis for axis in self.json["axes"] if axis["axis"] == name)

    def positions(self) -> list[int]:
        return [axis["position"] for axis in self.json["axes"]]


Play = Callable[..., Played]


def player(folder: Path, read: Callable[[], tuple[str, str]]) -> Play:
    """Plays a text, or its lines; `read` gives what was printed."""

    def play(text: str | Sequence[str], *options: str | Path) -> Played:
        path = folder / NAME
        path.write_text(text if isinstance(text, str) else "\n".join(text) + "\n", "utf-8")
        read()
        arguments = [str(option) for option in options]
        status = run_tool(make_parser(), ["sim", str(path), *arguments])
        out, err = (each.replace(str(path), NAME) for each in read())
        return Played(status, out, err)

    return play


def pulses_of(steps: Path) -> list[tuple[int, int, int]]:
    """Tick, motor and position of every pulse of a steps file."""
    rows = steps.read_text().splitlines()[2:]
    return [(int(a), int(b), int(c)) for a, b, c in (row.split(",") for row in rows)]
