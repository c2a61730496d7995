"""The programs for WebAssembly do what those for this machine do, byte for byte.

`tools/test --long` draws 1000 random programs; otherwise there are few, as drawing them takes long.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from chance import SEED
from hypothesis import HealthCheck, given, seed, settings
from program_probe import Script
from program_strategies import scripts
from wasm_build import build_wasm

ROOT = Path(__file__).resolve().parents[2]
NATIVE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin"
EXAMPLES = ROOT / "tools" / "examples"
PROGRAMS = 1000 if "RKM04_LONG" in os.environ else 60
SECONDS = "60"
FILES = ("steps", "trace", "vcd", "curve")
REAL_TIME = ("real_seconds", "ratio")


@pytest.fixture(scope="module")
def wasm() -> Path:
    return build_wasm()


def run_all(jobs: Sequence[dict[str, Any]]) -> list[int]:
    """Run them in one process; their exit statuses."""
    node = Path(sys.executable).with_name("node")
    command: list[str | Path] = [node, "--no-warnings", ROOT / "tests/support/wasm_run.mjs"]
    out = subprocess.check_output(command, input=json.dumps(jobs), text=True)
    statuses: list[int] = json.loads(out)
    return statuses


def arguments_of(example: Path, folder: str) -> list[str]:
    """Simulate an example with all outputs; `folder` is the one of all files."""
    found = ["sim", "--motor", f"1={folder}/{example.name}", "--for", SECONDS]
    if example.with_suffix(".csv").exists():
        found += ["--inputs", f"{folder}/{example.stem}.csv"]
    for name in FILES:
        found += [f"--{name}", f"{folder}/{example.stem}.{name}"]
    return found


def told(path: Path) -> dict[str, object]:
    """What a simulation answered, but for the time that it took."""
    answer = json.loads(path.read_bytes())
    return {name: value for name, value in answer.items() if name not in REAL_TIME}


def test_every_example_makes_the_same_pulses_traces_waves_and_curves(wasm, tmp_path):
    examples = sorted(EXAMPLES.glob("*.rks"))
    ours, theirs = tmp_path / "native", tmp_path / "wasm"
    for folder in (ours, theirs):
        folder.mkdir()
        for path in [*examples, *EXAMPLES.glob("*.csv")]:
            (folder / path.name).write_bytes(path.read_bytes())
    for example in examples:
        command: list[str | Path] = [NATIVE / "rkm04-host", *arguments_of(example, str(ours))]
        (ours / f"{example.stem}.json").write_bytes(subprocess.check_output(command))
    jobs = [
        {
            "wasm": str(wasm / "rkm04-host.wasm"),
            "arguments": arguments_of(example, ""),
            "stdout": str(theirs / f"{example.stem}.json"),
            "folder": str(theirs),
        }
        for example in examples
    ]

    assert run_all(jobs) == [0] * len(examples)

    assert len(examples) >= 9
    for example in examples:
        assert told(theirs / f"{example.stem}.json") == told(ours / f"{example.stem}.json")
        for name in FILES:
            made = (theirs / f"{example.stem}.{name}").read_bytes()
            assert made == (ours / f"{example.stem}.{name}").read_bytes(), (example, name)


def drawn(count: int) -> str:
    """Scripts for the program probe."""
    found: list[str] = []

    @seed(SEED)
    @settings(
        max_examples=count, deadline=None, suppress_health_check=list(HealthCheck), database=None
    )
    @given(scripts())
    def take(script: Script) -> None:
        found.append(script.lines)

    take()
    return "".join(found)


def test_random_programs_do_the_same_to_the_tick(wasm, tmp_path):
    given_, told_ = tmp_path / "scripts", tmp_path / "told"
    given_.write_text(drawn(PROGRAMS), encoding="ascii")
    job = {
        "wasm": str(wasm / "program-probe.wasm"),
        "arguments": [],
        "stdin": str(given_),
        "stdout": str(told_),
        "folder": str(tmp_path),
    }

    assert run_all([job]) == [0]

    with given_.open("rb") as stdin:
        expected = subprocess.check_output([NATIVE / "program-probe"], stdin=stdin)
    answers = told_.read_bytes()
    assert answers.count(b"\nend ") >= PROGRAMS // 2
    assert answers == expected


def test_what_needs_sockets_is_refused_in_plain_words(wasm, tmp_path):
    job = {
        "wasm": str(wasm / "rkm04-host.wasm"),
        "arguments": ["serve"],
        "stdout": str(tmp_path / "told"),
        "folder": str(tmp_path),
    }

    assert run_all([job]) == [2]
