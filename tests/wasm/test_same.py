"""The programs for WebAssembly do what those for this machine do, byte for byte.

Drawing random programs takes long: without `tools/test --long` few are drawn, and the others are
these with smaller numbers.
"""

from __future__ import annotations

import json
import os
import random
import re
import subprocess
from pathlib import Path

import pytest
from chance import SEED
from hypothesis import HealthCheck, given, seed, settings
from program_probe import Script
from program_strategies import scripts
from wasm_build import build_wasm, run_all

ROOT = Path(__file__).resolve().parents[2]
NATIVE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin"
EXAMPLES = ROOT / "tools" / "examples"
PROGRAMS = 1000 if "RKM04_LONG" in os.environ else 300
DRAWN = PROGRAMS if "RKM04_LONG" in os.environ else 30
SECONDS = "60"
HEADER_BYTES = 2
"""Of a message: its number and its motor."""
FILES = ("steps", "trace", "vcd", "curve")
REAL_TIME = ("real_seconds", "ratio")


@pytest.fixture(scope="module")
def wasm() -> Path:
    return build_wasm()


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


def drawn(count: int) -> list[str]:
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
    return found


def varied(script: str, chance: random.Random) -> str:
    """The same script with smaller numbers, which begin with the same digit, in its programs."""

    def other(digits: re.Match[str]) -> str:
        lowest = int(digits[0][0]) * 10 ** (len(digits[0]) - 1)
        return str(chance.randint(lowest, int(digits[0])))

    def sent(line: re.Match[str]) -> str:
        message = bytes.fromhex(line[2]).decode("latin-1")
        text = message[:HEADER_BYTES] + re.sub(r"[1-9]\d+", other, message[HEADER_BYTES:])
        return f"{line[1]}{text.encode('latin-1').hex()}"

    return re.sub(r"^(send \d+ )([0-9a-f]+)$", sent, script, flags=re.MULTILINE)


def programs(count: int) -> list[str]:
    """So many, all different, as far as they have numbers."""
    chance = random.Random(SEED)
    found = drawn(min(count, DRAWN))
    return found + [varied(chance.choice(found), chance) for _ in range(count - len(found))]


def test_random_programs_do_the_same_to_the_tick(wasm, tmp_path):
    given_, told_ = tmp_path / "scripts", tmp_path / "told"
    scripts_ = programs(PROGRAMS)
    given_.write_text("".join(scripts_), encoding="ascii")
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
    assert len(set(scripts_)) > 0.7 * PROGRAMS
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
