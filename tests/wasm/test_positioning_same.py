"""The positioning unit for WebAssembly makes the pulses of that for this machine, byte for byte."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from chance import SEED
from wasm_build import build_wasm

ROOT = Path(__file__).resolve().parents[2]
NATIVE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin"
EXAMPLES = ROOT / "tools/examples/positioning"
SCRIPTS = 300
MOVES = 3
SECONDS = "10"
OUTPUTS = ("steps", "trace")
REAL_TIME = ("real_seconds", "ratio")


def drawn(chance: random.Random) -> Iterator[str]:
    """A script: axes taken and moved, with feeds, holds and readings at any moments."""
    for axis in range(1, 5):
        yield f"0,{axis},POS_INIT,{chance.randrange(7)}"
    now = 0.0
    for _ in range(MOVES):
        now += chance.choice((1, chance.uniform(0.01, 400), chance.randrange(2000)))
        axis = chance.randrange(1, 5)
        way, accel = chance.randrange(-40_000, 40_000), chance.randrange(1, 5000)
        mode = chance.choice(("POS_MODE", "POS_MODE_ABS"))
        yield f"{now:.6f},{axis},{mode},{way},{accel}"
        for _ in range(chance.randrange(1, 4)):
            now += chance.choice((0.5, chance.uniform(0, 300)))
            feed = chance.choice((1, chance.randrange(1, 60_000)))
            yield f"{now:.6f},{axis},POS_CONTROL,{feed}mm/min,{int(chance.random() < 0.8)}"
        yield f"{now:.6f},{axis},{chance.choice(('READ', 'POS_CAPTURE', 'READ'))}"


def jobs_of(folder: str, scripts: Path) -> Iterator[list[str]]:
    """The arguments of each simulation, whose files are all in one folder."""
    for script in sorted(scripts.glob("*.csv")):
        if script.stem.endswith("-inputs"):
            continue
        found = ["sim", f"{folder}/{script.name}", "--for", SECONDS]
        if (inputs := script.with_name(f"{script.stem}-inputs.csv")).exists():
            found += ["--inputs", f"{folder}/{inputs.name}"]
        for name in OUTPUTS:
            found += [f"--{name}", f"{folder}/{script.stem}.{name}"]
        yield found


def told(data: bytes) -> dict[str, Any]:
    """What a simulation answered, but for the time that it took."""
    return {name: value for name, value in json.loads(data).items() if name not in REAL_TIME}


def test_examples_and_random_scripts_make_the_same_pulses_and_events(tmp_path: Path) -> None:
    ours, theirs = tmp_path / "native", tmp_path / "wasm"
    chance = random.Random(SEED)
    files = {path.name: path.read_text() for path in EXAMPLES.glob("*.csv")}
    files |= {f"drawn{i}.csv": "\n".join(drawn(chance)) + "\n" for i in range(SCRIPTS)}
    for folder in (ours, theirs):
        folder.mkdir()
        for name, text in files.items():
            (folder / name).write_text(text)
    host = NATIVE / "positioning-host"
    answers = [subprocess.check_output([host, *job]) for job in jobs_of(str(ours), ours)]
    wasm = str(build_wasm() / "positioning-host.wasm")
    jobs = [
        {"wasm": wasm, "arguments": job, "stdout": f"{theirs}/{n}.json", "folder": str(theirs)}
        for n, job in enumerate(jobs_of("", theirs))
    ]
    serve = {**jobs[0], "arguments": ["serve"], "stdout": str(tmp_path / "refused")}
    node = Path(sys.executable).with_name("node")
    run: list[str | Path] = [node, "--no-warnings", ROOT / "tests/support/wasm_run.mjs"]

    statuses = subprocess.check_output(run, input=json.dumps([*jobs, serve]), text=True)

    assert json.loads(statuses) == [0] * len(jobs) + [2], "there are no sockets, so no serve"
    assert len(jobs) == SCRIPTS + len(list(EXAMPLES.glob("*.csv"))) - 1
    for number, answer in enumerate(answers):
        assert told((theirs / f"{number}.json").read_bytes()) == told(answer)
    made = [path for path in ours.iterdir() if path.suffix in (".steps", ".trace")]
    assert len(made) == len(OUTPUTS) * len(jobs)
    for path in made:
        assert (theirs / path.name).read_bytes() == path.read_bytes(), path.name
    lines = sum(path.read_text().count("\n") for path in ours.glob("drawn*.steps"))
    assert lines > 1000 * SCRIPTS
