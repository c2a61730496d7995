"""The image of a board: where its parts lie, what it needs, and the commands around it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from checks import ram_code
from rkm04_tools import board, board_size, image_suffix
from rkm04_tools.failure import NO_CONNECTION, NOT_SO
from rkm04_tools.objects import Graph, binutil
from rkm04_tools.tree import ROOT

STACK_MARGIN_BYTES = 256

CORE_COUPLED = range(0x1000_0000, 0x1001_0001)
SRAM2 = range(0x2001_C000, 0x2002_0000)
"""RM0090 2.3.1: DMA reaches the second, not the first."""
SHARED = ("stm32_step", "stm32_shared_begin", "stm32_shared_end")

pytestmark = pytest.mark.skipif(
    not shutil.which(board.COMPILER),
    reason=f"{board.COMPILER} is not installed: run tools/setup test",
)


@pytest.fixture(scope="module", params=board.names())
def image(request: pytest.FixtureRequest) -> board.Image:
    return board.build(request.param)


def test_the_image_is_within_its_budgets(image):
    sizes = board_size.measure(image.file("elf"), image.folder)
    budgets = board_size.budgets()

    assert sizes.flash <= budgets.flash
    assert sizes.ram <= budgets.ram
    assert sizes.stack <= budgets.stack


def test_the_stack_has_a_margin(image):
    region, _ = board_size.sections(image.file("elf"))[".stack"]

    assert board_size.budgets().stack + STACK_MARGIN_BYTES <= region


def test_what_must_run_from_ram_does(image):
    assert ram_code.main(["rkm04", str(image.file("elf"))]) == 0


def test_the_version_is_baked_in(image):
    assert board.version().encode() in image.file("bin").read_bytes()


def test_the_image_begins_with_the_stack_and_the_reset_handler(image):
    first = image.file("bin").read_bytes()[:8]
    symbols = binutil("nm", image.file("elf"))
    address = {name: int(value, 16) for value, _, name in map(str.split, symbols)}

    assert int.from_bytes(first[:4], "little") == address["stm32_stack_top"]
    assert int.from_bytes(first[4:], "little") == address["stm32_reset"] | 1


def addresses(image: board.Image, what: str) -> dict[str, int]:
    """Of all symbols of some kinds, as nm names them."""
    found = (line.split() for line in binutil("nm", image.file("elf")))
    return {name: int(value, 16) for value, kind, name in found if kind in what}


def test_all_data_is_on_a_bus_of_its_own_and_what_dma_moves_is_where_it_can_reach_it(image):
    data = addresses(image, "bB")
    dma = {name: data.pop(name) for name in SHARED if name in data}

    assert [name for name, address in dma.items() if address not in SRAM2] == []
    assert [name for name, address in data.items() if address not in CORE_COUPLED] == []


def test_a_stack_that_overflows_leaves_the_memory(image):
    assert addresses(image, "bB")["stm32_stack_bottom"] == CORE_COUPLED.start
    tried = board.build(image.board, what=board.BRINGUP)
    assert addresses(tried, "bB")["stm32_stack_bottom"] == 0x2000_0000


def test_all_that_is_loaded_goes_into_the_flash(image):
    rows = [line.split() for line in binutil("readelf", "-lW", image.file("elf"))]
    loaded = [int(row[3], 16) for row in rows if row[:1] == ["LOAD"] and int(row[4], 16) > 0]

    assert loaded
    assert all(0x0800_0000 <= address < 0x0810_0000 for address in loaded)


def test_nothing_lies_where_a_null_pointer_leads(image):
    assert min(address for address in addresses(image, "tTrR").values() if address) >= 0x200


def test_dfu_util_finds_the_suffix_of_the_image_and_takes_it_off_again(image, tmp_path):
    without = tmp_path / "image.bin"
    without.write_bytes(image.file("bin").read_bytes())

    checked = subprocess.run(
        ["dfu-suffix", "-c", without], capture_output=True, text=True, check=True
    ).stdout
    subprocess.run(["dfu-suffix", "-D", without], capture_output=True, check=True)

    assert re.findall(r"^(Product|Vendor) ID:\s*(\w+)$", checked, re.MULTILINE) == [
        ("Product", "0xDF11"),
        ("Vendor", "0x0483"),
    ]
    assert without.stat().st_size == board_size.measure(image.file("elf"), image.folder).flash
    name = image.file("bin").read_bytes()[without.stat().st_size :]
    assert name.startswith(f"{image.name}\0".encode())


@pytest.mark.parametrize("name", ["", "x" * 33])
def test_a_name_that_has_no_place_in_the_suffix_is_refused(name):
    with pytest.raises(ValueError, match="1 to 32 characters"):
        image_suffix.suffixed(b"", name)


def test_no_path_of_the_machine_is_in_the_image(image):
    assert str(ROOT).encode() not in image.file("bin").read_bytes()


HEADING = "Relocation section '.rel.ram' at offset 0x1 contains 999 entries:"
GOOD = [HEADING, *["00003de4  00000102 R_ARM_ABS32  00003000   helper"] * ram_code.REFERENCES_MIN]
ENTRIES = [f"00003000 T {name}" for name in [*ram_code.ENTRIES, *ram_code.UNIT_ENTRIES["rkm04"]]]


def test_good_relocations_have_nothing_wrong():
    assert list(ram_code.find_errors("rkm04", GOOD, ENTRIES)) == []


@pytest.mark.parametrize(
    ("relocations", "symbols", "complaint"),
    [
        (
            [*GOOD, "00003c38  0003101e R_ARM_THM_JUMP24       080037a5   far"],
            ENTRIES,
            "refers to far",
        ),
        ([*GOOD, "00003c38  0003101e R_ARM_ABS32       08003000   .rodata"], ENTRIES, "to .rodata"),
        (GOOD[:50], ENTRIES, "only 49 relocations"),
        (GOOD, ENTRIES[1:], "stm32_step_interrupt is not in the image"),
        (
            GOOD,
            ["08003000 T stm32_step_interrupt", *ENTRIES[1:]],
            "stm32_step_interrupt lies in the flash",
        ),
    ],
)
def test_a_planted_fault_is_found(relocations, symbols, complaint):
    errors = list(ram_code.find_errors("rkm04", relocations, symbols))

    assert len(errors) == 1
    assert complaint in errors[0]


def test_references_of_other_sections_do_not_count():
    other = [
        "Relocation section '.rel.text' at offset 0x1:",
        "08000000  1e R_ARM_ABS32  08003000   far",
    ]

    assert list(ram_code.find_errors("rkm04", [*GOOD, *other], ENTRIES)) == []


def graph(**calls: set[str]) -> Graph:
    return Graph(frames=dict.fromkeys(calls, 8), calls=dict(calls))


def test_the_deepest_chain_counts():
    found = graph(a={"b", "c"}, b=set(), c={"d"}, d=set())

    assert board_size.deepest("a", found) == 24


def test_a_library_function_has_the_frame_of_the_table():
    assert board_size.deepest("a", graph(a={"memcpy"})) == 8 + board_size.LIBRARY_FRAMES["memcpy"]


@pytest.mark.parametrize(
    ("calls", "complaint"),
    [
        ({"a": {"b"}, "b": {"a"}}, "recursion through a"),
        ({"a": {"printf"}}, "nothing is known of printf, called by a"),
        ({"a": {board_size.INDIRECT}}, "a calls through a pointer"),
    ],
)
def test_a_stack_that_cannot_be_known_is_an_error(calls, complaint):
    with pytest.raises(board_size.Unknown, match=complaint):
        board_size.deepest("a", graph(**calls))


def test_a_call_through_a_pointer_counts_as_the_table_says():
    calls = {"stm32_tick_interrupt": {board_size.INDIRECT}, "rkm04.c:rkm04_tick_isr": set()}

    assert board_size.deepest("stm32_tick_interrupt", graph(**calls)) == 16


def test_build_names_the_files_and_the_version(tool):
    result = tool("board", "build", "--json")

    assert result.status == 0
    assert result.json["version"] == board.version()
    assert [Path(name).suffix for name in result.json["files"]] == [".elf", ".hex", ".bin"]
    assert all((ROOT / name).is_file() for name in result.json["files"])


def test_a_build_is_set_up_anew_only_when_the_presets_have_changed(image, tmp_path, monkeypatch):
    presets = tmp_path / "CMakePresets.json"
    presets.touch()
    os.utime(presets, (1e10, 1e10))  # later than any build
    called = []
    monkeypatch.setattr(board, "PRESETS", presets)
    monkeypatch.setattr(board, "_call", lambda command, *_: called.append(command[1]))

    board.build(image.board)
    os.utime(presets, (0, 0))
    board.build(image.board)

    assert called == ["--preset", "--build", "--build"]


def test_size_shows_the_budgets(tool):
    result = tool("board", "size", "--json")

    assert result.status == 0
    assert set(result.json) == {"board", "flash", "ram", "stack", "over"}


def test_size_fails_over_the_budget(tool, monkeypatch):
    monkeypatch.setattr(board_size, "budgets", lambda _: board_size.Sizes(1, 10**6, 10**6))

    result = tool("board", "size")

    assert result.status == NOT_SO
    assert "over the budget" in result.err
    assert result.err.rstrip().endswith("flash")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], ["openocd", "interface/stlink.cfg", "target/stm32f4x.cfg", "verify reset exit"]),
        (["--probe", "cmsis-dap"], ["interface/cmsis-dap.cfg"]),
        (["--tool", "dfu-util"], ["dfu-util", "0x08000000:leave", ".bin"]),
        (["--tool", "stm32flash", "--port", "/dev/ttyS9"], ["stm32flash -e ", "-v", "/dev/ttyS9"]),
        (["--board", "f407-discovery"], ["f407-discovery.elf"]),
    ],
)
def test_a_dry_run_shows_the_command(tool, arguments, expected):
    result = tool("board", "flash", "--dry-run", *arguments)

    assert result.status == 0
    assert all(part in result.out for part in expected)


def fake_tool(folder: Path, name: str, script: str) -> None:
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("openocd", "Error: open failed"),
        ("dfu-util", "No DFU capable USB device available"),
        ("stm32flash", "Failed to open port: /dev/ttyS9"),
    ],
)
def test_a_missing_board_is_one_line_with_advice(tool, tmp_path, monkeypatch, name, said):
    fake_tool(tmp_path, name, f"echo '{said}' >&2; exit 1")
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")

    result = tool("board", "flash", "--tool", name, "--port", "/dev/ttyS9")

    assert result.status == NO_CONNECTION
    assert f"{name} finds no board: " in result.complaint


def test_a_flasher_that_fails_otherwise_is_shown(tool, tmp_path, monkeypatch):
    fake_tool(tmp_path, "openocd", "echo verify error; exit 1")
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")

    result = tool("board", "flash")

    assert result.status == NOT_SO
    assert "verify error" in result.out


OPENOCD_SIZE = "case \"$*\" in *mdh*) echo '0x1fff7a22: {:04x} ';; *) echo written >>log;; esac"
DFU_NAME = '"@Internal Flash  /0x08000000/04*016Kg,01*064Kg,{:02d}*128Kg"'
DFU_LIST = """case "$*" in
*-l*) echo 'Found DFU: [0483:df11] ver=2200, alt=1, name="@Option Bytes  /0x1FFFC000/01*016 e"'
echo 'Found DFU: [0483:df11] ver=2200, devnum=5, cfg=1, intf=0, alt=0, name={}, serial="1"';;
*) echo written >>log; """


@pytest.fixture(scope="module")
def built() -> board.Image:
    return board.build(board.DEFAULT_BOARD)


@pytest.fixture
def fake(built, tmp_path, monkeypatch):
    """Tools of this name run such a script; what they write is in `log`. The image is there."""
    monkeypatch.setattr(board, "build", board.image_of)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    log: Path = tmp_path / "log"

    def put(name: str, script: str) -> Path:
        fake_tool(tmp_path, name, f"cd {tmp_path}\n{script}")
        return log

    return put


@pytest.mark.parametrize(
    ("name", "script"),
    [
        ("openocd", OPENOCD_SIZE.format(1024)),
        ("dfu-util", DFU_LIST.format(DFU_NAME.format(7)) + "exit 0;; esac"),
    ],
)
def test_a_flashed_board_is_told(tool, fake, name, script):
    log = fake(name, script)
    result = tool("board", "flash", "--tool", name)

    assert (result.status, result.out) == (0, "rkm04-f405 is flashed\n")
    assert log.read_text() == "written\n"


@pytest.mark.parametrize(
    ("name", "script"),
    [
        ("openocd", OPENOCD_SIZE.format(512)),
        ("dfu-util", DFU_LIST.format(DFU_NAME.format(3)) + "exit 0;; esac"),
    ],
)
def test_nothing_is_written_into_a_part_without_room_for_stored_programs(tool, fake, name, script):
    log = fake(name, script)
    result = tool("board", "flash", "--tool", name)

    assert result.status == NOT_SO
    assert "this part has 512 kB of flash" in result.complaint
    assert not log.exists()
    assert tool("board", "flash", "--tool", name, "--small", "--json").json["flash_kb"] == 512
    assert log.read_text() == "written\n"


@pytest.mark.parametrize("name", ["openocd", "stm32flash"])
def test_a_tool_that_does_not_tell_the_size_is_told(tool, fake, name):
    fake(name, "exit 0")
    result = tool("board", "flash", "--tool", name, "--port", "/dev/ttyS9")

    assert result.status == 0
    assert f"{name} does not tell the size of the flash" in result.out


@pytest.mark.parametrize(
    ("said", "ended", "status"),
    [
        ("File downloaded successfully", 74, 0),
        ("Download done.", 74, NOT_SO),
        ("File downloaded successfully", 1, NOT_SO),
        ("Error during download get_status", 74, NOT_SO),
    ],
)
def test_dfu_util_that_loses_the_board_after_its_work_has_done_it(tool, fake, said, ended, status):
    fake("dfu-util", f"case \"$*\" in *-l*) exit 0;; esac; echo '{said}'; "
         f"echo 'dfu-util: Error during download get_status' >&2; exit {ended}")  # fmt: skip

    assert tool("board", "flash", "--tool", "dfu-util").status == status


def test_a_flasher_that_is_not_installed_is_told(tool, monkeypatch):
    which = shutil.which
    monkeypatch.setattr(shutil, "which", lambda name: None if name == "openocd" else which(name))

    result = tool("board", "flash")

    assert result.status == NO_CONNECTION
    assert "openocd is not installed: apt-get install openocd" in result.complaint


def test_stm32flash_needs_a_port(tool):
    assert "needs --port" in tool("board", "flash", "--tool", "stm32flash").complaint
