"""What a clone can do before it is set up, and what it says where it cannot be."""

from __future__ import annotations

import os
import shutil
import subprocess
from importlib.metadata import distributions
from pathlib import Path

import pytest
from rkm04_tools.cli import make_parser
from rkm04_tools.completion import commands_of

ROOT = Path(__file__).resolve().parents[2]
NEEDED = ("tools/rkm04_tools", "tools/checks", "tools/packing", "hal/stm32/boards")
FILES = (
    "tools/rkm04",
    "tools/test",
    "tools/setup",
    "tools/wheels",
    "tools/requirements.txt",
    "firmware/rkm04/rkm04.h",
    "firmware/rkm04/image/image.h",
    "firmware/gve134/command/gve_commands.def",
    "firmware/gve134/image/image.h",
    "firmware/positioning/registers/registers.def",
    "firmware/positioning/image/image.h",
)
COMMANDS = [name for name, _ in commands_of(make_parser()) if name not in ("build", "size")]


@pytest.fixture(scope="module")
def clone(tmp_path_factory) -> Path:
    """What a clone has of the tools, without a build."""
    root: Path = tmp_path_factory.mktemp("clone")
    for name in NEEDED:
        shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in FILES:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, root / name)
    (root / "tools/service_page").mkdir()
    (root / "tools/gve134").symlink_to("rkm04")
    (root / "tools/positioning").symlink_to("rkm04")
    return root


def run(clone: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    own = {k: v for k, v in os.environ.items() if not k.startswith(("RKM04_", "PYTHON"))}
    return subprocess.run(arguments, cwd=clone, env=own, capture_output=True, text=True, timeout=60)


def is_untouched(clone: Path) -> bool:
    return not (clone / "build").exists() and not list(clone.rglob("__pycache__"))


def test_help_version_and_completion_need_no_setup(clone):
    for arguments, begin in [
        (["--help"], "usage: rkm04 "),
        (["service", "--help"], "usage: rkm04 service "),
        (["sim", "a.rks", "--target", "stm32", "-h"], "usage: rkm04 sim "),
        (["--version"], "rkm04, with the firmware "),
        (["completion", "bash"], "_rkm04() {"),
        (["completion", "--words", "se"], "send\nserve\nservice\n"),
    ]:
        done = run(clone, "tools/rkm04", *arguments)
        assert (done.returncode, done.stderr) == (0, ""), arguments
        assert done.stdout.startswith(begin)
    for tool in ("tools/test", "tools/wheels"):
        done = run(clone, tool, "--help")
        assert (done.returncode, done.stderr) == (0, ""), tool
        assert done.stdout.startswith(f"usage: {tool} ")
    assert is_untouched(clone)


def test_the_other_tool_needs_no_setup_for_them_either(clone):
    for arguments, status, begin in [
        (["--help"], 0, "usage: gve134 "),
        (["check", "--help"], 0, "usage: gve134 check "),
        (["--version"], 0, "gve134, with the firmware IP134/200 v1 "),
        (["chekc", "a.gve"], 2, "gve134: COMMAND chekc is none; did you mean check?; gve134 "),
    ]:
        done = run(clone, "tools/gve134", *arguments)
        assert done.returncode == status, arguments
        assert (done.stdout or done.stderr).startswith(begin)
    assert is_untouched(clone)


def test_the_third_tool_needs_no_setup_for_them_either(clone):
    for arguments, status, begin in [
        (["--help"], 0, "usage: positioning "),
        (["sim", "--help"], 0, "usage: positioning sim "),
        (["--version"], 0, "positioning, with the firmware 01.00"),
        (["smi", "a.csv"], 2, "positioning: COMMAND smi is none; did you mean sim?; positioning "),
    ]:
        done = run(clone, "tools/positioning", *arguments)
        assert done.returncode == status, arguments
        assert (done.stdout or done.stderr).startswith(begin)
    assert is_untouched(clone)


def test_a_mistake_is_told_before_anything_is_installed_for_it(clone):
    done = run(clone, "tools/rkm04", "sim", "a.rks", "--stesp", "x")

    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "rkm04: unrecognized arguments: --stesp x; did you mean --steps?; "
        "rkm04 sim --help shows how it is used\n"
    )
    assert is_untouched(clone)


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (["chekc", "a.rks"], "check"),
        (["board", "flahs"], "flash"),
        (["stop", "--prot=x"], "--port"),
        (["sim", "--target", "stm23"], "stm32"),
    ],
)
def test_what_was_meant_is_asked(tool, arguments, meant):
    result = tool(*arguments)

    assert result.status == 2
    assert f"; did you mean {meant}?; rkm04" in result.complaint


@pytest.mark.parametrize("arguments", [["zzz"], ["stop", "--zzzzzz"]])
def test_nothing_is_asked_where_nothing_is_near(tool, arguments):
    assert "did you mean" not in tool(*arguments).complaint


@pytest.mark.parametrize("command", [["tools/rkm04", "check", "a.rks"], ["tools/test"]])
def test_a_clone_that_cannot_be_written_to_is_one_line(clone, command):
    build = clone / "build"
    build.touch()  # no folder can be made there, not by root either
    try:
        done = run(clone, *command)
    finally:
        build.unlink()

    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == (
        f"tools/setup: {build} cannot be written to; copy the project to a folder of your own\n"
    )


def sizes() -> dict[str, int]:
    """Bytes of the Python packages that are installed, by their names in the requirements."""
    return {
        each.name.lower(): sum(file.size or 0 for file in each.files or [])
        for each in distributions()
    }


def announced() -> dict[str, int]:
    lines = (ROOT / "tools" / "setup").read_text().splitlines()
    rows = [line.partition(") ") for line in lines if "megabytes=" in line and ") " in line]
    return {name.strip(): int(rest.partition("=")[2].split()[0]) for name, _, rest in rows}


def test_what_setup_announces_is_what_its_packages_need():
    sections: dict[str, int] = {}
    own, section = sizes(), ""
    for line in (ROOT / "tools" / "requirements.txt").read_text().splitlines():
        if line.startswith("# --- "):
            section = line.split()[2]
        elif "==" in line:
            name = line.partition("==")[0].lower()
            sections[section] = sections.get(section, 0) + own.get(name, 0)
    told = announced()

    assert set(told) == {"run", "service", "static", "board", "bench", "test"}
    parts_of = {
        "run": ["run"],
        "bench": ["run", "bench"],
        "service": ["run", "service"],
        "static": ["run", "service", "static"],
        "test": list(sections),
    }
    for level, parts in parts_of.items():
        packages = sum(sections[part] for part in parts) / 1e6
        assert packages < told[level] < 2.2 * packages + 100, (level, packages)
