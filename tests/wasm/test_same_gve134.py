"""The GVE134 unit for WebAssembly does what that for this machine does, byte for byte."""

from __future__ import annotations

import json
import os
import random
import subprocess
from pathlib import Path
from typing import Any

import pytest
from chance import SEED
from gve_drawn import drawn_file
from gve_probe import begin_of, lines_of
from gve_sessions import session
from rkm04_tools.gve134.service import alone
from wasm_build import build_wasm, run_all

ROOT = Path(__file__).resolve().parents[2]
NATIVE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin"
SESSIONS = 1000
FILES = 1000 if "RKM04_LONG" in os.environ else 30
MADE = ("steps", "trace", "vcd", "curve")
REAL_TIME = ("real_seconds", "ratio")
MARK = "; alone\n"
"""Of few files all outputs are compared, of the others the pulses."""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The examples and files by chance."""
    folder = tmp_path_factory.mktemp("files")
    for each in alone.brought()["examples"]:
        (folder / each["name"]).write_text(MARK + each["text"], encoding="utf-8", newline="")
    chance = random.Random(SEED)
    for number in range(FILES):
        name = folder / f"drawn{number}.gve"
        name.write_text(drawn_file(chance), encoding="utf-8", newline="")
    return folder


def commands(file: Path, place: str) -> dict[str, list[str]]:
    """What is done with a file, by the name of what is told; `place` is the folder of all files."""
    name = f"{place}/{file.name}"
    made = MADE if file.read_text(encoding="utf-8").startswith(MARK) else MADE[:1]
    options = [word for kind in made for word in (f"--{kind}", f"{name}.{kind}")]
    return {
        f"{file.name}.check": ["check", name],
        f"{file.name}.sim": ["sim", name, "--for", "10", *options],
        f"{file.name}.plan": ["plan", "400", "400", "1600", f"{name}.course"],
    }


def job(file: Path, words: list[str], told: Path, wasm: Path) -> dict[str, Any]:
    return {
        "wasm": str(wasm / "gve134-host.wasm"), "arguments": words, "stdin": str(file),
        "stdout": str(told), "folder": str(told.parent),
    }  # fmt: skip


def what(path: Path) -> bytes | dict[str, object]:
    """What was written, without the time that a simulation took."""
    if path.suffix != ".sim":
        return path.read_bytes()
    answer = json.loads(path.read_bytes())
    return {name: value for name, value in answer.items() if name not in REAL_TIME}


def test_examples_and_random_files_are_the_same_to_it(files: Path, tmp_path: Path) -> None:
    ours, theirs, jobs = tmp_path / "native", tmp_path / "wasm", []
    for folder in (ours, theirs):
        folder.mkdir()
    wasm = build_wasm()
    for file in sorted(files.iterdir()):
        for folder in (ours, theirs):
            (folder / file.name).write_bytes(file.read_bytes())
        for told, words in commands(file, str(ours)).items():
            native = [str(NATIVE / "gve134-host"), *words]
            with file.open("rb") as stdin, (ours / told).open("wb") as stdout:
                subprocess.run(native, stdin=stdin, stdout=stdout, check=True)
        for told, words in commands(file, "").items():
            jobs.append(job(file, words, theirs / told, wasm))

    assert run_all(jobs) == [0] * len(jobs)

    names = sorted(path.name for path in ours.iterdir())
    assert names == sorted(path.name for path in theirs.iterdir())
    assert len(names) > 5 * FILES
    for name in names:
        assert what(theirs / name) == what(ours / name), name
    steps = [(ours / f"drawn{number}.gve.steps").read_bytes() for number in range(FILES)]
    assert sum(each.count(b"\n") > 50 for each in steps) > FILES // 2


def spoken(seed: int) -> str:
    """The session of a seed, as the probe reads it."""
    told = session(seed)
    lines = begin_of(told) + lines_of(told.edges, told.line)
    return "\n".join((*lines, f"run {told.end}", ""))


def test_random_sessions_have_the_same_answers_and_pulses_to_the_tick(tmp_path: Path) -> None:
    """With halts, overrides, interrupts, damage, and whatever else can be told to the unit."""
    given, told = tmp_path / "sessions", tmp_path / "told"
    given.write_text("".join(spoken(SEED + n) for n in range(SESSIONS)), encoding="ascii")
    job = {
        "wasm": str(build_wasm() / "gve-probe.wasm"), "arguments": [], "stdin": str(given),
        "stdout": str(told), "folder": str(tmp_path),
    }  # fmt: skip

    assert run_all([job]) == [0]

    with given.open("rb") as stdin:
        expected = subprocess.check_output([NATIVE / "gve-probe"], stdin=stdin)
    assert expected.count(b"\nend ") == SESSIONS
    assert expected.count(b"\npulses ") > SESSIONS
    assert told.read_bytes() == expected
