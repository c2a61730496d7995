"""The first job of the documents: every command that they show, in order, prints what they show."""

from __future__ import annotations

import os
import re
import stat
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "firmware" / "gve134" / "docs" / "first-job.md"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ANYTHING = "…"
EXPORT = re.compile(r"export (\w+)=(\S+)")
PATIENCE_S = 300.0


@dataclass
class Typed:
    """A command of the document, and what it prints there."""

    command: str
    printed: list[str] = field(default_factory=list)

    def matches(self, shown: str) -> bool:
        pattern = "\n".join(map(re.escape, self.printed)).replace(ANYTHING, r"[^\n]*")
        return re.fullmatch(pattern, shown.rstrip("\n")) is not None


def typed() -> list[Typed]:
    found: list[Typed] = []
    for block in BLOCK.findall(DOCUMENT.read_text(encoding="utf-8")):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append(Typed(line[2:]))
            else:
                found[-1].printed.append(line)
    return found


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """A folder like a clone that has been set up, with a build/ of its own."""
    tools = tmp_path / "tools"
    tools.mkdir()
    (tmp_path / "build").mkdir()
    (tools / "examples").symlink_to(ROOT / "tools" / "examples")
    command = tools / "gve134"
    python = f'PYTHONPATH="{ROOT}/tools" exec "{sys.executable}" -P -m rkm04_tools.gve134 "$@"'
    command.write_text(f"#!/bin/sh\n{python}\n")
    command.chmod(command.stat().st_mode | stat.S_IXUSR)
    return tmp_path


@pytest.fixture
def terminals(clone: Path) -> Iterator[Terminals]:
    both = Terminals(clone)
    yield both
    both.close()


class Terminals:
    """One in which commands follow each other, and others for those that go on running."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._environment = dict(os.environ)
        self._running: list[subprocess.Popen[str]] = []

    def type(self, each: Typed) -> str:
        """What a command prints; of one that goes on running as many lines as are shown."""
        if match := EXPORT.fullmatch(each.command):
            self._environment[match[1]] = match[2]
            return ""
        process = subprocess.Popen(
            ["bash", "-c", f"exec {each.command}" if " serve " in each.command else each.command],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, encoding="utf-8", cwd=self._folder, env=self._environment,
        )  # fmt: skip
        if " serve " in each.command:
            self._running.append(process)
            assert process.stdout is not None
            return "".join(process.stdout.readline() for _ in each.printed)
        return process.communicate(timeout=PATIENCE_S)[0]

    def close(self) -> None:
        for process in self._running:
            process.terminate()
            process.communicate(timeout=PATIENCE_S)


def test_the_first_job_goes_as_the_document_shows(terminals: Terminals) -> None:
    commands = typed()
    assert len(commands) >= 7

    for each in commands:
        shown = terminals.type(each)
        assert each.matches(shown), f"$ {each.command}\n{shown}"
