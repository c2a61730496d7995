"""The PCs that there are wheels for, and how their programs are built with zig."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
PROGRAMS = ("rkm04-host", "gve134-host", "positioning-host")
LIBRARY = "rkm04-lines"
# Without the name of this folder, so that every checkout gives the same bytes.
FLAGS = f"-O2 -UNDEBUG -ffile-prefix-map={ROOT}/="


@dataclass(frozen=True)
class Target:
    """A kind of PC: its names for us, CMake and zig, and the tags of its wheel."""

    name: str
    system: str
    processor: str
    zig: str
    tags: tuple[str, ...]

    @property
    def suffix(self) -> str:
        """What the names of its programs end with."""
        return ".exe" if self.system == "Windows" else ""

    @property
    def library_suffix(self) -> str:
        """The same of its library."""
        return {"Windows": ".dll", "Darwin": ".dylib"}.get(self.system, ".so")


TARGETS = {
    each.name: each
    for each in (
        Target(
            "linux-x86_64", "Linux", "x86_64", "x86_64-linux-musl",
            ("manylinux2014_x86_64", "musllinux_1_1_x86_64"),
        ),
        Target(
            "linux-aarch64", "Linux", "aarch64", "aarch64-linux-musl",
            ("manylinux2014_aarch64", "musllinux_1_1_aarch64"),
        ),
        Target("windows-x86_64", "Windows", "x86_64", "x86_64-windows-gnu", ("win_amd64",)),
        Target("macos-arm64", "Darwin", "arm64", "aarch64-macos.13.0", ("macosx_13_0_arm64",)),
        Target("macos-x86_64", "Darwin", "x86_64", "x86_64-macos.13.0", ("macosx_13_0_x86_64",)),
    )
}  # fmt: skip


def build_programs(target: Target) -> list[Path]:
    """The programs of a target, which do not need anything of the system that they run on.

    Its library needs a libc, and takes whichever Python has.
    """
    folder = BUILD / "pc" / target.name
    _call(
        "cmake", "-G", "Ninja", "-S", ".", "-B", folder,
        "-DCMAKE_TOOLCHAIN_FILE=tools/cmake/pc.cmake",
        f"-DPC_SYSTEM={target.system}", f"-DPC_PROCESSOR={target.processor}",
        f"-DPC_TARGET={target.zig}", f"-DCMAKE_C_FLAGS={FLAGS}", "-DCMAKE_EXE_LINKER_FLAGS=-s",
    )  # fmt: skip
    _call("ninja", "-C", folder, *PROGRAMS, LIBRARY)
    made = [f"{name}{target.suffix}" for name in PROGRAMS] + [LIBRARY + target.library_suffix]
    return [folder / "bin" / name for name in made]


def build_wasm() -> list[Path]:
    """What `service --static` puts into its page; imported here, as help has nothing installed."""
    from rkm04_tools import static_pages

    _call("cmake", "--preset", "wasm")
    _call("cmake", "--build", "--preset", "wasm", "--target", "page-programs")
    return [BUILD / "wasm/bin" / name for name in static_pages.PROGRAMS]


def _call(*command: str | Path) -> None:
    cache = str(BUILD / "cache" / "zig")
    known = {**os.environ, "ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}
    done = subprocess.run(command, cwd=ROOT, env=known, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout + done.stderr)
        raise SystemExit(f"tools/wheels: {Path(command[0]).name} failed, see above")
