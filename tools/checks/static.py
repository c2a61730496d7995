"""Static analysis of the C sources: clang-tidy with the checks of .clang-tidy, and complexity.

    PYTHONPATH=tools build/venv/bin/python -m checks.static [--deep] [FILE ...]

Clang's analyzer follows the paths of each function by itself; with --deep, as in `tools/test
--long`, also through the functions that it calls, which takes minutes in place of seconds.

Cyclomatic complexity is at most 10, a switch counting once however many cases it has: the flat
switches of opcodes, states and registers are read case by case. MISRA has a ratchet of its own, in
misra.py; recursion and stack are proved from the objects (arm_check.py, rkm04_tools/board_size.py).
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import lizard

ROOT = Path(__file__).resolve().parents[2]
COMPLEXITY_MAX = 10
BOARD = "f405"

FIRMWARE = ("firmware/**/*.c",)
HOST = (
    "hal/host/*.c",
    "tools/common/*.c",
    "tools/lines/*.c",
    "tools/master/*.c",
    "tools/gve134_master/*.c",
    "tools/gve134_job/*.c",
    "tools/positioning_master/*.c",
    "tools/unit_host/*.c",
    "tools/unit_serve/*.c",
    "tools/unit_serve/posix/*.c",
    "tools/simulator/*.c",
    "tools/simulator/wasm/*.c",
    "tools/gve134_host/*.c",
    "tools/gve134_host/wasm/*.c",
    "tools/positioning_host/*.c",
    "tools/positioning_host/wasm/*.c",
    "tools/vboard/*.c",
)
ARM = ("hal/stm32/*.c",)
STAGES = ("firmware/*/", "firmware/*/*/")
FOLDERS = (
    *STAGES,
    "hal/include",
    "hal/host",
    "tools/common",
    "tools/lines",
    "tools/master",
    "tools/gve134_master",
    "tools/gve134_job",
    "tools/positioning_master",
    "tools/unit_host",
    "tools/unit_serve",
    "tools/simulator",
    "tools/gve134_host",
    "tools/positioning_host",
)
ARM_FOLDERS = (*STAGES, "hal/include", "hal/stm32", f"hal/stm32/boards/{BOARD}")
CLASS_2 = "/stm32_gpio_"
HALF_DUPLEX = "line_half"
"""Files that only RKM04 is built with; others go with either unit."""
ARM_TARGET = ("--target=arm-none-eabi", "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft")
NEWLIB = "/usr/include/newlib"
FILES_A_PROCESS = 10
SHALLOW = ("-Xclang", "-analyzer-config", "-Xclang", "mode=shallow")

FINDING = re.compile(
    r"^(.+?):(\d+):\d+: (?:warning|error): (.*) \[([\w.-]+?)(?:,[\w.,-]+)?\]$", re.M
)
# What a check says wrongly, by file: (check, file) -> why it is left.
LEFT: dict[tuple[str, str], str] = {
    (
        "bugprone-implicit-widening-of-multiplication-result",
        "firmware/engine/motion/motion_leg.c",
    ): "2 * A is at most 120 000",
    (
        "bugprone-implicit-widening-of-multiplication-result",
        "firmware/engine/motion/motion_point.c",
    ): "2 * STEP_ACCEL_PER_ACCEL is small",
    ("clang-analyzer-optin.core.EnumCastOutOfRange", "tools/vboard/cost.c"): "flags of capstone",
    ("clang-analyzer-optin.core.EnumCastOutOfRange", "tools/vboard/cpu.c"): "flags of Unicorn",
    ("clang-analyzer-optin.core.EnumCastOutOfRange", "tools/vboard/run.c"): "flags of Unicorn",
    ("clang-analyzer-unix.Stream", "tools/common/infile.c"): "the end is looked for by reading",
}


def sources(*patterns: str) -> list[str]:
    return sorted(
        path.relative_to(ROOT).as_posix() for each in patterns for path in ROOT.glob(each)
    )


def includes(folders: Iterable[str]) -> list[str]:
    """Options for folders, relative to the root: the same header must not have two names."""
    paths = [path for each in folders for path in sorted(ROOT.glob(each)) if path.is_dir()]
    return [f"-I{path.relative_to(ROOT).as_posix()}" for path in paths]


def tool(name: str) -> str:
    return str(Path(sys.executable).with_name(name))


def tidy(files: list[str], arguments: tuple[str, ...]) -> str:
    """What clang-tidy says of some files."""
    done = subprocess.run(
        [tool("clang-tidy"), "--quiet", *files, "--", "-std=c11", *arguments],
        cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True,
    )  # fmt: skip
    if done.returncode and not FINDING.search(done.stdout):
        return f"clang-tidy:0:0: error: it failed: {done.stderr.strip()[-400:]} [clang-tidy]\n"
    return done.stdout


def findings(text: str) -> Iterator[str]:
    """The findings in what clang-tidy has said, without those that are left."""
    for file, line, what, check in FINDING.findall(text):
        name = file.removeprefix(f"{ROOT}/")
        if (check, name) not in LEFT:
            yield f"{name}:{line}: {what} [{check}]"


def arm_includes(file: str) -> list[str]:
    """With the header of an image that fits the file."""
    unit = "rkm04" if CLASS_2 in file or HALF_DUPLEX in file else "gve134"
    return [*includes((f"firmware/{unit}/image",)), *includes(ARM_FOLDERS)]


def analyse(files: Iterable[str], deep: bool) -> Iterator[str]:
    """Run clang-tidy on C files, several a process, as its start takes longer than a file."""
    mode = () if deep else SHALLOW
    arm, host = set(sources(*ARM)), (*mode, *includes(FOLDERS))
    target = (*mode, *ARM_TARGET, "-isystem", NEWLIB)
    alike: dict[tuple[str, ...], list[str]] = {}
    for file in files:
        own = (*target, *arm_includes(file)) if file in arm else host
        alike.setdefault(own, []).append(file)
    jobs = [
        (some[start : start + FILES_A_PROCESS], own)
        for own, some in alike.items()
        for start in range(0, len(some), FILES_A_PROCESS)
    ]
    with ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        for text in pool.map(lambda job: tidy(*job), jobs):
            yield from findings(text)


def complexities(files: Iterable[str]) -> Iterator[str]:
    """The functions that are too complex."""
    extensions = lizard.get_extensions(["modified"])
    for file in files:
        for each in lizard.FileAnalyzer(extensions)(str(ROOT / file)).function_list:
            if (count := each.cyclomatic_complexity) > COMPLEXITY_MAX:
                yield (
                    f"{file}:{each.start_line}: {each.name} has a cyclomatic complexity of "
                    f"{count}, more than {COMPLEXITY_MAX}"
                )


def main(arguments: list[str]) -> int:
    deep = "--deep" in arguments
    files = [each for each in arguments if each != "--deep"] or sources(*FIRMWARE, *HOST, *ARM)
    found = sorted({*complexities(files), *analyse(files, deep)})
    print("\n".join(found) or f"{len(files)} sources, nothing found")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
