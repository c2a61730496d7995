"""Ctrl-C while a tool starts: it ends, quietly, wherever that finds it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PYTHON = """\
#!/bin/bash
[ "$1" = -c ] || echo "started $*" >>started
[ "$1" = -c ] || grep SigBlk /proc/self/status
"""
SETUP = """\
#!/bin/sh
echo >setup-runs
sleep 0.5
"""
NOTHING = "#!/bin/sh\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A tree whose set-up takes a while and ends well whatever comes, and whose Python tells."""
    for name, text in {
        "tools/rkm04": (ROOT / "tools" / "rkm04").read_text(),
        "tools/setup": SETUP,
        "build/venv/bin/python": PYTHON,
        "build/host/build.ninja": "",
        "bin/ninja": NOTHING,
    }.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)
    return tmp_path


def begin(root: Path) -> subprocess.Popen[str]:
    path = f"{root / 'bin'}:{os.environ['PATH']}"
    return subprocess.Popen(
        [root / "tools" / "rkm04", "watch"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=root,
        env={**os.environ, "PATH": path},
    )


def test_an_interruption_of_the_set_up_ends_the_command_though_the_set_up_ends_well(root):
    process = begin(root)
    end = time.monotonic() + 10
    while not (root / "setup-runs").exists():
        assert time.monotonic() < end
        time.sleep(0.01)

    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=10)

    assert (process.returncode, out, err) == (130, "", "")
    assert not (root / "started").exists()


def test_python_starts_with_the_signal_held_back(root):
    out, err = begin(root).communicate(timeout=10)

    assert err == ""
    assert (root / "started").read_text() == "started -P -m rkm04_tools watch\n"
    assert int(out.split()[1], 16) & 1 << signal.SIGINT - 1


@pytest.mark.parametrize("module", ["rkm04_tools", "rkm04_tools.gve134", "rkm04_tools.positioning"])
def test_an_interruption_that_was_held_back_ends_the_command_before_it_does_anything(module):
    def interrupt() -> None:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        os.kill(os.getpid(), signal.SIGINT)

    ended = subprocess.run(
        [sys.executable, "-P", "-m", module, "status", "--port", "socket://127.0.0.1:1"],
        capture_output=True,
        text=True,
        timeout=30,
        env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        preexec_fn=interrupt,
    )

    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", "")
