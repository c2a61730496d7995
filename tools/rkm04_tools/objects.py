"""What the compiler and binutils tell of Cortex-M4 objects and images."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

RAM_CODE = range(0x200, 0x1_C000)
"""Where images have code in RAM: hal/stm32/stm32f405.ld."""

CI_FRAME = re.compile(r'node: { title: "([^"]+)" label: "[^"]*\\n(\d+) bytes \(')
CI_CALL = re.compile(r'edge: { sourcename: "([^"]+)" targetname: "([^"]+)"')


@dataclass(kw_only=True)
class Graph:
    """Functions with their stack and their calls, from files of -fcallgraph-info=su."""

    frames: dict[str, int] = field(default_factory=dict)  # function -> bytes of stack
    calls: dict[str, set[str]] = field(default_factory=dict)  # function -> what it calls

    def add_calls(self, path: Path) -> None:
        graph = path.read_text()
        for function, size in CI_FRAME.findall(graph):
            self.frames[function] = int(size)
            self.calls.setdefault(function, set())
        for caller, callee in CI_CALL.findall(graph):
            self.calls.setdefault(caller, set()).add(callee)


def binutil(tool: str, *arguments: str | Path) -> list[str]:
    command = [f"arm-none-eabi-{tool}", *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def short(function: str) -> str:
    """The name alone; gcc puts the path of the source before that of a static function."""
    return function.rsplit(":", 1)[-1]
