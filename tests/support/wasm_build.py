"""Builds the programs for WebAssembly; several processes may ask for them at the same time."""

from __future__ import annotations

import fcntl
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "wasm"
COMMANDS = (["cmake", "--preset", "wasm"], ["cmake", "--build", "--preset", "wasm"])


def build_wasm() -> Path:
    """Return the folder of the programs. The first time the compiler makes its library, too."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for command in COMMANDS:
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout + done.stderr
    return BUILD / "bin"
