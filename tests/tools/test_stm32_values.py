"""Values of a board header: what drivers, supply and loader ask for compiles, or does not."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from rkm04_tools import board
from rkm04_tools.tree import ROOT

GOOD = (board.BOARDS / "f405" / "board.h").read_text()
LAST = "#define BOARD_DIR_HOLD_NS"
EDGES = ("HIGH", "LOW")
compiled = pytest.mark.skipif(
    not shutil.which(board.COMPILER), reason=f"{board.COMPILER} is not installed"
)


def compile_steps(
    folder: Path, high_ns: int, unit: str, low_ns: int = 0, *options: str
) -> subprocess.CompletedProcess[str]:
    """The step output of a board whose drivers want so much time, with the warnings of a build."""
    wanted = zip(EDGES, (high_ns, low_ns or high_ns), strict=True)
    times = {f"BOARD_STEP_{each}_NS 500U": f"BOARD_STEP_{each}_NS {ns}U" for each, ns in wanted}
    header = GOOD
    for old, new in times.items():
        assert old in header
        header = header.replace(old, new)
    (folder / "board.h").write_text(header)
    places = ("hal/include", "hal/stm32", "firmware/base", f"firmware/{unit}/image")
    folders = [folder, *(ROOT / each for each in places)]
    flags = ["-std=c11", "-mcpu=cortex-m4", "-mthumb", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    flags += ["-fsyntax-only", *options]
    command = [board.COMPILER, *flags, *(f"-I{each}" for each in folders)]
    plain = unit == board.UNIT and not options
    names = ["step", "step_setup", *(["gpio_step", "gpio_setup"] if plain else [])]
    sources = [ROOT / "hal/stm32" / f"stm32_{each}.c" for each in names]
    return subprocess.run([*command, *sources], capture_output=True, text=True, check=False)


def compile_one(folder: Path, source: str, header: str) -> subprocess.CompletedProcess[str]:
    """A source of the backend with this header of a board."""
    (folder / "board.h").write_text(header)
    places = ("hal/include", "firmware/base", "firmware/gve134/image")
    folders = [folder, *(ROOT / each for each in places)]
    command = [board.COMPILER, "-std=c11", "-mcpu=cortex-m4", "-mthumb", "-Wall", "-Wextra"]
    command += ["-Wconversion", "-fsyntax-only", *(f"-I{each}" for each in folders)]
    path = str(ROOT / f"hal/stm32/stm32_{source}.c")
    return subprocess.run([*command, path], capture_output=True, text=True, check=False)


@compiled
@pytest.mark.parametrize("high_ns", [500, 2500, 4900, 5000, 10_000])
def test_a_board_may_want_pulses_of_half_a_microsecond_to_ten(tmp_path: Path, high_ns: int) -> None:
    done = compile_steps(tmp_path, high_ns, "rkm04")

    assert (done.returncode, done.stderr) == (0, "")


@compiled
@pytest.mark.parametrize(
    ("high_ns", "unit", "complaint"),
    [
        (400, "rkm04", "two edges are as far apart as streams need"),
        (2600, "gve134", "the drivers of the board want wider pulses than the unit makes"),
        (10_000, "gve134", "the drivers of the board want wider pulses than the unit makes"),
        (10_001, "rkm04", "a stop waits for the end of a pulse"),
        (60_000_000, "rkm04", "a stop waits for the end of a pulse"),
    ],
)
def test_pulses_that_cannot_be_made_do_not_compile(
    tmp_path: Path, high_ns: int, unit: str, complaint: str
) -> None:
    done = compile_steps(tmp_path, high_ns, unit)

    assert done.returncode != 0
    assert complaint in done.stderr


HALF = "-DIMAGE_STEP_HALF=1"
PERIODS = [
    ("rkm04", 10_000, 52_500),
    ("rkm04", 500, 62_000),
    ("rkm04", 500, 52_500, HALF),
    ("gve134", 500, 2500),
    ("positioning", 2500, 2500),
    ("positioning", 1000, 4000),
    ("positioning", 4500, 500),
    ("positioning", 1000, 2500, HALF),
    ("positioning", 3000, 2000, HALF),
]
"""What drivers may want of a unit at most: high, and low."""


@compiled
@pytest.mark.parametrize(("unit", "high_ns", "low_ns", "option"), [(*p, "")[:4] for p in PERIODS])
def test_drivers_may_want_no_more_time_for_a_pulse_than_the_highest_rate_of_the_unit_leaves(
    tmp_path: Path, unit: str, high_ns: int, low_ns: int, option: str
) -> None:
    options = [option] if option else []
    fits = compile_steps(tmp_path, high_ns, unit, low_ns, *options)
    long = compile_steps(tmp_path, high_ns, unit, low_ns + 50, *options)
    far = compile_steps(tmp_path, high_ns, unit, 51_130_565, *options)

    assert (fits.returncode, fits.stderr) == (0, "")
    for done in (long, far):  # so far that its ticks are few again
        assert done.returncode != 0
        assert "more time for a pulse than the highest rate of the unit leaves" in done.stderr


SPEEDS = {
    "rkm04": ("program/program_opcodes.def", r"^X\(SPEED, 'V', NUMBER, 1, (\d+)\)"),
    "gve134": ("speeds/gve_speeds.h", r"^#define GVE_SPEED_TOP (\d+)U"),
    "positioning": ("axis/pos_axis.h", r"^#define POS_SPEED_MAX \(UINT32_C\((\d+)\) "),
}


@pytest.mark.parametrize("unit", SPEEDS)
def test_the_highest_rate_of_an_image_is_that_of_its_unit(unit: str) -> None:
    file, pattern = SPEEDS[unit]
    speeds = re.findall(pattern, (ROOT / "firmware" / unit / file).read_text(), re.MULTILINE)
    defined = r"^#define IMAGE_STEPS_PER_S_MAX (\d+)U$"

    assert re.findall(defined, board.image_header(unit), re.MULTILINE) == speeds != []


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("BOARD_SUPPLY_MIN_MV 3135U", "BOARD_SUPPLY_MIN_MV 3099U", "never be seen as good"),
        ("BOARD_DETECT_LEVEL 6U", "BOARD_DETECT_LEVEL 7U", "never be seen as good"),
        ("BOARD_DETECT_LEVEL 6U", "BOARD_DETECT_LEVEL 5U", "never be seen as good"),
        ("BOARD_DETECT_LEVEL 6U", "BOARD_DETECT_LEVEL 4U", "might not be seen"),
        ("BOARD_SUPPLY_MIN_MV 3135U", "BOARD_SUPPLY_MIN_MV 2890U", "the part might never start"),
        ("BOARD_BROWN_OUT_LEVEL 3U", "BOARD_BROWN_OUT_LEVEL 0U", "cannot run at 168 MHz"),
        ("BOARD_FLASH_BYTES 4U", "BOARD_FLASH_BYTES 3U", "might not be seen"),
    ],
)
@compiled
def test_levels_that_do_not_fit_the_supply_do_not_compile(
    tmp_path: Path, old: str, new: str, complaint: str
) -> None:
    assert old in GOOD
    done = compile_one(tmp_path, "supply", GOOD.replace(old, new))

    assert done.returncode == 1
    assert complaint in done.stderr


ENABLE = """#define BOARD_ENABLE_PINS(X) X(EN_ALL, D, 2, OUT)
#define BOARD_ENABLE_READY_US 150U
#define BOARD_ENABLE_IDLE_MS 2500U
"""
LEVELS = ("STEP", "DIR", "ENABLE", "BI", "BO", "LED", "S1", "PWM")


def with_value(name: str, value: str) -> str:
    """A header that has nothing wrong but this value."""
    header = GOOD.replace(LAST, f"{ENABLE}#define BOARD_ENABLE_LEVEL 0U\n{LAST}")
    old = re.compile(rf"#define {name} .*\n")
    return old.sub("", header) + f"\n#define {name} {value}\n"


@compiled
@pytest.mark.parametrize(
    ("source", "name", "values"),
    [
        *(("pins", f"BOARD_{level}_LEVEL", ("0U", "1U")) for level in LEVELS),
        ("clock", "BOARD_CRYSTAL_MHZ", ("4U", "8U", "25U", "26U")),
        ("step", "BOARD_DIR_SETUP_NS", ("0U", "28750U")),
        ("step", "BOARD_DIR_HOLD_NS", ("0U", "100000U")),
        ("flash", "BOARD_LOADER_BYTES", ("0", "0x4000", "0xC000", "0x10000", "131072", "0xA0000")),
    ],
)
def test_values_that_a_board_can_have_compile(
    tmp_path: Path, source: str, name: str, values: tuple[str, ...]
) -> None:
    for value in values:
        done = compile_one(tmp_path, source, with_value(name, value))

        assert (value, done.returncode, done.stderr) == (value, 0, "")


TURN = "DIR to stand for longer"
ERASED, OVERLAPS = "flashing the image would erase the loader", "where programs are stored"


@compiled
@pytest.mark.parametrize(
    ("source", "name", "value", "complaint"),
    [
        *(("pins", f"BOARD_{level}_LEVEL", "2U", f"BOARD_{level}_LEVEL must") for level in LEVELS),
        *(("clock", "BOARD_CRYSTAL_MHZ", mhz, "must be 4 to 26") for mhz in ("0U", "3U", "27U")),
        ("step", "BOARD_DIR_SETUP_NS", "28751U", TURN),
        ("gpio_step", "BOARD_DIR_HOLD_NS", "100001U", TURN),
        ("gpio_step", "BOARD_DIR_HOLD_NS", "0U", "BOARD_DIR_HOLD_NS must be 1 or more"),
        ("gpio_step", "BOARD_DIR_SETUP_NS", "0x40000000U", TURN),
        ("step", "BOARD_DIR_HOLD_NS", "0xFFFFFFFFU", TURN),
        ("flash", "BOARD_LOADER_BYTES", "0x1000", ERASED),
        ("flash", "BOARD_LOADER_BYTES", "0x14000", ERASED),
        ("flash", "BOARD_LOADER_BYTES", "0x30000", ERASED),
        ("flash", "BOARD_LOADER_BYTES", "0xB4000", ERASED),
        ("flash", "BOARD_LOADER_BYTES", "0xC0000", OVERLAPS),
        ("flash", "BOARD_LOADER_BYTES", "0xE0000", OVERLAPS),
        ("flash", "BOARD_LOADER_BYTES", "-0x4000", OVERLAPS),
    ],
)
def test_values_that_no_board_can_have_do_not_compile(
    tmp_path: Path, source: str, name: str, value: str, complaint: str
) -> None:
    done = compile_one(tmp_path, source, with_value(name, value))

    assert done.returncode == 1
    assert complaint in done.stderr


def test_the_room_for_an_image_is_that_of_its_script() -> None:
    script = (ROOT / "hal/stm32/stm32f405.ld").read_text()
    flash = (ROOT / "hal/stm32/stm32_flash.c").read_text()

    assert "stm32_loader_bytes, LENGTH = 64K\n" in script
    assert "#define IMAGE_BYTES_MAX 0x10000U" in flash
