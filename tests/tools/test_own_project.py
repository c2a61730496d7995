"""A project of one's own that takes this one by add_subdirectory, with its compiler and flags."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from rkm04_tools.board import COMPILER
from rkm04_tools.tree import ROOT

PROJECT = f"""\
cmake_minimum_required(VERSION 3.25)
project(own LANGUAGES C)
set(CMAKE_C_STANDARD 11)
add_subdirectory({ROOT} engine)
target_compile_definitions(hal INTERFACE HAL_TRACE_NONE)
add_executable(path path.c)
target_link_libraries(path PRIVATE engine_path engine_step base)
add_library(group STATIC group.c)
target_link_libraries(group PRIVATE engine_group engine_step base hal)
"""
CROSS = f"""\
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER {COMPILER})
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -Os")
set(CMAKE_EXE_LINKER_FLAGS_INIT "--specs=nosys.specs --specs=nano.specs")
"""
PATH = """\
#include "path.h"

int main(void)
{
    static struct path path;
    static struct path_section ring[8];
    path_init(&path, ring, 8, 10);
    return path_is_laid(&path) ? 0 : 1;
}
"""
GROUP = """\
#include "group.h"
#include "hal_run.h"

static struct group group;

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct step_channel *channel = context;
    return step_channel_lay_isr(&channel[motor], room);
}

static void plan_isr(void *context)
{
    (void)context;
    group_plan_isr(&group);
}

void start(struct step_channel *channel, struct path_section *ring)
{
    static struct hal_client client = {.lay_isr = lay_isr, .plan_isr = plan_isr};
    client.context = channel;
    group_init(&group, ring, 8);
    hal_run_start(&client);
}
"""

EXAMPLE = re.compile(r"^```cmake\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SEAM = re.compile(r"^(\w[\w ]*?\**)\b(hal_\w+)\(([^;{]*)\);", re.MULTILINE)
"""A function of the seam: what it returns, its name, what it takes."""


def backend() -> str:
    """A backend that does nothing, as the headers have its functions."""
    headers = sorted((ROOT / "hal" / "include").glob("*.h"))
    lines = [f'#include "{header.name}"' for header in headers] + ['#include "image.h"']
    for header in headers:
        for kind, name, takes in SEAM.findall(header.read_text()):
            does = "" if kind.strip() == "void" else f"return ({kind.strip()})0;"
            lines.append(f"{kind.strip()} {name}({takes})\n{{\n    {does}\n}}")
    return "\n".join(line for line in lines if "hal_trace(" not in line) + "\n"


def built(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """What its default target comes to."""
    for name, text in (
        ("CMakeLists.txt", PROJECT), ("cross.cmake", CROSS), ("path.c", PATH), ("group.c", GROUP),
    ):  # fmt: skip
        if not (folder / name).exists():
            (folder / name).write_text(text)
    configure = ["cmake", "-G", "Ninja", "-S", ".", "-B", "build", *options]
    subprocess.run(configure, cwd=folder, capture_output=True, text=True, check=True)
    build = ["cmake", "--build", "build"]
    return subprocess.run(build, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.skipif(not shutil.which(COMPILER), reason=f"{COMPILER} is not installed")
def test_the_engine_is_built_for_a_chip_with_the_flags_of_another_project(tmp_path: Path) -> None:
    done = built(tmp_path, "--toolchain", str(tmp_path / "cross.cmake"))

    assert (done.returncode, done.stderr) == (0, ""), done.stdout
    assert (tmp_path / "build" / "path").is_file()
    assert (tmp_path / "build" / "libgroup.a").is_file()


def test_another_project_gets_the_libraries_and_none_of_the_programs(tmp_path: Path) -> None:
    done = built(tmp_path)

    assert (done.returncode, done.stderr) == (0, ""), done.stdout
    assert subprocess.run([tmp_path / "build" / "path"], check=False).returncode == 0
    assert not list(tmp_path.glob("build/**/*-host"))
    assert not list(tmp_path.glob("build/**/rkm04-vboard"))


@pytest.mark.skipif(not shutil.which(COMPILER), reason=f"{COMPILER} is not installed")
def test_a_backend_of_ones_own_becomes_an_image_as_the_page_says(tmp_path: Path) -> None:
    page = (ROOT / "firmware" / "docs" / "design.md").read_text()
    (example,) = EXAMPLE.findall(page)
    (tmp_path / "CMakeLists.txt").write_text(example)
    (tmp_path / "mychip.c").write_text(backend())
    (tmp_path / "motion-controllers").symlink_to(ROOT)

    done = built(tmp_path, "--toolchain", str(tmp_path / "cross.cmake"))

    assert (done.returncode, done.stderr) == (0, ""), done.stdout
    assert (tmp_path / "build" / "rkm04-mychip").is_file()
